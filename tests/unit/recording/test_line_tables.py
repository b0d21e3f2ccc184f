"""Tables of line scans: the same multiframes as a bag, sweeps found in the data, clear errors."""

import bz2
import zipfile
from dataclasses import replace

import numpy as np
import pytest

from recon4.errors import ConfigError, CorruptFile, RecordingError, UnknownFormat
from recon4.model.rig import load_rig
from recon4.progress import Silent
from recon4.recording.formats.columns import read_columns
from recon4.recording.info.describe import describe
from recon4.recording.ingest import ingest
from recon4.recording.lasers.laser2d import read_laser2d
from recon4.recording.lasers.sweeps import sweeps
from recon4.recording.report import ImportReport
from recon4.recording.sources import Sources
from recon4.settings import IngestSettings
from recon4.simulation.line_bag import open_line_bag
from recon4.store.frames import FrameStore
from recon4.store.line_store import load_laser_scans, load_lines
from recon4.workflows.choice import is_planar
from tests.laser_rows import rows_of
from tests.line_tables import SHOTS, laser_columns, line_columns, line_scans, write_csv, write_npz

START_NS = 1_700_000_000_000_000_000
WRITERS = {"csv": write_csv, "npz": write_npz}


def head_rad(t_ns):
    return np.deg2rad(50.0) * 1e-9 * (t_ns - START_NS)


def write_walk(folder, kind="csv", *, scans=None, lines=None):
    folder.mkdir()
    lines = line_scans(300) if lines is None else lines
    WRITERS[kind](folder / f"lines.{kind}", line_columns(lines, head_rad))
    if scans is not None:
        WRITERS[kind](folder / f"laser2d.{kind}", laser_columns(scans))
    return folder


def read(paths, out, rig="wuerzburg"):
    rig = load_rig(rig) if isinstance(rig, str) else rig
    ingest(Sources(tuple(paths), rig), out, settings=IngestSettings(), progress=Silent())
    return FrameStore.open(out)


def with_holes(scans):
    scans.ranges(7)[3:9] = np.nan
    return scans


@pytest.mark.parametrize("kind", ["csv", "npz"])
def test_tables_give_the_multiframes_of_a_bag(tmp_path, kind):
    lines, scans = with_holes(line_scans(300)), with_holes(line_scans(290, range_m=3.0))
    write_walk(tmp_path / "walk", kind, lines=lines, scans=scans)
    with open_line_bag(tmp_path / "bag") as bag:
        bag.head("/profiler/head", lines.t_ns, head_rad(lines.t_ns))
        bag.scans("/profiler/line", lines, np.full((len(lines), SHOTS), 7, np.uint8))
        bag.scans("/laser2d/scan", scans)

    table, recorded = (
        read([tmp_path / "walk"], tmp_path / "a"),
        read([tmp_path / "bag"], tmp_path / "b"),
    )

    assert len(table) == len(recorded)
    assert table[5].t_ns == recorded[5].t_ns
    assert np.array_equal(table[5].dt_ns, recorded[5].dt_ns)
    assert np.allclose(table[5].xyz, recorded[5].xyz, atol=1e-5)
    assert set(table[5].intensity) == {7}
    mine, theirs = load_lines(tmp_path / "a"), load_lines(tmp_path / "b")
    assert np.array_equal(mine.t_ns, theirs.t_ns)
    assert np.allclose(mine.head_rad, theirs.head_rad, atol=1e-6)
    mine, theirs = load_laser_scans(tmp_path / "a"), load_laser_scans(tmp_path / "b")
    assert np.array_equal(mine.t_ns, theirs.t_ns)
    assert np.array_equal(np.isnan(mine.range_m), np.isnan(theirs.range_m))
    assert mine.angle_step_rad == pytest.approx(theirs.angle_step_rad, abs=1e-6)


def test_files_of_a_walk_come_in_any_order(tmp_path):
    walk = write_walk(tmp_path / "walk", scans=line_scans(290))
    paths = [walk / "laser2d.csv", walk / "lines.csv"]

    assert not is_planar(Sources(tuple(paths)))
    assert is_planar(Sources(tuple(paths[:1])))
    read(paths, tmp_path / "out")

    assert len(load_laser_scans(tmp_path / "out")) == 290


def test_info_says_what_there_is_and_what_is_missing(tmp_path):
    scans = with_holes(line_scans(290))
    write_walk(tmp_path / "walk", "npz", scans=scans)

    text = "\n".join(describe(tmp_path / "walk").lines())

    assert "lines.npz profiler: 300 line scans, 100.0 a second" in text
    assert "head from 0° to 150°, 21 shots a line, 100 % of them return" in text
    assert "2-D laser: 290 scans of 21 beams over 57°" in text
    assert "missing   IMU (imu.csv)" in text
    assert "missing   rig" in text


def test_a_pause_of_the_lines_is_a_gap(tmp_path):
    lines = line_scans(300)
    write_walk(tmp_path / "walk", lines=lines[np.r_[0:100, 180:300]])

    (gap,) = describe(tmp_path / "walk").gaps

    assert gap.seconds == pytest.approx(0.8, abs=0.02)


def test_a_2d_laser_alone_with_odometry(tmp_path):
    odometry = np.stack([np.linspace(0, 2, 60), np.zeros(60), np.linspace(0, 1.5, 60)], axis=1)
    scans = replace(line_scans(60, range_m=3.0), odometry=odometry)
    write_csv(tmp_path / "scans.csv", laser_columns(scans))

    found = read_laser2d([tmp_path / "scans.csv"], ImportReport())

    assert np.array_equal(found.t_ns, scans.t_ns)
    assert np.allclose(found.odometry, odometry, atol=1e-6)
    assert "60 scans" in "\n".join(describe(tmp_path / "scans.csv").lines())


def test_beams_without_a_row_have_no_return(tmp_path):
    columns = laser_columns(line_scans(60, range_m=3.0))
    kept = np.arange(len(columns["t_ns"])) % 21 != 4
    write_csv(tmp_path / "scans.csv", {name: values[kept] for name, values in columns.items()})

    found = read_laser2d([tmp_path / "scans.csv"], ImportReport())

    assert found.beams.tolist() == [21] * 60
    assert np.flatnonzero(np.isnan(rows_of(found)).all(axis=0)).tolist() == [4]


def test_a_beam_that_swings_back_and_forth_has_a_line_each_way():
    angle = np.array([0.0, 1, 2, 3, 4, 3, 2, 1, 0, 1, 2, 3, 4])
    rows = {"t_ns": np.arange(13, dtype=np.int64), "a": angle, "n": np.full(13, np.nan)}

    found = [len(part["t_ns"]) for part in sweeps(iter([rows]), "a", number="n", where="table")]

    assert found == [5, 4, 4]


def test_sweeps_do_not_depend_on_the_blocks():
    t_ns = np.arange(100, dtype=np.int64) * 1000
    t_ns[57:] += 200_000_000
    rows = {"t_ns": t_ns, "a": np.arange(100.0) % 10, "n": np.full(100, np.nan)}
    blocks = [{k: v[i : i + 7] for k, v in rows.items()} for i in range(0, 100, 7)]

    found = [part["t_ns"][0] for part in sweeps(iter(blocks), "a", number="n", where="table")]

    assert found == t_ns[[0, 10, 20, 30, 40, 50, 57, 60, 70, 80, 90]].tolist()


def test_a_column_that_numbers_lines_is_used():
    rows = {"t_ns": np.arange(6), "a": np.arange(6.0), "n": np.array([1.0, 1, 2, 2, 2, 3])}

    assert [len(p["a"]) for p in sweeps(iter([rows]), "a", number="n", where="table")] == [2, 3, 1]


def test_lines_without_angles_of_the_head_are_refused(tmp_path):
    columns = line_columns(line_scans(20), head_rad)
    del columns["head_deg"]
    write_csv(tmp_path / "lines.csv", columns)

    with pytest.raises(ConfigError, match=r"expected a column head_deg in lines\.csv"):
        read([tmp_path / "lines.csv"], tmp_path / "out")


def test_lines_need_a_rig(tmp_path):
    walk = write_walk(tmp_path / "walk")

    with pytest.raises(ConfigError, match="need a rig with a sensor of kind profiler"):
        read([walk], tmp_path / "out", None)


def test_a_stuck_head_is_named(tmp_path):
    columns = line_columns(line_scans(600), lambda t_ns: 0.0 * t_ns + 0.5)
    write_npz(tmp_path / "lines.npz", columns)

    with pytest.raises(RecordingError, match="expected a head that turns"):
        read([tmp_path / "lines.npz"], tmp_path / "out")


@pytest.mark.parametrize(
    ("row", "what"),
    [
        ("1700000000000000000,0,0", "expected 4 cells, got 3"),
        ("1700000000000000000.5,0,0,1", "whole nanoseconds, got '1700000000000000000.5'"),
        ("1700000000000000000,0,x,1", "expected a number, got 'x'"),
        ("1700000000000000000,0,1_0,1", "expected a number, got '1_0'"),
    ],
)
def test_a_wrong_cell_is_named_with_its_line(tmp_path, row, what):
    path = tmp_path / "lines.csv"
    path.write_text(f"t_ns,head_deg,shot_deg,range_m\n1,0,0,1\n\n{row}\n")

    with pytest.raises(CorruptFile, match=f"lines.csv: line 4: .*{what}"):
        list(read_columns(path, ["t_ns", "shot_deg", "range_m"], ["head_deg"]))


def test_decimal_commas_and_empty_cells_are_read(tmp_path):
    path = tmp_path / "lines.csv"
    path.write_text("range_m;t_ns;shot_deg\n1,5;7;-2,25\n;8;3\n")

    (block,) = read_columns(path, ["t_ns", "shot_deg", "range_m"], ["head_deg"])

    assert block["t_ns"].tolist() == [7, 8]
    assert block["shot_deg"].tolist() == [-2.25, 3.0]
    assert np.array_equal(block["range_m"], [1.5, np.nan], equal_nan=True)
    assert np.isnan(block["head_deg"]).all()


def test_columns_of_different_length_are_refused(tmp_path):
    columns = line_columns(line_scans(20), head_rad)
    write_npz(tmp_path / "lines.npz", columns | {"range_m": columns["range_m"][:-1]})

    with pytest.raises(CorruptFile, match="expected columns of one length"):
        list(read_columns(tmp_path / "lines.npz", ["t_ns", "range_m"], []))


def test_times_that_are_no_whole_numbers_are_refused(tmp_path):
    columns = line_columns(line_scans(20), head_rad)
    write_npz(tmp_path / "lines.npz", columns | {"t_ns": columns["t_ns"].astype(np.float64)})

    with pytest.raises(CorruptFile, match="t_ns: expected whole numbers of one row, got float64"):
        list(read_columns(tmp_path / "lines.npz", ["t_ns", "range_m"], []))


def test_an_archive_that_expands_too_much_is_refused(tmp_path):
    with zipfile.ZipFile(tmp_path / "lines.npz", "w", zipfile.ZIP_DEFLATED) as archive:
        for name in ("t_ns", "shot_deg", "range_m"):
            with archive.open(f"{name}.npy", "w") as file:
                header = {"descr": "<i8", "fortran_order": False, "shape": (8_000_000,)}
                np.lib.format.write_array_header_1_0(file, header)
                for _ in range(8):
                    file.write(bytes(8_000_000))

    with pytest.raises(CorruptFile, match="expected columns of at most"):
        list(read_columns(tmp_path / "lines.npz", ["t_ns", "shot_deg", "range_m"], []))


def test_a_missing_column_is_named(tmp_path):
    (tmp_path / "lines.csv").write_text("t_ns,range_m\n1,2\n")

    with pytest.raises(UnknownFormat, match="missing columns shot_deg"):
        list(read_columns(tmp_path / "lines.csv", ["t_ns", "shot_deg", "range_m"], []))


def test_a_file_that_is_no_table_is_no_recording(tmp_path):
    (tmp_path / "lines.npz").write_bytes(bz2.compress(b"t_ns,shot_deg,range_m\n"))

    with pytest.raises(UnknownFormat):
        describe(tmp_path / "lines.npz")
