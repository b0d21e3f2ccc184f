"""Storms of SIGTERM, SIGINT and SIGHUP: one line, the documented exit code, nothing half.

Every process of recon4 that runs for long, from the moment it has begun until it is gone. Where
Python throws exceptions away: ``test_stops.py``.
"""

from __future__ import annotations

import json
import os
import pty
import random
import re
import signal
import subprocess
import sys
import time
from collections.abc import Callable, Sequence
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path

import pytest

from recon4.live.project_files import begin
from recon4.live.session import load_session
from recon4.model.rig import load_rig
from recon4.recording.packets.velodyne.encode import PcapWriter
from recon4.sandbox import ONE_THREAD
from recon4.sandbox.private_cache import private_cache
from recon4.store.project import read_artifacts
from recon4.system.stopping import SIGNALS
from recon4.system.tuning import STOPPING
from recon4_app.viewer.scratch import scratch_of
from tests.loopback import an_address
from tests.project_builder import build_project
from tests.service.running import ROOT, recording_with_gate, server_process, wait_for
from tests.unit.recording.packet_builders import spin

RECON4 = (sys.executable, "-m", "recon4")
STORM_S = 0.8 * STOPPING.cleaning_up_s
"""Later signals may cut the end short."""
ANY = tuple(128 + number for number in SIGNALS)
"""Exit codes of work that was broken off."""
Begun = Callable[[subprocess.Popen[str]], object]


@dataclass(frozen=True)
class Ended:
    code: int
    said: str

    @property
    def named(self) -> list[str]:
        """The signals that its lines name."""
        return re.findall(r"^recon4: stopped by (\w+)", self.said, re.MULTILINE)


def makes(folder: Path, pattern: str) -> Begun:
    def begun(child: subprocess.Popen[str]) -> None:
        made = wait_for(lambda: child.poll() is not None or list(folder.glob(pattern)), pattern)
        assert made is not True, child.stderr.read()

    return begun


def says(word: str) -> Begun:
    def begun(child: subprocess.Popen[str]) -> None:
        assert any(word in line for line in child.stdout), child.stderr.read()

    return begun


@contextmanager
def running(command: Sequence[str | Path], begun: Begun):
    """A process in a session of its own that has begun; it is ended with the test."""
    with subprocess.Popen(
        [*map(str, command)],
        stdin=subprocess.PIPE,
        stdout=subprocess.PIPE,
        stderr=subprocess.PIPE,
        text=True,
        cwd=ROOT,
        env=os.environ | ONE_THREAD,
        start_new_session=True,
    ) as child:
        try:
            begun(child)
            yield child
        finally:
            child.kill()


def storm(child: subprocess.Popen[str], rng: random.Random) -> None:
    """Send signals until it has ended."""
    until_s = time.monotonic() + STORM_S
    while child.poll() is None and time.monotonic() < until_s:
        child.send_signal(rng.choice(SIGNALS))
        time.sleep(rng.choice((0.0, 0.0005, 0.003)))


def stormed(
    command: Sequence[str | Path], begun: Begun, *, seed: int, after_s: float = 0.0
) -> Ended:
    rng = random.Random(seed)
    with running(command, begun) as child:
        time.sleep(rng.uniform(0.0, after_s))  # a random moment
        storm(child, rng)
        _, said = child.communicate(timeout=120.0)
    return Ended(child.returncode, said)


def assert_in_order(ended: Ended, codes: Sequence[int]) -> None:
    """One line with the signal, no traceback, and one of the exit codes (128 + n: of that one)."""
    assert "Traceback" not in ended.said and "Exception ignored" not in ended.said, ended.said
    assert len(ended.named) == 1, (ended.code, ended.said)
    assert ended.code in codes, ended.said
    assert ended.code in (0, 1, 128 + signal.Signals[ended.named[0]])


def test_a_server_stormed_during_its_start_ends_in_order(tmp_path):
    ended = stormed(
        [*RECON4, "serve", tmp_path, "--port", "0"],
        makes(tmp_path, ".recon4"),
        seed=random.randrange(1000),
        after_s=1.0,
    )

    assert_in_order(ended, (0, *ANY))


def test_a_stormed_server_ends_with_code_0_and_closes_its_files(tmp_path):
    ended = stormed([*RECON4, "serve", tmp_path, "--port", "0"], says("Serving"), seed=4)

    assert_in_order(ended, (0,))
    assert not list((tmp_path / ".recon4").glob("*.sqlite-wal"))


@pytest.mark.parametrize("name", ["process", "calibrate"])
@pytest.mark.study
def test_a_stormed_run_ends_in_order_and_leaves_nothing_half(tmp_path, short_recording, name):
    out = ["--out", tmp_path / "map"]
    if name == "calibrate":
        out = ["--out", tmp_path / "rig.toml", "--project", tmp_path / "map"]
    imu = ["--rig", "4recon", "--imu", short_recording / "imu.csv"]

    ended = stormed(
        [*RECON4, name, short_recording / "recording.pcap", *imu, *out],
        makes(tmp_path, "map/artifacts"),
        seed=5,
        after_s=2.0,
    )

    assert_in_order(ended, ANY)
    assert not [path for path in tmp_path.rglob("*") if path.name.startswith((".tmp-", "buckets-"))]
    assert not (tmp_path / "map" / "summary.json").exists()
    assert not (tmp_path / "rig.toml").exists()


@pytest.mark.study
def test_a_stormed_backup_and_restore_end_in_order_and_leave_nothing_half(tmp_path):
    root, backups, new = tmp_path / "root", tmp_path / "backups", tmp_path / "new"
    build_project(root / "office", points=1000)
    (root / ".recon4").mkdir()
    for k in range(1500):
        (root / "office" / f"{k}.txt").write_text(f"{k}")
    making = [*RECON4, "backup", root, "--out", backups]
    copied = stormed(making, makes(backups, "objects/*"), seed=6)
    subprocess.run(making, check=True, cwd=ROOT)
    put = stormed([*RECON4, "restore", backups, new], makes(tmp_path, ".tmp-restore-*"), seed=7)

    assert_in_order(copied, ANY)
    assert_in_order(put, ANY)
    assert not [path for path in tmp_path.iterdir() if path.name.startswith((".tmp-", "new"))]
    subprocess.run([*RECON4, "restore", backups, new], check=True, cwd=ROOT)
    assert (new / "office" / "1499.txt").read_text() == "1499"


@pytest.fixture
def rig(tmp_path):
    path = tmp_path / "rig.toml"
    path.write_text('name = "one"\n[[sensor]]\nname = "lidar"\n')
    return path


@pytest.mark.study
def test_a_stormed_recording_is_a_whole_project(tmp_path, rig):
    walk = tmp_path / "walk"

    ended = stormed(
        [*RECON4, "record", walk, "--rig", rig, "--address", an_address()],
        says("no datagrams"),
        seed=8,
    )

    assert_in_order(ended, (1,))  # without datagrams there is no map
    assert load_session(walk).outcome.exists()


@pytest.mark.study
def test_a_stormed_recorder_completes_its_file_and_a_stormed_mapper_says_so(tmp_path, rig):
    session = begin(tmp_path / "walk", load_rig(rig), address=an_address())
    recorder = [sys.executable, "-m", "recon4.live.recorder.process", session.project]
    mapper = [sys.executable, "-m", "recon4.live.mapper.process", session.project]
    rng = random.Random(9)

    with running(recorder, says("ready")) as child:
        mapped = stormed(mapper, says("ready"), seed=10)
        storm(child, rng)
        _, said = child.communicate(timeout=60.0)

    assert_in_order(Ended(child.returncode, said), (0,))
    assert_in_order(mapped, (1,))
    assert session.outcome.exists()


def test_a_stormed_viewer_ends_at_sigterm_only_and_removes_its_files(tmp_path, monkeypatch):
    build_project(tmp_path / "office", points=1000)
    caches = private_cache(scratch_of(tmp_path / ".recon4", "office"))  # as its pool gives it
    for name, folder in caches.items():
        monkeypatch.setenv(name, folder)
    jobs, sockets = tmp_path / ".recon4" / "jobs", tmp_path / "s"
    jobs.mkdir(parents=True)
    sockets.mkdir()
    arguments = [tmp_path / "office", "60", "50000", jobs, sockets / "v"]

    ended = stormed(
        [sys.executable, "-P", "-m", "recon4_app.viewer.process", *arguments],
        says("ready"),
        seed=11,
    )

    assert_in_order(ended, (0,))
    assert ended.named == ["SIGTERM"]


@pytest.mark.study
def test_a_stormed_worker_leaves_its_job_to_the_next_one(tmp_path):
    recording = recording_with_gate(tmp_path / "walk")
    rng = random.Random(12)
    with server_process(tmp_path) as (server, _):
        job = server.start("office", recording)
        server.wait_at_gate(job)
        worker = server.worker_pid(job)
        until_s = time.monotonic() + STORM_S
        while server.worker_pid(job) == worker and time.monotonic() < until_s:
            try:
                os.kill(worker, rng.choice(SIGNALS))
            except ProcessLookupError:
                break
            time.sleep(0.001)
        view = server.wait_at_gate(job, attempt=2)
        log = server.get(f"/api/jobs/{job}/log").text
        server.post(f"/api/jobs/{job}/cancel")

    named = re.findall(r"^recon4: stopped by (\w+)", log, re.MULTILINE)
    assert len(named) == 1 and "Traceback" not in log, log
    assert f"[{named[0]}]" in view["job"]["note"]
    assert "it continues after the last finished stage" in view["job"]["note"]


@pytest.mark.study
def test_a_recording_whose_terminal_is_closed_is_a_whole_project(tmp_path, rig):
    """As where an SSH connection breaks: SIGHUP, and nobody to write to."""
    t_ns, payloads = spin(2300)
    with PcapWriter(tmp_path / "source.pcap") as file:
        file.write(t_ns, payloads, source="192.168.1.201", port=2368)
    walk, address = tmp_path / "walk", an_address()
    command = [*RECON4, "record", str(walk), "--rig", str(rig), "--address", address]

    number, terminal = pty.fork()
    if number == 0:
        os.chdir(ROOT)
        os.execv(command[0], command)
    said = b""
    while b"no datagrams" not in said:
        said += os.read(terminal, 1000)
    replay = [*RECON4, "replay", tmp_path / "source.pcap", "--to", address]
    subprocess.run([*map(str, replay)], check=True, cwd=ROOT)
    os.close(terminal)
    _, status = os.waitpid(number, 0)

    assert os.waitstatus_to_exitcode(status) == 0
    assert json.loads(load_session(walk).outcome.read_text())["file"]["datagrams"] == 2300
    assert list(read_artifacts(walk)) == ["frames"]
