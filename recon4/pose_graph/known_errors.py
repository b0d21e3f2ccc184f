"""Errors of the poses that other stages have found, and no residual of the graph shows.

Two LiDARs that contradict each other pull every pose of the body to a place between what each of
them says. Where the body stands as at the start this is the same and cancels out; where it has
turned, it does not. Neighboring poses share it, so no residual of the graph shows it.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from itertools import groupby
from pathlib import Path

import numpy as np

from recon4.geometry.se3 import ROTATION, SE3, TRANSLATION, Array, skew
from recon4.model.calibration_figures import GNSS, IMU, CalibrationFigures, ParameterFigures
from recon4.model.odometry_figures import HeightDoubt, OdometryFigures, TurnDoubt
from recon4.model.trajectory import Times
from recon4.pose_graph.carried_motion import CarriedMotion, load_carried_motion
from recon4.pose_graph.tuning_solve import RIG_ERROR
from recon4.store.stage import read_figures

_Z = 5


@dataclass(frozen=True, slots=True, kw_only=True)
class RigError:
    """Standard deviations along each axis of the body."""

    turn_rad: float = 0.0
    shift_m: float = 0.0
    of_body: bool = False
    """Whether the turn is that of the body itself, which the map follows as a whole: relative to
    the first pose it is turned about it."""

    def seen_at(self, p_body: Array) -> RigError:
        """The same where the only LiDAR is at ``p_body`` [m], (3,): a body that it turns by ``δ``
        is shifted by ``-δ × p_body``, too.
        """
        if not self.of_body:
            return self
        return replace(self, shift_m=self.turn_rad * float(np.linalg.norm(p_body)))

    def modes(self, T_map_body: SE3, *, on_earth: bool) -> Array:
        """Independent errors of all poses that it makes, one standard deviation each, (N, 6, 12).

        Args:
            T_map_body: N poses.
            on_earth: False = relative to the first pose, which has the same error.

        Returns:
            Turn and shift of each pose, in axes of the map, by each of twelve errors.
        """
        R = T_map_body.R
        since = R if on_earth else R - R[0]
        # A turn that is not small acts about every axis, by its square.
        size = np.sqrt((since**2).sum(axis=(1, 2)) / 3.0)[:, None, None]
        spread = self.turn_rad * size * np.eye(3)
        every = np.concatenate([since, spread], axis=2)
        modes = np.asarray(np.kron(np.diag([self.turn_rad, self.shift_m]), every), np.float64)
        if self.of_body and not on_earth:
            arm = T_map_body.t - T_map_body.t[0]
            modes[:, TRANSLATION, ROTATION] = self.turn_rad * skew(arm) @ R[0]
        return modes


EXACT = RigError()
"""The rig file is right as far as is known."""


def audited_error(parameters: Sequence[ParameterFigures]) -> RigError:
    """The error of the poses by what an audit found of the LiDARs; the worst of them counts.

    The odometry estimates the errors of the IMU by itself, and an error of the GNSS antenna moves
    the map on the earth only. Where one LiDAR is alone, what is found of the IMU's mount may as
    well be an error of its own, which turns every pose of the body and bends no map. With
    ``T'_k = T_k exp(δ)``, aligned at the first pose, the turn of pose ``k`` is off by
    ``(R_k - R_0) δ``, and its position by ``-R_0 δ × (p_k - p_0)``. Exchanged
    axes are those of an IMU.
    """
    lidars = [row for row in parameters if row.sensor not in (IMU, GNSS)]
    off = [row for row in lidars if row.status == "off"]
    found = [_of_one(list(rows)) for _, rows in groupby(off, key=lambda row: row.sensor)]
    if not lidars:
        of_imu = [row for row in parameters if row.sensor == IMU and row.status == "off"]
        size_rad = _size(of_imu, "rotation")
        alone = size_rad < RIG_ERROR.exchanged_rad
        found = [RigError(turn_rad=RIG_ERROR.either * size_rad, of_body=alone)]
    return RigError(
        of_body=any(one.of_body for one in found),
        turn_rad=max((one.turn_rad for one in found), default=0.0),
        shift_m=max((one.shift_m for one in found), default=0.0),
    )


def _of_one(rows: Sequence[ParameterFigures]) -> RigError:
    """The same of one LiDAR, by the rows that are off."""
    turn_rad, shift_m, clock_s = (
        _size(rows, quantity) for quantity in ("rotation", "position", "clock")
    )
    return RigError(
        turn_rad=RIG_ERROR.pull * float(np.hypot(turn_rad, RIG_ERROR.turn_rad_s * clock_s)),
        shift_m=float(
            np.linalg.norm(
                [
                    RIG_ERROR.arm_m * turn_rad,
                    RIG_ERROR.pull * shift_m,
                    RIG_ERROR.pull * RIG_ERROR.walk_m_s * clock_s,
                ]
            )
        ),
    )


def _size(rows: Sequence[ParameterFigures], quantity: str) -> float:
    return float(np.linalg.norm([row.change for row in rows if row.quantity == quantity]))


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
