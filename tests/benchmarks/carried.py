"""How far a refinement that is carried along with the nodes is from one that starts at the graph.

    python -m tests.benchmarks.carried PROJECT [--count 8]

Loops of the project are given false measurements, 5 cm off and with their information multiplied,
until decisions of all sizes were tried. Prints how far nodes move, how far both results are apart,
and the steps of the rounds from the graph. The project is left as it is.
"""

from __future__ import annotations

import argparse
import sys
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from recon4.geometry.se3 import SE3
from recon4.model.corrections import apply_corrections
from recon4.model.pose_graph import Edge, Verdict
from recon4.model.trajectory import Trajectory
from recon4.progress import Silent
from recon4.review.apply import is_measured
from recon4.review.decisions import Standing
from recon4.review.row_contents import Measurement, numbers_of
from recon4.review.solve import pair_of, review
from recon4.review.source import Source
from recon4.semi_rigid.refine import refine
from recon4.settings import Settings
from recon4.settings.reads import RefineReads, VerificationReads, part_of
from recon4.store.arrays import load_trajectory
from recon4.store.frames import CALIBRATED_RIG, open_frames
from recon4.store.project import read_artifacts
from recon4.store.stage_settings import settings_to_repeat
from recon4.workflows.lidar import LIDAR

OFF_M = 0.05
"""By how much a measurement is wrong [m]."""
FACTORS = (1, 2, 4, 10, 30)
"""By what its information is multiplied, in turn."""


@dataclass(frozen=True, slots=True)
class Tried:
    """A project whose loops are given false measurements."""

    root: Path
    source: Source
    rng: np.random.Generator

    @property
    def settings(self) -> Settings:
        """Those that the project was made with."""
        made = read_artifacts(self.root)
        stages = (*LIDAR.kept, *LIDAR.remade)
        return settings_to_repeat(made, [stage for stage in stages if stage.name in made])

    def false(self, edge: Edge, factor: float) -> Standing:
        """The decision to use a loop with a false measurement."""
        off = self.rng.normal(size=3) * (1.0, 1.0, 0.3)
        T = SE3(edge.T_i_j.R, edge.T_i_j.t + OFF_M * off / np.linalg.norm(off))
        measured = Measurement(
            T_i_j=numbers_of(T),
            information=tuple((factor * np.asarray(edge.information)).ravel().tolist()),
            overlap=0.9,
            error_m=0.01,
            limit_m=0.1,
            degeneracy=0.3,
            iterations=5,
        )
        pair = pair_of(self.source.verified, edge)
        return Standing(pair=pair, accepted=True, who="Eva", why="", T_i_j=(), measurement=measured)

    def line(self, one: Standing, factor: float) -> str:
        """What becomes of the trajectory by such a decision."""
        graph, made = self.source.verified, read_artifacts(self.root)
        verified = part_of(self.settings, VerificationReads)
        T = review(graph, (one,), settings=verified).graph.T_map_body
        undecided = load_trajectory(made["refine"] / "trajectory.npz")
        carried = apply_corrections(undecided, graph.t_ns, T_before=graph.T_map_body, T_after=T)
        rig = made["calibration"] if (made["calibration"] / CALIBRATED_RIG).is_file() else None
        whole = refine(
            open_frames(made["frames"], rig, made["odometry"]),
            made["odometry"],
            Trajectory(graph.t_ns, T),
            settings=part_of(self.settings, RefineReads),
            progress=Silent(),
        )
        node_mm, far_mm = _apart_mm(graph.T_map_body, T), _apart_mm(undecided.T_a_b, carried.T_a_b)
        apart_mm = _apart_mm(whole.trajectory.T_a_b, carried.T_a_b)
        turned_mrad = 1e3 * (whole.trajectory.T_a_b.inverse() @ carried.T_a_b).angle().max()
        steps = ", ".join(f"{1e3 * step.largest_step_m:.1f}" for step in whole.rounds)
        return (
            f"{one.pair} x {factor:g}: nodes move by {node_mm.max():.2f} mm, poses by "
            f"{far_mm.max():.2f} mm; carried and refined are apart by {apart_mm.max():.2f} mm "
            f"(median {np.median(apart_mm):.2f}), {turned_mrad:.3f} mrad; steps {steps} mm\n"
        )


def _apart_mm(a: SE3, b: SE3) -> np.ndarray:
    return np.asarray(1e3 * np.linalg.norm(a.t - b.t, axis=1))


def main() -> None:
    """Try and print."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("project", type=Path)
    parser.add_argument("--count", type=int, default=8)
    given = parser.parse_args()
    tried = Tried(given.project, Source.of(given.project), np.random.default_rng(0))
    loops = [
        edge
        for edge in tried.source.verified.edges
        if abs(edge.j - edge.i) > 1 and is_measured(edge) and edge.verdict is Verdict.ACCEPTED
    ]
    for k in range(given.count):
        factor = FACTORS[k % len(FACTORS)]
        edge = loops[tried.rng.integers(len(loops))]
        sys.stdout.write(tried.line(tried.false(edge, factor), factor))
        sys.stdout.flush()


if __name__ == "__main__":
    main()
