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

    def modes(self, t_ns: Times, T_map_body: SE3, *, on_earth: bool) -> Array:
        """Independent errors of all poses that they make, one standard deviation each, (N, 6, M).

        Args:
            t_ns: Times of the poses, the first one that of the walk.
            T_map_body: N poses with z up.
            on_earth: False = relative to the first pose.

        Returns:
            Turn and shift of each pose, in axes of the map, by each error.
        """
        since_s = (t_ns - t_ns[0]) / 1e9
        of_rig = self.rig.modes(T_map_body, on_earth=on_earth)
        if on_earth:
            return of_rig
        heights = (_height_mode(doubt, since_s) for doubt in self.heights)
        turns = (_turn_mode(turn, since_s, T_map_body) for turn in self.turns)
        return np.concatenate([of_rig, *heights, *turns], axis=2)


def _height_mode(doubt: HeightDoubt, since_s: Array) -> Array:
    """Shifts of poses by a ride, (N, 6, 1)."""
    mode = np.zeros((len(since_s), 6, 1))
    mode[:, _Z, 0] = np.interp(since_s, [doubt.start_s, doubt.end_s], [0.0, doubt.rise_m])
    return mode


def _turn_mode(turn: TurnDoubt, since_s: Array, T_map_body: SE3) -> Array:
    """Errors of poses by a turn that grows while nothing observes it, (N, 6, 1).

    Axes of odometry and of a local map differ by its leveling only.
    """
    grown_s = np.clip(since_s - turn.start_s, 0.0, turn.end_s - turn.start_s)
    axis = np.array(turn.axis)
    arm = T_map_body.t - T_map_body.t[0] - np.array(turn.center_m)
    moved = np.cross(axis, arm)
    twist = np.concatenate([np.broadcast_to(axis, arm.shape), moved], axis=1)
    return np.asarray((twist * (turn.rate_sd_rad_s * grown_s)[:, None])[:, :, None])


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
        carried=load_carried_motion(odometry) if figures.lines is None else None,
    )
