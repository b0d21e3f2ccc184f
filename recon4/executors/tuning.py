"""Limits of executors."""

from __future__ import annotations

import logging
from dataclasses import dataclass


@dataclass(frozen=True, slots=True, kw_only=True)
class ClusterTuning:
    """Workers of Dask."""

    most_workers: int = 256
    """Processes of one machine."""
    connects_within_s: float = 20.0
    """Time a scheduler may take to answer [s]."""
    log_level: int = logging.CRITICAL
    """Of the messages of Dask; a task that is lost is reported by its result."""


CLUSTER = ClusterTuning()
