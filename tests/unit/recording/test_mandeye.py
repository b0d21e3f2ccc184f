"""Folders of MANDEYE devices: read, written, damaged."""

import json
import shutil
from dataclasses import replace

import laspy
import numpy as np
import pytest

from recon4.cli.main import main
from recon4.errors import EmptyRecording, UnknownFormat
from recon4.model.rig import parse_rig
from recon4.model.samples import ImuSamples
from recon4.progress import Silent
from recon4.recording.assembly.assembler import Assembler
from recon4.recording.assembly.shots import Shots
from recon4.recording.info.describe import describe
from recon4.recording.kinds import RecordingKind, recognize
from recon4.recording.mandeye.convert import convert
from recon4.recording.mandeye.folder import list_walk
from recon4.recording.mandeye.imu import read_imu
from recon4.recording.mandeye.write import MandeyeWriter
from recon4.recording.open import open_recording
from recon4.recording.openers.request import OpenRequest
from recon4.recording.report import ImportReport
from recon4.recording.rigs.choice import RigToComplete, Stream, rig_to_complete, single_rig
from recon4.recording.sources import Sources
from recon4.settings import IngestSettings
from tests.builders import T0_NS, room_cloud, write_pcd, write_room_pcap
from tests.warned import K, derivations, warned

POINT_NS, PARTS, RATE_HZ = 200_000, 3, 50
G = 9.80665
RIG = rig_to_complete(
    [Stream("a", "Mid-360", serial="47MDL1"), Stream("b", "Mid-360", serial="47MDL2")]
)


def room_of_mid360(sensor, seconds, *, t0_ns=T0_NS):
    """Points all around, from 7° below to 52° above, 5 m away."""
    count = round(seconds * 1e9) // POINT_NS
    k = np.arange(count)
    azimuth, elevation = 2.4 * k, np.deg2rad(-7.0 + 59.0 * (k * 0.618 % 1.0))
    ray = np.column_stack(
        [
            np.cos(elevation) * np.cos(azimuth),
            np.cos(elevation) * np.sin(azimuth),
            np.sin(elevation),
        ]
    )
    none = np.zeros(count, np.uint8)
    return Shots(
        sensor,
        t0_ns + k * POINT_NS + 37 * sensor,
        (5.0 * ray).astype(np.float32),
        (k % 200).astype(np.uint16),
        none,
        none,
    )


def imu_of(seconds, *, t0_ns=T0_NS):
    t_ns = t0_ns + np.arange(round(seconds * RATE_HZ)) * (1_000_000_000 // RATE_HZ)
    phase = np.linspace(0.0, 3.0, len(t_ns))
    gyro = np.column_stack([np.sin(phase), np.cos(phase), 0.1 * phase])
    accel = np.column_stack([0.1 * phase, np.zeros(len(t_ns)), np.full(len(t_ns), G)])
    return ImuSamples(t_ns, gyro, accel)


def write_walk(folder, rig=RIG, *, seconds=5.0 * PARTS, t0_ns=T0_NS):
    """A walk of several parts; the points of the LiDARs come in turns, as from a device."""
    folder.mkdir()
    writer = MandeyeWriter(folder, rig)
    imu = imu_of(seconds, t0_ns=t0_ns)
    all_shots = [room_of_mid360(k, seconds, t0_ns=t0_ns) for k in range(len(rig.sensors))]
    for second in np.arange(0.0, seconds, 1.0):
        for shots in all_shots:
            rows = slice(round(second * 1e9) // POINT_NS, round((second + 1) * 1e9) // POINT_NS)
            parts = [getattr(shots, n)[rows] for n in ("t_ns", "xyz", "intensity", "ring", "echo")]
            writer.push(Shots(shots.sensor, *parts))
    writer.close(imu)
    return imu, all_shots


@pytest.fixture(scope="module")
def walk(tmp_path_factory):
    folder = tmp_path_factory.mktemp("mandeye") / "walk"
    return folder, *write_walk(folder)


@pytest.fixture
def copy(walk, tmp_path):
    return shutil.copytree(walk[0], tmp_path / "walk")


def read(folder, rig=RIG, report=None):
    report = report or ImportReport()
    recording = open_recording(OpenRequest((folder,), rig, IngestSettings(), report))
    items = list(recording.read())
    shots = [item for item in items if isinstance(item, Shots)]
    return shots, [item for item in items if isinstance(item, ImuSamples)], report


def joined(parts, name, sensor=0):
    return np.concatenate([getattr(one, name) for one in parts if one.sensor == sensor])


def test_what_was_written_is_read_again(walk):
    folder, imu, truth = walk
    shots, samples, report = read(folder)

    for sensor, known in enumerate(truth):
        times = joined(shots, "t_ns", sensor)
        assert np.abs(times - known.t_ns).max() <= 120  # a double has steps of 238 ns in our days
        np.testing.assert_allclose(joined(shots, "xyz", sensor), known.xyz, atol=6e-5)
        np.testing.assert_array_equal(joined(shots, "intensity", sensor), known.intensity)
    np.testing.assert_array_equal(np.concatenate([s.t_ns for s in samples]), imu.t_ns)
    gyro = np.concatenate([s.gyro_rad_s for s in samples])
    accel = np.concatenate([s.accel_m_s2 for s in samples])
    np.testing.assert_allclose(gyro, imu.gyro_rad_s, atol=1e-7)
    np.testing.assert_allclose(accel, imu.accel_m_s2, atol=1e-7)
    assert report.counts["files"] == PARTS
    assert not report.lost() and not report.findings


def test_the_files_are_those_of_the_devices(walk):
    folder = walk[0]
    names = {f"lidar{k:04d}.{end}" for k in range(PARTS) for end in ("laz", "sn")}
    names |= {f"imu{k:04d}.csv" for k in range(PARTS)}
    names |= {f"status{k:04d}.json" for k in range(PARTS)}

    assert {path.name for path in folder.iterdir()} == names
    with laspy.open(folder / "lidar0001.laz") as file:
        header, points = file.header, file.read()
    assert (str(header.version), header.point_format.id) == ("1.2", 1)
    np.testing.assert_array_equal(header.scales, 1e-4)
    assert set(np.unique(points.user_data)) == {0, 1}
    assert (folder / "lidar0000.sn").read_text("utf-8") == "0 47MDL1\n1 47MDL2\n"
    head, first, *_ = (folder / "imu0000.csv").read_text("utf-8").splitlines()
    assert head == "timestamp gyroX gyroY gyroZ accX accY accZ imuId timestampUnix"
    assert first.split()[0] == str(T0_NS) and float(first.split()[6]) == pytest.approx(1.0)
    assert json.loads((folder / "status0000.json").read_text("utf-8"))["state"] == "SCANNING"


def test_frames_are_windows_of_time_of_both_lidars(walk):
    shots, _, report = read(walk[0])
    assembler = Assembler(RIG, settings=IngestSettings(), report=report)
    frames = [frame for one in shots for frame in assembler.push(one)] + assembler.flush()

    assert len(frames) == 10 * 5 * PARTS
    assert all(set(np.unique(frame.sensor)) == {0, 1} for frame in frames)
    assert not report.counts["points_late"]


def test_info_finds_model_serial_and_imu_and_writes_a_rig_to_complete(walk):
    found = describe(walk[0])

    assert recognize(walk[0]) is RecordingKind.MANDEYE
    rig = parse_rig(found.first_rig, where="rig")
    assert [(s.model, s.serial) for s in rig.sensors] == [
        ("Mid-360", "47MDL1"),
        ("Mid-360", "47MDL2"),
    ]
    assert rig.imu_sensor == "lidar0"
    assert found.seconds == pytest.approx(5.0 * PARTS, abs=0.1)
    assert "IMU samples in 3 files imu*.csv" in found.samples
    with pytest.raises(RigToComplete, match="2 LiDARs and no rig"):
        read(walk[0], rig=None)


def test_one_lidar_needs_no_rig(tmp_path):
    folder = tmp_path / "walk"
    rig = rig_to_complete([Stream("a", "Mid-360")])
    write_walk(folder, rig, seconds=2.0)
    recording = open_recording(
        OpenRequest((folder,), None, IngestSettings(), report := ImportReport())
    )

    assert [s.model for s in recording.rig.sensors] == ["Mid-360"]
    assert recording.rig.imu_sensor == "" and sum(map(len, recording.read())) > 0
    assert not report.findings


def test_a_rig_finds_its_lidars_by_their_serial_numbers(walk):
    turned = parse_rig(describe(walk[0]).first_rig, where="rig")
    rig = replace(turned, sensors=tuple(reversed(turned.sensors)))
    shots, _, _ = read(walk[0], rig=rig)

    assert joined(shots, "t_ns", 1)[0] == pytest.approx(T0_NS, abs=240)


@pytest.mark.parametrize("damage", ["cut", "empty"])
def test_a_last_file_that_is_damaged_is_left_out_and_counted(damage, copy):
    last = copy / "lidar0002.laz"
    last.write_bytes(last.read_bytes()[: -len(last.read_bytes()) // 3] if damage == "cut" else b"")
    shots, _, report = read(copy)

    assert report.counts["files_corrupt"] == 1 and report.outcome == "lossy"
    assert warned(report, K.FILE_LEFT_OUT, error="lidar0002.laz")
    assert joined(shots, "t_ns").max() < T0_NS + 10 * 10**9


def test_a_missing_imu_file_is_counted_and_named(copy):
    (copy / "imu0001.csv").unlink()
    _, samples, report = read(copy)

    assert report.counts["imu_files_missing"] == 1
    assert any("lidar0001.laz" in text for text in report.lost())
    assert sum(len(s.t_ns) for s in samples) == 10 * RATE_HZ


def test_files_whose_numbers_are_not_in_the_order_of_their_times_are_sorted(copy):
    for name in ("lidar{}.laz", "imu{}.csv", "lidar{}.sn"):
        a, b = (copy / name.format(k) for k in ("0000", "0002"))
        a.rename(copy / "kept")
        b.rename(a)
        (copy / "kept").rename(b)
    shots, _, report = read(copy)

    assert report.counts["files_out_of_order"] == 2
    assert (np.diff(joined(shots, "t_ns")) >= 0).all()


def test_two_walks_in_one_folder_are_refused_with_their_files(copy, tmp_path):
    later = tmp_path / "later"
    write_walk(later, seconds=1.0, t0_ns=T0_NS + 5 * 3600 * 10**9)
    shutil.copy(later / "lidar0000.laz", copy / "lidar0003.laz")

    with pytest.raises(UnknownFormat, match=r"2 recordings of different times.*lidar0003\.laz"):
        read(copy)


def test_serial_numbers_that_change_are_a_warning(copy):
    (copy / "lidar0001.sn").write_text("0 OTHER\n", "utf-8")
    _, _, report = read(copy)

    assert warned(report, K.SERIALS_CHANGE, lidar="0", serial="OTHER", before="47MDL1")


def test_points_without_a_time_are_dropped_and_counted(copy):
    path = copy / "lidar0000.laz"
    points = laspy.read(path)
    points.gps_time[:100] = 0.0
    points.write(path)
    _, _, report = read(copy)

    assert report.counts["points_without_time"] == 100
    assert list_walk(copy, ImportReport()).parts[0].t_first_ns > 0


def test_a_folder_of_damaged_files_only_is_empty(tmp_path):
    (tmp_path / "lidar0000.laz").write_bytes(b"LASF" + bytes(50))

    with pytest.raises(EmptyRecording, match="none of 1 files"):
        read(tmp_path)


ROWS = [(T0_NS + k * 5_000_000, 0.1, 0.2, 0.3, 0.0, 0.1, 1.0) for k in range(40)]


@pytest.mark.parametrize(
    ("head", "separator", "more"),
    [
        ("timestamp gyroX gyroY gyroZ accX accY accZ imuId timestampUnix", " ", "0 1"),
        ("timestamp gyroX gyroY gyroZ accX accY accZ imuId", " ", "0"),
        ("timestamp,gyroX,gyroY,gyroZ,accX,accY,accZ,imuId,timestampUnix", ",", "0,1"),
        ("", " ", ""),
        ("", " ", "0"),
        ("", "\t", "0\t1"),
        ("imuId timestamp accX accY accZ gyroX gyroY gyroZ", " ", None),
    ],
)
def test_every_known_form_of_the_imu_file_gives_the_same_samples(head, separator, more, tmp_path):
    path = tmp_path / "imu0000.csv"
    lines = [head] * bool(head)
    for row in ROWS:
        cells = [str(value) for value in row]
        if more is None:
            cells = ["0", cells[0], *cells[4:], *cells[1:4]]
        lines.append(separator.join([*cells, more] if more else cells))
    path.write_text("\n".join(lines) + "\n", "utf-8")
    rows = read_imu(path, ImportReport())

    samples = rows.of(0)
    assert samples.t_ns.tolist() == [row[0] for row in ROWS]
    np.testing.assert_allclose(samples.gyro_rad_s[0], [0.1, 0.2, 0.3])
    np.testing.assert_allclose(samples.accel_m_s2[0], [0.0, 0.1 * G, G])


@pytest.mark.parametrize("cell", ["inf", "nan", "-5", "9" * 400, "1e300", "x"])
def test_a_line_without_a_time_is_dropped_and_counted(cell, tmp_path):
    path = tmp_path / "imu0000.csv"
    lines = [" ".join(map(str, row)) for row in ROWS]
    path.write_text("\n".join([*lines, f"{cell} 0 0 0 0 0 1 0"]), "utf-8")
    report = ImportReport()

    assert len(read_imu(path, report).samples.t_ns) == len(ROWS)
    assert report.counts["imu_lines_damaged"] == 1


def test_accelerations_in_m_s2_are_kept_and_said(tmp_path):
    path = tmp_path / "imu0000.csv"
    path.write_text("\n".join(f"{t} 0 0 0 0 0 9.81 0" for t, *_ in ROWS), "utf-8")
    report = ImportReport()

    assert read_imu(path, report).of(0).accel_m_s2[0, 2] == 9.81
    assert any("m/s², not g" in text for text in derivations(report))


def test_the_imu_of_another_lidar_is_not_read_and_counted(copy):
    path = copy / "imu0000.csv"
    lines = path.read_text("utf-8").splitlines()
    other = [" ".join([*line.split()[:7], "1", "0"]) for line in lines[1:]]
    path.write_text("\n".join([*lines, *other]), "utf-8")
    _, samples, report = read(copy)

    assert report.counts["imu_samples_not_read"] == 5 * RATE_HZ
    assert sum(len(s.t_ns) for s in samples) == 5 * PARTS * RATE_HZ


def test_an_imu_with_a_number_of_its_own_is_read(tmp_path):
    folder = tmp_path / "walk"
    write_walk(folder, rig_to_complete([Stream("a", "Avia")]), seconds=1.0)
    path = folder / "imu0000.csv"
    path.write_text(path.read_text("utf-8").replace(" 0 1", " 7 1"), "utf-8")
    _, samples, report = read(folder, rig=rig_to_complete([Stream("a", "generic")]))

    assert sum(len(s.t_ns) for s in samples) == RATE_HZ
    assert any("IMU: number 7 is read" in text for text in derivations(report))


def test_a_capture_is_converted_by_the_command(tmp_path, capsys):
    path = write_room_pcap(tmp_path / "walk.pcap", seconds=0.5)
    out = tmp_path / "folder"

    assert main(["convert", str(path), "--out", str(out)]) == 0
    assert "points and 0 IMU samples in" in capsys.readouterr().out
    shots, _, _ = read(out, rig=None)
    recording = open_recording(OpenRequest((path,), None, IngestSettings(), ImportReport()))
    known = np.concatenate([s.t_ns for s in recording.read() if isinstance(s, Shots)])
    assert len(joined(shots, "t_ns")) == len(known)
    assert main(["convert", str(path), "--out", str(out)]) == 1


def test_clouds_of_no_single_sensor_are_not_converted(tmp_path, capsys):
    folder = tmp_path / "clouds"
    folder.mkdir()
    write_pcd(folder / f"{T0_NS}.pcd", room_cloud())

    assert main(["convert", str(folder), "--out", str(tmp_path / "out")]) == 1
    assert "expected packets or messages of LiDARs" in capsys.readouterr().err
    assert not (tmp_path / "out").exists()


def test_a_converted_imu_is_on_the_clock_of_the_points_and_in_g(tmp_path):
    turns = np.random.default_rng(1).normal(0.0, 0.1, (90, 3))
    path = write_room_pcap(tmp_path / "walk.pcap", seconds=0.5)
    shots = open_recording(OpenRequest((path,), None, IngestSettings(), ImportReport()))
    start_ns = next(int(s.t_ns[0]) for s in shots.read() if isinstance(s, Shots) and len(s))
    numbers = [
        ",".join(f"{x:.9f}" for x in (*gyro, *1e-3 * gyro[:2], 1.0 + 1e-3 * gyro[2]))
        for gyro in turns
    ]
    rows = [f"{start_ns + k * 5_000_000},{row}" for k, row in enumerate(numbers)]
    head = "t_ns,gx_rad_s,gy_rad_s,gz_rad_s,ax_m_s2,ay_m_s2,az_m_s2"
    (tmp_path / "imu.csv").write_text("\n".join([head, *rows, ""]), "utf-8")
    late = replace(single_rig(Stream("a", "VLP-16")), imu_time_offset_s=0.05)

    sources = Sources((path,), late, imu=tmp_path / "imu.csv")
    assert convert(sources, tmp_path / "out", progress=Silent()).samples == 90
    found = read_imu(tmp_path / "out" / "imu0000.csv", ImportReport()).samples

    assert found.t_ns[0] == start_ns + 50_000_000
    np.testing.assert_allclose(found.accel_m_s2[:, 2], G * (1.0 + 1e-3 * turns[:, 2]), atol=1e-6)
