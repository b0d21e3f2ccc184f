"""IMU and GNSS samples from CSV files, made fit for use; poses as text."""

import numpy as np
import pytest

from recon4.errors import CorruptFile, EmptyRecording, UnknownFormat
from recon4.evaluation.evaluate import evaluate
from recon4.evaluation.text import evaluation_text
from recon4.geometry.se3 import SE3
from recon4.model.samples import GnssSamples, ImuSamples
from recon4.model.trajectory import Trajectory
from recon4.recording.formats.poses import (
    pose_format,
    read_tum,
    tum_hint,
    write_kitti,
    write_tum,
)
from recon4.recording.info.describe import describe
from recon4.recording.report import ImportReport
from recon4.recording.samples.clean import clean_gnss, clean_imu, gather, join
from recon4.recording.samples.csv_files import GNSS_HEADER, IMU_HEADER, read_gnss_csv, read_imu_csv
from tests.warned import K, derivations, kinds, warned

T0 = 1_700_000_000_123_456_789
HEADER = ",".join(IMU_HEADER)


def write(path, text):
    path.write_text(text, encoding="utf-8")
    return path


# -- pieces


@pytest.mark.parametrize("lengths", [[1] * 1000, [7, 0, 3, 1, 1, 1, 500, 2], [0, 0]])
def test_gathered_pieces_are_all_there_in_order_and_few(lengths):
    rows = np.random.default_rng(1).normal(size=(sum(lengths), 6))
    t_ns = T0 + np.arange(len(rows))
    parts, begin = [], 0
    for length in lengths:
        here = slice(begin, begin + length)
        gather(parts, ImuSamples(t_ns[here], rows[here, :3], rows[here, 3:]))
        begin += length
    whole = join(parts)

    assert whole.t_ns.tolist() == t_ns.tolist()
    assert np.array_equal(np.hstack([whole.gyro_rad_s, whole.accel_m_s2]), rows)
    assert len(parts) <= 1 + np.log2(len(rows) + 1)


# -- CSV


def test_imu_samples_keep_every_nanosecond(tmp_path):
    imu = read_imu_csv(write(tmp_path / "imu.csv", f"{HEADER}\n{T0},1,2,3,4,5,9.8\n"))

    assert imu.t_ns.tolist() == [T0]
    assert imu.gyro_rad_s.tolist() == [[1, 2, 3]]
    assert imu.accel_m_s2.tolist() == [[4, 5, 9.8]]


def test_a_european_file_reads_the_same(tmp_path):
    text = "\ufeff" + HEADER.replace(",", ";") + f"\r\n{T0};0,5;2;3;4;5;9,81\r\n"

    imu = read_imu_csv(write(tmp_path / "imu.csv", text))

    assert imu.gyro_rad_s[0, 0] == 0.5
    assert imu.accel_m_s2[0, 2] == 9.81


def test_columns_may_come_in_any_order_and_without_accelerometer(tmp_path):
    text = f"gz_rad_s,gy_rad_s,t_ns,gx_rad_s\n3,2,{T0},1\n"

    imu = read_imu_csv(write(tmp_path / "imu.csv", text))

    assert imu.gyro_rad_s.tolist() == [[1, 2, 3]]
    assert np.isnan(imu.accel_m_s2).all()


@pytest.mark.parametrize(
    ("text", "error", "message"),
    [
        ("a,b\n1,2\n", UnknownFormat, "missing columns t_ns, gx_rad_s.*; got a,b"),
        (f"{HEADER}\n", EmptyRecording, "no samples"),
        (f"{HEADER}\n{T0},1,2,3,4,5,x\n", CorruptFile, "line 2: expected a number, got 'x'"),
        (f"{HEADER}\n{T0},1,2,3,4,5\n", CorruptFile, "line 2: expected 7 cells, got 6"),
        (f"{HEADER}\n1.7e18,1,2,3,4,5,6\n", CorruptFile, "whole nanoseconds"),
        (f"{HEADER}\n{2**63},1,2,3,4,5,6\n", CorruptFile, "t_ns must be 0 to"),
    ],
    ids=["header", "empty", "word", "cut line", "float time", "time too large"],
)
def test_a_wrong_imu_file_is_refused_with_the_place(tmp_path, text, error, message):
    with pytest.raises(error, match=message):
        read_imu_csv(write(tmp_path / "imu.csv", text))


def test_gnss_positions_are_read_in_radians(tmp_path):
    text = (
        ",".join(GNSS_HEADER) + f"\n{T0},50,14,300,0.01,0.02,0.03,4,0,,90\n{T0 + 1},50,14,,,,,,,,\n"
    )

    gnss = read_gnss_csv(write(tmp_path / "gnss.csv", text))

    assert gnss.lat_rad[0] == pytest.approx(np.deg2rad(50))
    assert gnss.sd_enu_m[0].tolist() == [0.01, 0.02, 0.03]
    assert gnss.quality.tolist() == [4, 1]
    assert gnss.rpy_ned_rad[0, 2] == pytest.approx(np.pi / 2)
    assert np.isnan(gnss.rpy_ned_rad[0, 1])
    assert np.isnan(gnss.height_m[1])


def test_a_latitude_that_is_none_is_refused(tmp_path):
    with pytest.raises(CorruptFile, match="line 2: latitude and longitude must be in degrees"):
        read_gnss_csv(write(tmp_path / "g.csv", f"t_ns,lat_deg,lon_deg\n{T0},5551234.5,14\n"))


# -- cleaning


def imu_of(t_ns, *, gyro=0.1, accel=9.81):
    count = len(t_ns)
    force = np.tile([0.0, 0.0, accel], (count, 1))
    return ImuSamples(np.array(t_ns, np.int64), np.full((count, 3), gyro), force)


def cleaned(imu, jumps=()):
    report = ImportReport()
    return clean_imu(imu, offset_s=0.0, jumps_ns=list(jumps), report=report), report


def test_samples_are_sorted_and_unique():
    imu, report = cleaned(imu_of([30, 10, 20, 20, 40]))

    assert imu.t_ns.tolist() == [10, 20, 30, 40]
    assert report.counts == {"imu_unsorted": 1, "imu_copies": 1, "imu_kept": 4}


def test_two_samples_of_one_time_that_differ_are_a_loss_and_copies_are_none():
    imu = imu_of([10, 20, 20, 30, 30])
    imu.gyro_rad_s[2] += 0.01

    kept, report = cleaned(imu)

    assert kept.t_ns.tolist() == [10, 20, 30]
    assert report.counts == {"imu_duplicate": 1, "imu_copies": 1, "imu_kept": 3}


def test_samples_that_are_no_numbers_are_dropped_and_counted():
    imu = imu_of([10, 20, 30])
    imu.gyro_rad_s[1, 0] = np.nan
    imu.accel_m_s2[2, 1] = np.nan

    kept, report = cleaned(imu)

    assert kept.t_ns.tolist() == [10]
    assert report.counts["imu_nan"] == 2


def test_samples_that_a_driver_repeats_in_motion_are_dropped_and_said():
    rng = np.random.default_rng(4)
    imu = imu_of(5_000_000 * np.arange(1000))
    imu.gyro_rad_s[:] += 0.1 * rng.standard_normal((1000, 3))
    imu.gyro_rad_s[200:500], imu.gyro_rad_s[700:705] = [0.4, 0.0, 0.1], [0.0, 0.3, 0.0]

    kept, report = cleaned(imu)

    assert len(kept) == 701, "the first of them was measured; a slower sensor repeats a few"
    assert report.counts["imu_repeated"] == 299
    (found,) = (one for one in report.findings if one.kind is K.IMU_REPEATED)
    assert found.values["times"] == 1
    assert [found.values[name] for name in ("first_s", "longest_s")] == pytest.approx(
        [1.0, 1.5], abs=0.05
    )


def test_an_imu_at_rest_may_repeat_itself():
    imu = imu_of(5_000_000 * np.arange(200), gyro=0.01)
    rng = np.random.default_rng(4)
    imu.gyro_rad_s[100:] += 0.01 * rng.standard_normal((100, 3))
    imu.accel_m_s2[100:] += 0.01 * rng.standard_normal((100, 3))

    kept, report = cleaned(imu)

    assert len(kept) == 200
    assert np.isfinite(kept.accel_m_s2).all()
    assert "imu_repeated" not in report.counts


def test_a_missing_accelerometer_is_no_fault():
    imu = ImuSamples(np.array([1, 2]), np.zeros((2, 3)), np.full((2, 3), np.nan))

    kept, report = cleaned(imu)

    assert len(kept) == 2
    assert warned(report, K.ACCELEROMETER_MISSING)


def test_an_accelerometer_in_g_is_scaled_and_said():
    imu, report = cleaned(imu_of(range(5), accel=1.0))

    assert imu.accel_m_s2[0, 2] == pytest.approx(9.80665)
    assert report.counts["imu_accel_scaled"] == 5
    assert any("in g" in text for text in derivations(report))


def test_the_offset_is_added():
    imu = clean_imu(imu_of([0]), offset_s=0.25, jumps_ns=[], report=ImportReport())

    assert imu.t_ns.tolist() == [250_000_000]


def test_a_jump_of_the_lidars_clock_is_the_same_jump_here():
    hour = 3600 * 10**9
    imu, report = cleaned(imu_of([hour, hour + 10, 20, 30]), jumps=[hour])

    assert imu.t_ns.tolist() == [hour, hour + 10, hour + 20, hour + 30]
    assert report.counts["imu_jumps_back"] == 1


def test_positions_without_a_fix_are_dropped():
    nan = np.full((3, 3), np.nan)
    places = np.array([0.5, np.nan, 0.5])
    quality = np.array([4, 4, 0], np.uint8)
    gnss = GnssSamples(np.arange(3), places, places, places, nan, quality, nan)
    report = ImportReport()

    kept = clean_gnss(gnss, offset_s=0.0, report=report)

    assert kept.t_ns.tolist() == [0]
    assert report.counts == {"gnss_nan": 1, "gnss_no_fix": 1, "gnss_kept": 1}


def test_no_usable_sample_is_none_and_said():
    imu = imu_of([1])
    imu.gyro_rad_s[:] = np.nan

    kept, report = cleaned(imu)

    assert kept is None
    assert warned(report, K.GYROSCOPE_MISSING)


def test_parts_are_joined_in_order():
    assert join([]) is None
    assert join([imu_of([1, 2]), imu_of([3])]).t_ns.tolist() == [1, 2, 3]


# -- poses


def trajectory(count=20):
    rng = np.random.default_rng(4)
    t_ns = T0 + np.arange(count) * 10_000_001
    return Trajectory(t_ns, SE3.exp(rng.normal(size=(count, 6))))


def test_tum_comes_back(tmp_path):
    before = trajectory()

    write_tum(tmp_path / "t.tum", before)
    after = read_tum(tmp_path / "t.tum")

    assert pose_format(tmp_path / "t.tum") == "tum"
    np.testing.assert_array_equal(after.t_ns, before.t_ns)
    np.testing.assert_allclose(after.T_a_b.t, before.T_a_b.t, atol=1e-9)
    np.testing.assert_allclose(after.T_a_b.R, before.T_a_b.R, atol=1e-11)


def test_tum_worked_out_by_hand(tmp_path):
    path = write(
        tmp_path / "t.tum", "# t x y z q\n1.5 1 2 3 0 0 0.7071067811865476 0.7071067811865476\n"
    )

    poses = read_tum(path)

    assert poses.t_ns.tolist() == [1_500_000_000]
    np.testing.assert_allclose(poses.T_a_b[0] @ np.array([1.0, 0, 0]), [1, 3, 3], atol=1e-9)


HEADS = {
    "qw first": ("timestamp tx ty tz qw qx qy qz", [0, 1, 2, 3, 7, 4, 5, 6]),
    "usual": ("timestamp,tx,ty,tz,qx,qy,qz,qw", [0, 1, 2, 3, 4, 5, 6, 7]),
    "comment": ("# time x y z q_w q_x q_y q_z", [0, 1, 2, 3, 7, 4, 5, 6]),
    "units": (
        "#timestamp [s] p_x [m] p_y [m] p_z [m] qw qx qy qz",
        [0, 1, 2, 3, 7, 4, 5, 6],
    ),
}


@pytest.mark.parametrize("head", HEADS)
def test_a_head_line_states_the_order_of_a_tum_file(tmp_path, head):
    before, (line, order) = trajectory(), HEADS[head]
    write_tum(tmp_path / "t.tum", before)
    rows = [row.split() for row in (tmp_path / "t.tum").read_text().splitlines()]
    separator = "," if "," in line else " "
    lines = [line, *(separator.join(row[k] for k in order) for row in rows)]

    path = write(tmp_path / "other.txt", "\n".join(lines))
    after = read_tum(path)

    assert pose_format(path) == "tum"
    np.testing.assert_array_equal(after.t_ns, before.t_ns)
    np.testing.assert_allclose(after.T_a_b.R, before.T_a_b.R, atol=1e-11)


@pytest.mark.parametrize(
    ("unit_ns", "text"),
    [(1, "{}"), (1000, "{}.{:03d}"), (1_000_000, "{}.{:06d}"), (1_000_000_000, "{}.{:09d}")],
    ids=["ns", "us", "ms", "s"],
)
def test_times_of_a_tum_file_are_read_in_their_unit(tmp_path, unit_ns, text):
    times = [T0, T0 + 123_456_789]
    rows = [f"{text.format(*divmod(t, unit_ns))} 1 2 3 0 0 0 1" for t in times]

    poses = read_tum(write(tmp_path / "t.tum", "\n".join(rows)))

    assert poses.t_ns.tolist() == times


def turning(count=60):
    yaw = np.linspace(0.0, 5.0, count)
    T = [SE3.from_rpy(0.02 * np.sin(7 * a), 0.02 * np.cos(5 * a), a, t=[a, 0, 0]) for a in yaw]
    return Trajectory(T0 + 100_000_000 * np.arange(count), SE3.stack(T))


def test_odometry_of_a_lidar_that_lies_on_its_side_is_not_taken_for_qw_first():
    on_side = SE3.from_rpy(0.0, np.pi / 2, 0.0, t=[0, 0, 0])
    walk = turning()
    turned = on_side.inverse() @ walk.T_a_b @ on_side
    odometry = Trajectory(walk.t_ns, turned[0].inverse() @ turned)

    assert np.ptp(np.abs(odometry.T_a_b.quat_xyzw()[:, 0])) > 0.9
    assert tum_hint(odometry) == ""


def test_quaternions_with_qw_first_are_noticed_without_a_head_line(tmp_path):
    write_tum(tmp_path / "t.tum", turning())
    rows = [row.split() for row in (tmp_path / "t.tum").read_text().splitlines()]
    path = write(tmp_path / "w.tum", "\n".join(" ".join([*r[:4], r[7], *r[4:7]]) for r in rows))

    assert tum_hint(read_tum(tmp_path / "t.tum")) == ""
    assert tum_hint(trajectory()) == ""
    assert "is qw the first number" in tum_hint(read_tum(path))
    assert kinds(describe(path)) == [K.QUATERNION_ORDER]
    found = evaluate(path, truth=tmp_path / "t.tum")
    assert "Warning: w.tum: the body rolls over" in evaluation_text(found)
    assert "Warning" not in evaluation_text(evaluate(tmp_path / "t.tum", truth=tmp_path / "t.tum"))


def test_poses_are_written_as_kitti_has_them(tmp_path):
    before = trajectory()

    write_kitti(tmp_path / "p.txt", before)

    assert pose_format(tmp_path / "p.txt") == "kitti"
    after = np.loadtxt(tmp_path / "p.txt").reshape(-1, 3, 4)
    np.testing.assert_allclose(after, before.T_a_b.matrix()[:, :3], atol=1e-10)


@pytest.mark.parametrize(
    ("text", "error", "message"),
    [
        ("", EmptyRecording, "no poses"),
        ("1 2 3\n", CorruptFile, "line 1: expected 8 numbers, got 3"),
        ("1 0 0 0 0 0 0 2\n", CorruptFile, "a quaternion has length 1, got 2"),
        ("2 0 0 0 0 0 0 1\n1 0 0 0 0 0 0 1\n", CorruptFile, "line 2: times must increase"),
        ("1 0 0 nan 0 0 0 1\n", CorruptFile, "finite"),
        ("x 0 0 0 0 0 0 1\n", CorruptFile, "line 1"),
    ],
    ids=["empty", "short", "quaternion", "order", "nan", "word"],
)
def test_wrong_poses_are_refused_with_the_place(tmp_path, text, error, message):
    with pytest.raises(error, match=message):
        read_tum(write(tmp_path / "t.tum", text))
