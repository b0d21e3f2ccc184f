"""Points moved onto the surface fitted to the returns around them."""

import numpy as np
import pytest
from msgspec import structs

from recon4.kernels.moments import MOMENTS, add_point
from recon4.kernels.surface_records import PLANE, Neighbors, Sides
from recon4.kernels.surface_windows import window_planes
from recon4.mapping import surfaces as surfaces_module
from recon4.mapping.grid import Grid
from recon4.mapping.records import RECORD, in_voxel_order, to_sensor_m
from recon4.mapping.sparse_surfaces import with_sparse_places
from recon4.mapping.surface_fit import TUNING
from recon4.mapping.surfaces import fit_surfaces
from recon4.mapping.tile_memory import TileMeans
from recon4.settings import MapSettings

GRID = Grid.of(MapSettings())
NOISE_M = 0.015
DENSITY = 80_000
"""Returns on a square meter: eight on a square centimeter."""
FRONT = np.array([2.5, 1.0, 2.2])
WALL_M = 2.033


@pytest.fixture
def rng():
    return np.random.default_rng(1)


def rectangle(rng, corner, u, v, density=DENSITY):
    u, v = np.asarray(u, float), np.asarray(v, float)
    count = rng.poisson(np.linalg.norm(np.cross(u, v)) * density)
    return np.asarray(corner) + rng.random((count, 1)) * u + rng.random((count, 1)) * v


def wall(rng, y_m, density=DENSITY):
    return rectangle(rng, [1.5, y_m, 1.5], [1.6, 0, 0], [0, 0, 1.2], density)


def returns(rng, p, sensor=FRONT, noise_m=NOISE_M):
    """Records of what a sensor measures of points, with noise along the beam."""
    to_sensor = sensor - p
    range_m = np.linalg.norm(to_sensor, axis=1, keepdims=True)
    p = p + to_sensor / range_m * rng.normal(0.0, noise_m, (len(p), 1))
    records = np.zeros(len(p), RECORD)
    records["xyz"], records["returns"] = p, 1
    records["to_sensor"] = np.rint(250.0 * (sensor - p))
    return records


def fitted(*parts):
    """Thinned records, their points before and after, and the surfaces."""
    records = in_voxel_order(np.concatenate(parts), GRID)
    raw = records["xyz"].astype(float)
    surfaces = fit_surfaces(records, GRID, noise_m=NOISE_M)
    return records, raw, raw + surfaces.shift_m, surfaces


def inside(p, margin_m=0.1):
    return (
        (p[:, 0] > 1.5 + margin_m)
        & (p[:, 0] < 3.1 - margin_m)
        & (p[:, 2] > 1.5 + margin_m)
        & (p[:, 2] < 2.7 - margin_m)
    )


def test_a_noisy_wall_becomes_flat_and_says_its_noise(rng):
    _, raw, p, surfaces = fitted(returns(rng, wall(rng, WALL_M)))

    k = inside(raw)
    before, after = (np.abs(q[k, 1] - WALL_M) for q in (raw, p))
    sigma_m, count, planarity = surfaces.facts[:, k]
    assert before.mean() > 0.011
    assert after.mean() < 0.0025
    assert (after < 0.02).mean() > 0.98
    assert 0.010 < np.nanmedian(sigma_m) < 0.016
    assert np.median(count) > 500
    assert np.median(planarity) > 0.7
    assert np.median(surfaces.normal[k, 1]) < -0.99


def test_points_move_along_the_normal_only(rng):
    _, raw, _, surfaces = fitted(returns(rng, wall(rng, WALL_M)))

    along = np.abs(surfaces.shift_m[inside(raw)])
    assert along[:, 1].max() > 0.02
    assert np.percentile(along[:, [0, 2]], 99) < 0.002


@pytest.mark.parametrize("apart_m", [0.03, 0.05, 0.08])
def test_two_sheets_seen_from_one_side_stay_two(rng, apart_m):
    near, far = wall(rng, WALL_M, DENSITY / 2), wall(rng, WALL_M + apart_m, DENSITY / 2)

    records, raw, p, _ = fitted(returns(rng, near), returns(rng, far))

    k = inside(raw)
    weight = records["returns"][k].astype(float)

    def at(q, y_m):
        return weight[np.abs(q[k, 1] - y_m) < 0.005].sum()

    for y_m in (WALL_M, WALL_M + apart_m):
        assert at(p, y_m) > 0.85 * at(raw, y_m)
    assert at(p, WALL_M + apart_m / 2) < 1.15 * at(raw, WALL_M + apart_m / 2)


@pytest.mark.parametrize("thickness_m", [0.05, 0.08])
def test_the_two_faces_of_a_partition_stay_apart(rng, thickness_m):
    back = np.array([2.5, 3.2, 2.2])

    records, raw, p, _ = fitted(
        returns(rng, wall(rng, WALL_M)),
        returns(rng, wall(rng, WALL_M + thickness_m), back),
    )

    k = inside(raw)
    behind = to_sensor_m(records)[k, 1] > 0.0
    for side, y_m in ((~behind, WALL_M), (behind, WALL_M + thickness_m)):
        assert np.median(np.abs(p[k, 1][side] - y_m)) < 0.0035


@pytest.mark.parametrize("diameter_m", [0.01, 0.02, 0.04])
@pytest.mark.parametrize("before_wall_m", [0.06, 0.3])
def test_a_wire_before_a_wall_keeps_its_length(rng, diameter_m, before_wall_m):
    count = int(1.2 * diameter_m * DENSITY)
    angle = rng.uniform(np.pi, 2 * np.pi, count)
    y_m = WALL_M - before_wall_m
    wire = np.c_[
        rng.uniform(1.7, 2.9, count),
        y_m + diameter_m / 2 * np.sin(angle),
        2.1 + diameter_m / 2 * np.cos(angle),
    ]

    _, _, p, surfaces = fitted(returns(rng, wall(rng, WALL_M)), returns(rng, wire))

    there = np.hypot(p[:, 1] - y_m, p[:, 2] - 2.1) < 0.02 + diameter_m / 2
    pieces = np.unique(np.floor((p[there & ~surfaces.stray, 0] - 1.7) / 0.03).astype(int))
    assert len(set(pieces) & set(range(40))) >= 0.95 * 40


def test_a_convex_corner_stays_sharp(rng):
    corner = 1.533
    front = rectangle(rng, [corner, WALL_M, 1.5], [0.9, 0, 0], [0, 0, 1.0])
    left = rectangle(rng, [corner, WALL_M, 1.5], [0, 0.8, 0], [0, 0, 1.0])
    sensor = np.array([0.7, 0.9, 2.2])

    _, raw, p, _ = fitted(returns(rng, front, sensor), returns(rng, left, sensor))

    def distance(q):
        on_front = np.hypot(np.maximum(corner - q[:, 0], 0.0), q[:, 1] - WALL_M)
        on_left = np.hypot(q[:, 0] - corner, np.maximum(WALL_M - q[:, 1], 0.0))
        return np.minimum(on_front, on_left)

    middle = (raw[:, 2] > 1.6) & (raw[:, 2] < 2.4)
    edge = middle & (np.hypot(raw[:, 0] - corner, raw[:, 1] - WALL_M) < 0.05)
    assert np.median(distance(p[edge])) < 0.005
    assert np.mean(distance(p[edge])) < 0.6 * np.mean(distance(raw[edge]))


@pytest.mark.parametrize("edge_m", [2.28, 2.33])
def test_a_narrow_reveal_is_not_drawn_onto_the_plane_of_its_wall(rng, edge_m):
    """The reveal of a doorway in a wall of 8 cm; no window holds it without both faces."""
    depth_m = 0.08
    faces = [
        returns(rng, rectangle(rng, [1.5, y_m, 1.5], [edge_m - 1.5, 0, 0], [0, 0, 1.2]), sensor)
        for y_m, sensor in ((WALL_M, FRONT), (WALL_M + depth_m, np.array([2.5, 3.2, 2.2])))
    ]
    reveal = rectangle(rng, [edge_m, WALL_M, 1.5], [0, depth_m, 0], [0, 0, 1.2])

    _, raw, p, _ = fitted(*faces, returns(rng, reveal, np.array([3.1, 1.8, 2.1])))

    def in_doorway(q):
        """Returns on the plane of the wall, beyond its end."""
        on_plane = np.abs(q[:, 1] - WALL_M) < 0.005
        beyond = (q[:, 0] > edge_m + 0.01) & (q[:, 0] < edge_m + 0.05)
        return (on_plane & beyond & (np.abs(q[:, 2] - 2.1) < 0.4)).sum()

    assert in_doorway(raw) > 50
    assert in_doorway(p) < 1.5 * in_doorway(raw)


@pytest.mark.parametrize(("returns_beside", "is_plane"), [(500, True), (5000, False)])
def test_few_of_the_returns_of_a_window_are_no_plane(rng, returns_beside, is_plane):
    """A cell with thirty returns on a plane, beside a cell of a wall across it."""
    patch = rng.random((30, 3)) * [0.002, 0.05, 0.05]
    beside = rng.random((returns_beside, 3)) * [0.05, -0.002, 0.05]
    moments, views = np.zeros((2, 2, MOMENTS)), np.zeros((2, 2, 4))
    normals = np.array([[1.0, 0.0, 0.0], [0.0, 1.0, 0.0]])
    for c, points in enumerate((patch, beside)):
        for p in points:
            add_point.py_func(moments[c, 0], 1.0, *p)
        views[c, 0] = [*(len(points) * normals[c]), len(points)]
    planes, calm = np.zeros((2, 2, PLANE.numbers)), np.zeros(2, np.bool_)
    neighbors = Neighbors(
        np.array([0, 2, 4], np.int32),
        np.array([0, 1, 0, 1], np.int32),
        np.array([13, 10, 16, 13], np.uint8),
    )
    limits = TUNING.window(TUNING.strict, 0.05, NOISE_M)._replace(min_along_m=0.01)
    sides = Sides(normals, moments, views)

    window_planes(neighbors, sides, 0.5, limits, np.ones(2, np.bool_), planes, calm)

    assert (planes[0, 0, PLANE.sigma] > 0.0) == is_plane
    assert planes[1, 0, PLANE.sigma] > 0.0


def test_a_few_returns_before_a_wall_are_strays_and_keep_their_place(rng):
    loose = np.array([[2.2, WALL_M - 0.075, 2.0], [2.6, WALL_M - 0.07, 2.3]])

    _, raw, _, surfaces = fitted(returns(rng, wall(rng, WALL_M)), returns(rng, loose, noise_m=0.0))

    for p in loose:
        row = np.argmin(np.linalg.norm(raw - p, axis=1))
        assert surfaces.stray[row]
        assert not surfaces.shift_m[row].any()
    assert surfaces.stray.mean() < 0.02


@pytest.mark.parametrize(("sensor", "are_strays"), [(FRONT, False), ([2.5, -0.5, 2.2], True)])
def test_many_returns_before_a_wall_are_strays_only_when_measured_from_afar(
    rng, sensor, are_strays
):
    loose = rectangle(rng, [2.0, WALL_M - 0.083, 1.8], [0.5, 0, 0], [0, 0, 0.5], 0.04 * DENSITY)
    loose[:, 1] += rng.uniform(0.0, 0.023, len(loose))  # no second surface

    _, raw, _, surfaces = fitted(
        returns(rng, wall(rng, WALL_M)), returns(rng, loose, np.array(sensor), noise_m=0.0)
    )

    x, y, z = raw.T
    before = (y < WALL_M - 0.0601) & (abs(x - 2.25) < 0.15) & (abs(z - 2.05) < 0.15)
    assert before.sum() > 50
    assert surfaces.stray[before].mean() == pytest.approx(float(are_strays), abs=0.1)


def test_lines_and_single_points_have_no_surface(rng):
    line = np.c_[np.linspace(1.0, 2.0, 400), np.full(400, 2.0), np.full(400, 2.0)]

    _, _, _, surfaces = fitted(returns(rng, line, noise_m=0.002))

    assert not surfaces.shift_m.any()
    assert np.isnan(surfaces.facts[0]).all()
    assert not surfaces.facts[1:].any()


def test_the_same_points_give_the_same_bytes(rng):
    parts = returns(rng, wall(rng, WALL_M))

    first, second = (fitted(parts)[3] for _ in range(2))

    assert first.shift_m.tobytes() == second.shift_m.tobytes()
    assert first.facts.tobytes() == second.facts.tobytes()


def test_a_wall_fitted_in_parts_is_that_fitted_at_once(rng, monkeypatch):
    across = rectangle(rng, [2.033, 1.5, 1.5], [0, 1.6, 0], [0, 0, 1.2])
    records = in_voxel_order(returns(rng, across, np.array([1.0, 2.3, 2.2])), GRID)
    whole = fit_surfaces(records, GRID, noise_m=NOISE_M)
    slabs = structs.replace(surfaces_module.TILE_SURFACES, slab=len(records) // 6)
    monkeypatch.setattr(surfaces_module, "TILE_SURFACES", slabs)

    parts = fit_surfaces(records, GRID, noise_m=NOISE_M)

    apart = np.linalg.norm(parts.shift_m - whole.shift_m, axis=1)
    assert (apart < 0.0005).mean() > 0.97
    assert (parts.support == whole.support).all()
    assert (parts.stray == whole.stray).mean() > 0.999
    np.testing.assert_allclose(
        (parts.normal * whole.normal).sum(axis=1)[inside(records["xyz"][:, [1, 0, 2]])],
        1.0,
        atol=0.02,
    )


@pytest.mark.parametrize("together", [0.5, 100.0])
def test_only_small_parts_of_a_wall_are_fitted_side_by_side(rng, monkeypatch, together):
    across = rectangle(rng, [2.033, 1.5, 1.5], [0, 1.6, 0], [0, 0, 1.2], DENSITY / 4)
    records = in_voxel_order(returns(rng, across, np.array([1.0, 2.3, 2.2])), GRID)
    n, tuning = len(records), surfaces_module.TILE_SURFACES
    slabs = structs.replace(tuning, slab=n // 4, together=int(together * n))
    monkeypatch.setattr(surfaces_module, "TILE_SURFACES", slabs)
    shared = []

    def each(work, items):
        shared.append(items)
        return map(work, items)

    parts = fit_surfaces(records, GRID, noise_m=NOISE_M, means=TileMeans(None, each))

    assert len(shared) == (together > 1.0)
    assert parts.surface_of.any()


@pytest.mark.parametrize("parts", [1, 6])
def test_what_moves_changes_no_surface_and_has_none(rng, monkeypatch, parts):
    across = rectangle(rng, [2.033, 1.5, 1.5], [0, 1.6, 0], [0, 0, 1.2], DENSITY / 4)
    records = in_voxel_order(returns(rng, across, np.array([1.0, 2.3, 2.2])), GRID)
    stands = rng.random(len(records)) > 0.2
    slabs = structs.replace(surfaces_module.TILE_SURFACES, slab=len(records) // parts)
    monkeypatch.setattr(surfaces_module, "TILE_SURFACES", slabs)

    among = fit_surfaces(records, GRID, noise_m=NOISE_M, stands=stands)
    alone = fit_surfaces(records[stands], GRID, noise_m=NOISE_M)

    for name in ("shift_m", "support", "stray", "normal", "on_surface"):
        of_all = getattr(among, name)
        np.testing.assert_array_equal(of_all[stands], getattr(alone, name))
        assert not of_all[~stands].any()


def test_a_sparse_wall_becomes_flat_at_the_larger_scale(rng):
    records = in_voxel_order(returns(rng, wall(rng, WALL_M, 120)), GRID)
    before = fit_surfaces(records, GRID, noise_m=NOISE_M)
    assert not before.shift_m.any()

    after = with_sparse_places(records, before, grid=GRID, noise_m=NOISE_M)

    raw = records["xyz"].astype(float)
    k = inside(raw)
    measured, fitted_m = (np.abs(p[k, 1] - WALL_M) for p in (raw, raw + after.shift_m))
    assert fitted_m.mean() < 0.5 * measured.mean()
    assert np.median(after.facts[1, k]) > 12


def test_two_sparse_sheets_stay_two(rng):
    sheets = [returns(rng, wall(rng, y_m, 120)) for y_m in (WALL_M, WALL_M + 0.08)]
    floor = rectangle(rng, [0.5, 0.2, 0.433], [4, 0, 0], [0, 1.6, 0], 120)
    records = in_voxel_order(np.concatenate([*sheets, returns(rng, floor)]), GRID)

    after = with_sparse_places(
        records, fit_surfaces(records, GRID, noise_m=NOISE_M), grid=GRID, noise_m=NOISE_M
    )

    y = (records["xyz"] + after.shift_m)[inside(records["xyz"].astype(float)), 1]
    assert (np.abs(y - WALL_M - 0.04) < 0.015).mean() < 0.1
