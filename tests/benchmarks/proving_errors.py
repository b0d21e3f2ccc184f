"""Errors of a mapped walk against its truth, and of what it states of itself."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

from recon4.evaluation.ate import absolute_error, pair_poses
from recon4.geometry.se3 import Array, so3_log
from recon4.georeference.crs import GeodeticOrigin, to_enu, to_geodetic
from recon4.georeference.crs_file import read_crs
from recon4.model.trajectory import Trajectory
from recon4.pose_graph.uncertainty_files import load_uncertainty
from recon4.simulation.world import BRNO
from recon4.store.arrays import load_trajectory
from recon4.store.stage import StageRun

BASE_M, PER_METER = 0.05, 0.001
"""A right trajectory has at most this error: 5 cm and 0.1 % of the path length [m]."""
GROSS = 3.0
"""No pose of a right trajectory is farther off than this multiple of it."""
PLACED_M = 0.10
"""A georeferenced trajectory has at most this error on the earth [m]."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Errors:
    """Errors of one run against the truth."""

    length_m: float
    """True path length."""
    ate_m: float
    """RMSE of the positions of the final trajectory after the best rigid alignment."""
    largest_m: float
    """Largest of these errors."""
    error_95_m: float
    """95 % of these errors are at most this."""
    shape_m: float
    """Largest stated 2 sigma of a position after the best alignment."""
    closing_m: float
    """Error of the odometry's motion from the first to the last pose."""
    stated_m: float
    """Largest stated 2 sigma of a position of the final trajectory."""
    nees: float
    """Normalized estimation error squared per degree of freedom, mean of all stated poses."""
    bad_places: int
    """Stated poses that are wrong by more than 5 cm."""
    bad_announced: int
    """Those of them whose stated 2 sigma is above 5 cm, too."""
    placed_m: float | None
    """RMSE on the earth without any alignment; None = not georeferenced."""

    @property
    def right(self) -> bool:
        """Whether the trajectory is right, whatever the program says of it."""
        limit = BASE_M + PER_METER * self.length_m
        placed = self.placed_m is None or self.placed_m <= PLACED_M
        return self.ate_m <= limit and self.largest_m <= GROSS * limit and placed


def measure(runs: Mapping[str, StageRun[Any]], truth: Trajectory) -> Errors:
    """Compare the trajectories of a run with the truth."""
    level, odometry = runs["level"].artifact.folder, runs["odometry"].artifact.folder
    final, raw = (load_trajectory(folder / "trajectory.npz") for folder in (level, odometry))
    pairs = pair_poses(final, truth)
    absolute = absolute_error(pairs)
    error = absolute.position_m
    ends = pair_poses(raw, truth)
    motion = ends.T_map_body[0].inverse() @ ends.T_map_body[-1]
    true_motion = ends.T_true_body[0].inverse() @ ends.T_true_body[-1]
    placed = _on_earth(level, pairs.T_map_body.t)
    stated = _stated(level, final, truth)
    return Errors(
        length_m=_length_m(truth),
        ate_m=error.rmse,
        largest_m=error.maximum,
        error_95_m=float(np.percentile(absolute.position_errors_m, 95)),
        shape_m=stated.shape_m,
        closing_m=float(np.linalg.norm((true_motion.inverse() @ motion).t)),
        stated_m=stated.largest_m,
        nees=stated.nees,
        bad_places=stated.bad_places,
        bad_announced=stated.bad_announced,
        placed_m=None if placed is None else _rms(placed - pairs.T_true_body.t),
    )


@dataclass(frozen=True, slots=True, kw_only=True)
class Stated:
    """Stated covariances against true errors."""

    largest_m: float
    shape_m: float
    nees: float
    bad_places: int
    bad_announced: int


def _stated(level: Path, final: Trajectory, truth: Trajectory) -> Stated:
    found = load_uncertainty(level)
    assert found is not None
    first_ns = max(final.t_ns[0], truth.t_ns[0])
    last_ns = min(final.t_ns[-1], truth.t_ns[-1])
    t_ns = np.clip(found.t_ns, first_ns, last_ns)
    T, T_true = final.at(t_ns), truth.at(t_ns)
    p_map = T.t
    placed = _on_earth(level, p_map)
    if placed is None:  # relative to the first pose
        T_true = T[0] @ T_true[0].inverse() @ T_true
    else:
        p_map = placed
    turn = so3_log(T_true.R @ np.swapaxes(T.R, 1, 2))
    error = np.concatenate([turn, T_true.t - p_map], axis=1)[1:]
    chi2 = np.einsum("na,na->n", error, np.linalg.solve(found.cov[1:], error[:, :, None])[:, :, 0])
    bad = np.linalg.norm(error[:, 3:], axis=1) > BASE_M
    return Stated(
        largest_m=2.0 * float(found.sd_m.max()),
        shape_m=2.0 * float(found.shape_sd_m.max()),
        nees=float(chi2.mean()) / 6.0,
        bad_places=int(bad.sum()),
        bad_announced=int((bad & (2.0 * found.sd_m[1:] > BASE_M)).sum()),
    )


def _on_earth(level: Path, p_map: Array) -> Array | None:
    """Positions in the axes of the truth by the map's place on earth; None = it has none."""
    crs = read_crs(level)
    if crs is None:
        return None
    lat_rad, lon_rad = np.deg2rad([BRNO.lat_deg, BRNO.lon_deg]).tolist()
    true = GeodeticOrigin(lat_rad, lon_rad, BRNO.height_m)
    lat, lon, height_m = to_geodetic(crs.origin, p_map)
    return to_enu(true, lat, lon, ellipsoidal_height_m=height_m)


def _rms(difference: Array) -> float:
    return float(np.sqrt((difference**2).sum(axis=1).mean()))


def _length_m(truth: Trajectory) -> float:
    """Path length in steps of half a second, without the sway of the body."""
    places = truth.T_a_b.t[:: max(1, round(0.5e9 / np.diff(truth.t_ns).mean()))]
    return float(np.linalg.norm(np.diff(places, axis=0), axis=1).sum())
