"""Sandbox of a process that reads users' files: no network, no secrets, only its own files.

    policy = Policy(read=(recording,), write=(project,), temporary=folder / "tmp",
                    memory_bytes=4 << 30, cpu_s=3600)
    confinement = confine(policy)    # in the child, before other threads and the user's file

The parent starts the child with ``allowed_environment``. `Confinement` reports which barriers this
computer provides; ``recon4 doctor`` prints them.
"""

from recon4.sandbox.available_barriers import available_barriers
from recon4.sandbox.confine import confine, refuse_new_sockets
from recon4.sandbox.environment import (
    ONE_THREAD,
    allowed_environment,
    restart_with_one_thread,
)
from recon4.sandbox.policy import Barrier, Confinement, Network, Policy

__all__ = [
    "ONE_THREAD",
    "Barrier",
    "Confinement",
    "Network",
    "Policy",
    "allowed_environment",
    "available_barriers",
    "confine",
    "refuse_new_sockets",
    "restart_with_one_thread",
]
