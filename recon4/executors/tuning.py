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
    without_workers_s: float = 60.0
    """A scheduler whose workers have been gone for this long is given up [s]."""
    lost_worker_s: float = 86_400.0
    """A killed worker of this machine is started again; this long Dask waits before it ends for
    good what starts it: its 15 s are too few for a busy computer [s]."""
    looks_every_s: float = 2.0
    """Whether it has workers is looked at this often [s]."""
    log_level: int = logging.CRITICAL
    """Of the messages of Dask; a task that is lost is reported by its result."""


CLUSTER = ClusterTuning()
