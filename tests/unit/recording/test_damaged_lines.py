"""Single damaged lines of text files are dropped, counted and named; many refuse the file."""

import numpy as np
import pytest

from recon4.errors import CorruptFile
from recon4.evaluation.evaluate import evaluate
from recon4.model.finding_kinds import FindingKind
from recon4.model.samples import ImuSamples
from recon4.recording.formats.columns import read_columns
from recon4.recording.formats.poses import read_tum
from recon4.recording.frame_files.times import frame_times, read_times
from recon4.recording.info.describe import describe
from recon4.recording.report import ImportReport
from recon4.recording.samples.clean import clean_imu
from recon4.recording.samples.csv_files import IMU_HEADER, read_gnss_csv, read_imu_csv
from recon4.recording.samples.datagrams import SampleDecoder

T0 = 1_700_000_000_000_000_000
ROWS = 100
STEP = 10_000_000


def file_of(path, rows, header="", damaged=None):
    """A text file of rows; ``damaged`` replaces some, by number."""
    lines = [header.encode()] if header else []
    lines += [(damaged or {}).get(k, row.encode()) for k, row in enumerate(rows)]
    path.write_bytes(b"\n".join(lines) + b"\n")
    return path


def imu_file(path, damaged=None):
    rows = [f"{T0 + k * STEP},0.1,{k % 7},0.3,0,0,9.8" for k in range(ROWS)]
    return file_of(path, rows, ",".join(IMU_HEADER), damaged)


def gnss_file(path, damaged=None):
    rows = [f"{T0 + k * STEP},49.{k:03d},16.6" for k in range(ROWS)]
    return file_of(path, rows, "t_ns,lat_deg,lon_deg", damaged)


def tum_file(path, damaged=None):
    return file_of(
        path, [f"{k} {0.1 * k} {0.1 * (k % 7)} 0 0 0 0 1" for k in range(ROWS)], "", damaged
    )


DAMAGE = {
    "a word": b"hello",
    "a cut line": b"1700000000",
    "bytes that are no text": b"\xff\xfe\x80,1,2",
    "a NUL block of a lost page": b"\0" * 70_000,
    "a line that does not end": b"1," * 40_000,
}


@pytest.mark.parametrize("damage", DAMAGE.values(), ids=DAMAGE.keys())
@pytest.mark.parametrize(
    ("make", "read", "count"),
    [
        (imu_file, read_imu_csv, "imu_lines_damaged"),
        (gnss_file, read_gnss_csv, "gnss_lines_damaged"),
        (tum_file, read_tum, "poses_damaged"),
    ],
    ids=["imu", "gnss", "tum"],
)
def test_one_damaged_line_costs_one_row_and_is_named(tmp_path, damage, make, read, count):
    report = ImportReport()

    found = read(make(tmp_path / "a.csv", {40: damage}), report)

    assert len(found) == ROWS - 1
    assert report.counts[count] == 1
    line = 41 if make is tum_file else 42
    assert f"first: a.csv: line {line}:" in report.text(count)


@pytest.mark.parametrize(
    ("make", "read"), [(imu_file, read_imu_csv), (gnss_file, read_gnss_csv), (tum_file, read_tum)]
)
def test_a_file_with_many_damaged_lines_is_refused_with_their_number(tmp_path, make, read):
    path = make(tmp_path / "a.csv", dict.fromkeys(range(10, 16), b"x"))

    with pytest.raises(CorruptFile, match=r"line 1[12]: .*\(6 of 100 lines are damaged; up to 5 %"):
        read(path)


def test_a_position_outside_the_earth_is_one_damaged_line(tmp_path):
    report = ImportReport()
    row = f"{T0},5551234.5,16.6".encode()

    assert len(read_gnss_csv(gnss_file(tmp_path / "g.csv", {0: row}), report)) == ROWS - 1
    assert "must be in degrees" in report.text("gnss_lines_damaged")


@pytest.mark.parametrize(
    "pose",
    [
        b"40 0 0 0 0 0 0 2",
        b"39 0 0 0 0 0 0 1",
        b"9e8 0 0 0 0 0 0 1",
        b"1 2 3",
        b"40 nan 0 0 0 0 0 1",
    ],
    ids=["no rotation", "time of another", "time of another year", "cut", "no number"],
)
def test_one_wrong_pose_is_left_out(tmp_path, pose):
    report = ImportReport()

    poses = read_tum(tum_file(tmp_path / "a.tum", {40: pose}), report)

    assert np.setdiff1d(np.arange(ROWS), poses.t_ns // 10**9).tolist() == [40]
    assert "line 41" in report.text("poses_damaged")


def test_damaged_poses_are_said_by_the_evaluation(tmp_path):
    rows = [f"{0.1 * k:.1f} {0.1 * k} {0.1 * (k % 7)} 0 0 0 0 1" for k in range(ROWS)]
    path = file_of(tmp_path / "a.tum", rows, "", {40: b"x"})

    found = evaluate(path, truth=file_of(tmp_path / "truth.tum", rows))

    assert any("1 of 100 poses" in hint and "line 41" in hint for hint in found.hints)


def test_info_says_damaged_lines(tmp_path):
    info = describe(imu_file(tmp_path / "imu.csv", {40: b"x"}))

    assert any("line 42" in loss.text for loss in info.lost)


# -- times


@pytest.mark.parametrize("text", [b"x", b"-0.3", b"99999999", b"\0\0", b"3.9"])
@pytest.mark.parametrize("row", [0, 40, 99])
def test_a_damaged_time_of_a_file_is_taken_from_its_neighbors(tmp_path, text, row):
    rows = [f"{100 + 0.1 * k:.1f}" for k in range(ROWS)]
    file_of(tmp_path / "times.txt", rows, "# seconds", {row: text})

    times = frame_times(tmp_path, [tmp_path / f"{k}.pcd" for k in range(ROWS)])

    np.testing.assert_allclose(times.t_ns / 1e9, 100.0 + 0.1 * np.arange(ROWS), atol=1e-6)
    assert times.source == "times.txt"
    (found,) = times.findings
    assert found.kind is FindingKind.TIMES_DAMAGED
    assert found.values == {"name": "times.txt", "first": row + 1, "damaged": 1, "times": ROWS}


def test_a_file_of_times_with_many_damaged_ones_is_not_used(tmp_path):
    rows = [f"{0.1 * k:.1f}" for k in range(ROWS)]
    path = file_of(tmp_path / "times.txt", rows, "", dict.fromkeys(range(10), b"x"))

    with pytest.raises(CorruptFile, match=r"line 1: .*\(10 of 100 lines are damaged"):
        read_times(path)


# -- tables


@pytest.mark.parametrize("damage", [b"x,1,2", b"5", b"\0\0", f"{T0 + 10**15},1,2".encode()])
def test_a_damaged_line_of_a_table_costs_one_row(tmp_path, damage):
    rows = [f"{T0 + k * STEP},{k},2.5" for k in range(ROWS)]
    path = file_of(tmp_path / "lines.csv", rows, "t_ns,shot_deg,range_m", {40: damage})
    report = ImportReport()

    blocks = list(read_columns(path, ["t_ns", "shot_deg", "range_m"], [], report=report))

    shots = np.concatenate([block["shot_deg"] for block in blocks])
    assert np.setdiff1d(np.arange(ROWS), shots).tolist() == [40]
    assert report.counts["rows"] == ROWS - 1
    assert report.counts["rows_damaged"] + report.counts["rows_wrong_time"] == 1


# -- times of samples


def cleaned(t_ns, report):
    noise = np.random.default_rng(1).normal(size=(ROWS, 3)) * 0.1
    imu = ImuSamples(t_ns, noise, noise + np.array([0.0, 0.0, 9.8]))
    return clean_imu(imu, offset_s=0.0, jumps_ns=(), report=report)


@pytest.mark.parametrize("row", [0, 40, 99])
@pytest.mark.parametrize("wrong_ns", [0, 2**62, T0 + 86_400 * 10**9])
def test_a_sample_of_another_time_is_dropped_whatever_its_source(row, wrong_ns):
    t_ns = T0 + STEP * np.arange(ROWS)
    t_ns[row] = wrong_ns
    report = ImportReport()

    kept = cleaned(t_ns, report)

    assert len(kept) == ROWS - 1 and report.counts["imu_wrong_time"] == 1
    assert kept.t_ns[-1] - kept.t_ns[0] < ROWS * STEP


def test_samples_that_are_only_out_of_order_are_all_used():
    t_ns = T0 + 10**9 * np.random.default_rng(1).permutation(ROWS)
    report = ImportReport()

    kept = cleaned(t_ns, report)

    assert len(kept) == ROWS and not report.counts["imu_wrong_time"]


@pytest.mark.parametrize("at_once", [20, 1], ids=["together", "one by one"])
@pytest.mark.parametrize("wrong_ns", [10**17, -(10**17)])
def test_an_absurd_first_stamp_of_datagrams_does_not_block_the_others(at_once, wrong_ns):
    report = ImportReport()
    decoder = SampleDecoder(report)
    arrival_ns = [T0 + k * STEP for k in range(20)]
    stamps = [arrival_ns[0] + wrong_ns, *arrival_ns[1:]]
    texts = [b'{"t_ns": %d, "gx_rad_s": 0.1, "gy_rad_s": 0, "gz_rad_s": 0.5}' % t for t in stamps]

    found = [
        imu
        for k in range(0, 20, at_once)
        if (imu := decoder.push(arrival_ns[k : k + at_once], texts[k : k + at_once])[0])
    ]

    kept = np.concatenate([imu.t_ns for imu in found])
    assert np.isin(arrival_ns[3:], kept).all()
    assert not report.counts["samples_out_of_order"]
    assert report.counts["samples_damaged"] <= 2
