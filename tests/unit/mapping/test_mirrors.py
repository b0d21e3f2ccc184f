"""Mirrors that double a room, found in what a LiDAR maps of it."""

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from recon4.findings.walk_record import WalkRecord
from recon4.findings.witnesses.placing import Mirrors
from recon4.geometry.tuning import SURFACES
from recon4.mapping.mirrors import Sight, find_mirrors, load_mirrors, save_mirrors
from recon4.mapping.small_mirrors import find_small_mirrors
from recon4.model.figures import LevelFigures
from recon4.recording.packets.velodyne.models import MODELS
from recon4.simulation.setup import SimulationSetup, prepare
from recon4.simulation.world import World
from recon4.simulation.worlds import build_world
from recon4.simulation.worlds.showroom import ShowroomPlan
from tests.said import texts

EVERY_S = 1.0
PACKETS = 76
"""Of one revolution."""


def sights(setup: SimulationSetup) -> Sight:
    """What the LiDARs see on a walk, a revolution now and then, at its true place."""
    points, origins = [], []
    for row, lidar in enumerate(setup.lidars):
        for begin_s in np.arange(0.3, setup.walk.seconds - 0.3, EVERY_S):
            first = lidar.packets_before(int(begin_s * 1e9))
            rng = setup.rng(9, row, first)
            packets = range(first, first + PACKETS)
            shots = lidar.fire(packets, setup.walk, setup.surroundings, rng=rng)
            hit = np.flatnonzero(shots.distance.ravel() > 0)[row::7]
            up = np.broadcast_to(MODELS["VLP-16"].elevation_rad, shots.distance.shape).ravel()[hit]
            azimuth = shots.turn_rad.ravel()[hit]
            away = 0.002 * shots.distance.ravel()[hit, None]
            flat = np.cos(up)
            along = np.stack([flat * np.cos(azimuth), -flat * np.sin(azimuth), np.sin(up)], axis=1)
            T_map_body = setup.walk.poses(1e-9 * shots.t_ns.ravel()[hit])
            mount = lidar.sensor.T_body_sensor
            for p_sensor, into in ((away * along, points), (0.0 * along, origins)):
                p_body = mount @ p_sensor
                into.append(np.einsum("nij,nj->ni", T_map_body.R, p_body) + T_map_body.t)
    return Sight(np.concatenate(points), np.concatenate(origins))


def without_mirrors(world: World) -> World:
    """The same room with boards in place of the mirrors."""
    value = np.where(world.mesh.reflectivity <= SURFACES.mirror, 0.5, world.mesh.reflectivity)
    mesh = replace(world.mesh, reflectivity=value.astype(np.float32))
    return replace(world, mesh=mesh)


@pytest.mark.parametrize("world", ["mirrors", "mirrors:2"])
def test_a_mirror_is_found_with_its_place_and_size(world: str, tmp_path: Path) -> None:
    setup = prepare(world, seconds=20.0, seed=1)
    mesh = setup.world.mesh
    glass = mesh.vertices_m[mesh.triangles[mesh.reflectivity <= SURFACES.mirror]].reshape(-1, 3)
    glass = glass[glass[:, 1] < 0.2]
    area_m2 = np.ptp(glass[:, 0]) * np.ptp(glass[:, 2])

    seen = sights(setup)
    mirrors = find_mirrors(seen)

    found = [mirror.figures for mirror in mirrors]
    assert len(found) >= 1
    x, y = found[0].middle_m
    assert glass[:, 0].min() < x < glass[:, 0].max()
    assert y == pytest.approx(0.08, abs=0.15)
    assert 0.4 * area_m2 < found[0].area_m2 < 1.3 * area_m2
    assert 0.02 < found[0].behind < 0.6
    level = LevelFigures(leveled_by="imu", tilt_deg=0.0, crs="", local="", mirrors=tuple(found))
    reflected = mirrors[0].reflects(seen)
    y_m = seen.point_m[:, 1]
    assert y_m[reflected].max() < 0.05
    assert reflected[y_m < -0.15].mean() > 0.9
    save_mirrors(tmp_path / "mirrors.npz", mirrors)
    again = load_mirrors(tmp_path / "mirrors.npz")
    assert [mirror.figures for mirror in again] == found
    np.testing.assert_array_equal(again[0].reflects(seen), reflected)
    said = texts(Mirrors().check(WalkRecord(level=level)))
    assert len(said) == len(found) and all("doubles the room" in text for text in said)


def test_the_same_room_without_the_mirror_has_none() -> None:
    room = without_mirrors(build_world("mirrors"))

    assert find_mirrors(sights(prepare(room, seconds=20.0, seed=1))) == []


def test_a_mirror_that_hangs_before_its_wall_has_its_own_plane() -> None:
    plan = ShowroomPlan()

    (mirror,) = find_mirrors(sights(prepare("showroom", seconds=20.0, seed=1)))

    np.testing.assert_allclose(mirror.wall.normal, [0.0, -1.0, 0.0], atol=0.002)
    assert -mirror.wall.offset_m == pytest.approx(plan.depth_m - 0.04, abs=0.015)


# The middle of the well lies 13 cm before a rail of the storeys: seed 1 sees most of it.
@pytest.mark.parametrize(("world", "seed"), [("office", 2), ("storeys", 1), ("garage", 2)])
def test_rooms_with_doors_and_windows_have_none(world: str, seed: int) -> None:
    assert find_mirrors(sights(prepare(world, seconds=20.0, seed=seed))) == []


def test_columns_clad_with_mirrors_are_found_with_their_planes() -> None:
    setup = prepare("mirrors", seconds=20.0, seed=1)
    seen = sights(setup)
    mesh = setup.world.mesh
    faces = mesh.vertices_m[mesh.triangles[mesh.reflectivity <= SURFACES.mirror]]

    small = find_small_mirrors(seen, find_mirrors(seen))

    assert small
    for mirror in small:
        off_m = np.abs(faces @ mirror.wall.normal - mirror.wall.offset_m).max(axis=1)
        face = faces[off_m < 0.04].reshape(-1, 3)
        assert face[:, 1].min() > 3.0
        on_m = mirror.wall.on(face)
        edges = np.stack([mirror.cells.min(axis=0), mirror.cells.max(axis=0) + 1]) * mirror.grid_m
        assert (edges[0] > on_m.min(axis=0) - 0.1).all()
        assert (edges[1] < on_m.max(axis=0) + 0.1).all()
        assert mirror.figures.behind > 0.002


@pytest.mark.parametrize("world", ["mirrors", "office", "garage"])
def test_rooms_without_mirrors_have_no_small_one(world: str) -> None:
    room = without_mirrors(build_world(world))

    assert find_small_mirrors(sights(prepare(room, seconds=20.0, seed=1)), []) == []


def test_a_map_without_points_has_none() -> None:
    nothing = Sight(np.empty((0, 3)), np.empty((0, 3)))

    assert find_mirrors(nothing) == []
    assert find_small_mirrors(nothing, []) == []


def test_evenly_spaced_boards_have_none() -> None:
    """Seen from one side, the plane of a row maps the row behind it onto the one before it."""
    rows_m, period_m, width_m = (0.0, 3.0, 6.0), 2.0, 1.2
    y, z = np.meshgrid(np.linspace(-0.45, 0.45, 240), np.linspace(-0.14, 0.14, 70))
    direction = np.stack([np.ones(y.size), y.ravel(), z.ravel()], axis=1)
    points, origins = [], []
    for y0 in np.arange(-6.0, 6.0, 0.45):
        origin = np.array([-5.0, y0, 1.5])
        seen = np.zeros(len(direction), bool)
        for x in rows_m:
            p = origin + (x - origin[0]) * direction
            hit = ~seen & (np.mod(p[:, 1], period_m) < width_m)
            seen |= hit
            points.append(p[hit])
            origins.append(np.tile(origin, (int(hit.sum()), 1)))

    assert find_mirrors(Sight(np.concatenate(points), np.concatenate(origins))) == []


def like_rooms(origins_x, *, half_m=1.2, board_m=-9.0):
    """Two rooms of 4 m, one the mirror image of the other, with an opening of 2.4 m between them,
    seen from places with these x. Behind it a board, 1 m away, ends at ``board_m``."""
    rng = np.random.default_rng(3)
    points, origins = [], []
    for x0 in origins_x:
        for y0 in np.linspace(-2.0, 2.0, 8):
            origin = np.array([x0, y0, 1.3])
            d = rng.normal(size=(6000, 3))
            d /= np.linalg.norm(d, axis=1, keepdims=True)
            side = np.sign(x0)
            first = _reach(origin, d, (-4.0, 0.0) if side < 0 else (0.0, 4.0))
            at = origin + first[:, None] * d
            through = (np.abs(at[:, 0]) < 1e-6) & (np.abs(at[:, 1]) < half_m) & (at[:, 2] < 2.4)
            reach = np.where(through, _reach(origin, d, (-4.0, 4.0)), first)
            board = (1.0 - origin[0]) / d[:, 0]
            hit = through & (side < 0) & ((origin + board[:, None] * d)[:, 1] < board_m)
            reach = np.where(hit, board, reach)
            noisy = reach + rng.normal(0.0, 0.01, len(reach))
            points.append(origin + noisy[:, None] * d)
            origins.append(np.tile(origin, (len(d), 1)))
    return Sight(np.concatenate(points), np.concatenate(origins))


def _reach(origin, d, between):
    """Distance to the walls of a box, x within ``between``, from inside it, (N,)."""
    low, high = np.array([between[0], -3.0, 0.0]), np.array([between[1], 3.0, 2.6])
    with np.errstate(divide="ignore"):
        return np.where(d > 0, (high - origin) / d, (low - origin) / d).min(axis=1)


def test_a_like_room_is_no_reflection_once_it_was_entered() -> None:
    (doubtful,) = find_mirrors(like_rooms((-3.0, -2.0, -1.0)))

    assert doubtful.figures.middle_m[0] == pytest.approx(0.0, abs=0.1)
    assert find_mirrors(like_rooms((-3.0, -2.0, -1.0, 1.0, 2.0, 3.0))) == []


def test_an_opening_of_which_a_part_shows_something_else_is_no_mirror():
    assert find_mirrors(like_rooms((-3.0, -2.0, -1.0), half_m=2.4, board_m=-1.5)) == []


def test_an_opening_to_a_like_room_is_no_small_mirror():
    assert find_small_mirrors(like_rooms((-3.0, -2.0, -1.0), half_m=0.5), []) == []
