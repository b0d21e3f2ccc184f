"""Limits of batches."""

from __future__ import annotations

from msgspec import Struct


class BatchTuning(Struct, frozen=True, kw_only=True):
    """Processes of walks."""

    last_lines: int = 20
    """Lines of a process that are kept for what it complained of."""


BATCH = BatchTuning()
