"""LVX files are the packets that they were made of."""

import numpy as np
import pytest

from recon4.errors import ConfigError, CorruptFile, EmptyRecording, UnknownFormat
from recon4.model.samples import ImuSamples
from recon4.recording.assembly.shots import Shots
from recon4.recording.info.describe import describe
from recon4.recording.kinds import RecordingKind
from recon4.recording.open import open_recording
from recon4.recording.openers.request import OpenRequest
from recon4.recording.packets.livox.encode import encode_imu
from recon4.recording.packets.livox.family import FAMILY as LIVOX
from recon4.recording.packets.livox.lvx import is_lvx, read_lvx, read_lvx_head
from recon4.recording.packets.sensor_clock import SensorClock
from recon4.recording.report import ImportReport
from recon4.settings import IngestSettings
from tests.unit.recording.lvx_files import lvx
from tests.unit.recording.test_livox_packets import AVIA, MID360, opened, packets, walls
from tests.warned import K, derivations, kinds, warned

VERSIONS = {(1, 0): AVIA, (1, 1): AVIA, (2, 0): MID360}


def written(tmp_path, version, *, frames=3, each=20):
    """A file of one device with its packets, and these."""
    layout = VERSIONS[version]
    t_ns, payloads = packets(layout, walls(layout, frames * each))
    rows = [[(0, p) for p in payloads[k * each : (k + 1) * each]] for k in range(frames)]
    path = tmp_path / ("a.lvx2" if version == (2, 0) else "a.lvx")
    path.write_bytes(lvx(rows, version=version))
    return path, t_ns, payloads


def read(path, report=None):
    return list(read_lvx(path, report or ImportReport()))


@pytest.mark.parametrize("version", VERSIONS)
def test_the_points_are_those_of_the_packets(version, tmp_path):
    path, t_ns, payloads = written(tmp_path, version)
    layout, batches = VERSIONS[version], read(path)
    device = opened(layout, batches[0])
    expected = opened(layout, batches[0]).decode(t_ns, payloads)

    assert is_lvx(path)
    assert [len(batch) for batch in batches] == [20, 20, 20]
    assert LIVOX.recognize(batches[0], ()).size == layout.size
    rows = [batch.payloads(np.arange(len(batch)), layout.size) for batch in batches]
    found = np.concatenate(rows)
    assert device.sound(found).all()
    np.testing.assert_array_equal(device.stamps_ns(found), t_ns)
    np.testing.assert_array_equal(np.concatenate([b.t_ns for b in batches]), t_ns)
    shots = device.decode(t_ns, found)
    np.testing.assert_array_equal(shots.xyz, expected.xyz)
    np.testing.assert_array_equal(shots.t_ns, expected.t_ns)


@pytest.mark.parametrize("version", VERSIONS)
def test_the_imu_is_in_the_file_too(version, tmp_path):
    layout = VERSIONS[version]
    t_ns, payloads = packets(layout, walls(layout, 4))
    imu = encode_imu(t_ns, np.ones((4, 3)), np.full((4, 3), 9.80665), sdk=layout.sdk)
    path = tmp_path / "a.lvx"
    mixed = [(0, one) for pair in zip(payloads, imu, strict=True) for one in pair]
    path.write_bytes(lvx([mixed], version=version))
    [batch] = read(path)
    clock = SensorClock("lidar", packet_s=layout.shots / 240_000, report=ImportReport())
    samples = opened(layout, batch).samples(batch, clock).imu

    np.testing.assert_array_equal(samples.t_ns, t_ns)
    np.testing.assert_allclose(samples.accel_m_s2, 9.80665, rtol=1e-6)


def test_devices_have_an_address_each_and_their_mounts(tmp_path):
    _, payloads = packets(MID360, walls(MID360, 2))
    extrinsics = (None, (0.0, 0.0, 90.0, 1.0, 2.0, 3.0))
    path = tmp_path / "two.lvx2"
    path.write_bytes(
        lvx([[(0, payloads[0]), (1, payloads[1])]], version=(2, 0), extrinsics=extrinsics)
    )
    head, [batch] = read_lvx_head(path), read(path)
    first, second = head.devices

    assert batch.source.tolist() == [first.address, second.address]
    assert (first.mount, second.serial) == (None, "SN0000000000001")
    np.testing.assert_allclose(second.mount.t, [1, 2, 3])
    np.testing.assert_allclose(second.mount.R @ [1, 0, 0], [0, 1, 0], atol=1e-7)


def test_a_device_with_another_clock_arrives_with_its_neighbors(tmp_path):
    layout = AVIA
    t_ns, payloads = packets(layout, walls(layout, 3))
    _, others = packets(layout, walls(layout, 3), t0_ns=77_000_000_000)
    mixed = [
        (k % 2, one) for pair in zip(payloads, others, strict=True) for k, one in enumerate(pair)
    ]
    path = tmp_path / "two.lvx"
    path.write_bytes(lvx([mixed], extrinsics=(None, None)))
    [batch] = read(path)

    np.testing.assert_array_equal(batch.t_ns, np.repeat(t_ns, 2))


@pytest.mark.parametrize("version", VERSIONS)
def test_a_file_that_ends_in_a_frame_is_read_to_its_last_packet(version, tmp_path):
    path, _, _ = written(tmp_path, version)
    path.write_bytes(path.read_bytes()[:-2000])
    report = ImportReport()

    assert sum(map(len, read(path, report))) == 58
    assert report.outcome == "lossy" and report.counts["files_cut"] == 1
    assert kinds(report) == [K.FILE_SALVAGED]


def test_a_frame_that_is_elsewhere_than_it_says_ends_the_reading(tmp_path):
    path, _, _ = written(tmp_path, (1, 1))
    whole = bytearray(path.read_bytes())
    second = int.from_bytes(whole[24 + 5 + 59 + 8 :][:8], "little")
    whole[second] ^= 1
    path.write_bytes(bytes(whole))
    report = ImportReport()

    assert sum(map(len, read(path, report))) == 20
    assert warned(report, K.FRAME_LENGTH, at=second)


def test_damaged_packages_and_unknown_devices_are_counted(tmp_path):
    _, payloads = packets(AVIA, walls(AVIA, 4))
    payloads[2, 9] = 200
    path = tmp_path / "a.lvx"
    path.write_bytes(lvx([[(0, p) for p in payloads[:3]], [(5, payloads[3]), (0, payloads[0])]]))
    report = ImportReport()

    assert sum(map(len, read(path, report))) == 3
    assert (report.counts["records_damaged"], report.counts["records_of_unknown_device"]) == (1, 1)


def test_other_files_are_refused_with_what_was_expected(tmp_path):
    path, _, _ = written(tmp_path, (1, 1))
    whole = path.read_bytes()
    for content, error, words in (
        (b"nothing", UnknownFormat, "begins with livox_tech"),
        (whole[:16] + b"\x03" + whole[17:], UnknownFormat, r"LVX 3\.1"),
        (whole[:60], CorruptFile, "1 devices expected"),
        (whole[: 24 + 5 + 59], EmptyRecording, "without any packet"),
    ):
        path.write_bytes(content)
        with pytest.raises(error, match=words):
            read(path)


def test_a_file_opens_as_a_recording_with_points_and_imu(tmp_path):
    layout = MID360
    t_ns, payloads = packets(layout, walls(layout, 200))
    imu = encode_imu(t_ns[::10], np.ones((20, 3)), np.full((20, 3), 5.7), sdk=2)
    rows = [[(0, p) for p in payloads[k * 10 : k * 10 + 10]] + [(0, imu[k])] for k in range(20)]
    path = tmp_path / "walk.lvx2"
    path.write_bytes(lvx(rows, version=(2, 0)))
    report = ImportReport()
    recording = open_recording(OpenRequest((path,), None, IngestSettings(), report))
    items = list(recording.read())
    shots = [item for item in items if isinstance(item, Shots)]
    samples = [item for item in items if isinstance(item, ImuSamples)]

    assert (recording.kind, recording.rig.sensors[0].model) == (str(RecordingKind.LVX), "Mid-360")
    assert sum(map(len, shots)) == 200 * 96
    assert sum(map(len, samples)) == 20
    np.testing.assert_array_equal(np.concatenate([s.t_ns for s in samples]), t_ns[::10])
    assert min(s.t_ns[0] for s in shots if len(s)) == t_ns[0]
    assert not report.findings and "CRC" not in str(derivations(report))
    assert "Mid-360" in "\n".join(describe(path).lines())


def test_several_devices_are_sensors_mounted_as_the_file_says(tmp_path):
    layout = MID360
    _, payloads = packets(layout, walls(layout, 60))
    rows = [[(0, a), (1, b)] for a, b in zip(payloads, payloads, strict=True)]
    path = tmp_path / "two.lvx2"
    mounts = ((0.0, 0.0, 0.0, 0.0, 0.0, 0.0), (0.0, 0.0, 180.0, -0.2, 0.0, 0.1))
    path.write_bytes(lvx(rows, version=(2, 0), extrinsics=mounts))
    report = ImportReport()
    rig = open_recording(OpenRequest((path,), None, IngestSettings(), report)).rig

    assert [sensor.model for sensor in rig.sensors] == ["Mid-360", "Mid-360"]
    np.testing.assert_allclose(rig.sensors[1].T_body_sensor.t, [-0.2, 0.0, 0.1], atol=1e-6)
    assert "mounted as the file says" in derivations(report)[0]
    path.write_bytes(lvx(rows, version=(2, 0), extrinsics=(None, None)))
    with pytest.raises(ConfigError, match="2 LiDARs and no rig"):
        open_recording(OpenRequest((path,), None, IngestSettings(), ImportReport()))
