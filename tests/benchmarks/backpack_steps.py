"""e_r of the steps of a simulated backpack walk: 2-D SLAM, registered turns, every line refined.

    python -m tests.benchmarks.backpack_steps PROJECT WALK

``WALK`` is the folder of ``recon4 simulate``, ``PROJECT`` what ``recon4 process`` made of it. The
same points are placed by each trajectory and by the true one, in eight slices through the model.
"""

from __future__ import annotations

import argparse
from pathlib import Path

from recon4.evaluation.ate import absolute_error, pair_poses
from recon4.evaluation.floor import relative_error_floor
from recon4.evaluation.reference_mesh import read_mesh
from recon4.model.trajectory import Trajectory
from recon4.pose_graph.files import load_graph
from recon4.recording.formats.poses import read_tum
from recon4.semi_rigid.refine import corrected_by_nodes
from recon4.store.arrays import load_trajectory
from recon4.store.frames import FrameStore
from recon4.store.project import read_artifacts

_EVERY = 10
"""Of the multiframes every n-th is placed, as by ``recon4 evaluate --floor``."""


def steps_of(project: Path) -> dict[str, Trajectory]:
    """The trajectory after each step."""
    made = read_artifacts(project)
    odometry = load_trajectory(made["odometry"] / "trajectory.npz")
    return {
        "2-D SLAM and IMU": odometry,
        "turns registered": corrected_by_nodes(odometry, load_graph(made["verification"]).nodes),
        "every line refined": load_trajectory(made["refine"] / "trajectory.npz"),
    }


def main() -> None:
    """Print a table."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("project", type=Path)
    parser.add_argument("walk", type=Path)
    asked = parser.parse_args()
    frames = FrameStore.open(read_artifacts(asked.project)["frames"])
    tenth = [frames[row] for row in range(0, len(frames), _EVERY)]
    truth, mesh = read_tum(asked.walk / "truth.tum"), read_mesh(asked.walk / "model.ply")
    print("step                  position [cm]   e_r [cm]   floor [cm]   ratio")
    for name, estimate in steps_of(asked.project).items():
        error = absolute_error(pair_poses(estimate, truth)).position_m.rmse
        found = relative_error_floor(tenth, frames.rig, mesh, estimate=estimate, truth=truth)
        of_estimate, of_truth = (
            100.0 * e.point_weighted.mean_m for e in (found.estimated, found.true)
        )
        print(
            f"{name:20} {100.0 * error:14.2f} {of_estimate:10.2f} {of_truth:12.2f} "
            f"{found.ratio:7.3f}"
        )


if __name__ == "__main__":
    main()
