"""The keys of the viewer, for its controls and for the list of keys on its page."""

from __future__ import annotations

from typing import Any

HOTKEYS: tuple[tuple[Any, str], ...] = (
    ("N", "normalized"),
    ("R", "surface"),
    ("F", "fit"),
    ("7", "above"),
    ("1", "south"),
    ("3", "east"),
    ("O", "narrow"),
    ("M", "measure"),
    ("escape", "stop"),
    ("G", "stretch"),
    ("P", "play"),
)
"""Key and name for `PanelCallbacks.command`; its label is the text ``hotkey-NAME``."""
