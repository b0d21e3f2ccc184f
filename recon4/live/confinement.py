"""Sandbox policies of recorder and mapper, which read bytes from unknown network senders."""

from __future__ import annotations

import shutil
from pathlib import Path

from recon4.live.session import CaptureSession
from recon4.sandbox import Confinement, Network, Policy, confine, restart_with_one_thread
from recon4.sandbox.limits import physical_memory_bytes
from recon4.sandbox.private_cache import cached_elsewhere, private_cache
from recon4.sandbox.tuning import CONFINEMENT


def confine_recorder(session: CaptureSession) -> Confinement:
    """Allow this process to write the recording and to receive datagrams, nothing else.

    It opens no device: `DeviceOpener` hands it the descriptor of a serial receiver.
    """
    policy = Policy(
        write=(session.capture.parent, session.folder, _sockets(session)),
        read=(session.project,),
        network=Network.RECEIVE,
        memory_bytes=_memory_bytes(),
        open_files=CONFINEMENT.open_files_live,
    )
    return confine(policy)


def confine_mapper(session: CaptureSession) -> Confinement:
    """Allow this process to write its project and to use Unix sockets, nothing else."""
    restart_with_one_thread()
    policy = Policy(
        write=(session.project, _sockets(session)),
        read=cached_elsewhere(scratch_of(session)),
        temporary=scratch_of(session) / "tmp",
        network=Network.UNIX,
        memory_bytes=_memory_bytes(),
        open_files=CONFINEMENT.open_files_live,
    )
    return confine(policy)


def mapper_environment(session: CaptureSession) -> dict[str, str]:
    """Additional environment variables of the mapper: its cache folders, created here."""
    shutil.rmtree(scratch_of(session), ignore_errors=True)  # left by a mapper that was killed
    return private_cache(scratch_of(session) / "caches")


def scratch_of(session: CaptureSession) -> Path:
    """Folder of the mapper's temporary files; removed when it ends."""
    return session.folder / "scratch"


def _sockets(session: CaptureSession) -> Path:
    return session.socket("mapper").parent


def _memory_bytes() -> int:
    return int(CONFINEMENT.memory_fraction * physical_memory_bytes())
