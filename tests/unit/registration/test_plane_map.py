import numpy as np
import pytest
from msgspec import structs

from recon4.geometry.se3 import SE3, so3_exp
from recon4.registration.plane_map import PlaneMap
from recon4.registration.tuning import PlaneTuning

SETTINGS = PlaneTuning()
ORIGIN = np.zeros(3)


def patch(normal, offset_m, *, count=4000, extent_m=2.0, noise_m=0.0, seed=1):
    """Random points of a plane ``n . p = offset`` around the point nearest the origin."""
    rng = np.random.default_rng(seed)
    n = np.asarray(normal, float) / np.linalg.norm(normal)
    u = np.cross(n, [0.31, 0.82, -0.48])
    u /= np.linalg.norm(u)
    v = np.cross(n, u)
    s = rng.uniform(-extent_m, extent_m, (count, 2))
    return s[:, :1] * u + s[:, 1:] * v + (offset_m + noise_m * rng.normal(size=(count, 1))) * n


def made_of(*points):
    planes = PlaneMap(SETTINGS)
    for p in points:
        planes.add(np.ascontiguousarray(p))
    return planes


def hold(planes, p, *, fraction=None, center=ORIGIN, finest=0, gate_m=0.5):
    fraction = np.zeros(len(p)) if fraction is None else fraction
    return planes.match(
        np.ascontiguousarray(p), fraction, center=center, finest=finest, gate_m=gate_m
    )


@pytest.mark.parametrize("normal", [(0, 0, 1), (1, 0, 0), (0.3, -0.5, 0.8)])
def test_distance_from_an_exact_plane(normal):
    n = np.asarray(normal, float) / np.linalg.norm(normal)
    planes = made_of(patch(normal, 0.05))
    asked = patch(normal, 0.05, count=300, extent_m=1.0, seed=2) + 0.03 * n

    match = hold(planes, asked)

    found = np.isfinite(match.residual_m)
    assert found.mean() > 0.9
    np.testing.assert_allclose(np.abs(match.residual_m[found]), 0.03, atol=1e-6)
    assert match.mean_m == pytest.approx(0.03, abs=1e-6)
    assert match.match_ratio == found.mean()


def test_the_normal_equations_move_the_points_onto_the_plane():
    planes = made_of(patch((0, 0, 1), 0.05))
    asked = patch((0, 0, 1), 0.02, count=300, extent_m=1.0, seed=2)

    match = hold(planes, asked)
    H, g = match.H[:6, :6], match.g[:6]

    # Only height and the two tilts are held; the least-norm step is 3 cm up.
    np.testing.assert_allclose(-np.linalg.pinv(H, rcond=1e-9) @ g, [0, 0, 0, 0, 0, 0.03], atol=1e-6)
    assert np.linalg.matrix_rank(H, tol=1e-6 * np.trace(H)) == 3


def test_normal_equations_are_those_of_a_numerical_derivative():
    rng = np.random.default_rng(3)
    planes = made_of(patch((0, 0, 1), 0.05, noise_m=0.003), patch((1, 0.2, 0), 1.1, noise_m=0.003))
    asked = np.concatenate(
        [patch((0, 0, 1), 0.06, count=200, seed=4), patch((1, 0.2, 0), 1.11, count=200, seed=5)]
    )
    s = rng.uniform(0, 1, len(asked))
    center = np.array([0.4, -0.2, 0.1])
    before = hold(planes, asked, fraction=s, center=center)
    J = np.zeros((len(asked), 12))
    h = 1e-6
    for k in range(12):
        d = h * np.eye(12)[k]
        omega = (1 - s)[:, None] * d[:3] + s[:, None] * d[6:9]
        shift = (1 - s)[:, None] * d[3:6] + s[:, None] * d[9:]
        turned = np.einsum("nij,nj->ni", so3_exp(omega), asked - center)
        after = hold(planes, center + turned + shift, fraction=s, center=center)
        J[:, k] = (after.residual_m - before.residual_m) / h
    found = np.isfinite(before.residual_m) & (np.abs(J).max(axis=1) < 100)
    J, r = J[found], before.residual_m[found]

    # Whatever the weights are, the gradient is J^T (w r): solve for w and see it is one a point.
    weights = 1 / (1 + (r / SETTINGS.kernel_m) ** 2) / SETTINGS.point_sd_m**2
    np.testing.assert_allclose(before.H, J.T @ (weights[:, None] * J), rtol=0.05, atol=2e3)
    np.testing.assert_allclose(before.g, J.T @ (weights * r), rtol=0.05, atol=30)
    np.testing.assert_allclose(before.H, before.H.T)


def test_removing_points_restores_the_map():
    first, second = patch((0, 0, 1), 0.05), patch((0, 0.2, 1), 0.3, seed=7)
    asked = patch((0, 0, 1), 0.06, count=500, seed=2)
    planes = made_of(first)
    before = hold(planes, asked)

    planes.add(second)
    disturbed = hold(planes, asked)
    planes.remove(second)
    after = hold(planes, asked)

    assert disturbed.matches != before.matches or disturbed.mean_m != before.mean_m
    assert after.matches == before.matches
    np.testing.assert_allclose(after.residual_m, before.residual_m, atol=1e-9)


@pytest.mark.parametrize("level", [0, 2])
def test_what_is_added_cube_by_cube_is_in_all_sizes_of_cubes(level):
    points = patch((0.2, 0.4, 1), 0.05, noise_m=0.01)
    asked = patch((0.2, 0.4, 1), 0.06, count=500, extent_m=1.0, seed=2)
    in_runs = points[np.lexsort(np.floor(points / SETTINGS.finest_m).T)]
    only = structs.replace(SETTINGS, finest_m=SETTINGS.finest_m * 2**level, levels=1)
    of_one_size = PlaneMap(only)
    of_one_size.add(points)

    found, expected = hold(made_of(in_runs), asked, finest=level), hold(of_one_size, asked)

    there = np.isfinite(expected.residual_m)
    assert there.mean() > 0.5
    np.testing.assert_allclose(found.residual_m[there], expected.residual_m[there], atol=1e-11)


def test_an_emptied_map_matches_nothing():
    points = patch((0, 0, 1), 0.05)
    planes = made_of(points)

    planes.remove(points)
    removed = hold(planes, points)
    planes.add(points)
    planes.clear()
    cleared = hold(planes, points)

    assert removed.matches == cleared.matches == 0
    assert np.isnan(removed.mean_m)
    assert removed.degeneracy == 0.0


def test_growing_keeps_everything():
    # Far more cubes than the first tables hold.
    rng = np.random.default_rng(5)
    floor = np.concatenate([rng.uniform(-40, 40, (300_000, 2)), np.full((300_000, 1), 0.1)], axis=1)
    early = patch((0, 0, 1), 0.05) + np.array([90.0, 0.0, 0.0])
    few, all_at_once = made_of(early), made_of(early)
    all_at_once.add(floor)
    for part in np.array_split(floor, 7):
        few.add(np.ascontiguousarray(part))
    asked = floor[::100] + np.array([0.0, 0.0, 0.02])

    one, other = hold(all_at_once, asked), hold(few, asked)

    # What was there before the tables grew is still there.
    assert hold(all_at_once, early).match_ratio > 0.9
    assert one.match_ratio > 0.99
    np.testing.assert_array_equal(one.residual_m, other.residual_m)
    np.testing.assert_allclose(one.residual_m[np.isfinite(one.residual_m)], 0.02, atol=1e-6)


def test_a_cube_with_one_point_outlives_the_growing_of_the_tables():
    few = 0.02 + 0.16 * np.random.default_rng(3).random((SETTINGS.min_points, 3))
    few[:, 2] = 0.1
    floor = np.random.default_rng(5).uniform([160, -40, -40], [240, 40, 40], (60_000, 3))

    planes = made_of(few[:1], floor, few[1:])

    assert hold(planes, few).match_ratio == 1.0


def test_a_map_that_moves_along_for_long_does_not_fill_up():
    rng = np.random.default_rng(5)
    planes = PlaneMap(SETTINGS)
    for k in range(12):
        here = rng.uniform(-30, 30, (8000, 3)) * [1.0, 1.0, 0.01] + [100.0 * k, 0.0, 0.0]
        planes.add(here)
        planes.remove(here)

    assert len(planes._keys) <= 1 << 17


def test_what_is_left_behind_gives_its_rows_to_what_comes():
    near = patch((0, 0, 1), 0.05)
    far = near + np.array([60.0, 0.0, 0.0])
    new = patch((1, 0, 0), 0.07, seed=4) + np.array([5.0, 0.0, 0.0])
    moved, fresh = made_of(far, near), made_of(near)

    moved.forget_beyond(20.0, ORIGIN)
    assert len(moved) == len(fresh)
    for planes in (moved, fresh):
        planes.add(new)

    for asked in (near, new):
        expected = hold(fresh, asked)
        assert expected.match_ratio > 0.9
        np.testing.assert_array_equal(hold(moved, asked).residual_m, expected.residual_m)
    assert hold(moved, far).matches == 0


def test_a_cube_takes_its_own_row_and_no_free_ones():
    rng = np.random.default_rng(5)
    planes = made_of(rng.uniform(-60, 60, (40_000, 3)))
    arrays = [value for value in vars(planes).values() if isinstance(value, np.ndarray)]

    # A row of sums, fits and state has 201 bytes; a slot that finds it 12, of which half are free.
    assert len(planes) > 100_000
    assert sum(array.nbytes for array in arrays) <= 115 * len(planes._keys)


def test_the_variance_of_a_plane_grows_with_the_distance_from_its_center():
    # Few points, noisy, of a sensor that says it is exact: the plane's own error counts.
    rng = np.random.default_rng(4)
    p = np.column_stack([rng.uniform(0.0, 0.2, (12, 2)), rng.normal(0.1, 0.006, 12)])
    sure = structs.replace(SETTINGS, point_sd_m=1e-4)
    planes = PlaneMap(sure)
    planes.add(p)
    across, along, _ = np.linalg.eigvalsh(np.cov(p.T, bias=True))
    n = np.linalg.eigh(np.cov(p.T, bias=True))[1][:, 0]
    center = p.mean(axis=0)
    u = np.cross(n, [0.0, 1.0, 0.0])
    at_edge = center + 0.08 * u / np.linalg.norm(u)

    near, far = (float(np.trace(hold(planes, q[None]).H[3:6, 3:6])) for q in (center, at_edge))

    variance = across / 12
    grown = 1e-8 + variance * (1.0 + 0.08**2 / along)
    assert near / far == pytest.approx(grown / (1e-8 + variance), rel=1e-6)


def test_points_beyond_the_gate_do_not_match():
    planes = made_of(patch((0, 0, 1), 0.05))
    asked = patch((0, 0, 1), 0.15, count=300, extent_m=1.0, seed=2)

    assert hold(planes, asked, gate_m=0.11).match_ratio > 0.9
    assert hold(planes, asked, gate_m=0.09).matches == 0


def test_a_thin_wall_seen_from_its_other_side_does_not_match():
    face, other_face = patch((1, 0, 0), 3.0), patch((1, 0, 0), 3.12, seed=2)
    planes = PlaneMap(SETTINGS)
    planes.add(face, ORIGIN)

    before = hold(planes, other_face, center=np.array([2.0, 1.0, 0.0]))
    behind = hold(planes, other_face, center=np.array([5.0, 1.0, 0.0]))
    in_the_door = hold(planes, face, center=np.array([3.1, 4.0, 0.0]))

    assert before.match_ratio > 0.9
    assert behind.matches == 0
    assert in_the_door.match_ratio > 0.9


def test_removing_points_removes_their_view():
    face = patch((1, 0, 0), 3.0)
    planes = PlaneMap(SETTINGS)
    planes.add(face, ORIGIN)
    planes.add(face, np.array([9.0, 0.0, 0.0]))
    planes.remove(face, ORIGIN)

    assert hold(planes, face, center=np.array([8.0, 0.0, 0.0])).match_ratio > 0.9
    assert hold(planes, face, center=ORIGIN).matches == 0


def test_too_few_points_or_a_heap_make_no_plane():
    rng = np.random.default_rng(6)
    few = rng.uniform(0, 0.19, (SETTINGS.min_points - 1, 3)) * [1, 1, 0]
    heap = rng.uniform(10.0, 11.6, (20_000, 3))

    planes = made_of(few, heap)

    assert hold(planes, few).matches == 0
    assert hold(planes, heap).matches == 0


def test_a_line_is_no_plane():
    line = np.zeros((1000, 3))
    line[:, 0] = np.linspace(-1, 1, 1000)

    assert hold(made_of(line), line).matches == 0


def room_points(half_m, sides, count=3000):
    """Points of the given sides (axis, sign) of a box."""
    rng = np.random.default_rng(8)
    out = []
    for axis, sign in sides:
        p = rng.uniform(-1, 1, (count, 3)) * half_m
        p[:, axis] = sign * half_m[axis]
        out.append(p)
    return np.concatenate(out)


def test_all_directions_are_observable_in_a_room_and_one_is_not_in_a_tunnel():
    half = np.array([1.9, 1.9, 1.9])
    every = [(axis, sign) for axis in range(3) for sign in (-1, 1)]
    room = room_points(half, every)
    tunnel = room_points(np.array([8.0, 1.9, 1.9]), [side for side in every if side[0] != 0], 9000)

    assert hold(made_of(room), room).degeneracy == pytest.approx(1 / 3, abs=0.01)
    assert hold(made_of(tunnel), tunnel).degeneracy == pytest.approx(0.0, abs=0.005)


def test_points_at_the_end_of_a_frame_affect_the_end_pose_only():
    planes = made_of(patch((0, 0, 1), 0.05))
    asked = patch((0, 0, 1), 0.06, count=100, seed=2)

    at_end = hold(planes, asked, fraction=np.ones(100))

    assert not at_end.H[:6].any()
    assert not at_end.g[:6].any()
    assert at_end.H[11, 11] > 0


def test_fitting_all_at_once_changes_nothing():
    points = patch((0.3, -0.5, 0.8), 0.05, noise_m=0.01)
    lazy, eager = made_of(points), made_of(points)
    eager.fit()

    np.testing.assert_array_equal(hold(lazy, points).residual_m, hold(eager, points).residual_m)


def test_a_map_of_a_moved_world_gives_nearly_the_same_distances():
    points, asked = patch((0, 0, 1), 0.05), patch((0, 0, 1), 0.08, count=500, seed=2)
    T = SE3.from_rpy(0.4, 0.3, 1.0, t=[30.0, -20.0, 3.0])

    moved = hold(made_of(T @ points), T @ asked, center=T.t)

    assert moved.match_ratio > 0.8
    assert moved.mean_m == pytest.approx(0.03, abs=1e-6)


def test_the_weak_direction_of_a_corridor_is_along_it():
    rng = np.random.default_rng(3)
    x, z = rng.uniform(-8.0, 8.0, 6000), rng.uniform(0.0, 2.5, 6000)
    y = np.where(np.arange(6000) % 2, -0.9, 0.9)
    floor = np.column_stack([x, rng.uniform(-0.9, 0.9, 6000), 0 * x])
    points = np.concatenate([np.column_stack([x, y, z]), floor])
    points += rng.normal(0.0, 0.002, points.shape)
    planes = PlaneMap(SETTINGS)
    planes.add(points)

    found = planes.match(points, np.ones(len(points)), center=np.zeros(3), finest=0, gate_m=0.3)

    assert found.degeneracy < 0.01
    assert abs(found.weak_direction) == pytest.approx([1.0, 0.0, 0.0], abs=0.05)


def test_without_a_match_the_weak_direction_is_unknown():
    found = PlaneMap(SETTINGS).match(
        np.zeros((3, 3)), np.ones(3), center=np.zeros(3), finest=0, gate_m=0.3
    )

    assert np.isnan(found.weak_direction).all()


def test_the_sums_are_those_of_one_point_after_the_other_to_the_last_bit():
    planes = made_of(patch((0, 0, 1), 0.05, noise_m=0.01), patch((1, 0, 0.3), 0.4, seed=3))
    asked = patch((0.1, 0, 1), 0.03, count=150, extent_m=1.0, seed=2)
    fraction = np.random.default_rng(4).choice([0.0, 0.3, 0.7, 1.0], len(asked))
    summed = {"H": np.zeros((12, 12)), "g": np.zeros(12), "normals": np.zeros((3, 3))}

    together = hold(planes, asked, fraction=fraction)
    for p, s in zip(asked, fraction, strict=True):
        one = hold(planes, p[None], fraction=np.array([s]))
        summed = {name: values + getattr(one, name) for name, values in summed.items()}

    assert 100 < together.matches < 150
    assert np.array_equal(together.H, summed["H"])
    assert np.array_equal(together.g, summed["g"])
    assert np.array_equal(together.normals, summed["normals"] / together.matches)
