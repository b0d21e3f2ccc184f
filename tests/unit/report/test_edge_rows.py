"""The report's table of edges: verdict, reason, and who judged them in order."""

import numpy as np

from recon4.geometry.se3 import SE3
from recon4.model.pose_graph import (
    Edge,
    EdgeKind,
    PoseGraph,
    Reason,
    Verdict,
    known_history,
    known_judgment,
)
from recon4.report.edges import edge_rows


def loop(verdict: Verdict, reason: Reason = Reason.NONE, kind: EdgeKind = EdgeKind.LOOP) -> Edge:
    history = known_history(verdict, reason, kind=kind)
    return Edge(i=0, j=1, T_i_j=SE3.identity(), kind=kind, judgments=history)


def test_edges_that_came_to_a_verdict_in_other_ways_stand_in_rows_of_their_own() -> None:
    contradicted = loop(Verdict.REJECTED, Reason.VERIFICATION)
    edges = (
        contradicted,
        contradicted.judged(known_judgment(Verdict.ACCEPTED, decided_by="Ada")),
        *[loop(Verdict.ACCEPTED)] * 3,
        loop(Verdict.ACCEPTED, kind=EdgeKind.ODOMETRY),
        loop(Verdict.UNVERIFIED),
        loop(Verdict.REJECTED, Reason.OVERLAP),
    )
    nodes = np.arange(2)

    rows = edge_rows(PoseGraph(nodes, nodes, SE3.identity(2), edges), limit_m=0.1)

    assert [(row.verdict, row.reason, row.history, row.total) for row in rows] == [
        ("accepted", "", "search ✓", 3),
        ("accepted", "", "odometry ✓", 1),
        ("accepted", "", "search ✓ → verification ✕ → person ✓", 1),
        ("rejected automatically", "overlap < t_o", "search ✕", 1),
        ("rejected automatically", "path discrepancy > 10 cm", "search ✓ → verification ✕", 1),
        ("unverified", "", "search ✓ → verification ◌", 1),
    ]
