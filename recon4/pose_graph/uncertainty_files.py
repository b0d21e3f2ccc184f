"""Covariances of poses as files and figures."""

from __future__ import annotations

from pathlib import Path

import numpy as np

from recon4.errors import StoreError
from recon4.geometry.se3 import TRANSLATION
from recon4.locales.coded import CodedText
from recon4.model.figures import UncertaintyFigures
from recon4.model.trajectory import Trajectory
from recon4.pose_graph.uncertainty import HelpfulPoint, PoseUncertainty
from recon4.store.arrays import load_arrays
from recon4.store.atomic import atomic_file

_FILE = "uncertainty.npz"
_NAMES = ("rx", "ry", "rz", "x", "y", "z")
_UPPER = np.triu_indices(6)
_ARRAYS = ("t_ns", "cov", "on_earth", "point_ns", "point_sd_m")
"""In files of all versions."""


def save_uncertainty(folder: Path, found: PoseUncertainty) -> None:
    """Write ``uncertainty.npz``."""
    helpful = found.helpful
    np.savez(
        folder / _FILE,
        t_ns=found.t_ns,
        cov=found.cov,
        shape_cov=found.shape_cov,
        on_earth=np.array(found.on_earth),
        point_ns=np.array([helpful.start_ns, helpful.end_ns], np.int64),
        point_sd_m=np.array(helpful.largest_m),
    )


def load_uncertainty(folder: Path) -> PoseUncertainty | None:
    """Read it from a folder of the stage ``level``; None where nothing is stated.

    Files of earlier versions do not state the covariance of the shape. It is taken for that of the
    positions, which is larger.

    Raises:
        StoreError: If it is damaged.
    """
    if not (folder / _FILE).is_file():
        return None
    found = load_arrays(folder / _FILE)
    missing = [name for name in _ARRAYS if name not in found]
    if missing:
        raise StoreError(
            CodedText("arrays-missing", file=_FILE, names=str(list(_ARRAYS)), missing=str(missing))
        )
    start_ns, end_ns = found["point_ns"].tolist()
    return PoseUncertainty(
        found["t_ns"],
        found["cov"],
        bool(found["on_earth"]),
        found.get("shape_cov", found["cov"][:, TRANSLATION, TRANSLATION]),
        HelpfulPoint(start_ns, end_ns, float(found["point_sd_m"])),
    )


def uncertainty_figures(found: PoseUncertainty, trajectory: Trajectory) -> UncertaintyFigures:
    """The largest standard deviation, where it is, and what would reduce it."""
    worst = int(np.argmax(found.sd_m))
    start_ns = int(trajectory.t_ns[0])
    inside = np.clip(found.t_ns[[worst]], trajectory.t_ns[0], trajectory.t_ns[-1])
    x, y, z = np.round(trajectory.at(inside).t[0], 2).tolist()

    def after_start(t_ns: int) -> float:
        return round(max(t_ns - start_ns, 0) / 1e9, 2)

    return UncertaintyFigures(
        largest_sd_m=round(float(found.sd_m[worst]), 4),
        at_s=after_start(int(found.t_ns[worst])),
        at_m=(x, y, z),
        on_earth=found.on_earth,
        shape_rms_m=round(found.shape_rms_m, 4),
        shape_largest_sd_m=round(float(found.shape_sd_m.max()), 4),
        point_from_s=after_start(found.helpful.start_ns),
        point_to_s=after_start(found.helpful.end_ns),
        point_sd_m=round(found.helpful.largest_m, 4),
    )


def write_covariances(path: Path, poses: Trajectory, found: PoseUncertainty | None) -> None:
    """Write poses with their covariances as CSV, a row each; None = not stated, the header only.

    The covariance is that of (turn about the pose's own origin, position), both in the axes of the
    map; its upper triangle is written row by row.
    """
    upper = zip(*_UPPER, strict=True)
    columns = ["t_ns", "x_m", "y_m", "z_m", "qx", "qy", "qz", "qw"]
    columns += [f"cov_{_NAMES[a]}_{_NAMES[b]}" for a, b in upper]
    with atomic_file(path) as temporary, temporary.open("w", encoding="utf-8") as file:
        file.write(",".join(columns) + "\n")
        if found is None:
            return
        cov = found.at(poses.t_ns)[:, _UPPER[0], _UPPER[1]]
        numbers = np.hstack([poses.T_a_b.t, poses.T_a_b.quat_xyzw()])
        for t_ns, pose, row in zip(poses.t_ns.tolist(), numbers, cov, strict=True):
            values = [*(f"{v:.9g}" for v in pose), *(f"{v:.4e}" for v in row)]
            file.write(f"{t_ns},{','.join(values)}\n")
