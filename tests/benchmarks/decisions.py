"""What a new map costs after one decision: confirm, reject, accept, measure; each on a copy.

    python -m tests.benchmarks.decisions PROJECT

Prints processor seconds of every stage by the project's own record, 0 where it was reused, and how
far the final trajectory moved. *Measure* gives a loop another measurement, 5 cm off and with ten
times its information, that moves nodes by a centimeter or more. The project is left as it is.
"""

from __future__ import annotations

import argparse
import shutil
import sys
import tempfile
from collections.abc import Iterator
from pathlib import Path
from time import process_time

import numpy as np

from recon4.model.pose_graph import Edge, PoseGraph, Verdict
from recon4.pipeline import remake
from recon4.review.apply import is_measured
from recon4.review.decisions import Decision, DecisionKind, Pair, Standing
from recon4.review.journal import append
from recon4.review.row_contents import Measurement
from recon4.review.solve import pair_of, review
from recon4.review.source import Source
from recon4.settings.reads import VerificationReads, part_of
from recon4.store.arrays import load_trajectory
from recon4.store.project import read_artifacts, read_stages
from tests.benchmarks.carried import Tried

SMALL_M = 0.05
"""Decisions that move a node farther are not tried [m]."""
TRIED = 40
MEASURED_M = 0.01
"""What another measurement is to move a node by at least [m]."""
FACTOR = 10.0
"""On the information of that measurement."""


def chosen(root: Path) -> Iterator[tuple[Decision, float]]:
    """Of each kind the decision that moves a node farthest, but by less than `SMALL_M`."""
    source = Source.of(root)
    settings = part_of(source.settings, VerificationReads)
    graph = source.verified
    loops = [edge for edge in graph.edges if abs(edge.j - edge.i) > 1 and is_measured(edge)]
    used = [edge for edge in loops if edge.verdict is Verdict.ACCEPTED]
    unused = [edge for edge in loops if edge.verdict is Verdict.REJECTED]

    def moved_m(edge: Edge, accepted: bool) -> float:
        one = Standing(pair=pair_of(graph, edge), accepted=accepted, who="Eva", why="", T_i_j=())
        return farthest_m(graph, review(graph, (one,), settings=settings).graph)

    yield _decision(DecisionKind.ACCEPT, pair_of(graph, used[-1])), moved_m(used[-1], True)
    for kind, edges in (
        (DecisionKind.REJECT, used[:: 1 + len(used) // TRIED]),
        (DecisionKind.ACCEPT, unused[:: 1 + len(unused) // TRIED]),
    ):
        moves = [(moved_m(edge, kind is DecisionKind.ACCEPT), edge) for edge in edges]
        small = [(far_m, edge) for far_m, edge in moves if far_m < SMALL_M]
        if small:
            far_m, edge = max(small, key=lambda one: one[0])
            yield _decision(kind, pair_of(graph, edge)), far_m
    tried = Tried(root, source, np.random.default_rng(0))
    for edge in used[:: 1 + len(used) // TRIED]:
        one = tried.false(edge, FACTOR)
        far_m = farthest_m(graph, review(graph, (one,), settings=settings).graph)
        if MEASURED_M < far_m < SMALL_M:
            yield _decision(DecisionKind.REPLACE, one.pair, one.measurement), far_m
            return


def _decision(kind: DecisionKind, pair: Pair, measured: Measurement | None = None) -> Decision:
    return Decision(kind=kind, who="Eva", pair=pair, measurement=measured)


def farthest_m(before: PoseGraph, after: PoseGraph) -> float:
    """How far a node moved at most [m]."""
    return float(np.linalg.norm(after.T_map_body.t - before.T_map_body.t, axis=1).max())


def measure(root: Path, decision: Decision) -> tuple[dict[str, float], float, float]:
    """Seconds of the stages that ran, of the whole, and how far the trajectory moved [m]."""
    before = load_trajectory(read_artifacts(root)["level"] / "trajectory.npz").T_a_b.t
    append(root, decision)
    start = process_time()
    summary = remake(root)
    whole_s = process_time() - start
    after = load_trajectory(read_artifacts(root)["level"] / "trajectory.npz").T_a_b.t
    far_m = float(np.linalg.norm(after - before, axis=1).max())
    ran = {one.stage: 0.0 if one.reused else one.cpu_seconds for one in summary.stages}
    return ran, whole_s, far_m


def main() -> None:
    """Measure and print a table."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("project", type=Path)
    root = parser.parse_args().project
    current = {folder.name for folder in read_artifacts(root).values()}
    first_s = sum(row.cpu_seconds for row in read_stages(root) if row.key in current)
    sys.stdout.write(f"first run: {first_s:.1f} s\n")
    for decision, node_m in chosen(root):
        with tempfile.TemporaryDirectory(dir=root.parent) as folder:
            copy = shutil.copytree(root, Path(folder) / root.name)
            ran, whole_s, far_m = measure(copy, decision)
        stages = ", ".join(f"{stage} {s:.2f}" for stage, s in ran.items() if s)
        share = sum(ran.values()) / first_s
        sys.stdout.write(
            f"{decision.kind} {decision.pair}: a node moved {1e3 * node_m:.2f} mm, the trajectory "
            f"{1e3 * far_m:.2f} mm; {stages}; all stages "
            f"{sum(ran.values()):.1f} s = {share:.0%} of the first run, "
            f"with results {whole_s:.1f} s\n"
        )


if __name__ == "__main__":
    main()
