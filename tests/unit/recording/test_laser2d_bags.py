"""Bags with the scans of a 2-D laser and no LiDAR."""

from dataclasses import replace

import numpy as np
import pytest

from recon4.recording.info import describe
from recon4.recording.laser2d import is_laser2d, read_laser2d
from recon4.recording.report import ImportReport
from recon4.simulation.line_bag import open_line_bag
from tests.planar_walks import furnished_room, scanned


@pytest.fixture(scope="module")
def scans():
    truth = np.stack([np.linspace(-2.0, 2.0, 20), np.zeros(20), np.zeros(20)], axis=1)
    return replace(scanned(furnished_room(), truth, odometry=False).scans, time_step_s=1e-4)


def test_the_scans_of_a_bag_are_read(tmp_path, scans):
    with open_line_bag(tmp_path / "bag") as bag:
        bag.scans("/scan", scans)

    report = ImportReport()
    found = read_laser2d([tmp_path / "bag"], report)

    assert is_laser2d(tmp_path / "bag")
    np.testing.assert_array_equal(found.t_ns, scans.t_ns)
    np.testing.assert_allclose(found.range_m, scans.range_m)
    np.testing.assert_allclose(found.angles_rad, scans.angles_rad, atol=1e-5)
    assert found.time_step_s == pytest.approx(1e-4)
    assert found.odometry is None
    assert "no odometry" in " ".join(report.derived)


def test_info_says_what_a_bag_holds(tmp_path, scans):
    with open_line_bag(tmp_path / "bag") as bag:
        bag.scans("/scan", scans)

    text = "\n".join(describe(tmp_path / "bag").lines())

    assert "20 scans of 271 beams" in text
    assert "LiDAR data" not in text
