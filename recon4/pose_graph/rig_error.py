"""What an error of the rig file does to the poses: an error that turns with the body.

Two LiDARs that contradict each other pull every pose of the body to a place between what each of
them says. Where the body stands as at the start this is the same and cancels out; where it has
turned, it does not. Neighboring poses share it, so no residual of the graph shows it.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from itertools import groupby

import numpy as np

from recon4.geometry.se3 import ROTATION, SE3, TRANSLATION, Array, skew
from recon4.model.calibration_figures import GNSS, IMU, ParameterFigures
from recon4.pose_graph.tuning_solve import RIG_ERROR


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
        modes = np.kron(np.diag([self.turn_rad, self.shift_m]), every)
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
