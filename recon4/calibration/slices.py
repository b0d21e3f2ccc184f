"""A horizontal slice through a part of the walk, with the points of each LiDAR."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from recon4.calibration.recorded_walk import RecordedWalk
from recon4.calibration.tuning_methods import SLICES
from recon4.geometry.se3 import Array
from recon4.mapping.undistort import place
from recon4.model.rig import Rig


@dataclass(frozen=True, slots=True, kw_only=True)
class LidarSlices:
    """A horizontal slice as one LiDAR sees it, around the body."""

    name: str
    """Of the LiDAR."""
    before: list[list[float]]
    """Points by the rig file, x and y [m], (N, 2)."""
    after: list[list[float]]
    """The same by the calibrated rig."""


def slice_points(walk: RecordedWalk, rig: Rig, *, thickness_m: float) -> list[tuple[str, Array]]:
    """Points near the height of the body in the part of the walk where it turns most.

    Args:
        walk: The recording; its trajectory is used with every rig.
        rig: Mounts of the LiDARs.
        thickness_m: Of the slice [m].

    Returns:
        Name of each LiDAR and its points around the body, x and y [m], (N, 2).
    """
    rows = walk.rows(1, SLICES.seconds)
    if not rows:
        return []
    frames = walk.with_rig(rig).frames
    middle = walk.trajectory.at(frames.t_mid_ns[[rows[0][len(rows[0]) // 2]]]).t[0]
    found: list[list[Array]] = [[] for _ in rig.sensors]
    for row in rows[0]:
        frame = frames[row]
        p = place(frame, walk.trajectory, rig) - middle
        near = (np.abs(p[:, 2]) < thickness_m / 2.0) & (
            np.abs(p[:, :2]).max(axis=1) < SLICES.reach_m
        )
        for sensor, parts in enumerate(found):
            parts.append(p[near & (frame.sensor == sensor), :2])
    named = zip(rig.sensors, found, strict=True)
    return [(sensor.name, _some(np.concatenate(parts))) for sensor, parts in named]


def lidar_slices(walk: RecordedWalk, calibrated: Rig) -> tuple[LidarSlices, ...]:
    """The same slice by the rig of a walk and by a calibrated one, to the centimeter."""
    before, after = (
        {
            name: np.round(_some(p, SLICES.max_kept), 2).tolist()
            for name, p in slice_points(walk, rig, thickness_m=SLICES.thickness_m)
        }
        for rig in (walk.frames.rig, calibrated)
    )
    return tuple(LidarSlices(name=name, before=p, after=after[name]) for name, p in before.items())


def _some(p: NDArray[np.float64], most: int = SLICES.max_points) -> Array:
    return p[:: max(1, -(-len(p) // most))]
