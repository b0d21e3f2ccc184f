"""Undistortion: place every point by the pose at its time (V §2.6, Eq. 2.8; A5)."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from recon4.errors import ConfigError
from recon4.geometry.se3 import SE3, Array
from recon4.kernels.deskew import place_sensor_points
from recon4.locales.coded import CodedText
from recon4.mapping.tuning import POINT_PLACES
from recon4.model.multiframe import Multiframe
from recon4.model.rig import Rig
from recon4.model.trajectory import Times, Trajectory


@dataclass(frozen=True, slots=True, eq=False)
class Placed:
    """The points of a multiframe in the frame of the trajectory."""

    xyz_m: Array
    """Points [m], (N, 3)."""
    origin_m: Array
    """Position of the sensor at the time of each point [m], (N, 3)."""


def place(
    frame: Multiframe, trajectory: Trajectory, rig: Rig, *, slack_ns: int | None = None
) -> Array:
    """Undistort a multiframe: its points in the frame ``a`` of the trajectory.

    Args:
        frame: Points in the frames of their sensors.
        trajectory: ``T_a_body``.
        rig: Poses of the sensors in the body.
        slack_ns: Largest time of a point before or after the trajectory; the first or last motion
            is extrapolated. None = the duration of the frame, which a trajectory with one pose
            per frame requires.

    Returns:
        Points [m], float64 (N, 3).

    Raises:
        OutOfRange: If the trajectory does not cover the frame.
        ConfigError: If the frame has points of a sensor the rig does not have.
    """
    placed = Placed(np.empty((len(frame), 3)), np.empty((0, 3)))
    _place(frame, trajectory, rig, placed=placed, slack_ns=slack_ns)
    return placed.xyz_m


def place_with_origins(
    frame: Multiframe, trajectory: Trajectory, rig: Rig, *, slack_ns: int | None = None
) -> Placed:
    """Undistort a multiframe as `place` does; also the position of the sensor for each point."""
    placed = Placed(np.empty((len(frame), 3)), np.empty((len(frame), 3)))
    _place(frame, trajectory, rig, placed=placed, slack_ns=slack_ns)
    return placed


def _place(
    frame: Multiframe,
    trajectory: Trajectory,
    rig: Rig,
    *,
    placed: Placed,
    slack_ns: int | None,
) -> None:
    """Fill ``placed``; its positions of the sensor may be left out."""
    if len(frame) == 0:
        return
    if frame.sensor.max() >= len(rig.sensors):
        sensor, count = int(frame.sensor.max()), len(rig.sensors)
        raise ConfigError(
            CodedText(
                "multiframe-sensor",
                frame=frame.frame_id,
                sensor=sensor,
                rig=rig.name,
                sensors=count,
            )
        )
    knot_ns = _knots(frame, trajectory.t_ns)
    slack = frame.duration_ns if slack_ns is None else slack_ns
    T_map_body = trajectory.at(knot_ns, slack_ns=slack)
    T_map_sensor = SE3(T_map_body.R[:, None], T_map_body.t[:, None]) @ rig.T_body_sensor
    place_sensor_points(
        np.ascontiguousarray(frame.xyz),
        np.ascontiguousarray(frame.sensor),
        np.ascontiguousarray(frame.dt_ns),
        knot_ns - frame.t_ns,
        np.ascontiguousarray(T_map_sensor.R),
        np.ascontiguousarray(T_map_sensor.t),
        placed.xyz_m,
        placed.origin_m,
    )


def _knots(frame: Multiframe, pose_ns: Times) -> Times:
    """Times from the first to the last point, with the poses between them, at most 1 ms apart."""
    first = frame.t_ns + int(frame.dt_ns.min())
    last = max(frame.t_ns + int(frame.dt_ns.max()), first + 1)
    steps = -(-(last - first) // POINT_PLACES.knot_ns)
    regular = first + (last - first) * np.arange(steps + 1, dtype=np.int64) // steps
    a, b = np.searchsorted(pose_ns, [first, last])
    return np.union1d(regular, pose_ns[a:b])
