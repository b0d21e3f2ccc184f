"""The rounds of a search: when the graph is solved, and how exactly."""

import numpy as np
import pytest

from recon4.geometry.se3 import SE3
from recon4.model.pose_graph import Edge, EdgeKind, Judge, Judgment, Reason, Verdict
from recon4.pose_graph import search
from recon4.pose_graph.solve import optimize
from recon4.pose_graph.tuning import RecognitionTuning
from recon4.pose_graph.tuning_solve import COARSE, NEAR, SOLVE
from recon4.progress import Silent
from tests.large_walk import TrueRegistrar, odometry_graph, true_poses

NODES = 250


class FirstRoundOnly(TrueRegistrar):
    """Rejects every pair after the first round; notes which rounds found edges for the graph."""

    def __init__(self, truth, log):
        super().__init__(truth)
        self._log, self.recognition = log, RecognitionTuning(enabled=False)

    def register(self, pairs, progress):
        edges = super().register(pairs, progress)
        if self._log:
            refused = Judgment(Judge.SEARCH, Verdict.REJECTED, Reason.ERROR)
            edges = [edge.judged(refused) for edge in edges]
        self._log.append(any(edge.in_graph for edge in edges))
        return edges


def test_rounds_without_an_edge_are_not_solved_and_the_last_solve_is_near(monkeypatch):
    truth, log = true_poses(NODES), []

    def watched(graph, **given):
        log.append(given.get("tuning", SOLVE))
        return optimize(graph, **given)

    monkeypatch.setattr(search, "optimize", watched)
    graph = search.close_loops(
        odometry_graph(truth),
        FirstRoundOnly(truth, log),
        pieces=np.zeros(NODES, np.int64),
        leveled=True,
        progress=Silent(),
    )

    assert log == [True, COARSE, False, NEAR]
    again = optimize(graph, kernel="cauchy").T_map_body
    assert np.linalg.norm(again.t - graph.T_map_body.t, axis=1).max() < NEAR.last_step_m / 6.0


@pytest.mark.parametrize(("fits", "kernels"), [(True, ["cauchy"]), (False, ["none", "cauchy"])])
def test_places_that_fit_the_graph_are_solved_with_the_kernel_alone(monkeypatch, fits, kernels):
    truth = true_poses(NODES)
    graph = odometry_graph(truth)
    poses = graph.T_map_body if fits else truth
    place = Edge(
        i=0,
        j=NODES - 1,
        T_i_j=poses[0].inverse() @ poses[NODES - 1],
        kind=EdgeKind.LOOP,
        judgments=(Judgment(Judge.SEARCH, Verdict.ACCEPTED),),
        information=np.eye(6) * 0.01**-2.0,
    )
    solved = []

    def watched(graph, **given):
        solved.append(given["kernel"])
        return optimize(graph, **given)

    monkeypatch.setattr(search, "optimize", watched)
    monkeypatch.setattr(search, "recognize", lambda *_, **__: [place] if not solved else [])
    monkeypatch.setattr(search, "PlaceDrawer", lambda *_, **__: None)
    registrar = AllRejected(truth)
    pieces = np.zeros(NODES, np.int64)
    search.close_loops(graph, registrar, pieces=pieces, leveled=True, progress=Silent())

    assert solved == [*kernels, "cauchy"]  # the last one is exact


class AllRejected(TrueRegistrar):
    """Rejects every pair."""

    def register(self, pairs, progress):
        refused = Judgment(Judge.SEARCH, Verdict.REJECTED, Reason.ERROR)
        return [edge.judged(refused) for edge in super().register(pairs, progress)]


def test_a_coarse_solve_ends_when_no_pose_moves_far_and_leaves_centimeters():
    truth = true_poses(NODES)
    found = search.close_loops(
        odometry_graph(truth),
        TrueRegistrar(truth),
        pieces=np.zeros(NODES, np.int64),
        leveled=True,
        progress=Silent(),
    )
    bend = SE3.stack(
        SE3.from_rpy(0.0, 0.0, yaw, t=np.zeros(3)) for yaw in np.linspace(0.0, 0.2, NODES)
    )
    start = found.with_poses(bend @ found.T_map_body)

    coarse = optimize(start, kernel="cauchy", tuning=COARSE)
    exact = optimize(start, kernel="cauchy")

    moved_m = np.linalg.norm(exact.T_map_body.t - start.T_map_body.t, axis=1).max()
    left_m = np.linalg.norm(exact.T_map_body.t - coarse.T_map_body.t, axis=1).max()
    assert coarse.iterations < exact.iterations
    assert moved_m > COARSE.last_step_m  # so that one iteration is not enough
    assert left_m < COARSE.last_step_m / 6.0
