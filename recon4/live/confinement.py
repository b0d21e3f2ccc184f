"""What recorder and mapper may do: they take bytes from strangers on the network."""

from __future__ import annotations

import shutil
from pathlib import Path

from recon4.live.session import CaptureSession
from recon4.model.rig import Rig
from recon4.sandbox import Confinement, Network, Policy, confine, restart_with_one_thread
from recon4.sandbox.limits import physical_memory_bytes
from recon4.sandbox.private_cache import cached_elsewhere, private_cache

_SHARE_OF_MEMORY = 0.7
_OPEN_FILES = 1024


def confine_recorder(session: CaptureSession, rig: Rig) -> Confinement:
    """Let this process write the recording and receive datagrams, and nothing else.

    With a serial GNSS receiver it also opens devices, because a receiver that is plugged in again
    is another file in ``/dev``.
    """
    restart_with_one_thread()
    devices = (Path("/dev"),) if rig.gnss_serial else ()
    policy = Policy(
        write=(session.capture.parent, session.folder, _sockets(session), *devices),
        read=(session.project,),
        network=Network.RECEIVE,
        memory_bytes=_memory_bytes(),
        open_files=_OPEN_FILES,
    )
    return confine(policy)


def confine_mapper(session: CaptureSession) -> Confinement:
    """Let this process write its project and talk over Unix sockets, and nothing else."""
    restart_with_one_thread()
    policy = Policy(
        write=(session.project, _sockets(session)),
        read=cached_elsewhere(scratch_of(session)),
        temporary=scratch_of(session) / "tmp",
        network=Network.UNIX,
        memory_bytes=_memory_bytes(),
        open_files=_OPEN_FILES,
    )
    return confine(policy)


def mapper_environment(session: CaptureSession) -> dict[str, str]:
    """What the mapper needs in its environment besides the usual: its caches, made here."""
    shutil.rmtree(scratch_of(session), ignore_errors=True)  # of a mapper that was killed
    return private_cache(scratch_of(session) / "caches")


def scratch_of(session: CaptureSession) -> Path:
    """Folder of the mapper's temporary files; to be removed when it ends."""
    return session.folder / "scratch"


def _sockets(session: CaptureSession) -> Path:
    return session.socket("mapper").parent


def _memory_bytes() -> int:
    return int(_SHARE_OF_MEMORY * physical_memory_bytes())
