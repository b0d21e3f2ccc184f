"""CARMEN logs: what is read, repaired, counted and refused."""

import bz2
import gzip
from dataclasses import replace

import numpy as np
import pytest

from recon4.errors import CorruptFile, EmptyRecording, UnknownFormat
from recon4.recording.formats.carmen import is_carmen, read_carmen
from recon4.recording.formats.text_logs import log_lines
from recon4.recording.info.describe import describe
from recon4.recording.kinds import RecordingKind, recognize
from recon4.recording.lasers.laser2d import is_laser2d, read_laser2d
from recon4.recording.report import ImportReport
from tests.laser_rows import angles_of, rows_of
from tests.planar_walks import carmen_lines, furnished_room, scanned, write_carmen
from tests.warned import K, derivations, kinds, warned

HEAD = "PARAM robot_frontlaser_offset 0.0 nohost 0\n"


@pytest.fixture(scope="module")
def walk():
    truth = np.stack([np.linspace(-2.0, 2.0, 30), np.zeros(30), np.zeros(30)], axis=1)
    return scanned(furnished_room(), truth)


def flaser(ranges, time_s, laser=(1.0, 2.0, 0.5), robot=(1.0, 2.0, 0.5)):
    numbers = " ".join(str(value) for value in [*ranges, *laser, *robot])
    return f"FLASER {len(ranges)} {numbers} {time_s} nohost {time_s}\n"


def read(path, text=None):
    report = ImportReport()
    if text is not None:
        path.write_text(HEAD + text, "ascii")
    return read_laser2d([path], report), report


def test_a_log_is_read_as_it_was_written(tmp_path, walk):
    write_carmen(tmp_path / "walk.log", walk.scans)

    scans, report = read(tmp_path / "walk.log")

    assert recognize(tmp_path / "walk.log") is RecordingKind.CARMEN
    np.testing.assert_array_equal(scans.t_ns, walk.scans.t_ns)
    np.testing.assert_allclose(scans.range_m, walk.scans.range_m, atol=6e-4)
    np.testing.assert_allclose(angles_of(scans), angles_of(walk.scans), atol=1e-6)
    np.testing.assert_allclose(scans.odometry, walk.scans.odometry, atol=1e-6)
    assert report.outcome == "complete"
    assert report.findings == []


@pytest.mark.parametrize("pack", [bz2.compress, gzip.compress])
def test_compressed_logs_are_read_without_unpacking(tmp_path, walk, pack):
    text = "\n".join(carmen_lines(walk.scans)) + "\n"
    (tmp_path / "walk.log.packed").write_bytes(pack(text.encode()))

    scans, _ = read(tmp_path / "walk.log.packed")

    assert is_laser2d(tmp_path / "walk.log.packed")
    assert len(scans) == 30


@pytest.mark.parametrize("pack", [bz2.compress, gzip.compress])
def test_a_compressed_log_that_is_cut_off_is_read_as_far_as_it_goes(tmp_path, walk, pack):
    text = "\n".join(carmen_lines(walk.scans) * 40) + "\n"
    packed = pack(text.encode())
    (tmp_path / "cut").write_bytes(packed[: len(packed) * 3 // 4])

    report = ImportReport()
    found = read_carmen(tmp_path / "cut", report) if pack is gzip.compress else None

    if found is None:  # bz2 has blocks of 900 kB: a quarter less may leave none
        lines = list(log_lines(tmp_path / "cut", report))
        assert len(lines) < text.count("\n")
    else:
        assert 0 < len(found.t_ns) < 1200
    assert report.outcome == "lossy"
    assert warned(report, K.FILE_SALVAGED)


@pytest.mark.parametrize("pack", [bz2.compress, gzip.compress])
def test_all_streams_of_a_compressed_log_are_read(tmp_path, walk, pack):
    """Parallel compressors write several streams into one file, and tapes end with zeros."""
    parts = ["\n".join(carmen_lines(walk.scans)[a:b]) + "\n" for a, b in ((0, 20), (20, 60))]
    packed = b"".join(pack(part.encode()) for part in parts)
    (tmp_path / "log").write_bytes(packed)
    (tmp_path / "padded").write_bytes(packed + bytes(100))

    whole, report = read(tmp_path / "log")
    padded, also = read(tmp_path / "padded")

    assert len(whole) == len(padded) == 30
    assert report.findings == also.findings == []


@pytest.mark.parametrize("pack", [bz2.compress, gzip.compress])
def test_what_follows_the_compressed_data_is_reported(tmp_path, walk, pack):
    text = "\n".join(carmen_lines(walk.scans)) + "\n"
    (tmp_path / "log").write_bytes(pack(text.encode()) + b"FLASER 180")

    scans, report = read(tmp_path / "log")

    assert len(scans) == 30
    assert report.outcome == "lossy"
    assert warned(report, K.FILE_REST_UNREAD)


def test_a_flaser_of_180_beams_begins_at_minus_90_degrees(tmp_path):
    scans, _ = read(tmp_path / "log", flaser([2.0] * 180, 5.25) + flaser([2.1] * 180, 5.5))

    assert scans.t_ns.tolist() == [5_250_000_000, 5_500_000_000]
    assert scans.angle_min_rad == pytest.approx(-np.pi / 2)
    assert scans.angle_step_rad == pytest.approx(np.deg2rad(1.0))


@pytest.mark.parametrize(("beams", "field_deg"), [(181, 180.0), (361, 180.0), (1081, 270.0)])
def test_lasers_of_other_layouts_are_known_by_their_beams(tmp_path, beams, field_deg):
    scans, _ = read(tmp_path / "log", flaser([2.0] * beams, 5) + flaser([3.0] * beams, 6))

    angles = np.rad2deg(angles_of(scans)[[0, -1]])
    np.testing.assert_allclose(angles, [-field_deg / 2, field_deg / 2], atol=1e-6)


def test_scans_out_of_order_and_duplicates_are_repaired_and_counted(tmp_path):
    times = [1.0, 2.0, 2.0, 4.0, 3.0, 5.0]
    text = "".join(flaser([1.0 + k] * 4, time) for k, time in enumerate(times))

    scans, report = read(tmp_path / "log", text)

    assert (scans.t_ns // 10**9).tolist() == [1, 2, 3, 4, 5]
    assert rows_of(scans)[:, 0].tolist() == [1.0, 2.0, 5.0, 4.0, 6.0]
    assert report.counts["scans_duplicate"] == 1
    assert report.counts["scans_unsorted"] == 1
    assert kinds(report) == [K.SCANS_UNSORTED]


@pytest.mark.parametrize("back_s", [0.33, 2.03, 3600.0])
def test_a_log_goes_on_where_its_clock_was_set_back(tmp_path, back_s):
    times = 5000.0 + 0.1 * np.arange(40) - np.where(np.arange(40) >= 20, back_s, 0.0)
    text = "".join(flaser([1.0 + k] * 4, f"{time:.3f}") for k, time in enumerate(times))

    scans, report = read(tmp_path / "log", text)

    assert rows_of(scans)[:, 0].tolist() == (1.0 + np.arange(40)).tolist()
    np.testing.assert_allclose(np.diff(scans.t_ns) / 1e9, 0.1, atol=1e-9)
    assert report.counts["clock_jumps_back"] == 1
    assert kinds(report) == [K.CLOCK_JUMP]
    assert warned(report, K.CLOCK_JUMP, jump_s=-back_s)


def test_single_times_of_another_clock_are_taken_from_the_lines_around(tmp_path):
    times = 1.7e9 + 0.1 * np.arange(60)
    times[[7, 31]] = [5.0, 1.7e9 + 1000.0]
    text = "".join(flaser([1.0 + k] * 4, f"{time:.3f}") for k, time in enumerate(times))

    scans, report = read(tmp_path / "log", text)

    assert rows_of(scans)[:, 0].tolist() == (1.0 + np.arange(60)).tolist()
    np.testing.assert_allclose(np.diff(scans.t_ns) / 1e9, 0.1, atol=1e-6)
    assert report.counts["scans_wrong_time"] == 2
    assert kinds(report) == []


def test_damaged_lines_are_left_out_and_the_first_is_named(tmp_path):
    good = flaser([2.0] * 5, 1.0)
    bad = ["FLASER 5 1 2 3\n", "FLASER x 1\n", flaser([2.0, "nan1", 3, 4, 5], 2.0), "FLASER\n"]

    scans, report = read(tmp_path / "log", good + "".join(bad) + flaser([2.0] * 5, 3.0))

    assert len(scans) == 2
    assert report.counts["scans_damaged"] == 4
    assert warned(report, K.SCAN_LEFT_OUT, line=3)
    assert report.outcome == "lossy"


def test_the_repeated_largest_range_is_no_return(tmp_path):
    text = "".join(flaser([2.0, 3.0, 81.83, 81.9], float(k)) for k in range(30))

    scans, report = read(tmp_path / "log", text)

    assert np.isnan(rows_of(scans)[:, 2:]).all()
    assert np.isfinite(rows_of(scans)[:, :2]).all()
    assert "no return" in derivations(report)[0]


def test_numbers_that_are_no_ranges_are_counted(tmp_path):
    text = flaser([2.0, "nan", -1.0, 0.0, 3.0], 1.0) + flaser([2.0] * 5, 2.0)

    scans, report = read(tmp_path / "log", text)

    assert np.isnan(scans.ranges(0)[1:4]).all()
    assert report.counts["ranges_not_numbers"] == 2


@pytest.mark.parametrize(("factor", "unit"), [(100.0, "cm"), (1000.0, "mm")])
def test_other_units_are_converted_and_said(tmp_path, walk, factor, unit):
    large = replace(
        walk.scans, range_m=walk.scans.range_m * np.float32(factor), range_max_m=20.0 * factor
    )
    write_carmen(tmp_path / "walk.log", large)

    scans, report = read(tmp_path / "walk.log")

    np.testing.assert_allclose(scans.range_m, walk.scans.range_m, atol=1e-3)
    assert warned(report, K.RANGE_UNIT, unit=unit)
    assert report.counts["scans_converted"] == len(scans)


def test_corrected_poses_of_the_laser_are_not_taken_as_odometry(tmp_path):
    text = "".join(
        flaser([2.0] * 4, float(k), laser=(0.9 * k, 0.1 * k, 0.0), robot=(1.0 * k, 0.0, 0.0))
        for k in range(20)
    )

    scans, report = read(tmp_path / "log", text)

    np.testing.assert_allclose(scans.odometry[:, 0], np.arange(20.0))
    assert "corrected" in " ".join(derivations(report))


def test_the_pose_of_the_laser_is_used_where_it_is_mounted_off_the_center(tmp_path):
    text = "".join(
        flaser([2.0] * 4, float(k), laser=(k + 0.2, 0.0, 0.0), robot=(float(k), 0.0, 0.0))
        for k in range(20)
    )

    scans, _ = read(tmp_path / "log", text)

    np.testing.assert_allclose(scans.odometry[:, 0], np.arange(20) + 0.2)


def test_odometry_that_never_changes_is_not_used(tmp_path):
    scans, report = read(tmp_path / "log", flaser([2.0] * 4, 1.0) + flaser([2.5] * 4, 2.0))

    assert scans.odometry is None
    assert "never changes" in " ".join(derivations(report))


def test_each_scan_of_a_log_has_its_own_beams(tmp_path):
    text = "".join(flaser([2.0 + k] * (4 + k % 2), float(5 - k)) for k in range(5))

    scans, report = read(tmp_path / "log", text)

    assert scans.beams.tolist() == [4, 5, 4, 5, 4]
    assert scans.ranges(1).tolist() == [5.0] * 5
    np.testing.assert_allclose(scans.angles_rad(1), np.linspace(-np.pi / 2, np.pi / 2, 5))
    assert report.counts["scans"] == 5


def raw_laser(start_rad, ranges, time):
    values = " ".join(str(r) for r in ranges)
    return f"RAWLASER1 0 {start_rad} 3.0 1.0 80.0 0.01 0 {len(ranges)} {values} 0 {time} r {time}\n"


def test_a_laser_that_interlaces_its_scans_keeps_the_first_angle_of_each(tmp_path):
    starts = [-1.5, -1.25, -1.0, -0.75] * 3
    text = "".join(raw_laser(start, [2.0, 3.0], 1.0 + k) for k, start in enumerate(starts))

    scans, report = read(tmp_path / "log", text)

    assert scans.angle_min_rad.tolist() == starts
    assert report.counts["scans"] == 12


def test_messages_that_repeat_a_scan_are_no_loss_and_others_are_counted(tmp_path):
    lines = [flaser([2.0 + k, 3.0], 0.2 * k) for k in range(10)]
    repeated = [raw_laser(-1.5, [2.0 + k, 3.0], 0.2 * k + 0.01) for k in range(8)]
    later = [raw_laser(-1.5, [2.0 + k, 3.0], 20.0 + k) for k in range(1)]

    scans, report = read(tmp_path / "log", "".join(lines + repeated + later))

    assert len(scans) == 10
    assert report.counts["scans_repeated"] == 8
    assert report.counts["scans_of_another_message"] == 1


def test_rawlaser_has_no_odometry(tmp_path):
    line = "RAWLASER1 0 -1.5 3.0 1.0 80.0 0.01 0 4 1.0 2.0 3.0 80.0 2 7 8 {0} robot {0}\n"

    scans, report = read(tmp_path / "log", line.format(1.0) + line.format(2.0))

    assert scans.odometry is None
    assert scans.angle_min_rad.tolist() == [-1.5, -1.5]
    np.testing.assert_array_equal(scans.ranges(0), [1.0, 2.0, 3.0, np.nan])
    assert "No odometry" in " ".join(derivations(report))


def test_a_log_without_scans_is_refused(tmp_path):
    (tmp_path / "log").write_text(HEAD + "ODOM 0 0 0 0 0 0 1.0 nohost 0.0\n", "ascii")

    with pytest.raises(EmptyRecording, match="log: no scan of a laser"):
        read(tmp_path / "log")


def test_a_line_without_end_is_refused(tmp_path):
    (tmp_path / "log").write_bytes(HEAD.encode() + b"FLASER 3 " + b"1.0 " * 40_000)

    with pytest.raises(CorruptFile, match="line 2: expected at most 65536 bytes"):
        read(tmp_path / "log")


def test_a_small_file_that_becomes_huge_is_refused(tmp_path):
    (tmp_path / "log.gz").write_bytes(gzip.compress(b"PARAM a b c\n" * 4_000_000))

    with pytest.raises(CorruptFile, match=r"expected at most \d+ bytes of text"):
        read_carmen(tmp_path / "log.gz", ImportReport())


def test_other_texts_are_no_carmen_logs(tmp_path):
    (tmp_path / "notes.txt").write_text("FLASERS are nice\nbut this is no log\n", "ascii")

    assert not is_carmen(tmp_path / "notes.txt")
    with pytest.raises(UnknownFormat, match="no reader recognizes it"):
        recognize(tmp_path / "notes.txt")


def test_info_says_what_a_log_holds(tmp_path, walk):
    write_carmen(tmp_path / "walk.log", walk.scans)

    text = "\n".join(describe(tmp_path / "walk.log").lines())

    assert "CARMEN log of a 2-D laser" in text
    assert "30 scans of 271 beams over 270°, 10.0 a second" in text
    assert "odometry" in text


def rear_log(scans, *, turned):
    """A log of a laser at the back, whose poses are those of the laser or of the robot."""
    lines = []
    for k, robot in enumerate(scans.odometry):
        laser = robot + np.array([0.0, 0.0, np.pi * turned])
        ranges = np.nan_to_num(scans.ranges(k), nan=scans.range_max_m)
        lines.append("R" + flaser(ranges, scans.t_ns[k] / 1e9, laser, robot)[1:])
    return "".join(lines)


@pytest.mark.parametrize("turned", [True, False])
def test_a_log_of_the_rear_laser_alone_is_read_and_looks_backward(tmp_path, walk, turned):
    scans, report = read(tmp_path / "rear.log", rear_log(walk.scans, turned=turned))

    assert recognize(tmp_path / "rear.log") is RecordingKind.CARMEN
    assert scans.beams.tolist() == walk.scans.beams.tolist()
    turn = scans.odometry[:, 2] - walk.scans.odometry[:, 2]
    np.testing.assert_allclose(turn, np.pi, atol=1e-6)
    assert any("looks backward" in note for note in derivations(report)) is not turned


def test_the_front_laser_goes_before_the_rear_one(tmp_path, walk):
    rear = rear_log(walk.scans, turned=True)

    scans, report = read(tmp_path / "both.log", rear + flaser([2.0, 3.0, 4.0], 1e6))

    assert scans.beams.tolist() == [3]
    assert report.counts["scans_of_the_rear_laser"] == 30
