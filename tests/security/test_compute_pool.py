"""The compute pool under attack: a child that a file took over, a person who floods a lane.

Held: 0 of 9 reaches out of a child; 0 running children one second after their client left;
one person's small call waits for no more than one call of a person with six large ones.
"""

from __future__ import annotations

import asyncio
import signal
import socket
import subprocess
import sys
from dataclasses import replace
from functools import partial
from pathlib import Path

import pytest

from recon4.errors import Recon4Error
from recon4.system.processes import ChildRegister
from recon4_app.compute_pool.fair_queue import FairQueue
from recon4_app.compute_pool.model import QUOTAS, FileAccess, Lane, Quota, Terms
from recon4_app.compute_pool.pool import ComputePool
from recon4_app.compute_pool.process import ChildFailed
from recon4_app.compute_pool.tuning import FAIRNESS
from recon4_app.errors import AppError, ComputeFailed, TooMany
from tests import pool_functions as work
from tests.deadlines import BUSY_S, HANG_S
from tests.service.running import wait_for

EVE = Terms(person="Eve")


def in_pool(root: Path, scenario, **options):
    """What ``scenario(pool)`` returns; the pool is closed at its end."""

    async def run():
        state = root / ".recon4"
        register = ChildRegister(state / "children")
        pool = ComputePool(state / "compute", children=register, **options)
        try:
            return await scenario(pool)
        finally:
            await pool.close()

    return asyncio.run(run())


@pytest.fixture
def root(tmp_path):
    """A data folder with a key and two projects."""
    for name in (".recon4", "mine", "other"):
        (tmp_path / name).mkdir()
    (tmp_path / ".recon4" / "signing.key").write_text("secret")
    for name in ("mine", "other"):
        (tmp_path / name / "points.xyz").write_text("1 2 3\n")
    return tmp_path


def refused(root: Path, function, *calls: tuple[object, ...], **terms):
    """Check that each call of a function fails in every kind of child; returns the messages."""
    said = []

    async def both(pool):
        for run, lane in ((pool.run_interactive, Lane.SLICE), (pool.run_background, Lane.SURVEY)):
            for args in calls:
                with pytest.raises((ChildFailed, AppError, Recon4Error)) as error:
                    await run(lane, replace(EVE, **terms), function, *args)
                said.append(str(error.value))

    in_pool(root, both)
    assert len(said) == 2 * len(calls) > 0
    return said


def may_read(root: Path) -> FileAccess:
    return FileAccess(read=(root / "mine",))


def test_a_child_reads_what_it_was_given_and_nothing_else(root):
    async def allowed(pool):
        terms = replace(EVE, access=may_read(root))
        path = str(root / "mine" / "points.xyz")
        return await pool.run_background(Lane.SURVEY, terms, work.read_file, path)

    assert in_pool(root, allowed) == "1 2 3\n"
    hidden = (root / ".recon4" / "signing.key", root / "other" / "points.xyz")
    calls = [(str(path),) for path in hidden]
    for words in refused(root, work.read_file, *calls, access=may_read(root)):
        assert "Permission denied" in words


def test_a_child_writes_nowhere_but_in_its_own_folder(root):
    places = (root / "mine" / "points.xyz", root / "other" / "new", root / "new")
    calls = [(str(place),) for place in places]
    for words in refused(root, work.write_file, *calls, access=may_read(root)):
        assert "Permission denied" in words
    assert (root / "mine" / "points.xyz").read_text() == "1 2 3\n"
    assert not (root / "new").exists()


def test_a_child_has_no_network(root):
    with socket.create_server(("127.0.0.1", 0)) as listener:
        listener.setblocking(False)
        refused(root, work.connect, (listener.getsockname()[1],))
        with pytest.raises(BlockingIOError):
            listener.accept()


def test_a_child_starts_no_program_and_ends_no_other_process(root):
    refused(root, work.run_program, ())
    refused(root, work.kill_parent, ())  # else this test would have ended here


def test_a_child_has_no_secrets_in_its_environment(root, monkeypatch):
    monkeypatch.setenv("RECON4_PASSWORD", "three green owls dance")

    async def look(pool):
        return await pool.run_background(Lane.SURVEY, EVE, work.environment)

    assert "RECON4_PASSWORD" not in in_pool(root, look)


def test_memory_without_end_is_refused_in_words(root):
    for words in refused(root, work.take_memory, (1 << 40,)):
        assert "memory" in words


def test_what_a_child_hands_back_is_never_unpickled(root):
    owned = Path("/tmp/recon4-owned")
    owned.unlink(missing_ok=True)

    async def ask(pool):
        with pytest.raises(ComputeFailed, match="declared type"):
            await pool.run_background(Lane.SURVEY, EVE, work.answer_with_a_pickle)

    in_pool(root, ask)

    assert not owned.exists()


def test_a_link_that_a_child_made_is_not_followed(root):
    place = root / "kept.txt"
    terms = replace(EVE, outputs={"out.txt": place})

    async def ask(pool):
        with pytest.raises((ComputeFailed, ChildFailed)):
            key = str(root / ".recon4" / "signing.key")
            await pool.run_background(Lane.SURVEY, terms, work.link_out, "out.txt", key)

    in_pool(root, ask)

    assert not place.is_symlink()
    assert not place.exists()


def test_children_end_with_a_server_that_is_killed(root):
    started = root / "mine" / "pid"
    program = (
        "import asyncio, sys\n"
        "from pathlib import Path\n"
        "from recon4_app.compute_pool.model import FileAccess, Lane, Terms\n"
        "from recon4_app.compute_pool.pool import ComputePool\n"
        "from recon4.system.processes import ChildRegister\n"
        "from tests import pool_functions as work\n"
        "root = Path(sys.argv[1])\n"
        "terms = Terms(person='Eve', access=FileAccess(write=(root / 'mine',)))\n"
        "register = ChildRegister(root / '.recon4' / 'children')\n"
        "pool = ComputePool(root / '.recon4' / 'compute', children=register)\n"
        "asyncio.run(pool.run_background(\n"
        "    Lane.SURVEY, terms, work.note_and_pause, str(root / 'mine' / 'pid')))\n"
    )
    server = subprocess.Popen([sys.executable, "-c", program, str(root)])
    try:
        child = int(wait_for(partial(written, started), "a child runs"))
    finally:
        server.send_signal(signal.SIGKILL)
        server.wait()

    wait_for(lambda: not alive(child), "the child ends with its server", max_s=5.0 + BUSY_S)
    register = ChildRegister(root / ".recon4" / "children")
    assert [path.name.split("-")[0] for path in register.folder.iterdir()] == [str(child)]
    register.end_leftovers()
    assert not list(register.folder.iterdir())


def test_a_child_is_registered_while_it_lives(root):
    folder = root / ".recon4" / "children"

    async def scenario(pool):
        _, pid = await pool.run_interactive(Lane.SLICE, EVE, work.identity, 7)
        return pid, [path.name for path in folder.iterdir()]

    pid, registered = in_pool(root, scenario)

    assert pid in process_number(registered)
    assert not list(folder.iterdir()), "the pool is closed"


def process_number(names: list[str]) -> list[int]:
    return [int(name.split("-")[0]) for name in names]


def written(path: Path) -> str:
    return path.read_text() if path.exists() else ""


def alive(pid: int) -> bool:
    try:
        return Path(f"/proc/{pid}/stat").read_text().rpartition(")")[2].split()[0] not in "ZX"
    except OSError:
        return False


@pytest.mark.parametrize("kind", ["background", "interactive"])
def test_work_ends_when_its_client_leaves(root, kind):
    started = root / "mine" / "pid"
    terms = replace(EVE, access=FileAccess(write=(root / "mine",)))

    async def leave(pool):
        run = pool.run_background if kind == "background" else pool.run_interactive
        asked = asyncio.ensure_future(run(Lane.SURVEY, terms, work.note_and_pause, str(started)))
        pid = int(await asyncio.to_thread(wait_for, partial(written, started), "it runs"))
        asked.cancel()
        with pytest.raises(asyncio.CancelledError):
            await asked
        await asyncio.to_thread(
            wait_for, lambda: not alive(pid), "its child ends", max_s=10.0 + BUSY_S
        )
        await asyncio.wait_for(idle(pool.queues[Lane.SURVEY]), HANG_S)

    in_pool(root, leave)


def test_a_pool_that_closes_lets_work_that_was_left_end_its_child(root):
    started = root / "mine" / "pid"
    terms = replace(EVE, access=FileAccess(write=(root / "mine",)))

    async def leave_and_close(pool):
        run = pool.run_background(Lane.SURVEY, terms, work.note_and_pause, str(started))
        asked = asyncio.ensure_future(run)
        await asyncio.to_thread(wait_for, partial(written, started), "it runs")
        asked.cancel()
        with pytest.raises(asyncio.CancelledError):
            await asked
        for _ in range(3):
            await asyncio.sleep(0)  # the work is canceled, too
        await pool.close()

    in_pool(root, leave_and_close)

    assert list((root / ".recon4" / "compute").iterdir()) == []


def test_a_call_cancelled_before_its_first_step_gives_its_slot_back(root):
    async def leave_at_once(pool):
        asked = asyncio.ensure_future(pool.run_background(Lane.SIGN, EVE, work.environment))
        await asyncio.sleep(0)  # it has its slot, its task has not begun
        asked.cancel()
        with pytest.raises(asyncio.CancelledError):
            await asked
        await asyncio.wait_for(idle(pool.queues[Lane.SIGN]), HANG_S)
        return await pool.run_background(Lane.SIGN, EVE, work.identity, 3)

    assert in_pool(root, leave_at_once)[0] == 3


async def idle(queue: FairQueue) -> None:
    while queue.running or queue.waiting:
        await asyncio.sleep(0.01)


# -- who is next


def order_of(quota: Quota, arrivals: list[tuple[str, bool]]) -> list[str]:
    """The order in which calls are granted when each ends before the next may begin."""

    async def run():
        queue, granted = FairQueue("test", quota), []

        async def call(person, large):
            slot = await queue.acquire(person, large=large)
            granted.append(f"{person}{'L' if large else 's'}")
            await asyncio.sleep(0)
            queue.release(slot)

        first = await queue.acquire("nobody")
        calls = [asyncio.ensure_future(call(*one)) for one in arrivals]
        await asyncio.sleep(0)
        queue.release(first)
        await asyncio.gather(*calls)
        return granted

    return asyncio.run(run())


def test_people_take_turns(root):
    arrivals = [("a", False)] * 3 + [("b", False)] * 2

    assert order_of(Quota(), arrivals) == ["as", "bs", "as", "bs", "as"]


def test_small_calls_go_before_large_ones_but_a_large_one_does_not_starve():
    arrivals = [("a", True)] + [("b", False)] * (2 * FAIRNESS.max_passed)

    granted = order_of(Quota(), arrivals)

    assert granted.index("aL") == FAIRNESS.max_passed


def test_six_large_exports_of_one_person_leave_a_slot_for_the_small_one_of_another():
    async def run():
        queue = FairQueue("export", QUOTAS[Lane.EXPORT])
        running = await queue.acquire("Eve", large=True)
        others = [asyncio.ensure_future(queue.acquire("Eve", large=True)) for _ in range(5)]
        await asyncio.sleep(0)
        small = await asyncio.wait_for(queue.acquire("Anna"), 1.0)  # granted at once
        waiting = queue.waiting
        for one in others:
            one.cancel()
        await asyncio.gather(*others, return_exceptions=True)
        queue.release(small)
        queue.release(running)
        return waiting, queue.running, queue.waiting

    assert asyncio.run(run()) == (5, 0, 0)


def test_a_full_queue_refuses_with_the_time_to_wait_and_only_who_filled_it():
    quota = Quota(waiting_per_person=2, retry_after_s=30.0)

    async def run():
        queue = FairQueue("export", quota)
        running = await queue.acquire("Eve")
        calls = [asyncio.ensure_future(queue.acquire("Eve")) for _ in range(2)]
        await asyncio.sleep(0)
        with pytest.raises(TooMany, match="2 requests of Eve") as refusal:
            await queue.acquire("Eve")
        other = asyncio.ensure_future(queue.acquire("Anna"))
        await asyncio.sleep(0)
        queue.release(running)
        await other  # Anna is next although Eve asked first
        for one in calls:
            one.cancel()
        return refusal.value.headers

    assert asyncio.run(run()) == {"Retry-After": "30"}
