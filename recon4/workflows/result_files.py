"""Writers of single result files from the artifacts of a run."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import numpy as np

from recon4.mapping.deviation import PoseCovariances
from recon4.model.trajectory import Times, Trajectory
from recon4.pose_graph.files import load_graph
from recon4.pose_graph.g2o import write_g2o
from recon4.pose_graph.uncertainty_files import load_uncertainty, write_covariances
from recon4.recording.formats.poses import write_tum
from recon4.store.arrays import load_trajectory
from recon4.store.atomic import atomic_file
from recon4.store.frames import FrameStore


def write_trajectory(artifact: Path, path: Path) -> None:
    """Write the trajectory of a stage as TUM."""
    with atomic_file(path) as temporary:
        write_tum(temporary, load_trajectory(artifact / "trajectory.npz"))


def write_pose_covariances(frames: Path, level: Path, path: Path) -> None:
    """Write the final poses of the multiframes with their covariances."""
    dense = load_trajectory(level / "trajectory.npz")
    t_ns = FrameStore.open(frames).t_mid_ns
    t_ns = t_ns[(t_ns >= dense.t_ns[0]) & (t_ns <= dense.t_ns[-1])]
    write_covariances(path, Trajectory(t_ns, dense.at(t_ns)), load_uncertainty(level))


def covariances_of(level: Path) -> Callable[[Times], PoseCovariances] | None:
    """Positions and covariances by time, from the stage ``level``; None where none are stated.

    Times [ns], (N,), outside the trajectory get its nearest end.
    """
    found = load_uncertainty(level)
    if found is None:
        return None
    trajectory = load_trajectory(level / "trajectory.npz")

    def at(t_ns: Times) -> PoseCovariances:
        inside = np.clip(t_ns, trajectory.t_ns[0], trajectory.t_ns[-1])
        return PoseCovariances(trajectory.at(inside).t, found.at(inside))

    return at


def write_graph(artifact: Path, path: Path) -> None:
    """Write the graph of a stage as g2o."""
    with atomic_file(path) as temporary:
        write_g2o(temporary, load_graph(artifact))
