"""Whole recordings of Ouster sensors: captures and a bag, with the metadata beside or in them."""

import json
import shutil

import numpy as np
import pytest

from recon4.errors import ConfigError
from recon4.geometry.se3 import SE3
from recon4.model.rig import Sensor
from recon4.recording.assembly.shots import Shots
from recon4.recording.info.describe import describe
from recon4.recording.kinds import located_sources
from recon4.recording.open import open_recording
from recon4.recording.openers.request import OpenRequest
from recon4.recording.packets.family import Companion
from recon4.recording.packets.ouster.encode import metadata_json
from recon4.recording.packets.velodyne.encode import PcapWriter
from recon4.recording.report import ImportReport
from recon4.recording.sources import Sources
from tests.builders import T0_NS
from tests.ouster_models import nominal_metadata
from tests.security.fuzz.kinds_ouster import packets_of
from tests.unit.recording.ouster_packets import WIDE, datagrams_of, opened
from tests.unit.recording.packet_builders import rig
from tests.warned import K, derivations, kinds


@pytest.fixture
def beside(data, tmp_path):
    """A function that copies sample files into a folder of their own; returns the first."""

    def copy(*names):
        for name in names:
            shutil.copy(data("packets/ouster") / name, tmp_path / name)
        return tmp_path / names[0]

    return copy


def read(path, sensors=None):
    """Report, shots by sensor, and inertial samples."""
    report = ImportReport()
    paths = located_sources(Sources.of(path)).recordings
    request = OpenRequest(paths, rig(*sensors) if sensors else None, WIDE, report)
    shots, samples = {}, []
    for part in open_recording(request).read():
        if isinstance(part, Shots):
            shots.setdefault(part.sensor, []).append(part)
        else:
            samples.append(getattr(part, "imu", part))
    return report, shots, [part for part in samples if part is not None]


def points(shots):
    return sum(map(len, shots))


def elevation_deg(shots):
    above_m = shots.xyz[:, 2] - 0.037
    return np.rad2deg(np.arcsin(above_m / np.linalg.norm(shots.xyz - [0, 0, 0.037], axis=1)))


def test_a_capture_gives_points_and_inertial_samples_on_one_clock(beside):
    path = beside("OS-1-128_v2.3.0_1024x10_lb_n3.pcap", "OS-1-128_v2.3.0_1024x10.json")

    report, shots, imu = read(path)

    t_ns = np.concatenate([part.t_ns for part in imu])
    accel = np.concatenate([part.accel_m_s2 for part in imu])
    assert (points(shots[0]), len(t_ns), report.findings) == (322536, 30, [])
    assert np.abs(np.diff(t_ns) - 10_000_000).max() < 1_000
    assert abs(int(t_ns[0]) - int(shots[0][0].t_ns[0])) < 30_000_000
    assert np.linalg.norm(accel.mean(axis=0)) == pytest.approx(10.8, abs=0.5)
    assert accel[:, 2].min() > 9.0


def test_a_bag_of_the_driver_is_read_with_the_metadata_in_it(data):
    path = data("packets/ouster/512x10_raw.bag")

    report, shots, imu = read(path)

    assert (points(shots[0]), sum(map(len, imu)), report.findings) == (28751, 10, [])
    info = describe(path)
    assert [(one.label, one.model) for one in info.sensors] == [
        ("/os_node0/lidar_packets", "OS0-128")
    ]
    assert info.sensors[0].rotation_hz == pytest.approx(10.0, abs=0.1)
    assert "/os_node0/imu_packets: other packets of a LiDAR" in info.samples[0]
    assert "/os_node0/metadata: describes a LiDAR" in info.samples[1]


def test_two_sensors_that_send_to_one_port_get_the_metadata_of_their_own(beside):
    path = beside("same_ports_legacy.pcap", "same_ports_legacy.1.json", "same_ports_legacy.2.json")
    sensors = [
        Sensor(name=name, model=model, T_body_sensor=SE3.identity(), address=address, port=7502)
        for name, model, address in (
            ("a", "OS1-64", "169.254.238.111"),
            ("b", "OS0-128", "169.254.92.158"),
        )
    ]

    report, shots, _ = read(path, sensors)

    assert set(kinds(report)) <= {K.CLOCK_FREE}
    assert (points(shots[0]), points(shots[1])) == (63, 486)
    assert report.counts["packets"] == 2
    for row, name in ((0, "same_ports_legacy.2.json"), (1, "same_ports_legacy.1.json")):
        document = json.loads(path.with_name(name).read_text())
        angles = np.sort(document["beam_intrinsics"]["beam_altitude_angles"])
        for part in shots[row]:
            assert np.abs(elevation_deg(part) - angles[part.ring]).max(initial=0.0) < 2.0


def test_a_file_of_the_recordings_name_is_taken_with_a_note(beside):
    path = beside(
        "OS-1-64_1024x10_fw20.pcap",
        "OS-1-64_sensor_config_reduced.json",
        "same_ports_legacy.2.json",
    )

    report, shots, imu = read(path)

    assert (points(shots[0]), sum(map(len, imu))) == (16749, 11)
    assert any("by its name, not same_ports_legacy.2.json" in text for text in derivations(report))
    assert any("does not tell lidar_origin" in text for text in derivations(report))


def test_without_metadata_the_message_says_which_file_goes_where(beside):
    path = beside("OS-2-32-U0_v2.0.0_1024x10.pcap")

    with pytest.raises(ConfigError, match="put the metadata json of the sensor beside"):
        read(path)


def test_metadata_of_other_packets_is_named_with_both_sizes(beside):
    path = beside("OS-2-32-U0_v2.0.0_1024x10.pcap", "same_ports_legacy.2.json")

    with pytest.raises(ConfigError, match=r"of packets of 12608 bytes .*those here have 6464"):
        read(path)


def test_sensors_behind_one_address_and_port_are_told_apart(tmp_path):
    one = nominal_metadata("OS1-32", serial="111")
    same_size = nominal_metadata("OS0-32", serial="222")
    larger = nominal_metadata("OS1-64", profile="LEGACY", serial="333")
    path = tmp_path / "relay.pcap"
    sent = {metadata.serial: packets_of(metadata, 40) for metadata in (one, same_size, larger)}
    with PcapWriter(path) as file:
        for k in range(40):
            for place, payloads in enumerate(sent.values()):
                t_ns = np.array([T0_NS + 1_562_500 * (k + 1) + 1000 * place])
                file.write(t_ns, payloads[k : k + 1], source="10.0.0.7", port=7502)
    for metadata in (one, same_size, larger):
        (tmp_path / f"{metadata.serial}.json").write_bytes(metadata_json(metadata))
    alike = {"T_body_sensor": SE3.identity(), "port": 7502}
    sensors = [
        Sensor(name="c", model="OS1-64", serial="333", **alike),
        Sensor(name="b", model="OS0-32", serial="222", **alike),
        Sensor(name="a", model="OS1-32", serial="111", **alike),
    ]

    report, shots, _ = read(path, sensors)

    returns = [opened_alone(m, sent[m.serial]) for m in (larger, same_size, one)]
    assert [points(shots[row]) for row in range(3)] == returns
    assert report.findings == []
    assert report.counts["packets"] == 120
    assert report.counts["packets_wrong_length"] == 0
    steepest = [max(elevation_deg(p).max() for p in shots[row] if len(p)) for row in range(3)]
    assert steepest == pytest.approx([21.0, 45.0, 21.0], abs=1.0)
    found = {one.model: one.count for one in describe(path).sensors}
    assert found == {"OS1-32": 40, "OS0-32": 40, "OS1-64": 40}


def opened_alone(metadata, payloads):
    packets = opened(datagrams_of(payloads), Companion("os.json", metadata_json(metadata)))
    return len(packets.decode(packets.stamps_ns(payloads), payloads))
