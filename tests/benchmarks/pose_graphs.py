"""The well-known pose graphs: is the optimum reached, and how long does it take beside gtsam alone?

    python -m tests.benchmarks.pose_graphs FOLDER [NAME …]

FOLDER holds ``NAME.g2o``. Of each: nodes and edges, 0.5 chi² after `initialize` and `optimize`, how
much larger it is than the optimum, and processor time. The optimum is where gtsam alone ends that
may go on until nothing decreases any more. Its time is that of its solver with its usual limits
from the same start, without reading and making the factors.
"""

from __future__ import annotations

import argparse
import time
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import gtsam

from recon4.evaluation.table import number, text_table
from recon4.geometry.se3 import SE3
from recon4.model.pose_graph import PoseGraph
from recon4.pose_graph.solve import initialize, optimize
from tests.g2o_reader import read_g2o

NAMES = ("parking-garage", "sphere2500", "torus3D")
GOAL = 1e-6
"""Largest excess over the optimum."""
ANCHOR_SD = 1e-3


@dataclass(slots=True)
class Seconds:
    """Processor time of a block [s]."""

    used: float = 0.0


@contextmanager
def measured() -> Iterator[Seconds]:
    """Measure the processor time of a block."""
    seconds, began = Seconds(), time.process_time()
    yield seconds
    seconds.used = time.process_time() - began


def main() -> None:
    """Solve the graphs, and print a table."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("folder", type=Path)
    parser.add_argument("names", nargs="*", default=NAMES)
    given = parser.parse_args()
    heads = [
        "graph",
        "nodes",
        "edges",
        "0.5 chi²",
        "above the optimum",
        "s",
        "gtsam alone",
        "by it",
    ]
    rows = [row_of(name, given.folder / f"{name}.g2o") for name in given.names]
    print(text_table(heads, rows))


def row_of(name: str, path: Path) -> list[str]:
    """Solve a graph by both."""
    graph, factors = read_g2o(path), gtsam_factors(path)
    with measured() as ours:
        start = initialize(graph)
        solution = optimize(graph.with_poses(start), kernel="none")
    values = gtsam_values(start, graph)
    with measured() as alone:
        found = gtsam.LevenbergMarquardtOptimizer(factors, values).optimize()
    best = min(factors.error(solve_exactly(factors, one)) for one in (found, values))
    cost = 0.5 * solution.chi2
    excess = cost / best - 1.0
    print(
        f"{name}: {cost:.9g} in {solution.iterations} iterations, optimum {best:.9g}, gtsam alone "
        f"{factors.error(found):.9g}: {'reached' if excess <= GOAL else 'NOT REACHED'}",
        flush=True,
    )
    counts = [str(len(graph)), str(len(graph.edges))]
    times = [number(ours.used), number(alone.used), number(ours.used / alone.used)]
    return [name, *counts, f"{cost:.8g}", f"{excess:.1e}", *times]


def solve_exactly(factors: Any, values: Any) -> Any:
    """Solve until nothing decreases any more."""
    limits = gtsam.LevenbergMarquardtParams()
    limits.setRelativeErrorTol(1e-14)
    limits.setAbsoluteErrorTol(0.0)
    limits.setMaxIterations(1000)
    return gtsam.LevenbergMarquardtOptimizer(factors, values, limits).optimize()


def gtsam_factors(path: Path) -> Any:
    """Factors of a file as gtsam reads it, the first node held."""
    factors, poses = gtsam.readG2o(str(path), True)
    first, model = min(poses.keys()), gtsam.noiseModel.Isotropic.Sigma(6, ANCHOR_SD)
    factors.add(gtsam.PriorFactorPose3(first, poses.atPose3(first), model))
    return factors


def gtsam_values(T: SE3, graph: PoseGraph) -> Any:
    """Poses for gtsam, under the numbers of the nodes in the file."""
    values = gtsam.Values()
    for row, node in enumerate(graph.frame_ids.tolist()):
        values.insert(node, gtsam.Pose3(gtsam.Rot3(T[row].R), T[row].t))
    return values


if __name__ == "__main__":
    main()
