"""Times and limits of uploads."""

from __future__ import annotations

from msgspec import Struct


class UploadNameLimits(Struct, frozen=True, kw_only=True):
    """Names of uploads."""

    max_letters: int = 100
    """Longer names are cut in the middle; the ending stays visible."""
    max_folders: int = 8
    """Folders in a name."""


UPLOAD_NAMES = UploadNameLimits()


class ReceiveTuning(Struct, frozen=True, kw_only=True):
    """Bytes that arrive."""

    gather_bytes: int = 1 << 20
    """The network delivers about 64 kB at a time; writes are gathered to this size."""
    silent_s: float = 30.0
    """A sender without data for this long is disconnected [s]."""


RECEIVING = ReceiveTuning()


class SettleTimes(Struct, frozen=True, kw_only=True):
    """An upload that is given up."""

    settles_within_s: float = 3.0
    """Its file is closed within this time [s]."""


SETTLING = SettleTimes()


class TusLimits(Struct, frozen=True, kw_only=True):
    """Heads of the tus protocol."""

    max_metadata: int = 8192
    """Longest metadata."""


TUS = TusLimits()
