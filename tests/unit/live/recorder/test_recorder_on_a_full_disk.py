"""A recorder whose disk fills up."""

import json
import resource
import subprocess
import sys
from dataclasses import replace

from recon4.live.findings import findings
from recon4.live.newest_messages import Newest
from recon4.model.rig import load_rig
from tests.unit.live.recorder.recorder_process import decode, numbers, recording, send

SETTLED = """
def settled(file):
    state = file.state()
    return state.datagrams + state.dropped
"""
"""Datagrams that were written or dropped: nothing is known of the others yet."""


def test_a_full_disk_stops_the_file_at_a_whole_record_and_is_said(tmp_path):
    code = (
        SETTLED
        + """
import resource, signal, sys, time
from pathlib import Path
from recon4.live.recorder.capture_file import CaptureFile, Datagram
signal.signal(signal.SIGXFSZ, signal.SIG_IGN)
resource.setrlimit(resource.RLIMIT_FSIZE, (100_000, 100_000))
file = CaptureFile(Path(sys.argv[1]), on_written=lambda size: None)
for k in range(200):
    file.add(Datagram(k, ("127.0.0.1", 5), 2368, k.to_bytes(4, "little") + bytes(1202)))
    if k % 10 == 9:
        while settled(file) <= k: time.sleep(0.01)
file.close()
state = file.state()
print(state.datagrams, state.dropped, state.problem)
"""
    )
    path = tmp_path / "walk.pcap"

    done = subprocess.run([sys.executable, "-c", code, path], capture_output=True, text=True)

    kept, dropped, problem = done.stdout.strip().split(" ", 2)
    assert (int(kept) + int(dropped), problem) == (200, "the disk is full"), done.stderr
    found, report = numbers(path)
    assert found == list(range(int(kept)))
    assert 60 < len(found) < 80
    assert report.outcome == "complete"


def test_after_a_full_disk_recording_goes_on(tmp_path):
    code = (
        SETTLED
        + """
import resource, signal, sys, time
from pathlib import Path
from recon4.live.recorder.capture_file import CaptureFile, Datagram
signal.signal(signal.SIGXFSZ, signal.SIG_IGN)
unlimited = resource.getrlimit(resource.RLIMIT_FSIZE)[1]
file = CaptureFile(Path(sys.argv[1]), on_written=lambda size: None)
problems = []
for k in range(300):
    if k == 100: resource.setrlimit(resource.RLIMIT_FSIZE, (50_000, unlimited))
    if k == 200: resource.setrlimit(resource.RLIMIT_FSIZE, (unlimited, unlimited))
    file.add(Datagram(k, ("127.0.0.1", 5), 2368, k.to_bytes(4, "little") + bytes(1202)))
    if k % 10 == 9:
        while settled(file) <= k: time.sleep(0.01)
        problems.append(file.state().problem)
file.close()
print(file.state().dropped, problems[5], "/", problems[15], "/", problems[-1])
"""
    )
    path = tmp_path / "walk.pcap"

    done = subprocess.run([sys.executable, "-c", code, path], capture_output=True, text=True)

    assert done.stdout.strip() == "100  / the disk is full /", done.stderr
    assert numbers(path)[0] == [*range(100), *range(200, 300)]


def test_on_a_full_disk_neither_marks_nor_pauses_end_the_recording(session):
    with recording(session) as (process, talk):
        send(session, 50)
        talk.hear("status", lambda message: message["file"]["datagrams"] == 50)
        resource.prlimit(process.pid, resource.RLIMIT_FSIZE, (10, resource.RLIM_INFINITY))
        send(session, 50, start=50)
        full = talk.hear("status", lambda message: message["file"]["problem"])
        talk.send(do="pause")
        message = talk.hear("status", lambda message: message["notes"])
        talk.send(do="resume")
        talk.hear("status", lambda message: not message["paused"])
        unlimited = (resource.RLIM_INFINITY, resource.RLIM_INFINITY)
        resource.prlimit(process.pid, resource.RLIMIT_FSIZE, unlimited)
        send(session, 5, start=100)
        talk.hear("status", lambda message: message["file"]["datagrams"] == 55)
        talk.send(do="mark", what="point", text="door")
        talk.hear("mark", lambda message: message["text"] == "door")
        talk.send(do="stop")
        stopped = talk.hear("stopped")

    rig = load_rig(session.rig)
    states = [Newest(status=decode(one)) for one in (full, message)]
    texts = {found.text for newest in states for found in findings(rig, newest, "")}
    assert "Nothing is recorded: the disk is full" in texts
    assert any(text.startswith("A mark could not be saved: ") for text in texts)
    assert (stopped["file"]["dropped"], stopped["notes"]) == (50, "")
    assert numbers(session.capture)[0] == [*range(50), *range(100, 105)]
    (mark,) = map(json.loads, session.marks.read_text().splitlines())
    assert mark["text"] == "door"


def test_a_nearly_full_disk_stops_the_recording_in_good_order(session):
    session = replace(session, least_free_bytes=1 << 62)
    session.save()

    with recording(session) as (process, talk):
        stopped = talk.hear("stopped")
        assert process.wait(20) == 0

    assert stopped["why"] == "the disk is nearly full"
    assert json.loads(session.outcome.read_text())["why"] == "the disk is nearly full"
