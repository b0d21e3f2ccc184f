"""Confines this process with all barriers of the kernel, before it opens a user's file."""

from __future__ import annotations

import logging
import os
import sys
import tempfile
from collections.abc import Callable
from pathlib import Path

from recon4.sandbox import landlock, seccomp
from recon4.sandbox.environment import allowed_environment
from recon4.sandbox.installation import WRITABLE, readable_paths
from recon4.sandbox.kernel import PR_SET_NO_NEW_PRIVS, prctl, threads_of_this_process
from recon4.sandbox.landlock import FileRight
from recon4.sandbox.limits import apply_rlimits
from recon4.sandbox.namespaces import drop_capabilities, own_network
from recon4.sandbox.policy import Barrier, Confinement, Network, Policy

log = logging.getLogger("recon4.sandbox")

NOTHING_KEPT_FROM = {
    "privileges": "a program with the setuid bit gains its rights",
    "environment": "",
    "limits": "one file may exhaust memory, disk or processor",
    "files": "a hostile file that takes over a parser reads every file of this user",
    "calls": "a hostile file that takes over a parser reaches the network and other processes",
    "network": "only the filter of system calls keeps it from the network",
    "capabilities": "it keeps the rights of root",
}
"""Barrier -> consequence if it is missing."""


def confine(policy: Policy) -> Confinement:
    """Confine this process and its children permanently. Call before other threads start.

    Where the kernel lacks a barrier the others still go up; what is missing is logged as a
    warning and is in the record.

    Args:
        policy: What stays allowed.

    Returns:
        Which barriers hold.

    Raises:
        RuntimeError: If other threads run already: the kernel would not confine those. Set one
            thread for BLAS (``OPENBLAS_NUM_THREADS=1``) or confine before numpy is imported.
    """
    if (count := threads_of_this_process()) > 1:
        raise RuntimeError(f"confine() must come before other threads; {count} are running")
    _use_temporary(policy.temporary)
    _drop_environment()
    steps: list[tuple[str, Callable[[], str]]] = [
        ("privileges", _no_new_privileges),
        ("network", lambda: _network(policy)),
        ("capabilities", _capabilities),
        ("limits", lambda: _limits(policy)),
        ("files", lambda: _files(policy)),
        ("calls", lambda: _calls(policy)),
    ]
    confinement = Confinement(tuple(_try(name, step) for name, step in steps))
    log.log(logging.WARNING if confinement.missing else logging.INFO, "%s", confinement)
    return confinement


def refuse_new_sockets() -> None:
    """Refuse sockets, connections and listening from now on; open ones stay usable.

    For a process that opens its ports first and reads from strangers afterwards. Without effect
    where there is no filter of system calls.
    """
    try:
        seccomp.restrict(network=Network.NONE, processes=False)
    except OSError as error:
        log.warning("new sockets are not refused: %s", error)


def _try(name: str, step: Callable[[], str]) -> Barrier:
    try:
        return Barrier(name, holds=True, detail=step())
    except OSError as error:
        return Barrier(name, holds=False, detail=f"{error}; {NOTHING_KEPT_FROM[name]}")


def _use_temporary(folder: Path | None) -> None:
    if folder is None:
        return
    folder.mkdir(mode=0o700, parents=True, exist_ok=True)
    os.environ["TMPDIR"] = tempfile.tempdir = str(folder)


def _drop_environment() -> None:
    for name in os.environ.keys() - allowed_environment(os.environ).keys():
        del os.environ[name]


def _no_new_privileges() -> str:
    prctl(PR_SET_NO_NEW_PRIVS, 1)
    return "no_new_privs"


def _network(policy: Policy) -> str:
    if policy.network is Network.RECEIVE:
        return "its own ports need the network of this computer"
    return own_network()


def _capabilities() -> str:
    drop_capabilities()
    return "dropped"


def _limits(policy: Policy) -> str:
    apply_rlimits(policy)
    return "memory, files, threads"


def _files(policy: Policy) -> str:
    version = landlock.abi()
    if version == 0:
        raise OSError("this kernel has no Landlock (Linux 5.13 or later, turned on)")
    landlock.restrict(_rules(policy))
    scopes = "" if version >= landlock.Since.SCOPES else ", no scope of signals (since Linux 6.12)"
    return f"Landlock ABI {version}{scopes}"


def _rules(policy: Policy) -> list[tuple[Path, FileRight]]:
    sockets = FileRight.MAKE_SOCK if policy.network in (Network.UNIX, Network.RECEIVE) else 0
    write = FileRight.WRITE | sockets
    rules = [(path, FileRight.READ) for path in (*readable_paths(), *policy.read)]
    rules += [(path, write) for path in (*map(Path, WRITABLE), *policy.write)]
    if policy.temporary is not None:
        rules.append((policy.temporary, write))
    if policy.processes:
        programs = [sys.executable, sys.prefix, sys.base_prefix, "/usr/bin", "/bin"]
        programs += ["/usr/lib", "/lib", "/lib64"]
        rules += [(Path(path), FileRight.READ | FileRight.EXECUTE) for path in programs]
    return rules


def _calls(policy: Policy) -> str:
    seccomp.restrict(network=policy.network, processes=policy.processes)
    return "seccomp"
