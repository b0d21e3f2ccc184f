import numpy as np
import pytest

from recon4.geometry.se3 import SE3
from recon4.registration.frame_fit import FrameFitter
from recon4.registration.motion import FreeMotion, Rest
from recon4.registration.odometry import Odometry
from recon4.registration.plane_map import PlaneMap
from recon4.registration.scan_strategy import is_stationary, zero_velocity_update
from recon4.registration.segments import sample_segments
from recon4.registration.state_vector import END, STATE, VECTOR
from recon4.registration.tuning import OdometryTuning, ScanTuning
from recon4.settings import Settings
from tests.room_walks import FRAME_NS
from tests.scanned_room import RIG, standing, strolling, walk


def standing_then_going(t_s):
    """Half a second of standing, then 8 cm/s along x."""
    T = standing(t_s)
    T.t[:, 0] = 0.08 * np.maximum(np.asarray(t_s) - 0.5, 0.0)
    return T


def poses(recording, settings=None):
    odometry = Odometry(recording.rig, settings or Settings())
    steps = [odometry.push(frame) for frame in recording]
    assert not any(step.lost for step in steps)
    return SE3.stack(step.T_odom_body for step in steps), steps


@pytest.fixture(scope="module")
def slow():
    return walk(standing_then_going, 12, with_imu=False)


def test_a_stationary_body_does_not_drift_without_an_imu(slow):
    T, steps = poses(slow)

    np.testing.assert_array_equal(T.t[:5], 0.0)
    np.testing.assert_allclose(T.R[:5], np.broadcast_to(np.eye(3), (5, 3, 3)), atol=1e-12)
    np.testing.assert_allclose(steps[3].T_dense.t, 0.0, atol=1e-12)


def test_a_body_that_begins_to_creep_is_followed(slow):
    T, _ = poses(slow)

    off_m = np.linalg.norm(T.t - slow.true_poses().t, axis=1)
    assert off_m.max() < 0.006
    assert T.t[-1, 0] > 0.04


def test_a_walking_body_is_not_stationary():
    recording = walk(strolling, 3, with_imu=False)
    T = recording.true_poses()

    assert not is_stationary(T[0].inverse() @ T[1])
    assert not is_stationary(SE3.from_rpy(0.0, 0.0, 0.0, t=[0.0, 0.0, 0.02]))
    assert is_stationary(SE3.from_rpy(0.001, 0.0, 0.0, t=[0.004, 0.0, 0.0]))
    assert not is_stationary(SE3.from_rpy(0.0, 0.0, 0.01, t=np.zeros(3)))


def test_scans_with_oscillating_matches_are_not_lost():
    recording = walk(strolling, 6, with_imu=False)
    # Two rounds never end by a small step.
    settings = Settings(odometry=OdometryTuning(scans=ScanTuning(rounds=2)))

    T, _ = poses(recording, settings)

    T_true = recording.true_poses()
    apart_m = (T[2].inverse() @ T[5]).t - (T_true[2].inverse() @ T_true[5]).t
    assert np.linalg.norm(apart_m) < 0.03


def fit_of_second_frame(recording, state):
    """Its prediction from a state and its fit to the planes of the first frame."""
    settings, start_ns = Settings(), recording[1].t_ns
    first, second = (sample_segments(recording[k], RIG) for k in (0, 1))
    target = PlaneMap()
    target.add(np.concatenate([first.a_body, first.b_body]))
    prediction = FreeMotion(settings.odometry).predict(state, start_ns + FRAME_NS)
    fitter = FrameFitter(settings.odometry, 1e-4, coarse=3, rounds=8)
    return prediction, fitter.fit(target, second, prediction), second


def test_both_ends_of_a_segment_are_matched_to_the_planes(slow):
    state = FreeMotion(Settings().odometry).initial(slow[1].t_ns)

    _, fit, segments = fit_of_second_frame(slow, state)

    assert fit.match.residual_m.shape == (2 * len(segments),)
    assert fit.match.match_ratio > 0.8


def test_the_zero_velocity_update_does_not_depend_on_the_prediction(slow):
    T = SE3.stack([SE3.identity(), SE3.from_rpy(0.0, 0.0, 0.06, t=[0.1, 0.04, 0.0])])
    t_ns = slow[1].t_ns, slow[1].t_ns + FRAME_NS
    turning = FreeMotion(Settings().odometry).between(T, t_ns, slow[1].t_ns)
    prediction, free, _ = fit_of_second_frame(slow, turning)

    held = zero_velocity_update(free, prediction, SE3.identity())

    end = prediction.end.corrected(held.delta[6:], held.P[6:, 6:])
    assert held is not free
    np.testing.assert_allclose(end.T_odom_body.matrix(), np.eye(4), atol=1e-12)
    np.testing.assert_allclose(end.vector[3:9], 0.0, atol=1e-12)
    np.testing.assert_allclose(held.T_dense.t, np.zeros_like(free.T_dense.t), atol=0.0)
    assert held.T_dense.R.shape == free.T_dense.R.shape


def velocity_after(recording, rest):
    """Of a body predicted at 0.8 m/s along x and 0.4 m/s upwards, which no plane observes."""
    settings, start_ns = Settings(), recording[1].t_ns
    T = SE3.stack([SE3.identity(), SE3.from_rpy(0.0, 0.0, 0.0, t=[0.08, 0.0, 0.04])])
    motion = FreeMotion(settings.odometry)
    state = motion.between(T, (start_ns - FRAME_NS, start_ns), start_ns)
    prediction = motion.predict(state, start_ns + FRAME_NS)
    segments = sample_segments(recording[1], RIG)
    fitter = FrameFitter(settings.odometry, 1e-4, coarse=3, rounds=8)
    fit = fitter.fit(PlaneMap(), segments, prediction, rest=rest)
    after = prediction.end.corrected(fit.delta[END], fit.P[END, END])
    velocity_sd = np.sqrt(np.diag(after.P)[STATE.velocity])
    return after.vector[VECTOR.velocity], fit.stationary, velocity_sd


def test_who_has_stopped_is_slowed_and_not_called_stationary(slow):
    moving, stopped, still = (
        velocity_after(slow, rest) for rest in (Rest.MOVING, Rest.STOPPED, Rest.STATIONARY)
    )

    np.testing.assert_allclose(moving[0], [0.8, 0.0, 0.4], atol=1e-3)
    assert 0.0 < stopped[0][0] < 0.2 and stopped[0][2] > 0.39
    assert np.abs(still[0]).max() < 0.01
    assert (moving[1], stopped[1], still[1]) == (False, False, True)


def test_who_stands_sways_sideways_and_hardly_up_or_down(slow):
    _, _, velocity_sd = velocity_after(slow, Rest.STATIONARY)

    np.testing.assert_allclose(velocity_sd, [0.02, 0.02, 0.005], rtol=0.1)
