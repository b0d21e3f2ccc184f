"""Rides that only the IMU feels: the car of an elevator stands still for a LiDAR."""

from typing import Any

import numpy as np
import pytest

from recon4.findings.witnesses.imu import ride_finding
from recon4.findings.wording import text_of
from recon4.geometry.se3 import SE3, so3_exp
from recon4.model.finding import Level
from recon4.model.odometry_figures import HeightDoubt
from recon4.model.rig import load_rig
from recon4.model.samples import ImuSamples
from recon4.model.trajectory import Trajectory
from recon4.registration.unseen_rides import (
    HeightContradiction,
    UnseenRide,
    _contradicted,
    unseen_rides,
)
from recon4.simulation.degradation import Degradation
from recon4.simulation.gait import plan_walk
from recon4.simulation.imu import ImuModel, simulate_imu
from recon4.simulation.truth import true_trajectory
from recon4.simulation.worlds import build_world
from recon4.units import STANDARD_GRAVITY_M_S2
from tests.room_walks import rig_of

RIG = load_rig("4recon")
EPOCH_NS = 1_780_308_000_000_000_000
BIAS_M_S2 = np.array([0.12, 0.0, -0.05])
NOTHING_LOST = np.empty(0, np.int64)


def walked(
    world: str, *, seconds: float = 60.0, seed: int = 1, **degraded: float
) -> tuple[Trajectory, ImuSamples]:
    """What the odometry makes of a walk, with errors of 2 mm and blind to the elevator; the IMU."""
    walk = plan_walk(build_world(world), seconds=seconds, rng=np.random.default_rng([seed, 0]))
    worse = {name.replace("_", "-"): value for name, value in degraded.items()}
    degradation = Degradation.drawn(worse, lasers=[16, 16], seed=seed)
    rng = np.random.default_rng([seed, 2])
    model = degradation.imu_model(ImuModel())
    imu = degradation.imu(simulate_imu(walk, RIG, model, epoch_ns=EPOCH_NS, rng=rng))
    true = true_trajectory(walk, epoch_ns=EPOCH_NS)
    place = true.T_a_b.t + 0.002 * rng.standard_normal((len(true), 3))
    if walk.ride is not None:
        place[:, 2] -= walk.ride.at((true.t_ns - EPOCH_NS) * 1e-9)[0]
    return Trajectory(true.t_ns, SE3(true.T_a_b.R, place)), imu


def only_rides(*args: Any, **how: Any) -> list[UnseenRide]:
    """What is found, all of it rides."""
    found = unseen_rides(*args, **how)
    assert all(isinstance(one, UnseenRide) for one in found), found
    return found


def rides(world: str, **how: float) -> list[UnseenRide]:
    trajectory, imu = walked(world, **how)
    return only_rides(trajectory, imu, RIG, lost_ns=NOTHING_LOST)


def is_severe(ride):
    """Whether it forbids the use of the map."""
    return ride_finding(ride.doubt).level is Level.DO_NOT_USE


def text(ride):
    """A ride in words."""
    return text_of(ride_finding(ride.doubt))


@pytest.mark.parametrize("how", [{}, {"imu_grade": 5}, {"imu_clock": 0.02}, {"imu_scale": 0.03}])
def test_rides_up_and_down_are_found_with_their_height(how: dict[str, float]) -> None:
    up, down = rides("elevator:1", **how)

    assert (up.rise_m, down.rise_m) == pytest.approx((3.4, -3.4), abs=0.6)
    assert 8.0 < up.start_s < up.end_s < down.start_s < down.end_s < 40.0
    assert is_severe(up) and is_severe(down)
    assert "a ride of about 3." in text(up)
    assert " m down that no LiDAR sees" in text(down)


@pytest.mark.parametrize("how", [{}, {"imu_grade": 5}, {"imu_rotation": 1.5}])
@pytest.mark.parametrize("world", ["staircase", "tower", "office", "forest"])
def test_what_the_lidar_sees_is_no_ride(world: str, how: dict[str, float]) -> None:
    assert rides(world, **how) == []


def test_a_recording_that_ends_on_the_way_has_a_begin_alone() -> None:
    trajectory, imu = walked("elevator:1")
    early = trajectory.t_ns < trajectory.t_ns[0] + 11_500_000_000
    cut = Trajectory(trajectory.t_ns[early], trajectory.T_a_b[early])

    (found,) = only_rides(cut, imu, RIG, lost_ns=NOTHING_LOST)

    assert np.isnan(found.rise_m)
    assert is_severe(found)
    assert "a change of the vertical speed by +" in text(found)


def test_odometry_between_imu_and_lidar_contradicts_the_imu() -> None:
    """Measured: it follows the car for 1.5 m of 3.4 m, then sinks by 0.3 m/s for ten seconds."""
    trajectory, imu = walked("elevator:1", seconds=20.0)
    t_s = (trajectory.t_ns - trajectory.t_ns[0]) * 1e-9
    height_m = np.interp(t_s, [5.5, 7.0, 9.5, 16.0, 20.0], [0.0, 0.45, 1.55, -1.85, -2.3])
    place = trajectory.T_a_b.t + np.outer(height_m, [0.0, 0.0, 1.0])
    followed = Trajectory(trajectory.t_ns, SE3(trajectory.T_a_b.R, place))

    found = unseen_rides(followed, imu, RIG, lost_ns=NOTHING_LOST)

    assert found[0].start_s == pytest.approx(6.5, abs=1.5)
    assert "as in an elevator" in text(found[0])
    assert any(is_severe(one) for one in found)


@pytest.mark.parametrize(("speed_m_s", "found"), [(0.23, 1), (0.05, 0)])
def test_a_vertical_speed_that_changes_at_once_contradicts_an_imu_that_did_not_feel_it(
    speed_m_s: float, found: int
) -> None:
    """Measured: an odometry that follows a lift for 2.2 m of 3.4 m, then comes to rest at once."""
    trajectory, imu = walked("office", seconds=20.0)
    t_s = (trajectory.t_ns - trajectory.t_ns[0]) * 1e-9
    sinks = np.outer(np.maximum(t_s - 9.0, 0.0), [0.0, 0.0, -speed_m_s])
    bent = Trajectory(trajectory.t_ns, SE3(trajectory.T_a_b.R, trajectory.T_a_b.t + sinks))

    contradictions = unseen_rides(bent, imu, RIG, lost_ns=NOTHING_LOST)

    assert [type(one) for one in contradictions] == found * [HeightContradiction]
    assert all(abs(one.start_s - 9.0) < 0.6 for one in contradictions)
    # In the three seconds until the LiDARs may correct it.
    assert all(one.rise_m == pytest.approx(3.5 * speed_m_s, rel=0.15) for one in contradictions)


def test_a_step_of_a_lift_is_announced_but_forbids_nothing() -> None:
    platform = UnseenRide(3.0, 6.0, 0.4, 0.3)

    assert not is_severe(platform)
    assert not is_severe(HeightContradiction(3.0, 6.0, 0.15, 0.03, -0.6))
    assert is_severe(HeightContradiction(3.0, 6.0, 0.15, 0.03, -1.2))


def test_a_walk_that_sinks_when_its_recording_begins_is_wrong_by_what_it_sinks() -> None:
    trajectory, imu = walked("office", seconds=20.0)
    t_s = (trajectory.t_ns - trajectory.t_ns[0]) * 1e-9
    sunk_m = 0.2 * np.exp(-t_s / 0.6)
    place = trajectory.T_a_b.t + np.outer(sunk_m, [0.0, 0.0, 1.0])
    sinking = Trajectory(trajectory.t_ns, SE3(trajectory.T_a_b.R, place))

    (found,) = unseen_rides(sinking, imu, RIG, lost_ns=NOTHING_LOST)

    assert isinstance(found, HeightContradiction)
    assert found.start_s < 1.0
    assert abs(found.rise_m) == pytest.approx(0.15, abs=0.08)


@pytest.mark.parametrize(("break_knots", "found"), [(4, 1), (12, 2)])
def test_a_contradiction_goes_on_through_a_short_break(break_knots: int, found: int) -> None:
    """As in elevator:2: 0.2 m/s² up for 2.5 s, a break, 0.2 m/s² down for 2.5 s."""
    push = np.full(5, 0.2)
    extra = np.concatenate([np.zeros(10), push, np.zeros(break_knots), -push, np.zeros(10)])

    stretches = _contradicted(0.5 * np.arange(len(extra)), extra, 0.02)

    assert len(stretches) == found
    if found == 1:
        # 0.5 m/s after the first push, so 0.6 + 1.0 + 0.6 m, and a little more at the knots.
        assert stretches[0].rise_m == pytest.approx(2.25, abs=0.1)
        assert is_severe(stretches[0])
        assert (stretches[0].start_s, stretches[0].end_s) == (5.0, 11.5)
    assert stretches[0].doubt == HeightDoubt(
        start_s=stretches[0].start_s,
        end_s=stretches[0].end_s,
        rise_m=stretches[0].rise_m,
        largest_m_s2=stretches[0].largest_m_s2,
        usual_m_s2=stretches[0].usual_m_s2,
    )


def test_a_ride_without_an_end_is_doubted_like_a_storey() -> None:
    assert UnseenRide(3.0, 6.0, -3.4, 0.6).doubt.rise_m == -3.4
    assert UnseenRide(3.0, 6.0, float("nan"), 0.6).doubt.rise_m == 3.0


def test_an_imu_that_contradicts_the_whole_walk_has_no_rides() -> None:
    trajectory, imu = walked("elevator:1")
    rng = np.random.default_rng(4)
    slow = np.repeat(rng.normal(0.0, 1.0, len(imu) // 100 + 1), 100)[: len(imu), None]
    shaken = ImuSamples(imu.t_ns, imu.gyro_rad_s, imu.accel_m_s2 + slow * [0.0, 0.0, 1.0])

    found = unseen_rides(trajectory, shaken, RIG, lost_ns=NOTHING_LOST)

    assert found
    assert not any(isinstance(one, UnseenRide) for one in found)
    assert "the accelerometer contradicts the heights" in text(found[0])


def test_where_tracking_was_lost_nothing_is_said() -> None:
    trajectory, imu = walked("elevator:1")
    up, _ = only_rides(trajectory, imu, RIG, lost_ns=NOTHING_LOST)
    within = (trajectory.t_ns[0] + 1e9 * np.arange(up.start_s, up.end_s, 0.1)).astype(np.int64)

    (found,) = only_rides(trajectory, imu, RIG, lost_ns=within)

    assert found.rise_m < 0.0


def test_a_short_or_silent_imu_says_nothing() -> None:
    trajectory, imu = walked("office", seconds=20.0)
    few = ImuSamples(imu.t_ns[:300], imu.gyro_rad_s[:300], imu.accel_m_s2[:300])
    silent = ImuSamples(imu.t_ns, imu.gyro_rad_s, np.full_like(imu.accel_m_s2, np.nan))

    for samples in (few, silent):
        assert unseen_rides(trajectory, samples, RIG, lost_ns=NOTHING_LOST) == []


def standing(
    *,
    seconds: float = 60.0,
    rise: tuple[float, float, float] = (0.0, 0.0, 0.0),
    lying_s: tuple[float, float] | None = None,
    strides: bool = False,
) -> list[UnseenRide | HeightContradiction]:
    """What is found of a body at one place, or one that walks on, whose accelerometer has a bias.

    Args:
        seconds: Length of the recording.
        rise: Begin [s], length of each push [s] and speed [m/s] of a lift, which runs for 18 s.
        lying_s: From when to when the body lies on its back [s].
        strides: Whether it walks on at 1 m/s.
    """
    rng = np.random.default_rng(5)
    t_s = np.arange(0.0, seconds, 0.01)
    begin_s, push_s, speed_m_s = rise
    pushed = np.zeros_like(t_s)
    for at_s, sign in ((begin_s, 1.0), (begin_s + 18.0, -1.0)):
        pushed[(t_s >= at_s) & (t_s < at_s + push_s)] = sign * speed_m_s / max(push_s, 1e-9)
    turn = np.zeros((len(t_s), 3))
    if lying_s:
        turn[:, 1] = np.interp(t_s, [lying_s[0] - 1, lying_s[0], *lying_s[1:], lying_s[1] + 1],
                               [0.0, -np.pi / 2, -np.pi / 2, 0.0])  # fmt: skip
    R = so3_exp(turn)
    force = np.einsum("nji,j->ni", R, [0.0, 0.0, 1.0]) * (STANDARD_GRAVITY_M_S2 + pushed)[:, None]
    noise = 0.02 * rng.standard_normal(force.shape)
    t_ns = EPOCH_NS + np.rint(1e9 * t_s).astype(np.int64)
    imu = ImuSamples(t_ns=t_ns, gyro_rad_s=np.zeros_like(force),
                     accel_m_s2=force + noise + BIAS_M_S2)  # fmt: skip
    place = np.zeros((len(t_s), 3))
    place[:, 0] = t_s * strides
    rig = rig_of(SE3.identity())
    return unseen_rides(Trajectory(t_ns, SE3(R, place)), imu, rig, lost_ns=NOTHING_LOST)


def test_a_slow_platform_lift_is_found_while_the_body_stays_in_one_place() -> None:
    (ride,) = standing(rise=(20.0, 1.25, 0.15))

    assert isinstance(ride, UnseenRide)
    assert ride.rise_m == pytest.approx(0.15 * 18.0, abs=0.4)
    assert is_severe(ride)
    assert standing(rise=(20.0, 1.25, 0.15), strides=True) == []


def test_nothing_is_found_of_a_body_that_stands() -> None:
    assert standing() == []
    assert standing(strides=True) == []


def test_a_bias_that_turns_into_the_vertical_is_no_ride() -> None:
    assert standing(lying_s=(20.0, 32.0)) == []


@pytest.mark.parametrize("gap_s", [0.6, 1.0, 2.0])
def test_a_gap_of_the_imu_is_no_ride(gap_s: float) -> None:
    trajectory, imu = walked("office")
    since_s = (imu.t_ns - imu.t_ns[0]) * 1e-9
    kept = np.ones(len(imu), bool)
    for start_s in np.arange(4.13, 50.0, 6.37):
        kept &= (since_s < start_s) | (since_s > start_s + gap_s)
    pieces = ImuSamples(imu.t_ns[kept], imu.gyro_rad_s[kept], imu.accel_m_s2[kept])

    assert unseen_rides(trajectory, pieces, RIG, lost_ns=NOTHING_LOST) == []
