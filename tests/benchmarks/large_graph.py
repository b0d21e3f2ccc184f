"""How do search, verification and covariances of a pose graph grow with the walk?

    python -m tests.benchmarks.large_graph [NODES …]

Walks on the corridors of a building with four storeys (`tests.large_walk`), a node every half
second: 10 000 are 83 minutes. Of each part: processor time, and the largest memory of the process
while it ran. Pairs are registered by the truth, and walls seen by it: these parts, in brackets, are
within the search, and no work of recon4. The solve of gtsam alone has the same edges and start as
that of recon4.
"""

from __future__ import annotations

import argparse
import tempfile
import time
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

import gtsam
import numpy as np

from recon4.evaluation.table import number, text_table
from recon4.model.pose_graph import EdgeKind, PoseGraph, Verdict
from recon4.pose_graph import search
from recon4.pose_graph.factors import FactorProblem
from recon4.pose_graph.files import load_graph, save_graph
from recon4.pose_graph.recognition import recognize
from recon4.pose_graph.solve import optimize
from recon4.pose_graph.uncertainty import pose_uncertainty
from recon4.pose_graph.verification import verify
from recon4.progress import Silent
from recon4.settings import VerificationSettings
from tests.large_walk import TrueRegistrar, odometry_graph, true_poses

SIZES = (2500, 5000, 10000)


class Parts:
    """Processor time and memory of the parts of a run."""

    def __init__(self) -> None:
        self.seconds: dict[str, float] = {}
        self.peak_mb: dict[str, float] = {}

    @contextmanager
    def measured(self, name: str) -> Iterator[None]:
        """Measure a block; the same name again adds up."""
        Path("/proc/self/clear_refs").write_text("5")  # forgets the largest memory so far
        began = time.process_time()
        yield
        used = time.process_time() - began
        self.seconds[name] = self.seconds.get(name, 0.0) + used
        self.peak_mb[name] = max(self.peak_mb.get(name, 0.0), peak_mb())

    def measuring(self, name, function):  # type: ignore[no-untyped-def]
        """The function, measured whenever it is called."""

        def call(*given, **named):  # type: ignore[no-untyped-def]
            with self.measured(name):
                return function(*given, **named)

        return call

    def timed(self, name, function):  # type: ignore[no-untyped-def]
        """The function, with its processor time alone: it is called too often for `measured`."""

        def call(*given):  # type: ignore[no-untyped-def]
            began = time.process_time()
            made = function(*given)
            self.seconds[name] = self.seconds.get(name, 0.0) + time.process_time() - began
            return made

        self.peak_mb[name] = 0.0
        return call


def peak_mb() -> float:
    """Largest resident memory of this process since it was forgotten [MB]."""
    status = Path("/proc/self/status").read_text()
    return int(status.split("VmHWM:")[1].split()[0]) / 1e3


def main() -> None:
    """Measure walks of several lengths, and print a table."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("nodes", nargs="*", type=int, default=SIZES)
    given = parser.parse_args()
    runs = [measured(nodes) for nodes in given.nodes]
    names = list(runs[-1].seconds)
    rows = [
        [name, *(f"{number(run.seconds[name])} s {run.peak_mb[name]:.0f} MB" for run in runs)]
        for name in names
    ]
    print(text_table(["part", *(f"{nodes} nodes" for nodes in given.nodes)], rows))


def measured(nodes: int) -> Parts:
    """Search, verify and state the covariances of one walk."""
    parts, truth = Parts(), true_poses(nodes)
    start, registrar = odometry_graph(truth), TrueRegistrar(truth)
    found = searched(start, registrar, parts)
    with tempfile.TemporaryDirectory() as folder, parts.measured("files"):
        save_graph(Path(folder), found)
        found = load_graph(Path(folder))
    with parts.measured("verification"):
        verified = verify(found, settings=VerificationSettings())
    with parts.measured("covariances"):
        stated = pose_uncertainty(verified.graph)
    report(truth, start, verified.graph, registered=registrar.registered)
    assert stated is not None
    print(f"stated: RMS of the shape {stated.shape_rms_m * 1e3:.1f} mm")
    solve_alone(start, verified.graph, parts)
    return parts


def searched(start: PoseGraph, registrar: TrueRegistrar, parts: Parts) -> PoseGraph:
    """Search for all loops, with its parts measured."""
    search.optimize = parts.measuring("search: solves", optimize)
    search.recognize = parts.measuring("search: recognition", recognize)
    registrar.register = parts.measuring("(registration by the truth)", registrar.register)  # type: ignore[method-assign]
    registrar.views.ends = parts.timed("(views by the truth)", registrar.views.ends)  # type: ignore[method-assign]
    with parts.measured("search"):
        pieces = np.zeros(len(start), np.int64)
        found = search.close_loops(start, registrar, pieces=pieces, leveled=True, progress=Silent())  # type: ignore[arg-type]
    search.optimize, search.recognize = optimize, recognize
    return found


def solve_alone(start: PoseGraph, verified: PoseGraph, parts: Parts) -> None:
    """Solve the edges in use from where odometry has the nodes, by recon4 and by gtsam alone."""
    graph = start.with_edges(tuple(edge for edge in verified.edges if edge.in_graph))
    with parts.measured("solve"):
        solution = optimize(graph, kernel="none")
    of = graph.relations
    problem = FactorProblem.check(graph.T_map_body, of, fixed=(0,), priors=())
    factors, values = problem.factors(np.ones(len(of)), kernel="none"), gtsam.Values()
    for node in range(len(graph)):
        values.insert(node, gtsam.Pose3(graph.T_map_body[node].matrix()))
    with parts.measured("solve by gtsam alone"):
        alone = gtsam.LevenbergMarquardtOptimizer(factors, values).optimize()
    print(
        f"{len(of)} edges: 0.5 chi² {0.5 * solution.chi2:.6f}, gtsam {factors.error(alone):.6f}",
        flush=True,
    )


def report(truth: PoseGraph, start: PoseGraph, graph: PoseGraph, *, registered: int) -> None:
    """Say what was found, and how far it is from the truth."""
    loops = [edge for edge in graph.edges if edge.kind is EdgeKind.LOOP]
    before, after = (np.linalg.norm(one.T_map_body.t - truth.t, axis=1) for one in (start, graph))
    rejected = sum(edge.verdict is Verdict.REJECTED for edge in loops)
    print(
        f"{len(graph)} nodes: {registered} pairs registered, {len(loops)} loops of which "
        f"{rejected} rejected; off by at most {before.max():.2f} m before, {after.max():.3f} m now",
        flush=True,
    )


if __name__ == "__main__":
    main()
