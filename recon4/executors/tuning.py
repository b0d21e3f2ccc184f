"""Limits of executors."""

from __future__ import annotations

import logging

from msgspec import Struct


class ClusterTuning(Struct, frozen=True, kw_only=True):
    """Workers of Dask."""

    most_workers: int = 256
    """Processes of one machine."""
    connects_within_s: float = 20.0
    """Time a scheduler may take to answer [s]."""
    log_level: int = logging.CRITICAL
    """Of the messages of Dask; a task that is lost is reported by its result."""


CLUSTER = ClusterTuning()
