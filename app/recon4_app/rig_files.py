"""Rig files of users: parsed in a confined child, never in the server."""

from __future__ import annotations

from pathlib import Path

from starlette.concurrency import run_in_threadpool

from recon4.model.rig import load_rig
from recon4_app.compute_pool.model import FileAccess, Lane, Terms
from recon4_app.compute_pool.pool import ComputePool
from recon4_app.network.request_caller import Caller
from recon4_app.projects.inspect_recording import files_beside
from recon4_app.rigs.rig_work import described_rig
from recon4_app.tuning import RIG_FILE_TIMES


async def check_rig_file(pool: ComputePool, caller: Caller, path: Path) -> None:
    """Check that a file is a rig.

    Raises:
        ConfigError: If it is not a rig file.
        ComputeFailed: If it takes too long to parse.
    """
    await caller.wait(pool.run_interactive(Lane.INSPECT, _terms(caller, path), rig_name, path))


async def read_rig_file(pool: ComputePool, caller: Caller, path: Path) -> str:
    """The text of a rig file with the files beside it that describe its LiDARs.

    Raises:
        ConfigError: If it is not a rig file.
        ComputeFailed: If it takes too long to parse.
    """
    beside = await run_in_threadpool(files_beside, path)
    terms = _terms(caller, path, *beside)
    return await caller.wait(pool.run_interactive(Lane.INSPECT, terms, described_rig, path, beside))


def _terms(caller: Caller, *paths: Path) -> Terms:
    return Terms(person=caller.name, access=FileAccess(read=paths), limit_s=RIG_FILE_TIMES.limit_s)


def rig_name(path: Path) -> str:
    """The name of the rig in a file."""
    return load_rig(path).name
