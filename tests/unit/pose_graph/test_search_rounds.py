"""The rounds of a search: when the graph is solved, and how exactly."""

import numpy as np

from recon4.model.pose_graph import Judge, Judgment, Reason, Verdict
from recon4.pose_graph import search
from recon4.pose_graph.solve import optimize
from recon4.pose_graph.tuning import RecognitionTuning
from recon4.pose_graph.tuning_solve import COARSE, SOLVE
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


def test_rounds_without_an_edge_are_not_solved_and_only_the_last_solve_is_exact(monkeypatch):
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

    assert log == [True, COARSE, False, SOLVE]
    again = optimize(graph, kernel="cauchy").T_map_body
    assert np.linalg.norm(again.t - graph.T_map_body.t, axis=1).max() < 1e-6
