"""Recordings with the scans of a 2-D laser and no LiDAR, whose angles may change."""

from dataclasses import replace
from types import SimpleNamespace

import numpy as np
import pytest

from recon4.errors import StoreError
from recon4.model.laser_scans import joined_scans
from recon4.recording.clocks.stamps import StampClock
from recon4.recording.formats.bags import BagMessage
from recon4.recording.info.describe import describe
from recon4.recording.lasers.laser2d import is_laser2d, read_laser2d
from recon4.recording.lasers.scan_messages import ScanCollector
from recon4.recording.lasers.scan_replay import datagrams_of_scans
from recon4.recording.report import ImportReport
from recon4.simulation.line_bag import open_line_bag
from recon4.store.line_store import LineStoreWriter, load_laser_scans
from tests.laser_rows import angles_of, rows_of, with_times
from tests.line_tables import laser_columns, write_csv
from tests.planar_walks import (
    clockwise_and_back,
    full_turns,
    furnished_room,
    interlaced,
    scanned,
    scanned_in,
)
from tests.scan_captures import write_capture
from tests.warned import K, derivations, warned


@pytest.fixture(scope="module")
def scans():
    truth = np.stack([np.linspace(-2.0, 2.0, 20), np.zeros(20), np.zeros(20)], axis=1)
    return with_times(scanned(furnished_room(), truth, odometry=False).scans, 1e-4)


def test_ranges_in_millimeters_below_a_limit_in_meters_are_converted(tmp_path, scans):
    in_mm = replace(scans, range_m=scans.range_m * 1000.0)
    with open_line_bag(tmp_path / "bag") as bag:
        bag.scans("/scan", in_mm)
    report = ImportReport()

    read = read_laser2d([tmp_path / "bag"], report)

    assert np.nanmax(np.abs(read.range_m - scans.range_m)) < 1e-3
    assert warned(report, K.RANGE_UNIT, unit="mm")


def test_the_scans_of_a_bag_are_read(tmp_path, scans):
    with open_line_bag(tmp_path / "bag") as bag:
        bag.scans("/scan", scans)

    report = ImportReport()
    found = read_laser2d([tmp_path / "bag"], report)

    assert is_laser2d(tmp_path / "bag")
    np.testing.assert_array_equal(found.t_ns, scans.t_ns)
    np.testing.assert_allclose(found.range_m, scans.range_m)
    np.testing.assert_allclose(angles_of(found), angles_of(scans), atol=1e-5)
    assert found.time_step_s == pytest.approx(1e-4)
    assert found.odometry is None
    assert "No odometry" in " ".join(derivations(report))


def test_info_says_what_a_bag_holds(tmp_path, scans):
    with open_line_bag(tmp_path / "bag") as bag:
        bag.scans("/scan", scans)

    text = "\n".join(describe(tmp_path / "bag").lines())

    assert "20 scans of 271 beams" in text
    assert "LiDAR data" not in text


LAYOUTS = [full_turns, interlaced, clockwise_and_back]


@pytest.fixture(scope="module", params=LAYOUTS, ids=lambda layout: layout.__name__)
def changing(request):
    truth = np.stack([np.linspace(-2.0, 2.0, 40), np.zeros(40), np.zeros(40)], axis=1)
    return scanned_in(furnished_room(), truth, request.param(40)).scans


def same_scans(found, expected, *, rad):
    assert np.array_equal(found.t_ns, expected.t_ns)
    assert np.array_equal(found.start, expected.start)
    np.testing.assert_allclose(found.range_m, expected.range_m, atol=1e-6)
    np.testing.assert_allclose(found.angle_min_rad, expected.angle_min_rad, atol=rad)
    np.testing.assert_allclose(found.angle_step_rad, expected.angle_step_rad, atol=rad / 100)


def test_each_scan_of_a_bag_has_its_own_angles(tmp_path, changing):
    with open_line_bag(tmp_path / "bag") as bag:
        bag.scans("/scan", changing)

    report = ImportReport()
    same_scans(read_laser2d([tmp_path / "bag"], report), changing, rad=1e-6)
    assert report.lost() == []


def test_each_scan_of_a_capture_has_its_own_angles(tmp_path, changing):
    with open_line_bag(tmp_path / "bag") as bag:
        bag.scans("/scan", changing)
    sent = [(d.t_ns, d.port, d.payload) for d in datagrams_of_scans(tmp_path / "bag", None)]
    write_capture(tmp_path / "walk.pcap", sent)

    same_scans(read_laser2d([tmp_path / "walk.pcap"], ImportReport()), changing, rad=1e-6)


def test_each_scan_of_a_table_has_its_own_angles(tmp_path, changing):
    number = np.repeat(np.arange(len(changing)), changing.beams)
    write_csv(tmp_path / "scans.csv", laser_columns(changing) | {"scan": number})

    report = ImportReport()
    found = read_laser2d([tmp_path / "scans.csv"], report)

    assert len(found) == len(changing)
    assert report.counts["beams_off_grid"] == 0
    for k in range(len(found)):
        np.testing.assert_allclose(found.points(k), changing.points(k), atol=1e-4)


def test_the_store_keeps_the_angles_of_each_scan(tmp_path, changing):
    writer = LineStoreWriter(tmp_path)
    for part in (changing[:15], changing[15:]):
        writer.append_scans(part)
    writer.close()

    same_scans(load_laser_scans(tmp_path), changing, rad=1e-15)


def test_a_store_of_an_earlier_version_is_read(tmp_path, scans):
    np.save(tmp_path / "laser2d_range_m.npy", rows_of(scans))
    angles = {"angle_min_rad": scans.angle_min_rad[0], "angle_step_rad": scans.angle_step_rad[0]}
    np.savez(
        tmp_path / "laser2d.npz", t_ns=scans.t_ns, range_max_m=20.0, time_step_s=1e-4, **angles
    )

    same_scans(load_laser_scans(tmp_path), scans, rad=1e-15)


@pytest.mark.parametrize("name", ["start", "angle_min_rad", "t_ns", "range_max_m"])
def test_a_damaged_store_of_scans_is_refused(tmp_path, scans, name):
    writer = LineStoreWriter(tmp_path)
    writer.append_scans(scans)
    writer.close()
    arrays = dict(np.load(tmp_path / "laser2d.npz"))
    np.savez(tmp_path / "laser2d.npz", **arrays | {name: arrays[name].astype(str)})

    with pytest.raises(StoreError, match="expected numbers"):
        load_laser_scans(tmp_path)
    arrays[name] = np.repeat(arrays[name], 2)
    np.savez(tmp_path / "laser2d.npz", **arrays)
    with pytest.raises(StoreError, match="expected"):
        load_laser_scans(tmp_path)


# -- messages that contradict themselves


def message(**fields):
    usual = {
        "ranges": [2.0, 3.0, 4.0],
        "angle_min": -0.1,
        "angle_max": 0.1,
        "angle_increment": 0.1,
        "time_increment": 1e-4,
        "range_min": 0.1,
        "range_max": 20.0,
        "intensities": [],
    }
    return SimpleNamespace(**usual | fields)


def collected(messages):
    report = ImportReport()
    collector = ScanCollector(0, report)
    parts = [
        part for k, one in enumerate(messages) for part in collector.add(one, 10 + k, where="/scan")
    ]
    return joined_scans([*parts, *collector.flush()]), report


def test_a_scan_without_ranges_is_counted_and_the_others_are_read():
    found, report = collected([message(ranges=[]), message(), message(ranges=[1.0])])

    assert found.beams.tolist() == [3, 1]
    assert report.counts["scans_damaged"] == 1
    assert warned(report, K.SCAN_LEFT_OUT, error="expected 1 to 100000 ranges, got 0")


def test_the_step_counts_where_the_last_angle_contradicts_it():
    found, report = collected([message(angle_max=0.2), message(angle_max=0.3)])

    assert found.angles_rad(1).tolist() == pytest.approx([-0.1, 0.0, 0.1])
    assert report.counts["scans_of_another_last_angle"] == 1
    assert "contradicts the step" in report.repaired()[0]


@pytest.mark.parametrize("step_s", [-1e-4, float("inf"), float("nan"), 60.0])
def test_times_of_beams_that_make_no_sense_are_not_used(step_s):
    found, report = collected([message(), message(time_increment=step_s)])

    assert found.time_step_s.tolist() == [1e-4, 0.0]
    assert report.counts["scans_of_wrong_beam_times"] == 1


def test_a_scan_that_came_twice_is_no_loss_and_another_one_of_its_time_is():
    report = ImportReport()
    collector = ScanCollector(0, report)
    for one in (message(), message(), message(ranges=[5.0, 6.0, 7.0])):
        list(collector.add(one, 10, where="/scan"))

    assert report.counts["scans_repeated"] == report.counts["scans_duplicate"] == 1
    assert len(report.lost()) == 1


@pytest.mark.parametrize("wrong_s", [0, 2_147_483_647])
def test_one_scan_with_the_stamp_of_another_time_keeps_its_place(wrong_s):
    report = ImportReport()
    usual = [(10**18 + k * 10**8, 10**18 + k * 10**8) for k in range(9)]
    collector = ScanCollector(0, report, stamps=StampClock(usual))
    parts = []
    for k, (t_ns, _) in enumerate(usual):
        seconds, nanosec = (wrong_s, 0) if k == 4 else divmod(t_ns, 10**9)
        header = SimpleNamespace(stamp=SimpleNamespace(sec=seconds, nanosec=nanosec))
        one = message(header=header, scan_time=0.1, ranges=[2.0 + k, 3.0, 4.0])
        parts += collector.push(BagMessage("/scan", "", t_ns, b""), one)

    found = joined_scans([*parts, *collector.flush()])

    assert found.t_ns.tolist() == [t_ns for t_ns, _ in usual]
    assert report.counts["scans_wrong_time"] == 1 and not report.lost()


def test_beams_of_a_table_at_irregular_angles_are_kept_near_their_angles(tmp_path):
    rng = np.random.default_rng(7)
    angle = np.linspace(-180.0, 180.0, 450, endpoint=False) + rng.uniform(-0.3, 0.3, (20, 450))
    columns = {
        "t_ns": (10**18 + 10**8 * np.arange(20)[:, None] + 10**5 * np.arange(450)).ravel(),
        "beam_deg": angle.ravel(),
        "range_m": rng.uniform(1.0, 9.0, angle.size).astype(np.float32),
        "scan": np.repeat(np.arange(20), 450),
    }
    write_csv(tmp_path / "scans.csv", columns)

    report = ImportReport()
    found = read_laser2d([tmp_path / "scans.csv"], report)

    assert report.counts["beams_off_grid"] == 0
    seen = np.isfinite(found.ranges(3))
    assert np.array_equal(found.ranges(3)[seen], columns["range_m"].reshape(20, 450)[3])
    off_deg = np.rad2deg(found.angles_rad(3)[seen]) - angle[3]
    assert np.abs(off_deg).max() < 0.06


@pytest.mark.parametrize("step_rad", [0.0, 1e-30, -1e-5, np.nan])
def test_a_step_that_puts_all_beams_into_one_direction_is_refused(step_rad):
    found, report = collected([message(angle_increment=step_rad), message()])

    assert len(found) == 1
    assert report.counts["scans_damaged"] == 1
    assert warned(report, K.SCAN_LEFT_OUT, error="expected a first angle and a step between beams")
