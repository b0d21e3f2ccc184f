"""Clocks that were set back while a sensor measured, and times that are uneven for other causes."""

import numpy as np
import pytest

from recon4.model.samples import ImuSamples
from recon4.recording.clocks.set_back import going_on, newest_fall_ns
from recon4.recording.clocks.stamp_order import StampOrder
from recon4.recording.lasers.tables import read_laser_table
from recon4.recording.report import ImportReport
from recon4.recording.samples.clean import clean_imu
from tests.builders import T0_NS, bag_path, room_cloud
from tests.robot_bags import RobotBag
from tests.unit.recording.ingested import run
from tests.warned import K, warned

PERIOD_NS = 100_000_000
IMU_NS = 5_000_000
MS = 1_000_000


def times(back_ns=0, *, step_ns=PERIOD_NS, count=60):
    """Even times in the order of arrival, whose clock goes back before the thirtieth [ns]."""
    t_ns = np.arange(count) * step_ns
    t_ns[30:] -= back_ns
    return t_ns


def jitter(t_ns, sd_ns):
    noise = np.random.default_rng(1).standard_normal(len(t_ns))
    return t_ns + (sd_ns * noise).astype(np.int64)


@pytest.mark.parametrize("back_ms", [30, 80, 120, 330, 2000, 3_600_000])
def test_times_go_on_where_their_clock_was_set_back(back_ms):
    t_ns = times(back_ms * MS)

    found = going_on(t_ns)

    np.testing.assert_array_equal(t_ns + found.shift_ns, times())
    assert [(one.t_ns, one.back_ns) for one in found.steps] == [(29 * PERIOD_NS, back_ms * MS)]


def test_a_clock_may_scatter_and_be_set_back_twice():
    t_ns = times(330 * MS)
    t_ns[45:] -= 150 * MS

    found = going_on(jitter(t_ns, 3 * MS))

    assert [one.back_ns for one in found.steps] == pytest.approx([330 * MS, 150 * MS], abs=5 * MS)


def test_uneven_times_of_a_clock_that_runs_are_left_alone():
    rng = np.random.default_rng(2)
    even = times(count=4000)
    late = even.copy()
    late[[20, 33]] += 260 * MS
    held_up = even.copy()
    held_up[40:43] = held_up[43]
    faster = np.concatenate([times(), times()[-1] + PERIOD_NS // 2 * np.arange(1, 15)])
    uneven = [
        even,
        late,
        held_up,
        faster,
        times(-80 * MS),
        times(20 * MS),
        even[rng.random(4000) < 0.5],
        even + rng.exponential(0.8 * PERIOD_NS, 4000).astype(np.int64),
        rng.permuted(even.reshape(-1, 4), axis=1).ravel(),
        even[::-1],
    ]

    assert not any(going_on(t_ns) for t_ns in uneven)


@pytest.mark.parametrize("parts", [[1, 0], [2, 1, 0], [0, 2, 1]])
def test_parts_in_another_order_are_no_clock_set_back(parts):
    assert going_on(np.concatenate([np.split(times(), 3)[part] for part in parts])) is None


@pytest.mark.parametrize("back_ms", [30, 80, 330, 2000])
def test_messages_go_on_in_the_order_of_recording(back_ms):
    order = StampOrder()
    stamps = times(back_ms * MS).tolist()

    found = [one for k, stamp in enumerate(stamps) for one in order.push(stamp, k)]
    found += order.flush()

    assert found == list(zip(times().tolist(), range(60), strict=True))
    assert [step.back_ns for step in order.steps] == [back_ms * MS]
    assert order.too_late == 0


def test_late_messages_are_no_clock_set_back():
    t_ns = times()
    t_ns[[20, 33, 34]] -= 240 * MS

    assert not any(newest_fall_ns(t_ns[:end].tolist()) for end in range(1, 60))


def imu_of(t_ns):
    gyro = np.random.default_rng(3).normal(0.0, 0.1, (len(t_ns), 3))
    return ImuSamples(np.asarray(t_ns), gyro, gyro + np.array([0.0, 0.0, 9.81]))


def cleaned(imu):
    report = ImportReport()
    return clean_imu(imu, offset_s=0.0, jumps_ns=(), report=report), report


@pytest.mark.parametrize("back_ms", [30, 80, 2000])
@pytest.mark.parametrize("burst", [1, 10])
def test_the_clock_of_an_imu_may_be_set_back_alone(back_ms, burst):
    even = np.arange(2000) * IMU_NS
    t_ns = even[np.minimum(np.arange(2000) // burst * burst + burst - 1, 1999)]
    t_ns = t_ns - back_ms * MS * (np.arange(2000) >= 1000)
    imu = imu_of(t_ns)

    clean, report = cleaned(imu)

    assert len(clean) == 2000
    assert np.allclose(np.diff(clean.t_ns), IMU_NS, atol=10)
    np.testing.assert_array_equal(clean.gyro_rad_s, imu.gyro_rad_s)
    assert report.counts["clock_jumps_back"] == 1
    assert warned(report, K.CLOCK_JUMP, sensor="IMU", jump_s=-back_ms / 1e3)


def test_samples_that_are_recorded_again_are_copies():
    imu = imu_of(np.arange(2000) * IMU_NS)
    again = np.concatenate([np.arange(1500), np.arange(1000, 2000)])

    clean, report = cleaned(
        ImuSamples(imu.t_ns[again], imu.gyro_rad_s[again], imu.accel_m_s2[again])
    )

    np.testing.assert_array_equal(clean.t_ns, imu.t_ns)
    assert report.counts["imu_copies"] == 500
    assert "clock_jumps_back" not in report.counts


@pytest.mark.parametrize("back_ms", [80, 330, 5000])
def test_the_clock_of_a_laser_table_may_be_set_back(tmp_path, back_ms):
    path, report = tmp_path / "laser2d.csv", ImportReport()
    rows = [
        f"{10**12 + t + 100 * beam},{k},{beam},{3 + k / 100}\n"
        for k, t in enumerate(times(back_ms * MS).tolist())
        for beam in range(5)
    ]
    path.write_text("t_ns,scan,beam_deg,range_m\n" + "".join(rows))

    scans = read_laser_table(path, report)

    np.testing.assert_array_equal(scans.t_ns, 10**12 + times())
    np.testing.assert_allclose(scans.range_m[::5], 3 + np.arange(60) / 100, atol=1e-6)
    assert report.counts["clock_jumps_back"] == 1
    assert warned(report, K.CLOCK_JUMP, sensor="laser2d.csv", jump_s=-back_ms / 1e3)


@pytest.mark.parametrize("absolute", [False, True], ids=["relative", "absolute"])
def test_clouds_of_a_bag_go_on_where_their_stamps_were_set_back(tmp_path, absolute):
    path = bag_path(tmp_path, "mcap")
    with RobotBag(path, "mcap") as bag:
        for k, t in enumerate(times(80 * MS).tolist()):
            bag.recorded_ns = T0_NS + k * PERIOD_NS + 110 * MS
            cloud = room_cloud(columns_per_turn=36)
            cloud["intensity"] = np.full_like(cloud["intensity"], k)
            if absolute:
                cloud["timestamp"] = (T0_NS + t) / 1e9 + np.linspace(0.0, 0.099, len(cloud["x"]))
            bag.cloud("/points", T0_NS + t, cloud)

    store = run(path, out=tmp_path / "frames")

    assert [int(np.median(frame.intensity)) for frame in store] == list(range(60))
    np.testing.assert_allclose(np.diff(store.index["t_ns"]), PERIOD_NS, atol=MS)
    assert store.report["counts"]["clock_jumps_back"] == 1
    assert warned(store.report, K.CLOCK_JUMP, sensor="/points", jump_s=-0.08)
