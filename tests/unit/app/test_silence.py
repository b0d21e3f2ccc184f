"""When a child counts as hung: time it waited for a processor is not its own."""

from __future__ import annotations

import asyncio
import os
import subprocess
import sys
import time
from contextlib import suppress

import pytest

from recon4.system.processes import first_line, waited_for_processor_s
from recon4_app.jobs.model import JobKind
from recon4_app.jobs.silence import SilenceClock, allowed_silence_s
from recon4_app.jobs.status import JobStatus
from tests.service.running import wait_for

SPIN = "import os; os.sched_setaffinity(0, {int(__import__('sys').argv[1])})\nwhile True: pass"


@pytest.fixture
def starved():
    """A process that shares one processor with two others."""
    processor = str(min(os.sched_getaffinity(0)))
    command = [sys.executable, "-c", SPIN, processor]
    processes = [subprocess.Popen(command) for _ in range(3)]
    yield processes[0].pid
    for process in processes:
        process.kill()
        process.wait()


@pytest.mark.skipif(sys.platform != "linux", reason="only Linux measures it")
def test_waiting_for_a_processor_is_not_silence(starved):
    clock = SilenceClock()
    clock.silent_s(1, starved)
    began_s, waited_s = time.monotonic(), waited_for_processor_s(starved)

    wait_for(lambda: waited_for_processor_s(starved) > waited_s + 0.5, "it waits for a processor")

    assert clock.silent_s(1, starved) <= time.monotonic() - began_s - 0.4


def test_a_sleeping_worker_is_silent_until_its_heart_beats():
    clock = SilenceClock()
    clock.silent_s(1, None)
    time.sleep(0.05)
    assert clock.silent_s(1, None) >= 0.05
    assert clock.silent_s(2, None) == 0.0


def test_a_process_that_is_gone_has_not_waited():
    assert waited_for_processor_s(2**22 + 1) == 0.0


async def line_of(code: str, *, within_s: float) -> bytes:
    process = await asyncio.create_subprocess_exec(
        sys.executable, "-c", code, stdout=asyncio.subprocess.PIPE
    )
    try:
        return await first_line(process, within_s=within_s)
    finally:
        with suppress(ProcessLookupError):  # it may have ended by itself
            process.kill()
        await process.wait()


@pytest.mark.skipif(sys.platform != "linux", reason="only Linux measures it")
@pytest.mark.usefixtures("starved")
def test_a_child_that_waits_for_a_processor_has_time_to_start():
    processor = min(os.sched_getaffinity(0))
    work = (
        f"import os, time; os.sched_setaffinity(0, {{{processor}}}); os.nice(5)\n"
        "while time.process_time() < 0.12: pass\nprint('ready', flush=True); time.sleep(60)"
    )

    assert asyncio.run(line_of(work, within_s=0.6)) == b"ready\n"


def test_a_child_that_says_nothing_has_failed_after_its_own_time():
    assert asyncio.run(line_of("import time; time.sleep(60)", within_s=0.5)) == b""


def test_a_child_that_ends_without_a_line_has_failed_at_once():
    assert asyncio.run(line_of("pass", within_s=60.0)) == b""


def test_a_worker_that_reads_only_a_finished_map_may_be_silent_for_longer():
    reading, computing = (
        allowed_silence_s(kind, JobStatus(), 120.0) for kind in (JobKind.PROCESS, JobKind.EXPORT)
    )
    assert (reading, computing) == (120.0, 1200.0)
