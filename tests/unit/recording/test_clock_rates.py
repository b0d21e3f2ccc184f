"""Clocks of LiDARs that run slow, corrected by the rate in the rig file."""

from dataclasses import replace

import numpy as np
import pytest

from recon4.errors import ConfigError, StoreError
from recon4.model.multiframe import Multiframe
from recon4.model.rig import format_rig, parse_rig
from recon4.recording.clocks.rates import with_clock_rates
from recon4.recording.openers.request import Recording
from recon4.recording.report import ImportReport
from tests.builders import T0_NS, room_cloud, write_pcd
from tests.unit.recording.ingested import run
from tests.unit.recording.test_mandeye import RIG, imu_of, joined, read, room_of_mid360, write_walk
from tests.warned import derivations

RATE, LATE_NS = 250e-6, 3_000_000_000
SECOND = replace(RIG.sensors[1], time_offset_s=LATE_NS / 1e9, clock_rate_ppm=1e6 * RATE)
SLOW = replace(RIG, sensors=(RIG.sensors[0], SECOND), imu_sensor="lidar1")


def stamped(t_ns, first_ns):
    """What a slow clock, which started with the others, shows at true times."""
    return t_ns - LATE_NS - np.rint((t_ns - first_ns) * RATE / (1.0 + RATE)).astype(np.int64)


def test_points_and_imu_of_a_slow_lidar_are_put_right(tmp_path):
    truth, imu = room_of_mid360(1, 30.0), imu_of(30.0)
    slow = replace(truth, t_ns=stamped(truth.t_ns, truth.t_ns[0]))
    slow_imu = replace(imu, t_ns=stamped(imu.t_ns, truth.t_ns[0]))
    shifted = replace(slow, t_ns=slow.t_ns + LATE_NS)  # as readers do
    items = [shifted.take(slice(0, 9000)), slow_imu, shifted.take(slice(9000, None))]
    report = ImportReport()
    recording = with_clock_rates(Recording(SLOW, lambda: iter(items)), report)

    first, samples, rest = recording.read()
    t_ns = np.concatenate([first.t_ns, rest.t_ns])
    assert np.abs(t_ns - truth.t_ns).max() <= 2
    assert np.abs(samples.t_ns + LATE_NS - imu.t_ns).max() <= 2
    assert "corrected by +250.0 µs a second" in derivations(report)[0]


def test_a_walk_of_two_lidars_has_one_time(tmp_path):
    write_walk(tmp_path / "walk", seconds=10.0)
    shots, _, _ = read(tmp_path / "walk")
    moved, _, _ = read(tmp_path / "walk", rig=SLOW)

    t_ns = joined(shots, "t_ns", 1)
    later_ns = joined(moved, "t_ns", 1) - t_ns - LATE_NS
    np.testing.assert_allclose(later_ns, RATE * (t_ns - t_ns[0]), atol=1)
    np.testing.assert_array_equal(joined(moved, "t_ns", 0), joined(shots, "t_ns", 0))


def test_frames_of_one_lidar_are_put_right():
    rig = replace(RIG, sensors=(replace(RIG.sensors[0], clock_rate_ppm=1e6 * RATE),))
    none = np.zeros(2, np.uint8)
    columns = {"xyz": np.zeros((2, 3), np.float32), "intensity": np.zeros(2, np.uint16)}
    columns |= {"ring": none, "sensor": none, "echo": none}
    dt_ns = np.array([0, 80_000_000], np.int32)
    frames = [Multiframe(k, T0_NS + k * 10**9, 10**8, dt_ns=dt_ns, **columns) for k in range(3)]
    recording = with_clock_rates(Recording(rig, lambda: iter(frames)), ImportReport())

    assert [frame.t_ns - T0_NS for frame in recording.read()] == [0, 1_000_250_000, 2_000_500_000]
    assert next(recording.read()).dt_ns.tolist() == [0, 80_020_000]


def test_a_rig_file_has_the_rate_and_refuses_what_is_none():
    text = format_rig(SLOW)
    assert "clock_rate_ppm = 250.0" in text
    again = parse_rig(text, where="rig")
    assert [sensor.clock_rate_ppm for sensor in again.sensors] == [0.0, 250.0]
    assert "clock_rate_ppm" not in format_rig(RIG)

    with pytest.raises(ConfigError, match="clock_rate_ppm must be within ±10000, got 20000"):
        parse_rig(text.replace("250.0", "20000"), where="rig")
    laser = 'name = "r"\n[[sensor]]\nname = "l"\nkind = "laser2d"\nclock_rate_ppm = 1.0\n'
    with pytest.raises(ConfigError, match="only a lidar has a clock whose rate is corrected"):
        parse_rig(laser, where="rig")


def test_the_rates_of_stored_frames_cannot_be_changed(tmp_path):
    folder = two_clouds(tmp_path)
    store = run(folder, out=tmp_path / "frames")
    (sensor,) = store.rig.sensors

    with pytest.raises(StoreError, match="rates of clocks are applied when it is read"):
        store.with_rig(replace(store.rig, sensors=(replace(sensor, clock_rate_ppm=1.0),)))


def two_clouds(folder):
    clouds = folder / "clouds"
    clouds.mkdir()
    for k in range(2):
        write_pcd(clouds / f"{T0_NS + k * 10**8}.pcd", room_cloud())
    return clouds
