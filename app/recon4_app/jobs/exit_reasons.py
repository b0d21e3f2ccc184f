"""How a worker ended that wrote no outcome: words of `recon4/locales/en/endings.ftl`."""

from __future__ import annotations

import signal

from recon4.system.stopping import SIGNALS

_STOPPED = {128 + number: -number for number in SIGNALS}
"""Exit code of a worker that a signal stopped in order -> what the kernel reports of a signal."""


def exit_reason(code: int | None) -> tuple[str, int]:
    """How a worker ended, from its exit code; None = no server saw it end.

    Returns:
        ``unseen``, ``code``, ``signal`` or the name of a signal, and the number of code or signal.
    """
    if code is None:
        return "unseen", 0
    code = _STOPPED.get(code, code)
    if code >= 0:
        return "code", code
    try:
        return signal.Signals(-code).name, -code
    except ValueError:
        return "signal", -code
