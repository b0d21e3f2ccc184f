"""The audit log on a full disk: nothing is done that is not in it, and it stays readable."""

import subprocess
import sys
from contextlib import contextmanager

import httpx
import pytest

from recon4_app.access.disk_reserve import RESERVE_FILE
from recon4_app.access.tuning import RESERVE
from tests.service.running import ROOT
from tests.service.secure import PASSWORD, secure_server

SIZE = "24m"


@contextmanager
def small_disk(place):
    place.mkdir()
    subprocess.run(["mount", "-t", "tmpfs", "-o", f"size={SIZE}", "tmpfs", place], check=True)
    try:
        yield place
    finally:
        subprocess.run(["umount", "-l", place], check=True)


@pytest.fixture
def disk(tmp_path):
    try:
        with small_disk(tmp_path / "probe"):
            pass
    except (OSError, subprocess.CalledProcessError):
        pytest.skip("mounts a small disk")
    with small_disk(tmp_path / "disk") as place:
        yield place


def fill(disk):
    filler = disk / "filler"
    with filler.open("wb", buffering=0) as file:
        try:
            while file.write(bytes(4096)):
                pass
        except OSError:
            return filler


def done(log):
    """Action and object of what was done, the oldest first."""
    return [
        (one["action"], one["object"])
        for one in reversed(log["entries"])
        if one["outcome"] == "done"
    ]


def person(name):
    return {"name": name, "role": "viewer", "password": PASSWORD}


def test_on_a_full_disk_people_sign_in_and_what_is_acknowledged_is_in_the_log(disk):
    with secure_server(disk) as server, server.signed_in("anna") as anna:
        filler = fill(disk)
        with server.signed_in("vera") as vera:
            forbidden = vera.post("/api/people", json=person("eva"))
        added = anna.post("/api/people", json=person("ida"))
        log = anna.get("/api/audit").json()
        filler.unlink()
        anna.post("/api/people", json=person("ota"))
        kept = (disk / ".recon4" / RESERVE_FILE).stat().st_size

    assert (forbidden.status_code, added.status_code) == (403, 201)
    assert done(log)[-2:] == [("sign in", "viewer"), ("add person", "ida, viewer")]
    assert log["chain"]["broken_at"] is None
    assert kept > RESERVE.reserve_bytes // 2


def test_when_the_reserve_is_used_up_nothing_is_done_that_is_not_in_the_log(disk):
    roles = ("viewer", "operator")
    with secure_server(disk) as server, server.signed_in("anna") as anna:
        (disk / ".recon4" / RESERVE_FILE).write_bytes(bytes(3 * RESERVE.needed_bytes))
        filler = fill(disk)
        answers = [anna.patch("/api/people/vera", json={"role": roles[k % 2]}) for k in range(60)]
        acknowledged = [f"vera, {roles[k % 2]}" for k, a in enumerate(answers) if a.is_success]
        role = {one["name"]: one["role"] for one in anna.get("/api/people").json()}["vera"]
        log = anna.get("/api/audit?most=1000").json()
        otto = {"name": "otto", "password": PASSWORD}
        late = [
            httpx.post(f"{server.url}/api/login", json=otto, verify=server.trust())
            for _ in range(20)
        ]
        signed_in = done(anna.get("/api/audit?most=1000").json())[len(done(log)) :]
        command = recon4("users", "audit", "--root", disk, "--last", "1")
        refused = recon4("users", "disable", "vera", "--root", disk)
        filler.unlink()
        after = anna.patch("/api/people/vera", json={"role": "reviewer"})
        whole = anna.get("/api/audit").json()["chain"]

    assert {answer.status_code for answer in answers} == {200, 507}
    assert "the space kept for the audit log" in answers[-1].json()["detail"]
    assert [what for action, what in done(log) if action == "set role"] == acknowledged
    assert acknowledged[-1] == f"vera, {role}"
    assert log["chain"]["broken_at"] is None
    assert {answer.status_code for answer in late} == {200, 507}
    assert "the disk is full" in late[-1].json()["detail"]
    assert signed_in == [("sign in", "operator")] * sum(answer.is_success for answer in late)
    assert command.returncode == 0 and "otto" in command.stdout, command.stderr
    assert refused.returncode == 1 and "the disk is full" in refused.stderr
    assert "Traceback" not in refused.stderr and len(refused.stderr.splitlines()) == 1
    assert (after.status_code, whole["broken_at"]) == (200, None)


def recon4(*arguments):
    command = [sys.executable, "-m", "recon4", *map(str, arguments)]
    return subprocess.run(command, capture_output=True, text=True, check=False, cwd=ROOT)
