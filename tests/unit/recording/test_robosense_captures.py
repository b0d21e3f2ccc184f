"""Captures of RoboSense LiDARs: angles of the lasers at another port, or in a file beside it."""

import numpy as np
import pytest

from recon4.errors import ConfigError
from recon4.recording.assembly.shots import Shots
from recon4.recording.kinds import located_sources
from recon4.recording.packets.capture import PacketCapture
from recon4.recording.packets.robosense.models import MODELS
from recon4.recording.packets.velodyne.encode import PcapWriter
from recon4.recording.report import ImportReport
from recon4.recording.rigs.choice import rig_to_complete
from recon4.recording.sources import Sources
from tests.unit.recording.packet_builders import WIDE
from tests.unit.recording.test_robosense_packets import angles_of, device_of, spin
from tests.warned import derivations


def test_a_capture_reads_angles_from_the_device_packets_at_another_port(tmp_path):
    model = MODELS["Ruby Plus"]
    t_ns, payloads = spin(model, 400)
    with PcapWriter(tmp_path / "walk.pcap") as file:
        file.write(t_ns + 300_000, payloads, source="192.168.1.200", port=6699)
        file.write(t_ns[-1:] + 400_000, device_of(model), source="192.168.1.200", port=7788)
    report = ImportReport()

    capture = PacketCapture([tmp_path / "walk.pcap"], rig_to_complete, settings=WIDE, report=report)
    shots = [part for part in capture.read() if isinstance(part, Shots)]

    assert [s.model for s in capture.rig.sensors] == ["Ruby Plus"]
    assert sum(map(len, shots)) == 400 * 3 * 128
    assert any("device packets (DIFOP)" in text for text in derivations(report))
    assert not report.findings


def test_a_capture_reads_angles_from_a_file_beside_it(tmp_path):
    model = MODELS["Airy"]
    t_ns, payloads = spin(model, 200)
    with PcapWriter(tmp_path / "walk.pcap") as file:
        file.write(t_ns + 300_000, payloads, source="192.168.1.200", port=6699)
    angles = angles_of(model) / 100
    with pytest.raises(ConfigError, match="csv file with a row of elevation and azimuth"):
        PacketCapture(
            [tmp_path / "walk.pcap"], rig_to_complete, settings=WIDE, report=ImportReport()
        )

    rows = "\n".join(f"{elevation:.2f},{azimuth:.2f}" for elevation, azimuth in np.abs(angles))
    (tmp_path / "airy.csv").write_text(rows)
    paths = located_sources(Sources.of(tmp_path / "walk.pcap")).recordings
    report = ImportReport()
    capture = PacketCapture(paths, rig_to_complete, settings=WIDE, report=report)

    assert sum(len(part) for part in capture.read() if isinstance(part, Shots)) == 200 * 8 * 48
    assert any("from airy.csv" in text for text in derivations(report))


def test_a_clock_that_is_years_off_is_no_quarter_of_an_hour_off(tmp_path):
    model = MODELS["Helios 5515"]
    t_ns, payloads = spin(model, 200)
    years_ns = 2400 * 86_400_000_000_000 + 882_480_000_000
    with PcapWriter(tmp_path / "walk.pcap") as file:
        file.write(t_ns + years_ns, payloads, source="192.168.1.200", port=6699)
    report = ImportReport()

    capture = PacketCapture([tmp_path / "walk.pcap"], rig_to_complete, settings=WIDE, report=report)
    points = sum(len(part) for part in capture.read() if isinstance(part, Shots))

    assert points == 200 * 12 * 32
    assert any(
        "-882.480 s and whole hours off the recorder" in text for text in derivations(report)
    )


def test_a_model_whose_packets_are_those_of_another_one_is_said(tmp_path):
    t_ns, payloads = spin(MODELS["Ruby Plus"], 100)
    device = device_of(MODELS["Ruby Plus"])
    with PcapWriter(tmp_path / "walk.pcap") as file:
        file.write(t_ns[:1], device, source="192.168.1.200", port=7788)
        file.write(t_ns, payloads, source="192.168.1.200", port=6699)
    report = ImportReport()

    PacketCapture([tmp_path / "walk.pcap"], rig_to_complete, settings=WIDE, report=report)

    assert any("Packets of Ruby have the same form" in text for text in derivations(report))
