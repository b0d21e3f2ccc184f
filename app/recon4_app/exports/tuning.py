"""Limits of exports that are kept."""

from __future__ import annotations

from msgspec import Struct


class KeptExportLimits(Struct, frozen=True, kw_only=True):
    """Files that exports have made."""

    kept_s: float = 7 * 86_400.0
    """A file is kept this long, unless all exceed `max_bytes` [s]; its row is kept for ever."""
    max_bytes: int = 100 << 30
    """Of all files; the oldest are removed first."""
    listed: int = 200
    """Newest rows on the page of a project."""
    check_limit_s: float = 600.0
    """Longest time of the verification of a delivery [s]: 100 GB at 170 MB/s."""
    estimate_limit_s: float = 60.0
    """Longest time of an estimate [s]."""


KEPT_EXPORTS = KeptExportLimits()
