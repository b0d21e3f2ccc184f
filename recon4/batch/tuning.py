"""Limits of batches."""

from __future__ import annotations

from dataclasses import dataclass


@dataclass(frozen=True, slots=True, kw_only=True)
class BatchTuning:
    """Processes of walks."""

    last_lines: int = 20
    """Lines of a process that are kept for what it complained of."""


BATCH = BatchTuning()
