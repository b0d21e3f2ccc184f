"""Texts about how a worker ended that wrote no outcome."""

from __future__ import annotations

import signal

from recon4.system.stopping import SIGNALS

REASONS = {
    signal.SIGKILL: "was killed from outside; often the memory of the computer was not enough",
    signal.SIGSEGV: "crashed in native code (segmentation fault)",
    signal.SIGABRT: "was given up by native code (abort)",
    signal.SIGBUS: "crashed reading a file that got shorter (bus error)",
    signal.SIGFPE: "crashed in native code (arithmetic)",
    signal.SIGILL: "needs a processor with more instructions (illegal instruction)",
    signal.SIGTERM: "was ended from outside",
}
_STOPPED = {128 + number: -number for number in SIGNALS}
"""Exit code of a worker that a signal stopped in order -> what the kernel reports of a signal."""


def exit_reason(code: int | None) -> str:
    """How a worker ended, from its exit code; None = no server saw it end."""
    if code is None:
        return "died while no server watched"
    code = _STOPPED.get(code, code)
    if code >= 0:
        return f"ended without a result (exit code {code})"
    try:
        kind = signal.Signals(-code)
    except ValueError:
        return f"was ended by signal {-code}"
    return f"{REASONS.get(kind, 'was ended')} [{kind.name}]"
