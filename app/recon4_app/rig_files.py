"""Rig files of users: parsed in a confined child, never in the server."""

from __future__ import annotations

from pathlib import Path

from recon4.model.rig import load_rig
from recon4_app.compute_pool.model import FileAccess, Lane, Terms
from recon4_app.compute_pool.pool import ComputePool
from recon4_app.network.request_caller import Caller
from recon4_app.tuning import RIG_FILE_TIMES


async def check_rig_file(pool: ComputePool, caller: Caller, path: Path) -> None:
    """Check that a file is a rig.

    Raises:
        ConfigError: If it is not a rig file.
        ComputeFailed: If it takes too long to parse.
    """
    terms = Terms(
        person=caller.name, access=FileAccess(read=(path,)), limit_s=RIG_FILE_TIMES.limit_s
    )
    await caller.wait(pool.run_interactive(Lane.INSPECT, terms, rig_name, path))


def rig_name(path: Path) -> str:
    """The name of the rig in a file."""
    return load_rig(path).name
