"""Times and limits of uploads."""

from __future__ import annotations

from dataclasses import dataclass


@dataclass(frozen=True, slots=True, kw_only=True)
class UploadNameLimits:
    """Names of uploads."""

    max_letters: int = 100
    """Longer names are cut in the middle; the ending stays visible."""
    max_folders: int = 8
    """Folders in a name."""


UPLOAD_NAMES = UploadNameLimits()


@dataclass(frozen=True, slots=True, kw_only=True)
class ReceiveTuning:
    """Bytes that arrive."""

    gather_bytes: int = 1 << 20
    """The network delivers about 64 kB at a time; writes are gathered to this size."""
    silent_s: float = 30.0
    """A sender without data for this long is disconnected [s]."""


RECEIVING = ReceiveTuning()


@dataclass(frozen=True, slots=True, kw_only=True)
class SettleTimes:
    """An upload that is given up."""

    settles_within_s: float = 3.0
    """Its file is closed within this time [s]."""


SETTLING = SettleTimes()


@dataclass(frozen=True, slots=True, kw_only=True)
class TusLimits:
    """Heads of the tus protocol."""

    max_metadata: int = 8192
    """Longest metadata."""


TUS = TusLimits()
