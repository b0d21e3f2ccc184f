"""Odometry that runs again with what it found out about a wrong IMU."""

from dataclasses import replace
from itertools import pairwise

import numpy as np
import pytest

from recon4.evaluation.ate import pair_poses
from recon4.model.samples import ImuSamples
from recon4.progress import Silent
from recon4.recording.formats.poses import read_tum
from recon4.registration.odometry import Odometry
from recon4.registration.passes import OdometryPass, register_all
from recon4.settings import preset

SETTINGS = preset("indoor")
SCALE = 1.1


def with_scale(frames, scale):
    imu = ImuSamples(frames.imu.t_ns, scale * frames.imu.gyro_rad_s, frames.imu.accel_m_s2)
    return replace(frames, imu=imu)


class Counted(Silent):
    """Counts the passes."""

    passes = 0

    def start(self, what, total, unit):
        self.passes += 1


def turn_error_rad(made: OdometryPass, office_recording) -> float:
    """Largest error of the orientation against that of the first multiframe."""
    pairs = pair_poses(made.trajectory, read_tum(office_recording / "truth.tum"))
    found, true = pairs.T_map_body, pairs.T_true_body
    left = (true[0].inverse() @ true).inverse() @ (found[0].inverse() @ found)
    return float(np.max(left.angle()))


@pytest.mark.slow
def test_a_wrong_scale_is_corrected_from_the_start(frames, office_recording, monkeypatch):
    walk, progress = with_scale(frames, SCALE), Counted()

    corrected = register_all(walk, SETTINGS, progress=progress)
    monkeypatch.setattr(OdometryPass, "fits_as_well", lambda *_: False)
    first = register_all(walk, SETTINGS, progress=Silent())

    assert progress.passes == 2
    assert "scale" in first.estimate.faults[0].kind and "scale" in corrected.estimate.faults[0].kind
    errors = [turn_error_rad(made, office_recording) for made in (first, corrected)]
    assert errors[1] < 0.6 * errors[0]


def test_an_imu_in_order_needs_one_pass(frames):
    progress = Counted()

    made = register_all(frames, SETTINGS, progress=progress)

    assert progress.passes == 1
    assert made.estimate.faults == ()


@pytest.mark.parametrize(
    ("factor", "lost", "fits"), [(1.01, 0, True), (1.05, 0, False), (1.0, 1, False)]
)
def test_a_pass_fits_as_well_if_it_loses_nothing_and_lies_as_near(frames, factor, lost, fits):
    made = register_all(frames, SETTINGS, progress=Silent())
    steps = [
        replace(s, error_m=factor * s.error_m, lost=k < lost) for k, s in enumerate(made.steps)
    ]

    assert replace(made, steps=steps).fits_as_well(made) is fits


def largest_jump_m(steps) -> float:
    """Of the end of a multiframe from where the next one begins, but for the first [m]."""
    return max(
        float(np.linalg.norm(step.T_dense.t[-1] - after.T_dense.t[0]))
        for step, after in pairwise(steps[1:])
    )


def test_poses_lead_to_where_the_next_multiframe_begins(frames):
    odometry = Odometry(frames.rig, SETTINGS, frames.imu)
    steps = [odometry.push(frame) for frame in frames]

    made = register_all(frames, SETTINGS, progress=Silent())

    assert largest_jump_m(steps) > 1e-4
    assert largest_jump_m(made.steps) < 1e-9
    middles = made.trajectory.at(np.array([step.t_mid_ns for step in made.steps])).t
    stated = np.stack([step.T_odom_body.t for step in made.steps])
    np.testing.assert_allclose(middles, stated, atol=2e-4)
