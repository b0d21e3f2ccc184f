"""A killed server leaves no process behind but job workers and the processes of a live capture.

Figure to hold: 0 children alive 5 s after SIGKILL of the server (it had been 2 for 18 min).
"""

from __future__ import annotations

import os
import signal
import subprocess
import sys
import time

import psutil
import pytest

from recon4.system.processes import ChildRegister, process_identity
from recon4_app.viewer.pool import socket_folder
from tests.deadlines import BUSY_S
from tests.processes import command_of
from tests.project_builder import build_project
from tests.service.killing import leftover_files
from tests.service.running import ROOT, server_process, wait_for
from tests.service.viser_client import camera, viewing

GONE_WITHIN_S = 5.0

HOLDS_THE_INTERPRETER_LOCK = """
import signal, sys
from recon4.system.processes import die_with_parent
signal.pthread_sigmask(signal.SIG_BLOCK, signal.valid_signals())
die_with_parent(0)
print("ready", flush=True)
sum(range(10**13))
"""
PARENT = """
import subprocess, sys, threading
def start():
    child = subprocess.Popen([sys.executable, "-c", sys.argv[1]], stdin=subprocess.PIPE)
    print(child.pid, flush=True)
    children.append(child)
children = []
thread = threading.Thread(target=start)
thread.start()
thread.join()
sys.stdin.read()
"""


@pytest.fixture
def root(tmp_path):
    build_project(tmp_path / "office", points=2000)
    return tmp_path


def test_no_child_of_a_killed_server_lives_on(root):
    with server_process(root) as (server, process):
        with viewing(server.url) as client:
            client.send(camera())
            client.until(lambda c: "/grid" in c.nodes)
            found = server.get("/api/projects/office/review/queue")
            assert found.status_code == 200, found.text
            children = psutil.Process(process.pid).children(recursive=True)
            assert len(children) >= 2, "viewer, child of the compute pool"
            process.kill()
            process.wait()
        _, alive = psutil.wait_procs(children, timeout=GONE_WITHIN_S)

    for child in alive:
        child.kill()
    assert not alive


def test_a_child_dies_with_its_parent_but_not_with_the_thread_that_started_it():
    with subprocess.Popen(
        [sys.executable, "-c", PARENT, HOLDS_THE_INTERPRETER_LOCK],
        stdin=subprocess.PIPE,
        stdout=subprocess.PIPE,
        text=True,
        cwd=ROOT,
    ) as parent:
        child = psutil.Process(int(parent.stdout.readline()))
        assert parent.stdout.readline() == "ready\n"
        time.sleep(0.2)  # the starting thread has ended before "ready"; give a wrong signal time
        assert child.is_running()

        parent.kill()
        parent.wait()
        gone, _ = psutil.wait_procs([child], timeout=GONE_WITHIN_S)

    assert gone == [child]


def test_a_child_whose_parent_ended_before_it_asked_dies_at_once():
    ours, theirs = os.pipe()
    os.close(theirs)
    code = "from recon4.system.processes import die_with_parent; die_with_parent(0); print('alive')"

    ended = subprocess.run(
        [sys.executable, "-c", code], stdin=ours, capture_output=True, check=False, cwd=ROOT
    )
    os.close(ours)

    assert ended.returncode == -signal.SIGKILL
    assert ended.stdout == b""


def test_the_next_server_ends_a_leftover_it_knows_and_nothing_else(root):
    """A leftover is one whose number, start time and boot are on record."""
    register = ChildRegister(root / ".recon4" / "children")
    with (
        subprocess.Popen([sys.executable, "-c", "input()"], stdin=subprocess.PIPE) as leftover,
        subprocess.Popen([sys.executable, "-c", "input()"], stdin=subprocess.PIPE) as stranger,
    ):
        register.add(leftover.pid)
        identity = process_identity(stranger.pid)
        number, _, boot = identity.split("-", 2)
        (register.folder / f"{number}-1-{boot}").touch()  # its number, another start
        (register.folder / f"{number}-{identity.split('-')[1]}-another-boot").touch()

        with server_process(root):
            wait_for(lambda: leftover.poll() is not None, "the leftover ends", max_s=10.0 + BUSY_S)
            assert leftover.returncode == -signal.SIGKILL
            assert stranger.poll() is None
            assert not list(register.folder.glob(f"{leftover.pid}-*"))
            assert not list(register.folder.glob(f"{stranger.pid}-*"))
        stranger.kill()


@pytest.mark.study
def test_a_viewer_that_was_killed_leaves_no_socket_and_no_record(root):
    with server_process(root) as (server, process):
        for _ in range(2):
            with viewing(server.url) as client:
                client.send(camera())
                client.until(lambda c: "/grid" in c.nodes)
                viewers = psutil.Process(process.pid).children()
                (viewer,) = [
                    one for one in viewers if "recon4_app.viewer.process" in command_of(one)
                ]
                viewer.kill()
                psutil.wait_procs([viewer], timeout=GONE_WITHIN_S)
        with viewing(server.url) as client:
            client.send(camera())
            client.until(lambda c: "/grid" in c.nodes)
        assert len(list(socket_folder(root / ".recon4").iterdir())) == 1
        assert len(list((root / ".recon4" / "children").iterdir())) == 1

    assert leftover_files(root) == []
