"""A real recorder process: what it keeps, loses and reports."""

import json
import signal
import socket
import time

import numpy as np
import pytest
from msgspec import structs

from recon4.live.findings import findings
from recon4.live.newest_messages import Newest
from recon4.live.recorder import capture_file
from recon4.live.recorder.capture_file import CaptureFile, Datagram
from recon4.live.replay import replay
from recon4.model.rig import load_rig
from recon4.progress import Silent
from recon4.recording.formats.pcap import read_pcap
from recon4.recording.packets.velodyne.encode import PcapWriter
from recon4.recording.report import ImportReport
from tests.unit.live.recorder.recorder_process import Talk, decode, numbers, recording, send
from tests.unit.recording.packet_builders import spin


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

    assert any("lidar LiDAR sends from 127.0.0.77, not 127.0.0.5" in text for text in found), found
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


def test_too_much_waiting_for_the_disk_is_dropped_and_counted(tmp_path, monkeypatch):
    few = structs.replace(capture_file.CAPTURE_FILE, max_waiting_bytes=10_000)
    monkeypatch.setattr(capture_file, "CAPTURE_FILE", few)
    file = CaptureFile(tmp_path / "walk.pcap", on_written=lambda size: None)

    for _ in range(30):
        file.add(Datagram(1, ("127.0.0.1", 5), 2368, bytes(1206)))
    file.close()

    assert file.state().dropped + file.state().datagrams == 30
    assert file.state().dropped >= 20


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
    assert took_s > 0.95 * (t_ns[-1] - t_ns[0]) / 1e9
    assert set(batch.source.tolist()) == {0x7FA801C9}
    late_ns = batch.t_ns - t_ns
    assert np.median(late_ns - late_ns.min()) < 0.2 * (t_ns[-1] - t_ns[0]), "sent at its pace"


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
