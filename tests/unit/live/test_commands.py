"""The commands ``record`` and ``replay`` as a person runs them."""

import signal
import subprocess
import sys

import pytest

from recon4.recording.packets.velodyne.encode import PcapWriter
from recon4.store.project import read_artifacts
from tests.deadlines import HANG_S
from tests.loopback import an_address
from tests.unit.recording.packet_builders import spin


def recon4(*arguments, **options):
    command = [sys.executable, "-m", "recon4", *map(str, arguments)]
    return subprocess.Popen(
        command, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True, **options
    )


@pytest.mark.study
def test_a_recording_without_a_server_is_stopped_by_ctrl_c_and_is_a_project(tmp_path):
    address = an_address()
    rig = tmp_path / "rig.toml"
    rig.write_text('name = "one"\n[[sensor]]\nname = "lidar"\n')
    t_ns, payloads = spin(2300)
    with PcapWriter(tmp_path / "source.pcap") as file:
        file.write(t_ns, payloads, source="192.168.1.201", port=2368)
    out = tmp_path / "walk"

    with recon4("record", out, "--rig", rig, "--address", address) as recorder:
        said = [recorder.stdout.readline(), recorder.stdout.readline()]
        with recon4("replay", tmp_path / "source.pcap", "--to", address) as sender:
            sent = sender.communicate(timeout=HANG_S)[0]
        recorder.send_signal(signal.SIGINT)
        rest, complaint = recorder.communicate(timeout=HANG_S)

    assert "2300 datagrams sent" in sent
    assert (sender.returncode, recorder.returncode) == (0, 0), complaint + rest
    assert "Ctrl-C stops" in said[0]
    assert "2300 datagrams recorded, 0 lost; " in rest
    assert f"next: recon4 process {out}/recordings/walk.pcap" in rest
    assert list(read_artifacts(out)) == ["frames"]


def test_wrong_rigs_and_recordings_are_named(tmp_path):
    with recon4("record", tmp_path / "walk", "--rig", "none") as record:
        said = record.communicate(timeout=HANG_S)[1]
    with recon4("replay", tmp_path / "nothing.pcap") as replay:
        message = replay.communicate(timeout=HANG_S)[1]

    t_ns, payloads = spin(10)
    with PcapWriter(tmp_path / "source.pcap") as file:
        file.write(t_ns, payloads, source="192.168.1.201", port=2368)
    with recon4("replay", tmp_path / "source.pcap", "--to", "nobody.invalid") as astray:
        lost = astray.communicate(timeout=HANG_S)[1]

    assert (record.returncode, replay.returncode, astray.returncode) == (1, 1, 1)
    assert "cannot send to nobody.invalid" in lost
    assert "no rig named 'none'" in said
    assert "nothing.pcap" in message
    assert not (tmp_path / "walk").exists()
