"""Where an odometry and fixes that come later meet."""

from dataclasses import replace

import numpy as np
import pytest

from recon4.geometry.se3 import SE3, Array
from recon4.registration.aiding import GnssAiding
from recon4.registration.met_fixes import MetFixes
from recon4.registration.motion import FreeMotion, MotionState
from recon4.registration.state_vector import STATE, VECTOR
from recon4.settings import OdometrySettings
from recon4.units import STANDARD_GRAVITY_M_S2

ARM_M = np.array([0.2, 0.0, 1.0])
SETTINGS = OdometrySettings()
TILT_RAD = 0.02
DOWN = np.array([0.0, 0.0, -STANDARD_GRAVITY_M_S2])


def fixes(*spans_s: tuple[float, float], speed_m_s: float = 1.0) -> GnssAiding:
    """Ten fixes a second over spans of time: a body that walks to the north, heading north."""
    t_s = np.concatenate([np.arange(first, last, 0.1) for first, last in spans_s])
    R = SE3.from_rpy(0.0, 0.0, 0.5 * np.pi, t=[0.0, 0.0, 0.0]).R
    p = np.outer(t_s, [0.0, speed_m_s, 0.0])
    return GnssAiding(
        t_ns=np.rint(1e9 * t_s).astype(np.int64),
        p_enu=p + R @ ARM_M,
        sd_m=np.full((len(t_s), 3), 0.1),
        R_enu_body=np.tile(R, (len(t_s), 1, 1)),
        attitude_sd_rad=0.01,
        p_body_antenna=ARM_M,
    )


def state(t_s: float, *, at: SE3 | None = None, velocity: Array | None = None) -> MotionState:
    """A state of an odometry with axes of its own."""
    begun = FreeMotion(SETTINGS).initial(round(1e9 * t_s))
    moved = begun if at is None else begun.at_pose(at, sd_rad=1e-3, sd_m=1e-2)
    return moved if velocity is None else moved.moving(velocity, 0.01)


def falling(of: MotionState, *, sd_m_s2: float = 0.01) -> MotionState:
    """The same state with gravity along its z axis, known with a standard deviation."""
    vector, P = of.vector.copy(), of.P.copy()
    vector[VECTOR.gravity] = DOWN
    P[STATE.gravity, STATE.gravity] = sd_m_s2**2 * np.eye(3)
    return replace(of, vector=vector, P=P)


def met(aiding: GnssAiding, begun: MotionState | None = None) -> MetFixes:
    """Fixes beside an odometry that begins at 0 s."""
    beside = MetFixes(aiding, SETTINGS)
    beside.begin(begun or state(0.0), FreeMotion(SETTINGS).predict)
    return beside


def test_fixes_that_begin_later_are_met_where_the_odometry_is() -> None:
    here = SE3.from_rpy(0.0, 0.0, 0.3, t=[7.0, -2.0, 0.5])
    late = met(fixes((2.0, 5.0)))
    assert late.fixes is None

    late.meet(state(1.9, at=here))
    assert late.fixes is None  # not yet
    late.meet(state(2.0, at=here))

    assert late.fixes is not None
    for t_s, went_m in ((2.0, 0.0), (4.0, 2.0)):
        T = late.fixes.pose(round(1e9 * t_s))
        assert T is not None
        assert (here.inverse() @ T).t == pytest.approx([went_m, 0.0, 0.0], abs=1e-6)
        assert (here.inverse() @ T).angle() == pytest.approx(0.0, abs=1e-6)


def test_fixes_after_an_outage_are_met_anew_and_those_after_a_short_gap_are_not() -> None:
    drifted = SE3.from_rpy(0.0, 0.0, 0.5 * np.pi, t=[1.5, 4.0, 0.0])

    for begins_s, beside_m in ((1.9, 0.0), (4.0, 1.5)):
        both = met(fixes((0.0, 1.0), (begins_s, 6.0)))
        both.meet(state(4.0, at=drifted))
        assert both.fixes is not None
        T = both.fixes.pose(5_000_000_000)
        assert T is not None
        assert T.t == pytest.approx([beside_m, 5.0, 0.0], abs=1e-6)


def test_an_odometry_that_knows_gravity_takes_only_heading_and_place_of_its_pose() -> None:
    late = met(fixes((2.0, 5.0)), falling(state(0.0)))
    tilted = SE3.from_rpy(TILT_RAD, 0.0, 0.3, t=[7.0, -2.0, 0.5])

    found = late.meet(falling(state(2.0, at=tilted)))

    assert late.fixes is not None
    T = late.fixes.pose(4_000_000_000)
    assert T is not None
    assert T.t == pytest.approx([7.0 + 2.0 * np.cos(0.3), -2.0 + 2.0 * np.sin(0.3), 0.5], abs=0.01)
    assert T.R[2] == pytest.approx([0.0, 0.0, 1.0], abs=1e-9)
    assert found.vector[VECTOR.gravity] == pytest.approx(DOWN)


@pytest.mark.parametrize(("tilt_rad", "sd_m_s2"), [(0.12, 0.01), (0.02, 0.3)])
def test_a_gravity_that_the_fixes_contradict_or_know_better_is_theirs(tilt_rad, sd_m_s2) -> None:
    start = falling(state(0.0), sd_m_s2=0.3)
    late = met(fixes((2.0, 5.0)), start)
    tilted = SE3.from_rpy(tilt_rad, 0.0, 0.0, t=[7.0, -2.0, 0.5])

    found = late.meet(falling(state(2.0, at=tilted), sd_m_s2=sd_m_s2))

    assert found.vector[VECTOR.gravity] == pytest.approx(tilted.R @ DOWN)
    assert found.P[STATE.gravity, STATE.gravity] == pytest.approx(0.09 * np.eye(3))


def test_a_velocity_that_the_fixes_contradict_is_theirs() -> None:
    for velocity, expected in (
        ([-1.0, 0.0, 0.0], [0.0, 1.0, 0.0]),
        ([0.1, 0.9, 0.0], [0.1, 0.9, 0.0]),  # the odometry knows it better
    ):
        late = met(fixes((2.0, 5.0)))
        here = SE3.from_rpy(0.0, 0.0, 0.5 * np.pi, t=[0.0, 0.0, 0.0])
        found = late.meet(state(2.0, at=here, velocity=np.array(velocity)))
        assert found.vector[VECTOR.velocity] == pytest.approx(expected, abs=1e-6)


def test_a_body_that_stands_by_its_fixes_is_stopped() -> None:
    late = met(fixes((2.0, 5.0), speed_m_s=0.0))

    found = late.meet(state(2.0, velocity=np.array([1.0, 0.0, 0.0])))

    assert found.vector[VECTOR.velocity] == pytest.approx([0.0, 0.0, 0.0], abs=1e-6)
