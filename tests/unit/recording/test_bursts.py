"""Samples whose stamps come in bursts."""

import numpy as np
import pytest

from recon4.recording.report import ImportReport
from recon4.recording.samples.bursts import without_bursts

MEASURED_NS = 1_780_000_000_000_000_000 + 5_000_000 * np.arange(2000)
RNG = np.random.default_rng(3)
ARRIVED_NS = np.repeat(MEASURED_NS[9::10] + RNG.integers(1_000_000, 2_000_000, 200), 10)


@pytest.mark.parametrize(
    "stamps_ns",
    [
        ARRIVED_NS,
        ARRIVED_NS + 30_000 * (np.arange(2000) % 10),
        MEASURED_NS // 10_000_000 * 10_000_000,
        MEASURED_NS // 1_000_000_000 * 1_000_000_000,
    ],
    ids=["read in one go", "read one after the other", "10 ms", "whole seconds"],
)
def test_samples_in_bursts_are_spread_evenly(stamps_ns):
    report = ImportReport()

    found_ns = without_bursts(stamps_ns, report)

    assert report.counts["imu_in_bursts"] == 2000
    assert np.all(np.diff(found_ns) > 0)
    late_ns = found_ns - MEASURED_NS
    assert np.ptp(late_ns[10:]) < 1_100_000
    assert abs(np.median(late_ns)) < 2_000_000


def test_a_pause_between_bursts_is_kept():
    stamps_ns = ARRIVED_NS + np.where(np.arange(2000) < 1000, 0, 3_000_000_000)

    found_ns = without_bursts(stamps_ns, ImportReport())

    steps_ns = np.diff(found_ns)
    assert np.count_nonzero(steps_ns > 2_900_000_000) == 1
    assert np.median(steps_ns) == pytest.approx(5_000_000, rel=0.01)


@pytest.mark.parametrize("pause_s", [1.5, 37.0, 3600.0])
def test_a_pause_makes_no_bursts_of_even_samples(pause_s):
    stamps_ns = MEASURED_NS + round(1e9 * pause_s) * (np.arange(2000) >= 400)

    assert without_bursts(stamps_ns, ImportReport()) is stamps_ns


@pytest.mark.parametrize("late_ms", [0.0, 1.0, 3.0, 8.0])
def test_stamps_that_scatter_are_no_bursts(late_ms):
    late_ns = RNG.exponential(1e6 * late_ms, len(MEASURED_NS)).astype(np.int64)
    stamps_ns, report = np.sort(MEASURED_NS + late_ns), ImportReport()

    np.testing.assert_array_equal(without_bursts(stamps_ns, report), stamps_ns)
    assert not report.counts


def test_digits_that_keep_samples_apart_are_no_bursts():
    stamps_ns = MEASURED_NS[0] + 2_500_000 * np.arange(2000) // 1_000_000 * 1_000_000

    assert without_bursts(stamps_ns, ImportReport()) is stamps_ns
