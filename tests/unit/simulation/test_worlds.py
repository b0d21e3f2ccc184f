import numpy as np
import pytest

from recon4.errors import ConfigError
from recon4.geometry.mesh import MeshBuilder, write_ply
from recon4.geometry.raycast import Scene
from recon4.simulation.gait import plan_walk
from recon4.simulation.lidar import Surroundings
from recon4.simulation.person import GAIT
from recon4.simulation.worlds import PROCEDURAL, WORLDS, build_world
from tests.first_variants import all_but_first_are_studies

ROUND_S = {
    "office": 250, "staircase": 200, "street": 220, "field": 450, "corridor": 170, "tunnel": 110,
    "garage": 110, "plaza": 150, "storeys": 150, "tower": 200,
    "forest": 140, "hall": 45, "mirrors": 25, "elevator": 60, "rooms": 200,
    "showroom": 45,
}  # fmt: skip
"""About a full round [s]."""
VARIANTS = [f"{name}:{variant}" for name in PROCEDURAL for variant in (1, 2)]


@pytest.fixture(scope="module")
def worlds():
    return {name: build_world(name) for name in [*WORLDS, *VARIANTS]}


def test_an_unknown_world_is_refused_with_the_names_there_are():
    with pytest.raises(ConfigError, match=r"no world named 'moon'; there are: office, staircase"):
        build_world("moon")


@pytest.mark.parametrize("name", ["corridor:", "corridor:-1", "corridor:x", "corridor:2000000"])
def test_a_variant_is_a_number(name):
    with pytest.raises(ConfigError, match="a variant is a number of 0 to 1000000"):
        build_world(name)


def test_a_world_of_one_geometry_has_no_variants():
    with pytest.raises(ConfigError, match="office has no variants"):
        build_world("office:1")


@pytest.mark.parametrize("name", PROCEDURAL)
def test_variants_differ(name, worlds):
    shapes = [worlds[key].mesh.vertices_m for key in (name, f"{name}:1", f"{name}:2")]

    assert len({shape.tobytes() for shape in shapes}) > 1


@pytest.mark.parametrize("name", [*WORLDS, *VARIANTS])
def test_a_world_is_always_the_same_and_sound(name, worlds):
    mesh, again = worlds[name].mesh, build_world(name).mesh

    assert np.array_equal(mesh.vertices_m, again.vertices_m)
    assert np.all(np.isfinite(mesh.vertices_m))
    assert mesh.triangles.max() < len(mesh.vertices_m)
    assert len(mesh.reflectivity) == len(mesh.triangles)
    assert np.all((mesh.reflectivity > 0.0) & (mesh.reflectivity <= 2.5))


@pytest.mark.parametrize("seed", all_but_first_are_studies([2, 3]))
@pytest.mark.parametrize("name", [*WORLDS, *VARIANTS])
def test_the_person_walks_into_nothing(name, seed, worlds):
    world = worlds[name]
    seconds = ROUND_S[name.partition(":")[0]]
    walk = plan_walk(world, seconds=float(seconds), rng=np.random.default_rng(seed))
    foot = walk.state(np.arange(0.0, walk.seconds, 0.1))[:, :3] - [0.0, 0.0, GAIT.body_height_m]
    scene = Scene(world.mesh)

    clearance = [
        scene.distance(foot + np.array([0.0, 0.0, h])).min() for h in (0.45, 0.8, 1.2, 1.5, 1.8)
    ]

    assert min(clearance) > 0.24


@pytest.mark.parametrize("name", [*WORLDS, *VARIANTS])
def test_the_person_walks_on_the_floor(name, worlds):
    world = worlds[name]
    walk = plan_walk(world, seconds=60.0, rng=np.random.default_rng(4))
    t_s = np.arange(0.0, 60.0, 0.25)
    body = walk.state(t_s)[:, :3]
    down = np.tile([0.0, 0.0, -1.0], (len(body), 1))
    around = Surroundings(world.mesh, Scene(world.mesh), car=world.car)

    hits = around.cast(np.hstack([body, down]).astype(np.float32), walk, t_s)

    assert np.all(np.abs(hits.range_m - GAIT.body_height_m) < 0.3)
    assert abs(np.median(hits.range_m) - GAIT.body_height_m) < 0.12


@pytest.mark.parametrize("name", ["office", "street", "field"])
def test_markers_lie_on_paint(name, worlds):
    world = worlds[name]
    places = np.array([[m.x_m, m.y_m, m.z_m] for m in world.markers])

    assert len(places) >= 3
    assert Scene(world.mesh).distance(places).max() < 0.005
    paint = world.mesh.triangles[world.mesh.reflectivity > 1.0]
    corners = world.mesh.vertices_m[paint].reshape(-1, 3)
    nearest = np.linalg.norm(places[:, None] - corners, axis=2).min(axis=1)
    assert nearest.max() < 0.4


def test_distance_to_a_mesh_is_that_to_its_nearest_triangle():
    builder = MeshBuilder()
    builder.box([0, 0, 0], [1, 1, 1], 0.5)

    points = np.array([[0.5, 0.5, 3.0], [2.0, 2.0, 0.5], [0.5, 0.5, 0.9]])

    np.testing.assert_allclose(
        Scene(builder.mesh()).distance(points), [2.0, np.sqrt(2.0), 0.1], atol=1e-6
    )


def test_bricks_have_the_sizes_asked_for():
    builder = MeshBuilder()
    builder.block([1.0, 2.0, 0.5], [0.4, 2.0, 1.0], 0.5, yaw_rad=np.pi / 2)
    builder.tube([10, 0, 0], [10, 0, 2], 0.5, reflectivity=0.3, sides=64)

    vertices = builder.mesh().vertices_m

    np.testing.assert_allclose(vertices[:8].min(axis=0), [0.0, 1.8, 0.5], atol=1e-6)
    np.testing.assert_allclose(vertices[:8].max(axis=0), [2.0, 2.2, 1.5], atol=1e-6)
    np.testing.assert_allclose(np.ptp(vertices[8:], axis=0), [1.0, 1.0, 2.0], atol=1e-2)


def test_a_model_file_is_read_back_by_an_independent_reader(tmp_path, worlds):
    trimesh = pytest.importorskip("trimesh")
    mesh = worlds["staircase"].mesh
    write_ply(tmp_path / "model.ply", mesh)

    loaded = trimesh.load(tmp_path / "model.ply", process=False)

    np.testing.assert_array_equal(loaded.vertices.astype(np.float32), mesh.vertices_m)
    np.testing.assert_array_equal(loaded.faces, mesh.triangles)


@pytest.mark.parametrize("name", ["office", "street", "field"])
def test_markers_are_not_hidden(name, worlds):
    world = worlds[name]
    scene = Scene(world.mesh)
    for marker in world.markers:
        place = np.array([marker.x_m, marker.y_m, marker.z_m])
        # Half a meter off on all six sides, looking at the marker.
        sides = np.vstack([np.eye(3), -np.eye(3)])
        hits = scene.cast(np.hstack([place + 0.5 * sides, -sides]).astype(np.float32))
        seen = np.abs(hits.range_m - 0.5) < 0.01

        assert np.any(world.mesh.reflectivity[hits.triangle[seen]] > 1.0), marker.name
