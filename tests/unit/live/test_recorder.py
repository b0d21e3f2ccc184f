"""A real recorder process on real sockets."""

import json
import os
import resource
import signal
import socket
import subprocess
import sys
import time
from contextlib import contextmanager
from dataclasses import replace

import numpy as np
import pytest

from recon4.errors import ConfigError
from recon4.live.findings import findings
from recon4.live.newest import Newest
from recon4.live.protocol import decode_message
from recon4.live.recorder.capture_file import CaptureFile, Datagram
from recon4.live.recorder.ports import check_sources, open_ports
from recon4.live.recorder.serial_line import parse_device
from recon4.live.replay import Shipment, moved, replay
from recon4.live.session import CaptureSession
from recon4.model.rig import load_rig, parse_rig
from recon4.progress import Silent
from recon4.recording.formats.pcap import read_pcap
from recon4.recording.report import ImportReport
from recon4.recording.velodyne.encode import PcapWriter
from tests.loopback import an_address
from tests.unit.recording.packet_builders import spin


@pytest.fixture
def session(tmp_path):
    address = an_address()
    session = CaptureSession(project=tmp_path / "walk", address=address, least_free_bytes=0)
    session.capture.parent.mkdir(parents=True)
    session.save()
    session.rig.write_text('name = "test"\n[[sensor]]\nname = "lidar"\n')
    return session


@contextmanager
def recording(session):
    process = subprocess.Popen(
        [sys.executable, "-m", "recon4.live.recorder.process", str(session.project)],
        stdout=subprocess.PIPE,
        stderr=subprocess.PIPE,
        text=True,
    )
    with process:
        try:
            assert process.stdout.readline() == "ready\n", process.stderr.read()
            with Talk(session) as talk:
                yield process, talk
        finally:
            process.kill()


class Talk:
    """A listener on the recorder's socket."""

    def __init__(self, session):
        self.socket = socket.socket(socket.AF_UNIX)
        self.socket.settimeout(20.0)
        self.socket.connect(str(session.socket("recorder")))
        self.lines = self.socket.makefile("r")

    def __enter__(self):
        return self

    def __exit__(self, *_):
        self.lines.close()
        self.socket.close()

    def send(self, **message):
        self.socket.sendall(json.dumps(message).encode() + b"\n")

    def hear(self, kind, met=lambda message: True):
        for line in self.lines:
            message = json.loads(line)
            if message["kind"] == kind and met(message):
                return message
        raise AssertionError(f"never heard {kind}")


def decode(message):
    return decode_message(json.dumps(message).encode())


def send(session, count, *, size=1206, start=0):
    udp = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)
    udp.bind(("127.0.0.77", 0))
    for k in range(start, start + count):
        udp.sendto(k.to_bytes(4, "little") + bytes(size - 4), (session.address, 2368))
    udp.close()


def numbers(path):
    report = ImportReport()
    found = [
        int.from_bytes(batch.buffer[s : s + 4].tobytes(), "little")
        for batch in read_pcap(path, report)
        for s in batch.start.tolist()
    ]
    return found, report


def test_datagrams_from_an_unexpected_address_are_no_silence(session):
    """The rig names another address than the one that the datagrams really come from."""
    session.rig.write_text('name = "test"\n[[sensor]]\nname = "lidar"\naddress = "127.0.0.5"\n')
    rig = load_rig(session.rig)
    with recording(session) as (process, talk):
        sent = 0
        while True:
            send(session, 50, start=sent)
            sent += 50
            message = talk.hear("status")
            if message["seconds"] > 3.0 and any(one["per_s"] for one in message["senders"]):
                break
        found = [one.text for one in findings(rig, Newest(status=decode(message)), "")]
        talk.send(do="stop")
        process.wait(20.0)

    assert any(
        "lidar is expected from 127.0.0.5, but data packets for port 2368 come from 127.0.0.77"
        in text
        for text in found
    ), found
    assert not any("No LiDAR sends anything" in text for text in found)


def test_every_datagram_is_in_the_file_with_sender_port_and_time(session):
    before_ns = time.time_ns()
    with recording(session) as (process, talk):
        send(session, 500)
        talk.hear("status", lambda message: message["file"]["datagrams"] == 500)
        talk.send(do="stop")
        stopped = talk.hear("stopped")
        assert process.wait(20) == 0

    (batch,) = read_pcap(session.capture, ImportReport())
    assert len(batch) == 500
    assert set(batch.source.tolist()) == {0x7F00004D}
    assert set(batch.port.tolist()) == {2368}
    assert before_ns < batch.t_ns[0] <= batch.t_ns[-1] < time.time_ns()
    assert (stopped["file"]["dropped"], stopped["kernel_drops"]) == (0, 0)
    assert json.loads(session.outcome.read_text())["why"] == "stopped"
    assert not session.socket("recorder").exists()


def test_what_was_synced_survives_a_kill_and_opens_with_the_normal_reader(session):
    with recording(session) as (process, talk):
        send(session, 300)
        message = talk.hear("status", lambda message: message["file"]["synced_bytes"] > 300 * 1206)
        process.send_signal(signal.SIGKILL)
        process.wait(20)

    assert session.capture.stat().st_size >= message["file"]["synced_bytes"]
    assert numbers(session.capture)[0] == list(range(300))
    assert not session.outcome.exists()


def test_a_pause_leaves_out_what_comes_and_says_how_much(session):
    with recording(session) as (process, talk):
        send(session, 10)
        talk.hear("status", lambda message: message["file"]["datagrams"] == 10)
        talk.send(do="pause")
        talk.hear("mark", lambda message: message["what"] == "pause")
        send(session, 20, start=10)
        talk.hear("status", lambda message: message["skipped_in_pauses"] == 20)
        talk.send(do="resume")
        talk.hear("mark", lambda message: message["what"] == "resume")
        send(session, 5, start=30)
        talk.hear("status", lambda message: message["file"]["datagrams"] == 15)
        talk.send(do="stop")
        process.wait(20)

    assert numbers(session.capture)[0] == [*range(10), *range(30, 35)]


def test_a_mark_is_on_the_disk_before_it_is_confirmed(session):
    with recording(session) as (process, talk):
        said = {"what": "point", "text": "crack in the wall, 2. Stock", "who": "Eva"}
        talk.send(do="mark", **said, ago_s=20.0)  # touched then, its note took so long
        talk.hear("mark")
        process.kill()
        process.wait(20)

    (mark,) = map(json.loads, session.marks.read_text().splitlines())
    assert (mark["text"], mark["who"]) == ("crack in the wall, 2. Stock", "Eva")
    assert 20.0 <= (time.time_ns() - mark["t_ns"]) / 1e9 < 60.0


def test_nonsense_on_the_socket_does_no_harm(session):
    with recording(session) as (process, talk):
        talk.socket.sendall(b'\xff\x00{"do": }\n[1, 2]\n{"do": "dance"}\n')
        send(session, 3)
        talk.hear("status", lambda message: message["file"]["datagrams"] == 3)
        with Talk(session) as other:
            other.socket.sendall(b"x" * 100_000)  # no line end: let go, nobody else notices
        talk.hear("status")
        assert process.poll() is None


def test_a_port_in_use_is_named_with_what_it_is_for(session):
    taken = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)
    taken.bind((session.address, 2368))
    command = [sys.executable, "-m", "recon4.live.recorder.process", str(session.project)]

    done = subprocess.run(command, capture_output=True, text=True, timeout=60)
    taken.close()

    assert done.returncode == 1
    assert "UDP port 2368 (lidar) cannot be opened" in done.stderr


def test_a_full_disk_stops_the_file_at_a_whole_record_and_is_said(tmp_path):
    code = """
import resource, signal, sys, time
from pathlib import Path
from recon4.live.recorder.capture_file import CaptureFile, Datagram
signal.signal(signal.SIGXFSZ, signal.SIG_IGN)
resource.setrlimit(resource.RLIMIT_FSIZE, (100_000, 100_000))
file = CaptureFile(Path(sys.argv[1]), on_written=lambda size: None)
for k in range(200):
    file.add(Datagram(k, ("127.0.0.1", 5), 2368, k.to_bytes(4, "little") + bytes(1202)))
    if k % 10 == 9:
        while file.state().waiting_bytes: time.sleep(0.01)
file.close()
state = file.state()
print(state.datagrams, state.dropped, state.problem)
"""
    path = tmp_path / "walk.pcap"

    done = subprocess.run([sys.executable, "-c", code, path], capture_output=True, text=True)

    kept, dropped, problem = done.stdout.strip().split(" ", 2)
    assert (int(kept) + int(dropped), problem) == (200, "the disk is full"), done.stderr
    found, report = numbers(path)
    assert found == list(range(int(kept)))
    assert 60 < len(found) < 80
    assert report.outcome == "complete"


def test_too_much_waiting_for_the_disk_is_dropped_and_counted(tmp_path, monkeypatch):
    monkeypatch.setattr("recon4.live.recorder.capture_file.MAX_WAITING_BYTES", 10_000)
    file = CaptureFile(tmp_path / "walk.pcap", on_written=lambda size: None)

    for _ in range(30):
        file.add(Datagram(1, ("127.0.0.1", 5), 2368, bytes(1206)))
    file.close()

    assert file.state().dropped + file.state().datagrams == 30
    assert file.state().dropped >= 20


def test_stamps_of_replayed_packets_are_moved_across_the_hour():
    _, payloads = spin(1)
    stamp_us = int.from_bytes(payloads[0, 1200:1204].tobytes(), "little")

    later = moved(Shipment(0, "10.0.0.1", 2368, payloads[0].tobytes()), 3_599_000_000_000)

    assert int.from_bytes(later.payload[1200:1204], "little") == (stamp_us + 3_599_000_000) % (
        3_600_000_000
    )
    assert later.payload[:1200] == payloads[0].tobytes()[:1200]
    sample = Shipment(0, "10.0.0.1", 8309, b'{"t_ns": 7, "gx_rad_s": 1}', stamped=True)
    assert json.loads(moved(sample, 5).payload) == {"t_ns": 12, "gx_rad_s": 1}


def test_a_replay_comes_in_at_the_speed_it_was_recorded_with_its_samples(session, tmp_path):
    source = tmp_path / "source"
    source.mkdir()
    t_ns, payloads = spin(700)
    with PcapWriter(source / "recording.pcap") as file:
        file.write(t_ns, payloads, source="192.168.1.201", port=2368)

    with recording(session) as (process, talk):
        began_s = time.monotonic()
        assert replay(source, progress=Silent(), target=session.address) == 700
        took_s = time.monotonic() - began_s
        talk.send(do="stop")
        process.wait(20)

    (batch,) = read_pcap(session.capture, ImportReport())
    assert took_s == pytest.approx((t_ns[-1] - t_ns[0]) / 1e9, abs=0.3)
    assert set(batch.source.tolist()) == {0x7FA801C9}
    steps = batch.t_ns - batch.t_ns[0] - (t_ns - t_ns[0])
    assert np.median(np.abs(steps)) < 20e6


@pytest.mark.parametrize("seed", range(4))
def test_a_kill_at_any_moment_loses_at_most_the_last_second(session, seed):
    killed_after_s = np.random.default_rng(seed).uniform(1.2, 3.2)
    sent_s = []
    with recording(session) as (process, _):
        udp = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)
        began_s = time.monotonic()
        while time.monotonic() - began_s < killed_after_s:
            udp.sendto(len(sent_s).to_bytes(4, "little") + bytes(1202), (session.address, 2368))
            sent_s.append(time.monotonic())
            time.sleep(0.0007)
        killed_s = time.monotonic()
        process.kill()
        process.wait(20)
        udp.close()

    found, _ = numbers(session.capture)
    assert found == list(range(len(found)))
    assert killed_s - sent_s[len(found) - 1] < 1.0
    # A crash of the computer loses what was not synced: that is counted, see `synced_bytes`.


def test_what_the_kernel_drops_is_counted(session):
    with recording(session) as (process, talk):
        send(session, 10)
        talk.hear("status", lambda message: message["file"]["datagrams"] == 10)
        process.send_signal(signal.SIGSTOP)
        sent = 60_000
        send(session, sent, size=1206, start=10)
        process.send_signal(signal.SIGCONT)
        talk.hear("status", lambda message: message["file"]["datagrams"] > 1000)
        send(session, 5, start=10 + sent)  # the kernel tells with the next one
        message = talk.hear("status", lambda message: message["kernel_drops"] > 0)
        talk.send(do="stop")
        message = talk.hear("stopped")

    assert message["file"]["datagrams"] + message["kernel_drops"] == 10 + sent + 5
    assert message["kernel_drops"] > 100


def test_after_a_full_disk_recording_goes_on(tmp_path):
    code = """
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
        while file.state().waiting_bytes: time.sleep(0.01)
        time.sleep(0.02)
        problems.append(file.state().problem)
file.close()
print(file.state().dropped, problems[5], "/", problems[15], "/", problems[-1])
"""
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


def test_sentences_of_a_serial_receiver_are_in_the_capture(session):
    ours, theirs = os.openpty()
    name = os.ttyname(theirs)
    session.rig.write_text(
        f'name = "test"\n[[sensor]]\nname = "lidar"\n[gnss]\nserial = "{name}:115200"\n'
    )
    sentence = b"$GPGGA,120000.00,4912.0,N,01636.0,E,4,12,0.8,250.0,M,44.0,M,1.0,0001*7B"
    with recording(session) as (process, talk):
        talk.hear("status", lambda message: message["serial"] == "")
        os.write(ours, sentence[:30])
        os.write(ours, sentence[30:] + b"\r\n" + sentence + b"\r\n")
        talk.hear("status", lambda message: message["file"]["datagrams"] == 2)
        os.close(ours)  # pulled out
        os.close(theirs)
        talk.hear("status", lambda message: name in message["serial"])
        talk.send(do="stop")
        process.wait(20)

    (batch,) = read_pcap(session.capture, ImportReport())
    assert batch.port.tolist() == [8310, 8310]
    assert batch.payloads(np.array([1]), len(sentence)).tobytes() == sentence


@pytest.mark.parametrize(
    ("sensors", "gnss", "said"),
    [
        (("", ""), "", "first, second all send to port 2368: give each its address"),
        (("10.0.0.1", ""), "", "all send to port 2368"),
        (("10.0.0.1", "10.0.0.1"), "", "all send to port 2368"),
        (("10.0.0.1", "10.0.0"), "", "second: address must be like 192.168.1.201"),
        (("10.0.0.1", "10.0.0.2"), 'serial = "/dev/x:fast"', "DEVICE:BAUD"),
        (("10.0.0.1", "10.0.0.2"), 'serial = "/dev/x"\nport = 0', "serial needs a port"),
    ],
)
def test_a_rig_that_cannot_be_listened_to_is_refused_with_what_to_do(sensors, gnss, said):
    text = "".join(
        f'[[sensor]]\nname = "{name}"\naddress = "{address}"\n'
        for name, address in zip(("first", "second"), sensors, strict=True)
    )
    rig = parse_rig(f"{text}[gnss]\n{gnss}\n", where="test")

    with pytest.raises(ConfigError, match=said):
        check_sources(rig)


def test_why_a_port_cannot_be_opened_is_said():
    rig = parse_rig('[[sensor]]\nname = "a"\n', where="test")

    with pytest.raises(ConfigError, match="no network card of this computer has that address"):
        open_ports(rig, address="192.0.2.1")


@pytest.mark.parametrize("text", ["/dev/x:fast", ":9600", "/dev/x:0"])
def test_a_serial_device_that_is_none_is_refused(text):
    with pytest.raises(ConfigError, match="DEVICE:BAUD"):
        parse_device(text)
    assert parse_device("/dev/ttyUSB0") == ("/dev/ttyUSB0", 9600)
