"""Errors of the poses that other stages have found, and no residual of the graph shows."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path

import numpy as np

from recon4.geometry.se3 import SE3, Array
from recon4.model.calibration_figures import CalibrationFigures
from recon4.model.odometry_figures import HeightDoubt, OdometryFigures, TurnDoubt
from recon4.model.trajectory import Times
from recon4.pose_graph.carried_motion import CarriedMotion, load_carried_motion
from recon4.pose_graph.rig_error import EXACT, RigError, audited_error
from recon4.store.stage import read_figures

_Z = 5


@dataclass(frozen=True, slots=True, kw_only=True)
class KnownErrors:
    """What is known to be wrong."""

    rig: RigError = EXACT
    """A LiDAR that is not as the rig file says."""
    heights: tuple[HeightDoubt, ...] = ()
    """Rides that no LiDAR sees; positions on the earth show them, a local map does not."""
    turns: tuple[TurnDoubt, ...] = ()
    """Turns that no LiDAR observes; likewise."""
    carried: CarriedMotion | None = None
    """Motion that only the accelerometer carries: part of the odometry edges; None = none."""

    def cov(self, t_ns: Times, T_map_body: SE3, *, on_earth: bool) -> Array:
        """Covariances that they add to poses, (N, 6, 6), turn first, in axes of the map.

        Args:
            t_ns: Times of the poses, the first one that of the walk.
            T_map_body: N poses with z up.
            on_earth: False = relative to the first pose.
        """
        out = self.rig.cov(T_map_body, on_earth=on_earth)
        since_s = (t_ns - t_ns[0]) / 1e9
        for doubt in () if on_earth else self.heights:
            height_m = np.interp(since_s, [doubt.start_s, doubt.end_s], [0.0, doubt.rise_m])
            out[:, _Z, _Z] += height_m**2
        for turn in () if on_earth else self.turns:
            out += _turn_cov(turn, since_s, T_map_body)
        return out


def _turn_cov(turn: TurnDoubt, since_s: Array, T_map_body: SE3) -> Array:
    """Covariances of poses by a turn that grows while nothing observes it, (N, 6, 6).

    Axes of odometry and of a local map differ by its leveling only.
    """
    grown_s = np.clip(since_s - turn.start_s, 0.0, turn.end_s - turn.start_s)
    axis = np.array(turn.axis)
    arm = T_map_body.t - T_map_body.t[0] - np.array(turn.center_m)
    moved = np.cross(axis, arm)
    twist = np.concatenate([np.broadcast_to(axis, arm.shape), moved], axis=1)
    twist *= (turn.rate_sd_rad_s * grown_s)[:, None]
    return np.asarray(twist[:, :, None] * twist[:, None, :])


NOTHING_KNOWN = KnownErrors()


def load_known_errors(*, audit: Path | None = None, odometry: Path | None = None) -> KnownErrors:
    """What the figures of stages say against the poses; None = there is no such stage.

    Raises:
        StoreError: If figures or arrays are missing or damaged.
    """
    rig = audited_error(read_figures(audit, CalibrationFigures).parameters) if audit else EXACT
    if odometry is None:
        return KnownErrors(rig=rig)
    figures = read_figures(odometry, OdometryFigures)
    return KnownErrors(
        rig=rig,
        heights=figures.heights,
        turns=figures.turns,
        carried=load_carried_motion(odometry) if figures.imu and figures.lines is None else None,
    )
