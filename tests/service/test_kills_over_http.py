"""A real server killed while people decide, send and delete: what it acknowledged is there.

Kills before every single operation on files: ``tests/unit/app/test_killed_in_between.py``.
"""

import json
import random
import shutil
import threading
import time
from concurrent.futures import ThreadPoolExecutor
from contextlib import suppress
from dataclasses import dataclass, field
from pathlib import Path

import httpx
import psutil
import pytest

from recon4.archive.verify import verify
from recon4.progress import Silent
from recon4.review.journal import broken, read_rows
from tests.deadlines import HANG_S
from tests.processes import command_of
from tests.project_builder import build_project
from tests.service.running import WITHOUT_TLS, server_process
from tests.service.tus_client import create, offset, patch

LIVES = 4
PACKETS = random.Random(3).randbytes(100_000)
TO_REMOVE = 40


@dataclass
class Acknowledged:
    """What responses confirmed, over all lives of the server."""

    rows: int = 0
    whole: list[str] = field(default_factory=list)
    """Files of complete uploads, by their URLs."""
    sending: dict[str, int] = field(default_factory=dict)
    """URL of an unfinished file -> bytes that were confirmed."""
    moved: str = "at home"
    """Where the project ``moved`` is; empty while a request moves it."""
    deleted: dict[str, str] = field(default_factory=dict)
    """Project -> its name in the trash."""
    removed: list[str] = field(default_factory=list)


def ask(server, method, path, **options):
    answer = httpx.request(method, server.url + path, timeout=HANG_S, verify=WITHOUT_TLS, **options)
    assert answer.status_code < 300, answer.text
    return answer


def decide(server, known):
    review = "/api/projects/office/review"
    pair = {"frame_i": 0, "frame_j": 10 + known.rows % 10}
    for step, body in (
        ("decisions", {"kind": "reject", **pair}),
        ("undo", {}),
        ("redo", {}),
        ("undo", {}),
    ):
        known.rows = ask(server, "POST", f"{review}/{step}", json=body).json()["seq"]


def send(server, known):
    url = create(server.url, len(PACKETS), filename="walk.pcap").headers["Location"]
    known.sending[url] = 0
    for half in range(2):
        part = len(PACKETS) // 2
        data = PACKETS[half * part : (half + 1) * part]
        assert patch(server.url, url, half * part, data).status_code == 204
        known.sending[url] = (half + 1) * part
    del known.sending[url]
    known.whole.append(url)


def move(server, known):
    known.moved = ""
    gone = ask(server, "DELETE", "/api/projects/moved").json()["id"]
    known.moved = gone
    known.moved = ""
    ask(server, "POST", f"/api/trash/{gone}/restore")
    known.moved = "at home"


def remove(server, known):
    name = next(k for k in range(TO_REMOVE) if str(k) not in [*known.deleted, *known.removed])
    gone = ask(server, "DELETE", f"/api/projects/{name}").json()["id"]
    known.deleted[str(name)] = gone
    ask(server, "DELETE", f"/api/trash/{gone}")
    known.removed.append(str(name))


def live(server, process, known, rng):
    """Four people work until the server is killed."""
    errors = []

    def work(act):
        try:
            while True:
                act(server, known)
        except (httpx.TransportError, StopIteration):
            pass  # it was killed, or nothing is left to remove
        except BaseException as error:
            errors.append(error)

    people = [threading.Thread(target=work, args=(act,)) for act in (decide, send, move, remove)]
    for one in people:
        one.start()
    time.sleep(rng.uniform(0.1, 1.0))
    process.kill()
    process.wait()
    for one in people:
        one.join()
    assert errors == []


def check(server, root, known):
    """Compare the disk of a server that has just started with what was acknowledged before."""
    rows = read_rows(root / "office")
    assert len(rows) - known.rows in (0, 1) and broken(rows) == []
    assert server.get("/api/server").json()["notices"] == []
    for url, confirmed in list(known.sending.items()):
        at = offset(server.url, url)
        assert at >= confirmed
        if at < len(PACKETS):
            assert patch(server.url, url, at, PACKETS[at:]).status_code == 204
        known.whole.append(url)
        del known.sending[url]
    for url in known.whole:
        upload = ask(server, "GET", f"/api/uploads/{url.rsplit('/', 1)[1].split('-')[0]}").json()
        assert upload["finished"] and Path(upload["recording"]).read_bytes() == PACKETS
    check_projects(server, root, known)


def check_projects(server, root, known):
    trash = {one["id"] for one in ask(server, "GET", "/api/trash").json()}
    listed = {one["id"]: one for one in ask(server, "GET", "/api/projects").json()}
    assert not [one for one in listed.values() if one["problem"]]
    found = [*(["at home"] if "moved" in listed else []), *(i for i in trash if "moved" in i)]
    assert len(found) == 1 and found[0] == (known.moved or found[0])
    if found != ["at home"]:
        ask(server, "POST", f"/api/trash/{found[0]}/restore")
    known.moved = "at home"
    for name in known.removed:
        assert name not in listed and known.deleted[name] not in trash
    for name, gone in list(known.deleted.items()):
        if gone in trash:  # the second attempt
            ask(server, "DELETE", f"/api/trash/{gone}")
        known.removed.append(name)
        assert not (root / name).exists()
    for one in trash:
        if one not in found and one not in known.deleted.values():
            ask(server, "POST", f"/api/trash/{one}/restore")  # its response was lost


@pytest.mark.study
def test_a_server_killed_at_random_moments_keeps_what_it_acknowledged(tmp_path):
    rng, known = random.Random(21), Acknowledged()
    build_project(tmp_path / "office", points=1000)
    for name in ("moved", *map(str, range(TO_REMOVE))):
        shutil.copytree(tmp_path / "office", tmp_path / name)

    for _ in range(LIVES):
        with server_process(tmp_path) as (server, process):
            check(server, tmp_path, known)
            live(server, process, known, rng)
    with server_process(tmp_path) as (server, _):
        check(server, tmp_path, known)

    assert known.rows > LIVES and len(known.whole) > LIVES and known.removed
    assert verify(tmp_path / "office", Silent()).damaged == ()
    assert verify(tmp_path / "moved", Silent()).damaged == ()
    with suppress(FileNotFoundError):
        assert not list((tmp_path / ".recon4" / "trash").glob(".going-*"))


def export(server):
    plane = {"kind": "horizontal", "z_m": 1.5, "thickness_m": 2.9}
    return httpx.get(
        f"{server.url}/api/projects/office/slices/export.csv",
        params={"ask": json.dumps({"plane": plane})},
        timeout=120.0,
        verify=WITHOUT_TLS,
    )


def children(process):
    below = psutil.Process(process.pid).children(recursive=True)
    return [one for one in below if "recon4_app.compute_pool.child" in command_of(one)]


def answered(server, kill):
    """The response to an export while somebody is killed; None = the server was."""
    with ThreadPoolExecutor(1) as thread:
        answer = thread.submit(export, server)
        kill()
        with suppress(httpx.TransportError):
            return answer.result()
    return None


@pytest.mark.study
def test_an_export_killed_at_random_moments_is_made_whole_by_the_next_request(tmp_path):
    """Server and helper process in turn; what is kept of exports is always whole."""
    rng = random.Random(22)
    build_project(tmp_path / "office", points=100_000)
    kept = tmp_path / ".recon4" / "slices" / "exports"
    with server_process(tmp_path) as (server, _):
        began_s = time.monotonic()
        expected = export(server).content
        took_s = time.monotonic() - began_s
    states = []
    for victim in ("server", "child"):
        shutil.rmtree(kept)
        with server_process(tmp_path) as (server, process):

            def kill(victim=victim, process=process):
                time.sleep(rng.uniform(0.2, 0.7) * took_s)
                for one in [process] if victim == "server" else children(process):
                    one.kill()

            answer = answered(server, kill)
            states.append(None if answer is None else answer.status_code)
            assert answer is None or answer.status_code in (200, 503)
            assert answer is None or answer.status_code == 503 or answer.content == expected
            if victim == "child":
                assert export(server).content == expected
        assert all(path.read_bytes() == expected for path in kept.glob("*"))
        with server_process(tmp_path) as (server, _):
            assert export(server).content == expected

    assert len(expected) > 100_000
    assert any(state != 200 for state in states)
