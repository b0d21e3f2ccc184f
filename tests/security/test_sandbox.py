"""Hostile code inside each confined process: 0 of 31 deeds succeed, as root and as another user.

Without confinement the same code succeeds with nearly all of them, so the list means something.
"""

import json
import os
import platform
import shutil
import signal
import socket
import subprocess
import sys
import tempfile
from pathlib import Path

import pytest

from recon4.sandbox import kernel, landlock
from recon4.sandbox.private_cache import KERNELS
from recon4.sandbox.syscalls import number
from recon4_app.jobs.folder import JobFolder, Limits
from recon4_app.jobs.model import Inputs
from recon4_app.settings import worker_environment

pytestmark = pytest.mark.skipif(
    kernel.machine() is None or landlock.abi() < landlock.Since.SCOPES,
    reason="needs Linux 6.12 or later with Landlock: `recon4 doctor` says what follows",
)
KINDS = ("worker", "viewer", "recorder", "mapper")
ORDINARY = 65534
AS_ROOT_ONLY = {"bpf", "new namespaces", "io_uring"}
"""What other users may not do anyway, or needs more than an empty request."""
WITHIN_S = 120.0


@pytest.fixture
def root():
    """A folder of projects with a key; not below pytest's own, which other users cannot enter."""
    root = Path(tempfile.mkdtemp(prefix="recon4-hostile-"))
    for name in ("mine/live", "mine/recordings", "mine/jobs", "other", ".recon4/jobs/j"):
        (root / name).mkdir(parents=True)
    (root / ".recon4" / "signing.key").write_text("the key")
    (root / "other" / "project.json").write_text("{}")
    yield root
    shutil.rmtree(root, ignore_errors=True)


@pytest.fixture
def ports():
    """A listening TCP port and a listening UDP port."""
    with (
        socket.create_server(("127.0.0.1", 0)) as tcp,
        socket.socket(type=socket.SOCK_DGRAM) as udp,
    ):
        udp.bind(("127.0.0.1", 0))
        tcp.setblocking(False)
        udp.setblocking(False)
        yield tcp, udp


def attack(root, ports, kind, user=None):
    """What the hostile child found, from a file it may write."""
    jobs = JobFolder(root / ".recon4" / "jobs" / "j")
    limits = Limits(memory_bytes=8 << 30, reserve_bytes=0)
    jobs.prepare(Inputs(recordings=()), root / "mine", limits)
    mine = jobs.path if kind in ("worker", "none") else root / "mine" / "live"
    machine = platform.machine()
    facts = {"root": str(root), "mine": str(mine), "port": ports[0].getsockname()[1]}
    facts |= {"udp": ports[1].getsockname()[1], "kernel": str(next(KERNELS.rglob("*.nbi")))}
    facts |= {"unshare": number("unshare", machine), "bpf": number("bpf", machine)}
    (mine / "facts.json").write_text(json.dumps(facts))
    give_away(root, user)
    command = [sys.executable, "-m", "tests.security.hostile", kind, str(mine / "facts.json")]
    command += [] if user is None else [str(user)]
    code = f"import subprocess, sys; sys.exit(subprocess.run({command!r}).returncode)"
    environment = worker_environment() | {"PYTHONDONTWRITEBYTECODE": "1"}
    parent = subprocess.Popen([sys.executable, "-c", code], env=environment, start_new_session=True)
    try:
        assert parent.wait(WITHIN_S) == 0
    finally:
        os.killpg(parent.pid, signal.SIGKILL) if parent.poll() is None or kind == "none" else None
    return json.loads((mine / "outcomes.json").read_text())


def give_away(root, user):
    if user is not None:
        for path in (root, *root.rglob("*")):
            os.chown(path, user, user)


def heard(ports):
    """How many connections and datagrams came."""
    count = 0
    for take in (lambda: ports[0].accept()[0].close(), lambda: ports[1].recv(100)):
        try:
            take()
            count += 1
        except BlockingIOError:
            continue
    return count


def succeeded(found):
    secrets = {"secrets in the environment": ""}
    return {deed for deed, outcome in (found["outcomes"] | secrets).items() if outcome == "done"}


@pytest.mark.parametrize("kind", KINDS)
def test_hostile_code_gets_nowhere(root, ports, kind, monkeypatch):
    monkeypatch.setenv("SECRET_OF_THE_SERVER", "x")

    found = attack(root, ports, kind)

    assert succeeded(found) == set()
    assert len(found["outcomes"]) == 31
    assert found["outcomes"]["secrets in the environment"] == ""
    assert heard(ports) == 0
    assert (root / "other" / "project.json").read_text() == "{}"


@pytest.mark.skipif(os.geteuid() != 0, reason="changes its user")
@pytest.mark.parametrize("kind", KINDS)
def test_nor_does_it_as_an_ordinary_user(root, ports, kind):
    found = attack(root, ports, kind, ORDINARY)

    assert succeeded(found) == set()
    assert heard(ports) == 0
    assert found["threads"] < 2000


@pytest.mark.skipif(os.geteuid() != 0, reason="as another user fewer deeds would succeed")
def test_without_confinement_it_gets_everywhere(root, ports):
    found = attack(root, ports, "none")

    assert found["outcomes"].keys() - succeeded(found) <= AS_ROOT_ONLY | {
        "secrets in the environment"
    } | {"read another project", "remove another project", "truncate another project"}
    assert heard(ports) == 2
