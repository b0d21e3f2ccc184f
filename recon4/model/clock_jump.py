"""A jump of all clocks of a recording at once."""

from __future__ import annotations

from dataclasses import dataclass


@dataclass(frozen=True, slots=True)
class ClockJump:
    """Where all clocks were set ahead: nothing is missing there, only the times go on later."""

    t_ns: int
    """Last time before it, as recorded [ns]."""
    length_ns: int
    """By how much the clocks were set ahead [ns]."""
