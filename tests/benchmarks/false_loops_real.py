"""False loops injected into the graphs of processed walks (issue's row 4).

    python -m tests.benchmarks.false_loops_real PROJECT [PROJECT …] [--seeds N]

The projects' own graphs before verification; a good edge is one that is kept when nothing is
injected. Where the project has positions, they judge a second time (stage ``level``), and the
attack ``instead`` is run as well: all true loops taken out, those injected agree with each other.
"""

from __future__ import annotations

import argparse
from dataclasses import replace
from pathlib import Path

import numpy as np

from recon4.geometry.se3 import SE3
from recon4.georeference.gnss import georeference
from recon4.georeference.stage import find_level
from recon4.georeference.tuning import GnssTuning
from recon4.model.corrections import apply_corrections
from recon4.model.pose_graph import EdgeKind, PoseGraph
from recon4.model.trajectory import Trajectory
from recon4.pose_graph.files import load_graph
from recon4.pose_graph.verification import verify
from recon4.settings import VerificationSettings
from recon4.store.arrays import load_trajectory
from recon4.store.frames import FrameStore
from recon4.store.project import read_artifacts
from tests.benchmarks.false_loops import ATTACKS

INJECTED = 20
_INSTEAD = "instead of the true ones"


def inject_instead(graph: PoseGraph, rng: np.random.Generator) -> PoseGraph:
    """Every true loop gives way; 20 in their place are all wrong by the same shift."""
    shift = SE3.exp([0, 0, 0, *_horizontal(rng.uniform(0.5, 1.5), rng.uniform(0, 2 * np.pi))])
    loops = [e for e in graph.edges if e.kind is EdgeKind.LOOP and e.in_graph and e.j - e.i > 10]
    rest = [e for e in graph.edges if not (e.kind is EdgeKind.LOOP and e.in_graph)]
    false = []
    for k in range(INJECTED):
        true = loops[k % len(loops)]
        noise = SE3.exp(rng.normal(size=6) * np.repeat([0.001, 0.01], 3))
        # One shift of the later visit as a whole, seen from each of its nodes.
        T_j_later = graph.T_map_body[true.j].inverse() @ graph.T_map_body[loops[0].j]
        false.append(
            true.evolve(T_i_j=true.T_i_j @ T_j_later @ shift @ T_j_later.inverse() @ noise)
        )
    return graph.with_edges((*rest, *false))


def _horizontal(length_m: float, angle_rad: float) -> list[float]:
    return [length_m * np.cos(angle_rad), length_m * np.sin(angle_rad), 0.0]


class Walk:
    """A processed walk whose edges are verified again."""

    def __init__(self, project: Path) -> None:
        at = read_artifacts(project)
        self.graph = load_graph(at["graph"])
        self.frames = FrameStore.open(at["frames"])
        self.odometry = load_trajectory(at["odometry"] / "trajectory.npz")

    def kept(self, graph: PoseGraph) -> list[np.ndarray]:
        """Which edges stay after verification and, with positions, after the stage ``level``."""
        verified = verify(graph, settings=VerificationSettings()).graph
        out = [np.array([e.in_graph for e in verified.edges])]
        if self.frames.gnss is None:
            return out
        T_odom = self.odometry.at(verified.t_ns)
        dense = apply_corrections(
            self.odometry, verified.t_ns, T_before=T_odom, T_after=verified.T_map_body
        )
        leveling = find_level(self.frames, dense, source="auto")
        dense = replace(dense, T_a_b=leveling.T_level_odom @ dense.T_a_b)
        placed = georeference(
            verified.with_poses(leveling.T_level_odom @ verified.T_map_body),
            Trajectory(dense.t_ns, dense.T_a_b), self.frames.gnss,
            rig=self.frames.rig, settings=GnssTuning(),
        )  # fmt: skip
        assert placed.origin is not None, placed.reason
        return [*out, np.array([e.in_graph for e in placed.graph.edges])]


def main(projects: list[Path], seeds: int) -> None:
    print("graph, attack, seed, after: false rejected, good edges lost")
    for project in projects:
        walk = Walk(project)
        good = walk.kept(walk.graph)
        attacks = dict(ATTACKS)
        if len(good) > 1:
            attacks[_INSTEAD] = inject_instead
        for name, inject in attacks.items():
            for seed in range(3, 3 + seeds):
                attacked = inject(walk.graph, np.random.default_rng(seed))
                same = {id(edge): row for row, edge in enumerate(walk.graph.edges)}
                was = [same[id(edge)] for edge in attacked.edges[:-INJECTED]]
                for after, before, now in zip(
                    ("verification", "positions"), good, walk.kept(attacked), strict=False
                ):
                    lost = int(np.sum(before[was] & ~now[:-INJECTED]))
                    rejected = int(np.sum(~now[-INJECTED:]))
                    print(
                        f"{project.name}, {name}, {seed}, {after}: {rejected} of {INJECTED}, "
                        f"{lost} of {int(before[was].sum())}",
                        flush=True,
                    )


if __name__ == "__main__":
    parser = argparse.ArgumentParser()
    parser.add_argument("projects", nargs="+", type=Path)
    parser.add_argument("--seeds", type=int, default=1)
    given = parser.parse_args()
    main(given.projects, given.seeds)
