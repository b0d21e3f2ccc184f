"""Registration of two single scans: a room with known walls, turned and moved."""

from dataclasses import replace
from itertools import pairwise

import numpy as np
import pytest
from msgspec import structs

from recon4.geometry.se3 import SE3
from recon4.kernels.scans import accumulate_symmetric, neighbor_normals
from recon4.model.multiframe import Multiframe
from recon4.registration.frame_view import FrameView
from recon4.registration.imu_strategy import starting_velocity
from recon4.registration.result import StopReason
from recon4.registration.scan_chain import ScanChain
from recon4.registration.scan_registration import (
    make_scan,
    overlay_plans,
    register_scans,
    search_scans,
)
from recon4.registration.tuning import ScanTuning
from tests.benchmarks.loaders import one_sensor

SCANS = ScanTuning(voxel_m=0.2)


def room(seed=1, count=12_000):
    """Points on floor, four walls and two blocks of a room of 12 m x 8 m x 3 m, none alike."""
    rng = np.random.default_rng(seed)
    u = rng.uniform(size=(count, 3)) * [12.0, 8.0, 3.0] - [4.0, 3.0, 1.5]
    kind = rng.integers(0, 7, count)
    u[kind == 0, 2] = -1.5
    u[kind == 1, 0] = -4.0
    u[kind == 2, 0] = 8.0
    u[kind == 3, 1] = -3.0
    u[kind == 4, 1] = 5.0
    block = (kind == 5) & (u[:, 1] > 3.0)
    u[kind == 5, 0] = 2.0
    u[(kind == 5) & ~block, 1] = 3.0 + rng.uniform(size=((kind == 5) & ~block).sum()) * 2.0
    u[kind == 6, 1] = -1.0
    u[kind == 6, 0] = 5.0 + rng.uniform(size=(kind == 6).sum()) * 3.0
    return u


def scan(T=None, seed=1):
    """The room, seen from a pose."""
    return make_scan((T or SE3.identity()).inverse() @ room(seed), SCANS)


def apart(T, T_true):
    error = T_true.inverse() @ T
    return float(np.linalg.norm(error.t)) + 5.0 * float(error.angle())


def test_the_normal_of_points_on_a_tilted_plane_is_the_planes():
    rng = np.random.default_rng(3)
    xy = rng.uniform(-1.0, 1.0, (40, 2))
    p = np.column_stack([xy, 0.5 * xy[:, 0]])
    normals = np.zeros_like(p)

    neighbor_normals(p, np.tile(np.arange(40), (40, 1)), normals)

    expected = np.array([-0.5, 0.0, 1.0]) / np.sqrt(1.25)
    assert np.abs(normals @ expected) == pytest.approx(1.0)


def test_points_on_a_line_have_no_normal():
    p = np.outer(np.arange(20.0), [1.0, 2.0, 0.5])
    normals = np.ones_like(p)

    neighbor_normals(p, np.tile(np.arange(20), (20, 1)), normals)

    assert not normals.any()


def test_normal_equations_of_one_match_worked_out_by_hand():
    H, g, nn = np.zeros((6, 6)), np.zeros(6), np.zeros((3, 3))
    q, p, up = np.array([[2.0, 0.0, 0.3]]), np.array([[2.5, 0.0, 0.0]]), np.array([[0.0, 0.0, 1.0]])

    # The normals point opposite ways, which must not matter: r = 0.3, w = 1 / (1 + 1).
    matches, right, weight, total, squares = accumulate_symmetric(
        q, -up, np.array([0]), p, up, np.zeros(3), 0.3, 0.1, H, g, nn
    )

    assert (matches, right) == (1, 0)
    assert (weight, total, squares) == pytest.approx((0.5, 0.15, 0.045))
    J = np.array([0.0, -2.0, 0.0, 0.0, 0.0, 1.0])
    np.testing.assert_allclose(H, 0.5 * np.outer(J, J), atol=1e-15)
    np.testing.assert_allclose(g, 0.15 * J, atol=1e-15)


def test_another_sampling_of_the_room_is_brought_onto_it():
    T_true = SE3.from_rpy(0.02, -0.03, 0.15, t=[0.4, -0.2, 0.1])

    found = register_scans(scan(), scan(T_true, seed=2), initial=SE3.identity(), settings=SCANS)

    assert found.converged
    assert apart(found.T_target_source, T_true) < 0.03


def test_exchanging_the_scans_gives_the_inverse():
    T_true = SE3.from_rpy(0.0, 0.02, 0.1, t=[0.3, 0.1, 0.0])
    a, b = scan(), scan(T_true, seed=2)

    there = register_scans(a, b, initial=SE3.identity(), settings=SCANS)
    back = register_scans(b, a, initial=SE3.identity(), settings=SCANS)

    assert apart(back.T_target_source, there.T_target_source.inverse()) < 0.02


def test_a_large_rotation_is_found_by_the_ground_plans():
    T_true = SE3.from_rpy(0.0, 0.0, 2.2, t=[2.5, 1.0, 0.0])
    a, b = scan(), scan(T_true, seed=2)

    # A room is nearly its own mirror image: without this the wrong half turn would pass as good.
    doubtful = structs.replace(SCANS, confident_inlier_ratio=0.99)

    starts = overlay_plans(a, b, count=3, height_m=0.0)
    found = search_scans(a, b, initial=SE3.identity(), settings=doubtful)

    assert min(apart(start, T_true) for start in starts) < 1.0
    assert found.converged
    assert apart(found.T_target_source, T_true) < 0.05


def test_a_flat_floor_alone_is_degenerate():
    floor = np.column_stack([np.random.default_rng(5).uniform(-5, 5, (6000, 2)), np.zeros(6000)])

    found = register_scans(
        make_scan(floor, SCANS), make_scan(floor, SCANS), initial=SE3.identity(), settings=SCANS
    )

    assert found.degeneracy < 1e-3


@pytest.mark.parametrize("count", [0, 5, 40])
def test_too_few_points_are_an_outcome(count):
    few = make_scan(room()[:count], SCANS)

    found = search_scans(scan(), few, initial=SE3.identity(), settings=SCANS)

    assert found.stop == StopReason.TOO_FEW
    assert not found.converged
    assert np.isnan(found.error_m)


def test_points_that_are_not_finite_are_skipped():
    p = room()
    p[::7] = np.nan

    assert np.isfinite(make_scan(p, SCANS).points).all()


def test_a_match_below_the_smallest_inlier_ratio_has_not_converged():
    strict = structs.replace(SCANS, min_inlier_ratio=1.01)

    found = register_scans(scan(), scan(seed=2), initial=SE3.identity(), settings=strict)

    assert found.stop == StopReason.TOO_FEW


def test_the_chain_keeps_the_last_good_scan_as_target():
    chain = ScanChain(SCANS)
    rng = np.random.default_rng(7)
    nowhere = rng.uniform(-30.0, 30.0, (4000, 3))
    T_true = SE3.from_rpy(0.0, 0.0, 0.1, t=[0.2, 0.0, 0.0])
    assert chain.locate(room(), 0) is None
    chain.keep(SE3.identity(), 0)

    lost, again = chain.locate(nowhere, 1), chain.locate(T_true.inverse() @ room(2), 200_000_000)

    assert lost is None
    assert again is not None
    assert apart(again, T_true) < 0.03
    assert chain.last[1] == 0


def turning(from_rad, to_rad, *, number):
    """A multiframe of 0.1 s of a body that turns in the room and sees each point at any time."""
    p, rng = room(number + 1), np.random.default_rng(number)
    fraction = rng.uniform(size=len(p))
    heading = from_rad + fraction * (to_rad - from_rad)
    c, s = np.cos(heading), np.sin(heading)
    xyz = np.column_stack([c * p[:, 0] + s * p[:, 1], c * p[:, 1] - s * p[:, 0], p[:, 2]])
    columns = {name: np.zeros(len(p), np.uint8) for name in ("intensity", "ring", "sensor", "echo")}
    start_ns, long_ns = number * 100_000_000, 100_000_000
    dt_ns = (fraction * long_ns).astype(np.int32)
    return Multiframe(number, start_ns, long_ns, xyz.astype(np.float32), dt_ns=dt_ns, **columns)


def heading_of_the_chain(model, ends_rad):
    """Heading that a chain of scans adds up, from the middle of the first to that of the last."""
    chain, T = ScanChain(), SE3.identity()
    for number, (from_rad, to_rad) in enumerate(pairwise(ends_rad)):
        view = FrameView(turning(from_rad, to_rad, number=number), one_sensor(model))
        T = T @ (view.locate_in(chain) or SE3.identity())
        chain.keep(T, view.frame.t_mid_ns)
    return float(T.rpy()[2])


def test_scans_of_a_rosette_are_undistorted_by_the_turn_that_they_show():
    ends_rad = [0.0, 0.0, 0.2, 0.6, 1.05, 1.5]

    as_of_a_rosette, as_measured = (
        heading_of_the_chain(m, ends_rad) for m in ("Mid-360", "VLP-16")
    )

    assert as_of_a_rosette == pytest.approx(1.275, abs=0.02)
    assert abs(as_measured - 1.275) > 0.3


def walking(*, number, m_s=1.5):
    """A multiframe of a body that walks along x, and sees what is in front first, then last."""
    frame = turning(0.0, 0.0, number=number)
    x_m = frame.xyz[:, 0]
    ahead = (x_m - x_m.min()) / np.ptp(x_m)
    fraction = ahead if number % 2 else 1.0 - ahead
    moved_m = m_s * 0.1 * (number + fraction[:, None]) * [1.0, 0.0, 0.0]
    dt_ns = (fraction * frame.duration_ns).astype(np.int32)
    return replace(frame, xyz=(frame.xyz - moved_m).astype(np.float32), dt_ns=dt_ns)


def off_at_the_start(model):
    """By how much the velocity is wrong that is found between two multiframes [m/s]."""
    found = starting_velocity(walking(number=0), walking(number=1), rig=one_sensor(model))
    return float(np.linalg.norm(found - [1.5, 0.0, 0.0]))


def test_the_first_velocity_by_a_rosette_is_that_of_undistorted_scans():
    of_a_rosette, as_measured = (off_at_the_start(model) for model in ("Mid-360", "VLP-16"))

    assert of_a_rosette < as_measured / 3


def test_a_scan_across_a_gap_is_undistorted_by_the_last_motion():
    frame, turn = turning(0.0, 0.4, number=0), SE3.from_rpy(0.0, 0.0, 0.4, t=np.zeros(3))
    still = turning(0.2, 0.2, number=0).xyz

    as_of_a_rosette, as_measured = (
        FrameView(frame, one_sensor(model)).scan(turn) for model in ("Mid-360", "VLP-16")
    )

    np.testing.assert_allclose(as_of_a_rosette, still, atol=1e-4)
    np.testing.assert_allclose(as_measured, frame.xyz, atol=1e-6)
