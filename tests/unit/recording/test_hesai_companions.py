"""Which correction file belongs to which Hesai, and inertial samples in its packets."""

import numpy as np
import pytest

from recon4.recording.assembly.shots import Shots
from recon4.recording.kinds import located_sources
from recon4.recording.packets.capture import PacketCapture
from recon4.recording.packets.family import Companion
from recon4.recording.packets.hesai.angles import Angles
from recon4.recording.packets.hesai.encode import encode_jt16_inertial, write_inertial
from recon4.recording.packets.hesai.family import FAMILY as HESAI
from recon4.recording.packets.hesai.models import MODELS
from recon4.recording.packets.velodyne.encode import PcapWriter
from recon4.recording.report import ImportReport
from recon4.recording.rigs.choice import rig_to_complete
from recon4.recording.sources import Sources
from recon4.units import STANDARD_GRAVITY_M_S2
from tests.unit.recording.hesai_mirrors import mirror_table
from tests.unit.recording.hesai_packets import WIDE, packet_sensor, table_of
from tests.unit.recording.test_hesai_packets import decoded_with, spin
from tests.warned import K, derivations, warned

XT32 = MODELS["XT32"]


def moved(angles: Angles, by_deg: float) -> Angles:
    """The angles of another unit."""
    return Angles(angles.elevation_rad + np.deg2rad(by_deg), angles.azimuth_rad)


def height_of_lowest(*companions, name="lidar"):
    """Elevation of the lowest beam [°] that an XT32 is decoded with, and the report."""
    sensor = packet_sensor("XT32", name=name, companions=companions)
    shots = decoded_with(HESAI.open(sensor), spin(XT32)[2])
    xyz = shots.xyz[shots.ring == 0]
    elevation = np.arctan2(xyz[:, 2], np.hypot(xyz[:, 0], xyz[:, 1]))
    return float(np.rad2deg(elevation).mean()), sensor.report


def test_the_table_with_as_many_rows_beside_the_recording_is_used():
    other = table_of(MODELS["XT16"].angles, "XT16.csv")
    imu = Companion("imu.csv", b"t,x,y\n1,2,3\n2,3,4\n")

    elevation, report = height_of_lowest(other, imu, table_of(moved(XT32.angles, 0.2)))

    assert elevation == pytest.approx(-15.8, abs=1e-3)
    assert derivations(report) == ["lidar: angles of its beams from correction.csv."]
    assert not report.findings


def test_a_table_of_another_model_with_as_many_channels_is_not_taken():
    elevation, report = height_of_lowest(table_of(MODELS["XT32M2X"].angles, "XT32.csv"))

    assert elevation == pytest.approx(-16.0, abs=1e-3)
    assert warned(report, K.ANGLES_TYPICAL, model="XT32")


@pytest.mark.parametrize(("name", "expected"), [("left", -15.9), ("right", -16.1)])
def test_of_several_units_the_name_of_the_file_decides(name, expected):
    tables = [
        table_of(moved(XT32.angles, 0.1), "XT_Left.csv"),
        table_of(moved(XT32.angles, -0.1), "XT_Right.csv"),
    ]

    elevation, _ = height_of_lowest(*tables, name=name)

    assert elevation == pytest.approx(expected, abs=1e-3)


def test_without_a_table_or_with_two_that_fit_a_typical_unit_stands_in_and_is_a_warning():
    _, none = height_of_lowest()
    _, two = height_of_lowest(table_of(XT32.angles, "a.csv"), table_of(XT32.angles, "b.csv"))

    assert warned(none, K.ANGLES_TYPICAL, absent=True, rows=32)
    assert warned(two, K.ANGLES_TYPICAL, fitting="a.csv, b.csv")


@pytest.mark.parametrize(
    ("row", "why"),
    [
        (b"5,abc,1", "row 5: expected channel,elevation,azimuth"),
        (b"6,10,0", "row 5: is of channel 6"),
        (b"5,100,0", "row 5: elevation 100 or azimuth 0 is no angle"),
        (b"5,nan,0", "row 5: elevation NaN or azimuth 0 is no angle"),
    ],
)
def test_a_damaged_row_is_named_and_the_table_not_used(row, why):
    lines = table_of(XT32.angles).content.split(b"\n")
    damaged = Companion("bad.csv", b"\n".join([*lines[:5], row, *lines[6:]]))

    _, report = height_of_lowest(damaged)

    assert report.findings[0].kind is K.ANGLES_UNREADABLE
    assert report.findings[0].values["name"] == "bad.csv"
    assert report.findings[0].values["error"].startswith(why)


def test_tables_are_told_from_other_files_beside_a_recording():
    table = table_of(XT32.angles)
    marked = Companion("new.csv", b"\xef\xbb\xbfeeff,1,1\nLaser Num,32\n" + table.content)
    points = Companion("points.csv", b"x,y,z,elevation,azimuth\n1,2,3,4,5\n")
    cut = Companion("AT128.dat", mirror_table().content[:-1])

    assert all(HESAI.describes(one) for one in (table, marked, mirror_table()))
    assert not any(HESAI.describes(one) for one in (points, cut, Companion("e", b"")))


def inertial_values(count):
    """Accelerations and rates as integers, (N, 6)."""
    row = np.arange(count)[:, None]
    return np.array([10, -20, 2049, 5, -7, 9]) + row * np.array([1, 2, 0, 3, -1, 0])


def samples_and_points(path, companions=()):
    report = ImportReport()
    capture = PacketCapture([path, *companions], rig_to_complete, settings=WIDE, report=report)
    parts = list(capture.read())
    shots = [part for part in parts if isinstance(part, Shots)]
    imu = [part.imu for part in parts if not isinstance(part, Shots) and part.imu is not None]
    names = ("t_ns", "gyro_rad_s", "accel_m_s2")
    columns = [np.concatenate([getattr(one, name) for one in imu]) for name in names]
    return shots, columns, report


def test_inertial_samples_in_the_tails_come_once_each_at_the_time_of_their_packet(tmp_path):
    model = MODELS["JT128"]
    stamp_us, _, payloads = spin(model, packets=60)
    of_packet = np.arange(60) // 5  # a sample every 5 packets
    values = inertial_values(12)
    write_inertial(payloads, model.layout, clock=40 * of_packet, values=values[of_packet])
    with PcapWriter(tmp_path / "walk.pcap") as file:
        file.write(stamp_us * 1000 + 300_000, payloads, source="192.168.1.201")

    shots, (t_ns, gyro, accel), report = samples_and_points(tmp_path / "walk.pcap")

    np.testing.assert_allclose(gyro, np.deg2rad(values[:, 3:] * 0.14))
    np.testing.assert_allclose(accel, values[:, :3] * 0.000488 * STANDARD_GRAVITY_M_S2)
    np.testing.assert_array_equal(t_ns, 1000 * stamp_us[::5])
    assert report.counts["imu_samples"] == 12
    assert report.counts["points"] == sum(len(part) for part in shots) == 60 * 256
    assert not [name for name in report.counts if name.startswith("packets_")]


def test_a_jt16_sends_its_inertial_samples_beside_its_points(tmp_path):
    model = MODELS["JT16"]
    stamp_us, _, payloads = spin(model, packets=600)
    values = inertial_values(20)
    samples = encode_jt16_inertial(stamp_us[::30] + 40, values)
    samples[3, 20] ^= 1
    with PcapWriter(tmp_path / "walk.pcap") as file:
        file.write(stamp_us * 1000 + 300_000, payloads, source="192.168.1.201")
        file.write(stamp_us[::30] * 1000 + 340_000, samples, source="192.168.1.201")

    shots, (t_ns, gyro, accel), report = samples_and_points(tmp_path / "walk.pcap")

    kept = np.delete(np.arange(20), 3)
    np.testing.assert_allclose(gyro, np.deg2rad(values[kept, 3:] / 32.8))
    np.testing.assert_allclose(accel, values[kept, :3] / 8192 * STANDARD_GRAVITY_M_S2)
    np.testing.assert_array_equal(t_ns, 1000 * (stamp_us[::30] + 40)[kept])
    assert sum(len(part) for part in shots) == report.counts["points"] == 600 * 16


def test_a_table_beside_a_capture_is_found(tmp_path):
    stamp_us, _, payloads = spin(XT32, packets=50)
    with PcapWriter(tmp_path / "walk.pcap") as file:
        file.write(stamp_us * 1000 + 300_000, payloads, source="192.168.1.201")
    table = table_of(XT32.angles)
    (tmp_path / table.name).write_bytes(table.content)
    report = ImportReport()

    paths = located_sources(Sources.of(tmp_path / "walk.pcap")).recordings
    capture = PacketCapture(paths, rig_to_complete, settings=WIDE, report=report)

    assert capture.rig.sensors[0].model == "XT32"
    assert any("angles of its beams from correction.csv" in text for text in derivations(report))
