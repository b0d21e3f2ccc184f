"""LiDAR against LiDAR from two maps (requirements V-CAL-1; V §2.3).

Each LiDAR alone makes a map of some seconds of the walk; the maps are registered. With the mount
of the first one fixed the result is the mount of the other: ``C_1^-1 C_2``.
"""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from recon4.calibration.mount_search import without_others
from recon4.calibration.recorded_walk import RecordedWalk
from recon4.calibration.tuning_methods import MAP_ALIGNMENT
from recon4.calibration.window import Window, place
from recon4.geometry.se3 import SE3, Array, mean_rotation
from recon4.model.rig import Rig
from recon4.registration.scan_registration import make_scan, register_scans
from recon4.settings.reads import CalibrationReads


@dataclass(frozen=True, slots=True, eq=False)
class MapAlignment:
    """Mount of a LiDAR from its maps."""

    T_body_sensor: SE3
    """Mean over the windows."""
    scatter_rad: float
    """Root mean square angle of the windows from the mean; NaN with a single one."""
    scatter_m: float
    """The same for the position [m]."""
    windows: int

    @property
    def agrees(self) -> bool:
        """Whether several windows give nearly the same mount."""
        return (
            self.scatter_rad < MAP_ALIGNMENT.scatter_rad
            and self.scatter_m < MAP_ALIGNMENT.scatter_m
        )


def align_maps(
    walk: RecordedWalk, rig: Rig, row: int, *, reference: int, settings: CalibrationReads
) -> MapAlignment | None:
    """Mount of a LiDAR such that its maps lie on those of the reference; None if none registers.

    Args:
        walk: The recording.
        rig: Where to begin.
        row: The LiDAR whose mount is estimated.
        reference: The LiDAR whose mount stays.
        settings: Of the odometry of each LiDAR alone and of the registration.
    """
    found = []
    for part in walk.rows(MAP_ALIGNMENT.windows, MAP_ALIGNMENT.window_s):
        maps = [
            walk.tracked_windows([part], without_others(rig, alone), settings, imu=None)
            for alone in (reference, row)
        ]
        if all(maps):
            both = (maps[0][0], maps[1][0])
            mount = _aligned(both, rig, (reference, row), settings=settings)
            found += [mount] if mount is not None else []
    if not found:
        return None
    T = SE3.stack(found)
    mean = SE3(mean_rotation(T.R), T.t.mean(axis=0))
    apart = mean.inverse() @ T
    many = len(found) > 1
    return MapAlignment(
        mean,
        float(np.sqrt(np.mean(apart.angle() ** 2))) if many else float("nan"),
        float(np.sqrt(np.mean(np.sum(apart.t**2, axis=1)))) if many else float("nan"),
        len(found),
    )


def _aligned(
    both: tuple[Window, Window], rig: Rig, rows: tuple[int, int], *, settings: CalibrationReads
) -> SE3 | None:
    """Both maps begin at the same body pose, so what is between them is the mount's error."""
    target, source = (
        make_scan(_map_of(window, rig, row)) for window, row in zip(both, rows, strict=True)
    )
    found = register_scans(target, source, initial=SE3.identity())
    if not found.converged:
        return None
    return found.T_target_source @ rig.sensors[rows[1]].T_body_sensor


def _map_of(window: Window, rig: Rig, row: int) -> Array:
    """Points of one LiDAR in the body frame at the start of the window [m], (N, 3)."""
    placed = place(window, rig).odom[window.sensor == row]
    T_odom_body = window.trajectory.at(window.knot_ns[:1], slack_ns=10**8)[0]
    return T_odom_body.inverse() @ placed


def with_mount(rig: Rig, row: int, T_body_sensor: SE3) -> Rig:
    """The rig with another mount of one LiDAR."""
    sensors = list(rig.sensors)
    sensors[row] = replace(sensors[row], T_body_sensor=T_body_sensor)
    return replace(rig, sensors=tuple(sensors))
