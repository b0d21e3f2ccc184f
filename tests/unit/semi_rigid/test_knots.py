import numpy as np
import pytest

from recon4.geometry.se3 import SE3, so3_exp
from recon4.model.trajectory import Trajectory
from recon4.semi_rigid.knots import IntervalEquations, apply_knots, solve_knots

NEIGHBOR_SD = np.repeat([2e-4, 1e-3], 3)
TOTAL_SD = np.repeat([5e-3, 2e-2], 3)


def system_of(frames, *, seed=1):
    J = np.random.default_rng(seed).normal(0, 100, (frames, 30, 12))
    r = np.random.default_rng(seed + 1).normal(0, 0.01, (frames, 30))
    H = np.einsum("fki,fkj->fij", J, J)
    return IntervalEquations(H, np.einsum("fki,fk->fi", J, r))


def energy_gradient(system, applied, step):
    """Gradient of matches, chain and anchor at ``step``, spelled out with a dense matrix."""
    knots = len(system.H) + 1
    chain, anchor = np.diag(NEIGHBOR_SD**-2), np.diag(TOTAL_SD**-2)
    A, b = np.zeros((6 * knots, 6 * knots)), np.zeros(6 * knots)
    total = applied.ravel()
    for k in range(knots):
        rows = slice(6 * k, 6 * k + 6)
        A[rows, rows] += anchor
        b[rows] += anchor @ total[rows]
    for k in range(knots - 1):
        rows = slice(6 * k, 6 * k + 12)
        difference = np.hstack([-np.eye(6), np.eye(6)])
        A[rows, rows] += system.H[k] + difference.T @ chain @ difference
        b[rows] += system.g[k] + difference.T @ chain @ difference @ total[rows]
    return A @ step.ravel() + b, A


@pytest.mark.parametrize("frames", [1, 2, 7, 30])
def test_the_banded_solution_is_the_dense_one(frames):
    system = system_of(frames)
    applied = np.random.default_rng(3).normal(0, 1e-3, (frames + 1, 6))

    step = solve_knots(system, applied, neighbor_sd=NEIGHBOR_SD, total_sd=TOTAL_SD)

    gradient, A = energy_gradient(system, applied, step)
    start, _ = energy_gradient(system, applied, np.zeros_like(applied))
    assert step.shape == (frames + 1, 6)
    assert np.abs(gradient).max() < 1e-8 * np.abs(start).max()
    np.testing.assert_allclose(step.ravel(), -np.linalg.solve(A, start), rtol=1e-6, atol=1e-12)


def test_without_information_nothing_moves():
    frames = 5
    nothing = IntervalEquations(np.zeros((frames, 12, 12)), np.zeros((frames, 12)))

    step = solve_knots(nothing, np.zeros((6, 6)), neighbor_sd=NEIGHBOR_SD, total_sd=TOTAL_SD)

    np.testing.assert_array_equal(step, 0.0)


def test_without_information_a_correction_decays_to_zero():
    frames = 3
    nothing = IntervalEquations(np.zeros((frames, 12, 12)), np.zeros((frames, 12)))
    applied = np.full((4, 6), 1e-3)

    step = solve_knots(nothing, applied, neighbor_sd=NEIGHBOR_SD, total_sd=TOTAL_SD)

    np.testing.assert_allclose(step, -applied, rtol=1e-9)


def test_the_influence_of_a_single_frame_decays_with_distance():
    frames, wanted_m = 400, 0.01
    H, g = np.zeros((frames, 12, 12)), np.zeros((frames, 12))
    for end in (5, 11):
        H[200, end, end] = 1e12
        g[200, end] = -1e12 * wanted_m

    up = solve_knots(
        IntervalEquations(H, g), np.zeros((401, 6)), neighbor_sd=NEIGHBOR_SD, total_sd=TOTAL_SD
    )[:, 5]

    assert up[200] == pytest.approx(wanted_m, rel=1e-3)
    assert up[201] == pytest.approx(wanted_m, rel=1e-3)
    # A chain on an anchor decays by exp(-neighbor_sd / total_sd) a knot: 5 % here.
    ratio = up[203:230] / up[202:229]
    np.testing.assert_allclose(ratio, np.exp(-1e-3 / 2e-2), rtol=0.002)
    assert not solve_knots(
        IntervalEquations(H, g), np.zeros((401, 6)), neighbor_sd=NEIGHBOR_SD, total_sd=TOTAL_SD
    )[:, :5].any()


# -- applying


def still(count=9):
    t_ns = np.arange(count, dtype=np.int64) * 50_000_000
    return Trajectory(t_ns, SE3(np.tile(so3_exp([0, 0, 0.3]), (count, 1, 1)), np.ones((count, 3))))


def test_corrections_are_interpolated_in_time_and_constant_outside():
    knot_ns = np.array([100_000_000, 200_000_000, 300_000_000])
    correction = np.zeros((3, 6))
    correction[:, 3] = [0.0, 0.02, 0.06]

    moved = apply_knots(still(), knot_ns, correction)

    np.testing.assert_allclose(
        moved.T_a_b.t[:, 0] - 1.0, [0, 0, 0, 0.01, 0.02, 0.04, 0.06, 0.06, 0.06], atol=1e-12
    )
    np.testing.assert_array_equal(moved.T_a_b.R, still().T_a_b.R)


def test_a_turn_is_about_the_pose_itself_in_the_axes_of_the_map():
    knot_ns = np.array([0, 400_000_000])
    correction = np.zeros((2, 6))
    correction[:, 0] = 0.1

    moved = apply_knots(still(), knot_ns, correction)

    np.testing.assert_array_equal(moved.T_a_b.t, 1.0)
    np.testing.assert_allclose(moved.T_a_b.R[4], so3_exp([0.1, 0, 0]) @ so3_exp([0, 0, 0.3]))


def test_no_correction_changes_nothing():
    trajectory = still()

    moved = apply_knots(trajectory, np.array([0, 400_000_000]), np.zeros((2, 6)))

    np.testing.assert_array_equal(moved.T_a_b.t, trajectory.T_a_b.t)
    np.testing.assert_allclose(moved.T_a_b.R, trajectory.T_a_b.R, atol=1e-15)
