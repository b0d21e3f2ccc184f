"""The registration of the method ``maps`` on real scenes of a car with three LiDARs."""

import numpy as np
import pytest

from recon4.registration.scan_registration import make_scan
from tests.benchmarks.calibration_real import SETTINGS, by_gicp, cloud, mount


@pytest.mark.study
def test_two_scenes_of_one_rig_give_the_same_mount_although_the_drawing_is_45_degrees_off(
    data,
):
    data("calibration")
    mounts = []
    for scene in ("0001", "0002"):
        top, left = cloud(scene, "top"), cloud(scene, "left")
        found = mount(make_scan(top, SETTINGS), make_scan(left, SETTINGS), "left")
        assert found.converged
        mounts.append(found.T_target_source)

    apart = mounts[0].inverse() @ mounts[1]
    assert np.rad2deg(apart.angle()) < 0.3
    assert np.linalg.norm(mounts[0].t - mounts[1].t) < 0.03
    assert np.rad2deg(mounts[0].rpy()[1]) == pytest.approx(45.0, abs=1.0)
    reference = by_gicp(top, left, mounts[1])
    assert np.rad2deg((reference.inverse() @ mounts[1]).angle()) < 0.15
    assert np.linalg.norm(reference.t - mounts[1].t) < 0.03
