"""All things like one: found among the clusters of a class, counted, and led into another map."""

from dataclasses import replace

import msgspec
import numpy as np
import pytest

from recon4.classes import likeness
from recon4.classes.clusters import ClusterEvidence, cells_of_class, connected, evidence
from recon4.classes.corrections import correction_of, count_points, place_correction
from recon4.classes.likeness import differences, find_alike
from recon4.errors import ConfigError
from recon4.geometry.se3 import SE3
from recon4.mapping.class_corrections import ClassVolumes
from recon4.mapping.tiles import TileSet
from recon4.model.alike import PickedThing
from recon4.model.cell_clusters import CellCluster, Clusters
from recon4.model.class_corrections import Reclassified
from recon4.model.classes import PointClass
from recon4.model.trajectory import Trajectory
from recon4.model.volumes import Box, bounds_of, contains, moved
from recon4.store.project import read_artifacts
from tests.project_builder import build_project, loop_walk

PILLARS = ((4.0, 5.0), (8.0, 5.0), (12.0, 5.0))
FLOOR = Reclassified(
    volume=Box(center_m=(8.0, 5.0, 0.0), size_m=(40.0, 40.0, 0.04)), to=int(PointClass.GROUND)
)
MOVING = int(PointClass.MOVING)


@pytest.fixture(scope="module")
def tiles(tmp_path_factory):
    root = tmp_path_factory.mktemp("a") / "office"
    build_project(root)
    return TileSet.open(read_artifacts(root)["map"])


def test_pillars_like_one_are_found_and_what_is_proposed_is_what_changes(tiles):
    picked = PickedThing(place_m=(8.31, 5.0, 1.5), to=MOVING)

    found = find_alike(tiles, picked, [FLOOR])
    what = found.reclassified(MOVING, most_different=1.0)
    counted = count_points(tiles, what, [FLOOR])

    middles = [np.add(one.low_m, one.high_m) / 2.0 for one in found.clusters[:3]]
    np.testing.assert_allclose(middles[0][:2], PILLARS[1], atol=0.1)
    assert sorted(tuple(p[:2].round().tolist()) for p in middles) == list(PILLARS)
    assert [one.difference <= 1.0 for one in found.clusters].count(True) == 3
    assert found.clusters[0].difference == 0.0
    assert found.clusters[0].over_ground_m == pytest.approx(0.0, abs=0.1)
    assert what.only == (PointClass.UNCLASSIFIED,)
    assert counted.points == sum(one.points for one in found.clusters[:3]) > 3000


def test_what_is_no_thing_or_too_large_is_refused(tiles, monkeypatch):
    with pytest.raises(ConfigError, match="no point to correct within 30 cm"):
        find_alike(tiles, PickedThing(place_m=(8.0, 2.0, 1.5), to=MOVING), [FLOOR])
    with pytest.raises(ConfigError, match="no point to correct"):  # it has the new class already
        find_alike(tiles, PickedThing(place_m=(8.31, 5.0, 1.5), to=1), [FLOOR])
    few = msgspec.structs.replace(likeness.CLUSTERS, most_columns=1000)
    monkeypatch.setattr(likeness, "CLUSTERS", few)
    with pytest.raises(ConfigError, match="too large"):  # floor, walls and pillars touch
        find_alike(tiles, PickedThing(place_m=(8.31, 5.0, 1.5), to=MOVING))


def test_beams_that_see_through_a_thing_are_counted(tiles):
    cells = cells_of_class(tiles, int(PointClass.UNCLASSIFIED), ClassVolumes.of([FLOOR]))
    cluster = connected(cells.key)

    known = evidence(tiles, cells, cluster)

    mine = np.argmin(np.abs(known.low_m + known.high_m - [16.0, 10.0, 3.0]).sum(axis=1))
    wall = np.argmax(known.cells)
    assert known.seen_through[mine] > 0.1 > known.seen_through[wall]  # beams of the room are random


def test_each_kind_of_evidence_tells_things_apart():
    count = np.array([100, 100, 300, 100, 100, 100, 100])
    low = np.zeros((7, 3))
    high = np.tile([0.5, 0.5, 1.8], (7, 1))
    high[3, 2] = 0.5
    over = np.array([0.0, np.nan, 0.0, 0.0, 2.0, 0.0, 0.0])
    planarity = np.array([0.2, 0.2, 0.2, 0.2, 0.2, 0.9, 0.2])
    seen = np.array([0.9, np.nan, 0.9, 0.9, 0.9, 0.9, 0.05])
    size = np.full(7, 0.5)

    found = differences(
        ClusterEvidence(count, count, low, high, size, size, over, planarity, seen), 0
    )

    assert found[0] == found[1] == 0.0  # what is unknown says nothing
    assert (found[2:] > 1.0).all()


def columns_of(x):
    return CellCluster(origin_m=(x, 0.0, 0.0), columns=((0, 0, 0, 1), (0, 0, 4, 4), (2, 1, 0, 0)))


def test_clusters_contain_their_cubes_and_follow_a_map():
    volume = Clusters(clusters=(columns_of(1.0), columns_of(3.0)), edge_m=0.5)
    p = np.array([[1.1, 0.1, 0.9], [1.1, 0.1, 1.1], [1.1, 0.1, 2.4], [2.1, 0.6, 0.2]])
    p = np.vstack([p, [[3.1, 0.1, 0.1], [0.9, 0.1, 0.1], [2.6, 0.1, 0.1]]])
    T = SE3.from_rpy(0.3, -0.2, 2.0, t=[50.0, 4.0, -3.0])

    np.testing.assert_array_equal(contains(volume, p), [1, 0, 1, 1, 1, 0, 0])
    np.testing.assert_array_equal(contains(moved(volume, T), T @ p), contains(volume, p))
    np.testing.assert_allclose(bounds_of(volume), [[1.0, 0.0, 0.0], [4.5, 1.0, 2.5]])


@pytest.mark.parametrize(
    ("change", "why"),
    [
        ({"edge_m": 0.0}, "cubes of 0.01 to 10 m"),
        ({"clusters": ()}, "1 to 500 clusters"),
        ({"clusters": (CellCluster(origin_m=(0, 0, 0), columns=()),)}, "a cube in each"),
        (
            {"clusters": (CellCluster(origin_m=(0, 0, 0), columns=((0, 0, 2, 1),)),)},
            "near the origin",
        ),
        ({"clusters": (msgspec.structs.replace(columns_of(0), u=(2, 0, 0)),)}, "right angle"),
        ({"clusters": (columns_of(np.nan),)}, "finite"),
    ],
)
def test_clusters_that_are_none_are_refused(change, why):
    good = {"clusters": (columns_of(0.0),), "edge_m": 0.5}
    with pytest.raises(ConfigError, match=why):
        Clusters(**(good | change))


def test_each_cluster_follows_its_own_points_and_one_that_came_apart_is_left_out(tiles):
    walk = loop_walk()
    found = find_alike(tiles, PickedThing(place_m=(8.31, 5.0, 1.5), to=MOVING), [FLOOR])
    what = found.reclassified(MOVING, most_different=1.0)
    counted = count_points(tiles, what, [FLOOR])
    halves = (walk.t_ns[[20, 40]], walk.t_ns[[500, 520]], walk.t_ns[[20, 520]])
    counted = replace(counted, clusters_ns=halves)
    shift = np.zeros((len(walk), 3))
    shift[len(walk) // 2 :, 1] = 0.4

    made = correction_of(what, counted, walk, map_key="ab")
    placed = place_correction(made, Trajectory(walk.t_ns, SE3(walk.T_a_b.R, walk.T_a_b.t + shift)))

    first, second = placed.what.volume.clusters
    assert placed.lost == 1
    assert first == made.what.volume.clusters[0]
    np.testing.assert_allclose(
        np.subtract(second.origin_m, made.what.volume.clusters[1].origin_m), [0, 0.4, 0], atol=1e-9
    )
    assert placed.moved_m == pytest.approx(0.4)
