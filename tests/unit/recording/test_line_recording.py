"""Bags of a backpack with a profiler: lines turned by their head, what is missing or damaged."""

from dataclasses import replace

import numpy as np
import pytest

from recon4.errors import ConfigError, EmptyRecording, RecordingError, UnknownFormat
from recon4.model.laser_scans import LaserScans
from recon4.model.rig import load_rig
from recon4.model.samples import ImuSamples
from recon4.progress import Silent
from recon4.recording.info.describe import describe
from recon4.recording.ingest import ingest
from recon4.recording.open import open_recording
from recon4.recording.openers.request import OpenRequest
from recon4.recording.report import ImportReport
from recon4.recording.sources import Sources
from recon4.settings import IngestSettings
from recon4.simulation.line_bag import open_line_bag
from recon4.store.frames import FrameStore
from recon4.store.line_store import load_laser_scans, load_lines
from tests.laser_rows import rows_of, with_times
from tests.robot_bags import mount
from tests.warned import K, derivations, findings_of, kinds, warned

START_NS = 1_700_000_000_000_000_000
LINE_NS = 10_000_000
SHOTS = 21


def line_scans(count, *, range_m=4.0, first=0):
    t_ns = START_NS + LINE_NS * np.arange(first, first + count, dtype=np.int64)
    return LaserScans.of_rows(
        t_ns,
        np.full((count, SHOTS), range_m, np.float32),
        angles=(-0.5, 0.05),
        range_max_m=100.0,
        time_step_s=4e-4,
    )


def write(folder, *, lines=None, head_deg_s=50.0, scans=None, head=True):
    lines = line_scans(300) if lines is None else lines
    with open_line_bag(folder) as bag:
        if head:
            t_ns = START_NS + LINE_NS * np.arange(310, dtype=np.int64)
            bag.head("/profiler/head", t_ns, np.deg2rad(head_deg_s) * 1e-9 * (t_ns - START_NS))
        bag.scans("/profiler/line", lines, np.full((len(lines), SHOTS), 7, np.uint8))
        if scans is not None:
            bag.scans("/laser2d/scan", scans)


def read(folder, out, rig=None):
    ingest(Sources((folder,), rig), out, settings=IngestSettings(), progress=Silent())
    return FrameStore.open(out)


def test_a_shot_lies_where_the_head_pointed_at_its_time(tmp_path):
    write(tmp_path / "bag")

    store = read(tmp_path / "bag", tmp_path / "out")

    frame, lines = store[5], load_lines(tmp_path / "out")
    since_ns = frame.t_ns - START_NS + frame.dt_ns.astype(np.int64)
    head = np.deg2rad(50.0) * 1e-9 * since_ns
    shot = since_ns % LINE_NS // 400_000
    elevation = -0.5 + 0.05 * shot
    expected = 4.0 * np.stack(
        [np.cos(elevation) * np.cos(head), np.cos(elevation) * np.sin(head), np.sin(elevation)], 1
    )
    assert np.allclose(frame.xyz, expected, atol=2e-3)
    assert set(frame.sensor) == {1}
    assert set(frame.intensity) == {7}
    assert len(lines) == 300
    assert np.allclose(lines.head_rad, np.deg2rad(50.0) * 0.01 * np.arange(300), atol=1e-6)
    assert np.all(lines.points == SHOTS)
    assert any("preset wuerzburg" in text for text in derivations(store.report))


def test_a_head_of_constant_rate_needs_no_angles(tmp_path):
    write(tmp_path / "bag", head=False)
    rig = load_rig("wuerzburg")
    sensors = (rig.sensors[0], replace(rig.sensors[1], head_rate_rad_s=2.0))

    read(tmp_path / "bag", tmp_path / "out", replace(rig, sensors=sensors))

    lines = load_lines(tmp_path / "out")
    assert np.allclose(np.diff(lines.head_rad), 0.02, atol=1e-9)


def test_missing_angles_of_the_head_are_named(tmp_path):
    write(tmp_path / "bag", head=False)

    with pytest.raises(ConfigError, match=r"angles of its head are missing.*/profiler/head"):
        read(tmp_path / "bag", tmp_path / "out")


def test_a_head_that_is_stuck_is_named(tmp_path):
    write(tmp_path / "bag", lines=line_scans(310), head_deg_s=0.0)

    with pytest.raises(RecordingError, match="expected a head that turns"):
        read(tmp_path / "bag", tmp_path / "out")


def test_scans_of_the_2d_laser_are_stored(tmp_path):
    scans = with_times(line_scans(250, range_m=3.0), 1e-5)
    scans.ranges(7)[3] = np.nan
    write(tmp_path / "bag", scans=scans)

    read(tmp_path / "bag", tmp_path / "out")

    found = load_laser_scans(tmp_path / "out")
    assert found is not None
    assert np.array_equal(found.t_ns, scans.t_ns)
    assert np.array_equal(found.range_m, scans.range_m, equal_nan=True)
    assert found.time_step_s == pytest.approx(1e-5)
    assert found.angle_min_rad == pytest.approx(-0.5)
    assert found.angle_step_rad == pytest.approx(0.05)


def test_a_missing_2d_laser_is_a_warning(tmp_path):
    write(tmp_path / "bag")

    store = read(tmp_path / "bag", tmp_path / "out")

    assert load_laser_scans(tmp_path / "out") is None
    assert K.SENSOR_NOT_RECORDED in kinds(store.report)


@pytest.mark.parametrize("roll_deg", [0.0, 180.0])
def test_transforms_that_contradict_the_rig_are_named(tmp_path, roll_deg):
    """In the rig the laser is 35 cm above the IMU, and as level."""
    with open_line_bag(tmp_path / "bag") as bag:
        t_ns = START_NS + LINE_NS * np.arange(310, dtype=np.int64)
        bag.head("/profiler/head", t_ns, 1e-9 * (t_ns - START_NS))
        bag.scans("/profiler/line", line_scans(300))
        bag.scans("/laser2d/scan", line_scans(30))
        bag.imu(ImuSamples(t_ns, np.zeros((310, 3)), np.tile([0.0, 0.0, 9.81], (310, 1))))
        write_transform(bag, "imu", "laser2d", mount(-0.05, z=0.35, roll=roll_deg))

    rig, report = open_with_report(tmp_path / "bag")

    assert rig.name == "wuerzburg"
    assert len(report.findings) == (roll_deg > 0)
    if roll_deg:
        pair = {"part": "IMU", "other": "laser2d"}
        assert warned(report, K.MOUNT_CONTRADICTED, angle_rad=np.pi, **pair)


def write_transform(bag, parent, child, T):
    types, kind = bag._store.types, "tf2_msgs/msg/TFMessage"
    x, y, z, w = T.quat_xyzw()
    stated = types["geometry_msgs/msg/TransformStamped"](
        header=bag._header(START_NS, parent),
        child_frame_id=child,
        transform=types["geometry_msgs/msg/Transform"](
            translation=types["geometry_msgs/msg/Vector3"](*(float(v) for v in T.t)),
            rotation=types["geometry_msgs/msg/Quaternion"](x=x, y=y, z=z, w=w),
        ),
    )
    bag._write("/tf_static", kind, START_NS, message=types[kind](transforms=[stated]))


def open_with_report(path):
    report = ImportReport()
    return open_recording(OpenRequest((path,), None, IngestSettings(), report)).rig, report


def test_lines_out_of_order_are_counted(tmp_path):
    lines = line_scans(300)
    t_ns = lines.t_ns.copy()
    write(tmp_path / "bag", lines=lines[:200])
    with open_line_bag(tmp_path / "twice") as bag:
        head_ns = START_NS + LINE_NS * np.arange(310, dtype=np.int64)
        bag.head("/profiler/head", head_ns, 1e-9 * (head_ns - START_NS))
        bag.scans("/profiler/line", lines, None)
        bag.scans("/profiler/line", lines[50:60], None)

    store = read(tmp_path / "twice", tmp_path / "out")

    assert store.report["counts"]["lines_out_of_order"] == 10
    assert np.array_equal(load_lines(tmp_path / "out").t_ns, t_ns)


def test_lines_that_are_lost_are_counted_and_said(tmp_path):
    lines = line_scans(300)
    write(tmp_path / "bag", lines=lines[np.arange(300) % 10 != 3])

    store = read(tmp_path / "bag", tmp_path / "out")

    assert store.report["counts"]["lines_missing"] == 30
    assert warned(store.report, K.LINES_MISSING, sensor="profiler", missing=30, lines=300)


def test_lines_without_any_return_are_not_lost(tmp_path):
    lines = line_scans(300)
    rows_of(lines)[100:140] = np.nan
    write(tmp_path / "bag", lines=lines)

    store = read(tmp_path / "bag", tmp_path / "out")

    assert store.report["counts"]["lines_empty"] == 40
    assert "lines_missing" not in store.report["counts"]


@pytest.mark.parametrize(("factor", "unit"), [(100.0, "cm"), (1000.0, "mm")])
def test_ranges_in_another_unit_are_converted_and_said(tmp_path, factor, unit):
    lines, scans = line_scans(300), line_scans(290, range_m=3.0)
    in_unit = [
        replace(s, range_m=s.range_m * np.float32(factor), range_max_m=s.range_max_m * factor)
        for s in (lines, scans)
    ]
    write(tmp_path / "bag", lines=in_unit[0], scans=in_unit[1])

    store = read(tmp_path / "bag", tmp_path / "out")

    assert np.allclose(np.linalg.norm(store[5].xyz, axis=1), 4.0, atol=1e-3)
    assert np.allclose(load_laser_scans(tmp_path / "out").range_m, 3.0, atol=1e-3)
    assert store.report["counts"]["lines_converted"] == 300
    assert store.report["counts"]["scans_converted"] == 290
    units = [one for one in findings_of(store.report) if one.kind is K.RANGE_UNIT]
    assert [one.values["unit"] for one in units] == [unit, unit]


def test_a_bag_without_line_scans_is_refused(tmp_path):
    with open_line_bag(tmp_path / "bag") as bag:
        bag.scans("/other", line_scans(5), None)

    with pytest.raises(EmptyRecording, match=r"no line scans of profiler; topics: /other"):
        read(tmp_path / "bag", tmp_path / "out", load_rig("wuerzburg"))


def test_a_rig_with_a_profiler_needs_a_bag(tmp_path):
    np.zeros(400, np.float32).tofile(tmp_path / "000000.bin")

    with pytest.raises(UnknownFormat, match="line scans are read from bags"):
        read(tmp_path, tmp_path / "out", load_rig("wuerzburg"))


def test_info_names_line_scans_head_and_2d_laser(tmp_path):
    scans = line_scans(250, range_m=3.0)
    write(tmp_path / "bag", lines=line_scans(300)[np.r_[0:100, 150:300]], scans=scans)

    found = describe(tmp_path / "bag")

    text = "\n".join(found.lines())
    assert "/profiler/line profiler: 250 line scans" in text
    assert "/profiler/head head: 310 angles" in text
    assert "/laser2d/scan 2-D laser: 250 scans" in text
    assert "LiDAR data" not in text
    assert "IMU" in " ".join(found.missing)
    assert any(gap.sensor == "/profiler/line" and gap.seconds > 0.4 for gap in found.gaps)


def test_info_names_what_is_missing_of_a_profiler(tmp_path):
    write(tmp_path / "bag", head=False)

    found = describe(tmp_path / "bag")

    assert any("angles of the head (/profiler/head" in text for text in found.missing)
    assert any("2-D laser" in text for text in found.missing)
