"""Compares the values that a browser sends with its widgets, before viser (pinned: 1.1.1) does.

viser casts whatever it is sent to the type of the widget's value and sets any property named in
the message, so a raw client could store what no widget gives.
"""

from __future__ import annotations

import logging
import math
from typing import Any

import viser
from viser import _messages

from recon4_app.viewer.tuning import VIEWS

log = logging.getLogger(__name__)


def only_fitting_values(gui: viser.GuiApi) -> None:
    """Have viser apply values that fit their widgets only; the first other one is logged."""
    interface, said = gui._websock_interface, False

    async def check(client_id: Any, message: _messages.GuiUpdateMessage) -> None:
        nonlocal said
        widget = gui._gui_input_handle_from_uuid.get(message.uuid)
        if widget is None:  # removed meanwhile, or of another browser
            return
        try:
            message.updates = {"value": fitting(widget, message.updates["value"])}
        except ValueError as error:
            if not said:
                log.warning("ignored a value from a browser: %s", error)
            said = True
            return
        await gui._handle_gui_updates(client_id, message)

    interface.unregister_handler(_messages.GuiUpdateMessage)
    interface.register_handler(_messages.GuiUpdateMessage, check)


def fitting(widget: object, value: object) -> bool | float | str:
    """A value as the widget has it; a number beyond a slider is the slider's end.

    Raises:
        ValueError: If the widget cannot have it.
    """
    match widget:
        case viser.GuiButtonHandle() if value is True:
            return True
        case viser.GuiCheckboxHandle() if isinstance(value, bool):
            return value
        case viser.GuiDropdownHandle() if isinstance(value, str) and value in widget.options:
            return value
        case viser.GuiSliderHandle():
            number = _number(value, whole=isinstance(widget.value, int))
            return min(max(number, widget.min), widget.max)
        case viser.GuiNumberHandle():
            return _number(value, whole=isinstance(widget.value, int))
    raise ValueError(f"expected one for a {type(widget).__name__}, got {str(value)[:40]!r}")


def _number(value: object, *, whole: bool) -> float:
    if isinstance(value, bool) or not isinstance(value, (int, float)):
        raise ValueError(f"expected a number, got {str(value)[:40]!r}")
    if not (math.isfinite(value) and abs(value) <= VIEWS.max_number):
        raise ValueError(f"expected a number up to {VIEWS.max_number:g}, got {value:g}")
    if whole and value != int(value):
        raise ValueError(f"expected a whole number, got {value:g}")
    return int(value) if whole else float(value)
