"""Tuning of the readers."""

from __future__ import annotations

from dataclasses import dataclass

from recon4.settings import IngestSettings


@dataclass(frozen=True, slots=True, kw_only=True)
class IngestTuning(IngestSettings):
    """Reading a recording: times of packets and messages (docs/reference/recordings.md)."""

    reorder_window_s: float = 0.2
    """Packets out of order by at most this are sorted [s]."""
    gap_s: float = 0.2
    """A jump of the clock larger than this is reported as a gap [s]."""
