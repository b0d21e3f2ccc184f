"""Channels that a sensor does not measure: zeros, constants, NaN and declared absence."""

from dataclasses import replace

import numpy as np
import pytest

from recon4.model.samples import GnssSamples, ImuSamples
from recon4.recording.report import ImportReport
from recon4.recording.samples.clean import clean_gnss, clean_imu
from tests.builders import T0_NS, Bag, bag_path, noisy, room_packets
from tests.unit.recording.ingested import run
from tests.warned import K, derivations, kinds, warned

STEP_NS = 5_000_000


def walked(count=400):
    """Samples of a body that turns and shakes."""
    rng = np.random.default_rng(3)
    gyro = 0.3 + 0.1 * rng.standard_normal((count, 3))
    accel = [0.0, 0.0, 9.81] + 0.5 * rng.standard_normal((count, 3))
    return ImuSamples(T0_NS + STEP_NS * np.arange(count), gyro, accel)


def cleaned(imu):
    report = ImportReport()
    return clean_imu(imu, offset_s=0.0, jumps_ns=[], report=report), report


def zero(values):
    values[:] = 0.0


def placeholder(values):
    values[:] = [0.0, 0.0, 9.81]


def one_axis(values):
    values[:, 1] = 0.0


def one_axis_nan(values):
    values[:, 2] = np.nan


def nothing(values):
    values[:] = np.nan


def at_its_limit(values):
    values[:] = 32.768


LACKING = [zero, placeholder, one_axis, one_axis_nan, nothing, at_its_limit]


@pytest.mark.parametrize("lack", LACKING)
def test_an_accelerometer_that_does_not_measure_is_said_and_the_gyroscope_used(lack):
    imu = walked()
    lack(imu.accel_m_s2)

    kept, report = cleaned(imu)

    assert len(kept) == len(imu)
    assert np.isnan(kept.accel_m_s2).all()
    assert np.array_equal(kept.gyro_rad_s, imu.gyro_rad_s)
    assert warned(report, K.ACCELEROMETER_MISSING)


@pytest.mark.parametrize("lack", LACKING)
def test_an_imu_whose_gyroscope_does_not_measure_is_not_used_and_said(lack):
    imu = walked()
    lack(imu.gyro_rad_s)

    kept, report = cleaned(imu)

    assert kept is None
    assert warned(report, K.GYROSCOPE_MISSING)


def test_an_imu_that_works_is_left_as_it_is():
    imu = walked()

    kept, report = cleaned(imu)

    assert np.array_equal(kept.accel_m_s2, imu.accel_m_s2)
    assert report.findings == []
    assert report.counts == {"imu_kept": len(imu)}


def test_a_few_equal_samples_of_a_body_at_rest_are_measurements():
    t_ns = T0_NS + STEP_NS * np.arange(10)
    still = ImuSamples(t_ns, np.zeros((10, 3)), np.tile([0.0, 0.0, 9.81], (10, 1)))

    kept, report = cleaned(still)

    assert np.isfinite(kept.accel_m_s2).all()
    assert report.findings == []


@pytest.mark.parametrize("scale", [0.02, 30.0, 1000.0], ids=["without gravity", "×30", "×1000"])
def test_accelerations_that_are_not_of_gravity_are_not_used(scale):
    imu = walked()
    imu.accel_m_s2[:] *= scale

    kept, report = cleaned(imu)

    assert np.isnan(kept.accel_m_s2).all()
    assert kinds(report) == [K.ACCELEROMETER_UNIT]


def test_motion_without_gravity_is_not_taken_for_accelerations_in_g():
    imu = walked()
    imu.accel_m_s2[:] = 0.65 * np.random.default_rng(5).standard_normal((len(imu), 3))

    kept, report = cleaned(imu)

    assert np.isnan(kept.accel_m_s2).all()
    assert "imu_accel_scaled" not in report.counts


# -- two topics, slower and failing accelerometers


def test_gyroscope_and_accelerometer_of_two_topics_are_joined():
    imu = walked()
    turns = ImuSamples(imu.t_ns, imu.gyro_rad_s, np.full_like(imu.accel_m_s2, np.nan))
    smooth = np.column_stack([np.sin(np.arange(200) / 20), np.zeros(200), np.full(200, 9.81)])
    smooth[:, 1] = smooth[:, 0]
    smooth[:, 2] += 0.1 * smooth[:, 0]
    forces_ns = imu.t_ns[0] + 10_000_000 * np.arange(200)
    order = np.argsort(np.concatenate([turns.t_ns, forces_ns]), kind="stable")
    both = ImuSamples(
        np.concatenate([turns.t_ns, forces_ns])[order],
        np.concatenate([turns.gyro_rad_s, np.full((200, 3), np.nan)])[order],
        np.concatenate([turns.accel_m_s2, smooth])[order],
    )

    kept, report = cleaned(both)

    assert np.array_equal(kept.gyro_rad_s[: len(kept)], imu.gyro_rad_s[: len(kept)])
    assert len(kept) >= len(imu) - 1
    middle = (smooth[10] + smooth[11]) / 2
    assert kept.accel_m_s2[20] == pytest.approx(smooth[10])
    assert kept.accel_m_s2[21] == pytest.approx(middle)
    assert report.findings == []
    assert "imu_nan" not in report.counts


def test_a_hole_of_the_accelerometer_is_a_gap_and_counted():
    imu = walked()
    imu.accel_m_s2[100:200] = 0.0
    imu.accel_m_s2[300:303] = np.nan

    kept, report = cleaned(imu)

    assert len(kept) == 300
    assert np.isfinite(kept.accel_m_s2).all()
    assert report.counts["imu_accel_missing"] == 100
    assert report.counts["imu_accel_interpolated"] == 3
    assert warned(report, K.ACCELERATIONS_MISSING, missing=100, samples=400)


def test_an_accelerometer_that_sticks_in_motion_is_a_hole():
    imu = walked()
    imu.accel_m_s2[100:200] = imu.accel_m_s2[100]

    kept, report = cleaned(imu)

    assert report.counts["imu_accel_missing"] == 99
    assert len(kept) == 301


def test_an_accelerometer_that_mostly_fails_counts_as_not_measured():
    imu = walked()
    imu.accel_m_s2[100:] = 0.0

    kept, report = cleaned(imu)

    assert len(kept) == 400
    assert np.isnan(kept.accel_m_s2).all()
    assert kinds(report) == [K.ACCELEROMETER_SPARSE]


# -- positions


def fixes(count=30):
    rng = np.random.default_rng(2)
    lat, lon = (np.deg2rad(v + 1e-6 * rng.standard_normal(count)) for v in (49.2, 16.6))
    t_ns = T0_NS + 100_000_000 * np.arange(count)
    sd, attitude = np.full((count, 3), 0.02), rng.standard_normal((count, 3))
    height_m = 250.0 + rng.standard_normal(count)
    return GnssSamples(t_ns, lat, lon, height_m, sd, np.full(count, 4, np.uint8), attitude)


def cleaned_fixes(gnss):
    report = ImportReport()
    return clean_gnss(gnss, offset_s=0.0, report=report), report


def test_positions_that_work_are_left_as_they_are():
    kept, report = cleaned_fixes(fixes())

    assert len(kept) == 30
    assert np.isfinite(np.column_stack([kept.height_m, kept.sd_enu_m, kept.rpy_ned_rad])).all()
    assert report.findings == []


def test_positions_in_radians_are_converted_and_said():
    right = fixes()
    gnss = replace(right, lat_rad=np.deg2rad(right.lat_rad), lon_rad=np.deg2rad(right.lon_rad))

    kept, report = cleaned_fixes(gnss)

    np.testing.assert_allclose(kept.lat_rad, right.lat_rad)
    np.testing.assert_allclose(kept.lon_rad, right.lon_rad)
    assert any("Positions were in radians" in text for text in derivations(report))


def test_positions_of_a_simulator_near_zero_stay_where_they_are():
    right = fixes()
    shift = [np.deg2rad(v) - 1e-5 for v in (49.2, 16.6)]
    gnss = replace(right, lat_rad=right.lat_rad - shift[0], lon_rad=right.lon_rad - shift[1])

    kept, report = cleaned_fixes(gnss)

    np.testing.assert_array_equal(kept.lat_rad, gnss.lat_rad)
    assert not any("radians" in text for text in derivations(report))


def test_positions_at_zero_are_dropped_and_counted():
    gnss = fixes()
    gnss.lat_rad[:5] = gnss.lon_rad[:5] = 0.0

    kept, report = cleaned_fixes(gnss)

    assert len(kept) == 25
    assert report.counts["gnss_at_zero"] == 5


def test_a_position_that_never_changes_is_not_used_and_said():
    gnss = fixes()
    gnss.lat_rad[:], gnss.lon_rad[:] = gnss.lat_rad[0], gnss.lon_rad[0]

    kept, report = cleaned_fixes(gnss)

    assert kept is None
    assert report.counts["gnss_constant"] == 30
    assert warned(report, K.GNSS_CONSTANT, fixes=30)


def test_heights_deviations_and_attitudes_of_zero_are_not_measured():
    gnss = fixes()
    gnss.height_m[:] = 0.0
    gnss.sd_enu_m[:] = 0.0
    gnss.rpy_ned_rad[:] = 0.0

    kept, report = cleaned_fixes(gnss)

    assert len(kept) == 30
    assert np.isnan(np.column_stack([kept.height_m, kept.sd_enu_m, kept.rpy_ned_rad])).all()
    assert kinds(report) == [K.GNSS_HEIGHTS_ZERO, K.INS_CONSTANT]


# -- from a bag to the store


@pytest.mark.parametrize("kind", ["bag1", "mcap"])
@pytest.mark.parametrize(
    ("absent", "said"),
    [(("accel",), K.ACCELEROMETER_MISSING), (("gyro",), K.GYROSCOPE_MISSING)],
)
def test_what_messages_declare_as_not_measured_is_not_used(tmp_path, kind, absent, said):
    store = run(write_bag(tmp_path, kind, absent=absent), out=tmp_path / "o")

    assert warned(store.report, said, why="absent")
    if absent == ("accel",):
        assert np.isnan(store.imu.accel_m_s2).all()
        assert len(store.imu) == 220
    else:
        assert store.imu is None


def test_a_bag_with_accelerations_of_zero_has_no_accelerometer(tmp_path):
    path = write_bag(tmp_path, "db3", accel=lambda k: np.zeros(3))

    store = run(path, out=tmp_path / "o")

    assert np.isnan(store.imu.accel_m_s2).all()
    assert warned(store.report, K.ACCELEROMETER_MISSING, why="zero")


def write_bag(folder, kind, *, absent=(), accel=lambda k: noisy([0.0, 0.0, 9.8], k)):
    t_ns, payloads = room_packets()
    path = bag_path(folder, kind)
    with Bag(path, kind) as bag:
        for first in range(0, len(t_ns), 75):
            rows = slice(first, first + 75)
            bag.scan("/velodyne_packets", t_ns[rows], payloads[rows])
            for k in range(20):
                gyro = noisy([0.0, 0.0, 0.1], first + k)
                at_ns = int(t_ns[first]) + k * STEP_NS
                bag.imu("/imu", at_ns, gyro, accel(first + k), absent=absent)
    return path
