"""Decisions that hardly move a map leave it where it was."""

from dataclasses import replace

import numpy as np
import pytest

from recon4.geometry.se3 import SE3
from recon4.georeference.crs import GeodeticOrigin
from recon4.georeference.gnss import GeoreferenceResult, LocalRecord
from recon4.georeference.hold import KEPT, hold, moved_by_decisions
from recon4.georeference.level import Leveling
from recon4.georeference.stage import LeveledMap
from recon4.georeference.tuning import HOLD
from recon4.mapping.mirrors import Mirror, Wall
from recon4.model.figures import LevelFigures, MirrorFigures
from recon4.model.local_frame import LocalReason
from recon4.model.trajectory import Trajectory
from recon4.pose_graph.files import load_graph
from recon4.pose_graph.uncertainty import pose_uncertainty
from recon4.progress import Silent
from recon4.settings import Settings
from recon4.settings.reads import ReadsNothing
from recon4.store.arrays import load_trajectory
from recon4.store.project import Project
from recon4.store.stage import Input, Stage, StageRunner
from tests.unit.review.graphs import two_rounds

GRAPH = two_rounds()
WALL = Wall(np.array([1.0, 0.0, 0.0]), 4.0)


def georeferenced(origin=None, rejected=()):
    none = np.zeros(0, np.int64)
    local = None if origin else LocalRecord(reason=LocalReason.NO_GNSS)
    nothing = (SE3.identity(), none, np.zeros((0, 3)), none.astype(bool), 0)
    return GeoreferenceResult(GRAPH, origin, local, *nothing, rejected=rejected)


def mirror(middle_m):
    figures = MirrorFigures(area_m2=2.0, middle_m=middle_m, behind=0.1)
    return Mirror(WALL, np.zeros((1, 2), np.int64), figures)


def leveled(**changes):
    one = LeveledMap(
        trajectory=GRAPH.nodes,
        graph=GRAPH,
        leveling=Leveling(SE3.identity(), "imu", 9, 9, 0.01),
        georeference=georeferenced(),
        crs=None,
        antenna=None,
        uncertainty=pose_uncertainty(GRAPH),
        mirrors=(mirror((4.0, 1.0)),),
    )
    return replace(one, **changes)


def moved(by_m=0.0, by_rad=0.0):
    """The trajectory with its last pose off."""
    T = GRAPH.T_map_body
    R, t = T.R.copy(), T.t.copy()
    t[-1, 1] += by_m
    R[-1] = R[-1] @ SE3.from_rpy(0.0, 0.0, by_rad, t=[0, 0, 0]).R
    return Trajectory(GRAPH.t_ns, SE3(R, t))


def less_known(factor):
    found = pose_uncertainty(GRAPH)
    return replace(found, cov=found.cov * factor)


def held_at(walk, undecided, out):
    return hold(walk, undecided, out, moved=moved_by_decisions(walk, undecided))


@pytest.fixture(scope="module")
def undecided(tmp_path_factory):
    """The artifact of the map without decisions."""
    with Project.open(tmp_path_factory.mktemp("held") / "office") as project:
        runner = StageRunner(project, Settings(), Silent())
        stage = Stage("level", 1, ReadsNothing, lambda context, walk: walk.save(context.out))
        return runner.run(stage, walk=Input("walk", leveled())).folder


def test_a_map_that_hardly_moves_has_the_bytes_of_before_and_the_graph_of_now(undecided, tmp_path):
    walk = moved(0.003)
    decided = GRAPH.with_edges(GRAPH.edges[:-1]).with_poses(walk.T_a_b)

    figures = held_at(leveled(trajectory=walk, graph=decided), undecided, tmp_path)

    assert {path.name for path in tmp_path.iterdir()} == {*KEPT, "graph.npz", "edges.json"}
    for name in KEPT:
        assert (tmp_path / name).read_bytes() == (undecided / name).read_bytes()
    assert figures.held.moved_m == pytest.approx(0.003)
    assert (figures.leveled_by, len(figures.mirrors)) == ("imu", 1)
    graph, line = load_graph(tmp_path), load_trajectory(tmp_path / "trajectory.npz")
    assert len(graph.edges) == len(GRAPH.edges) - 1
    np.testing.assert_allclose(graph.T_map_body.t, line.at(graph.t_ns).t, atol=1e-12)


@pytest.mark.parametrize(
    "changes",
    [
        {"trajectory": moved(2.0 * HOLD.moved_m)},
        {"trajectory": moved(by_rad=2.0 * HOLD.turned_rad)},
        {"trajectory": GRAPH.nodes[:-1]},
        {"uncertainty": less_known(1.2)},
        {"uncertainty": None},
        {"georeference": georeferenced(GeodeticOrigin(0.9, 0.2, 100.0))},
        {"mirrors": ()},
        {"mirrors": (mirror((4.0, 6.0)),)},
    ],
)
def test_a_map_that_moves_or_differs_is_not_held(changes, undecided, tmp_path):
    assert held_at(leveled(**changes), undecided, tmp_path) is None
    assert not list(tmp_path.iterdir())


def test_positions_that_reject_another_edge_place_another_map(tmp_path):
    placed = georeferenced(GeodeticOrigin(0.9, 0.2, 100.0), rejected=(3,))
    other = replace(placed, rejected=(4,))
    folder, out = tmp_path / "level", tmp_path / "out"
    with Project.open(folder) as project:
        runner = StageRunner(project, Settings(), Silent())
        stage = Stage("level", 1, ReadsNothing, lambda context, walk: walk.save(context.out))
        walk = Input("walk", leveled(georeference=placed))
        undecided = runner.run(stage, walk=walk).folder
    out.mkdir()

    assert held_at(leveled(georeference=other), undecided, out) is None
    held = held_at(leveled(georeference=placed), undecided, out)
    assert isinstance(held, LevelFigures)
