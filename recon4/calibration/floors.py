"""Floor normals and gravity while the backpack rests, for the calibration by gravity."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from recon4.calibration.number_rows import read_number_rows
from recon4.calibration.tuning_methods import RESTS
from recon4.geometry.se3 import Array
from recon4.model.frames import RecordedFrames
from recon4.model.multiframe import Multiframe
from recon4.model.rig import Rig


@dataclass(frozen=True, slots=True, eq=False)
class Inclinations:
    """Verticals at several inclinations of the backpack."""

    normal_body: Array
    """Normals of the floor, up, (N, 3)."""
    force_imu: Array
    """What the accelerometer reads, up, (N, 3)."""

    def __len__(self) -> int:
        return len(self.normal_body)


def find_inclinations(frames: RecordedFrames, rig: Rig) -> Inclinations:
    """Floor and gravity of each time the backpack rests for half a second or more."""
    imu = frames.imu
    normals, forces = [], []
    if imu is not None and len(imu) > 1:
        for first, last in _rests(frames):
            rows = (imu.t_ns >= frames[first].t_ns) & (imu.t_ns <= frames[last].t_ns)
            normal = _floor_normal(frames[(first + last) // 2], rig)
            if normal is not None and rows.any():
                normals.append(normal)
                forces.append(imu.accel_m_s2[rows].mean(axis=0))
    return Inclinations(np.array(normals).reshape(-1, 3), np.array(forces).reshape(-1, 3))


def read_inclinations(path: Path) -> Inclinations:
    """Read picked pairs: ``gx gy gz nx ny nz`` a line, force at rest and normal of the floor.

    Raises:
        CorruptFile: If a line has another number of values.
    """
    table = read_number_rows(path, "gx gy gz nx ny nz", most_bytes=RESTS.max_bytes)
    return Inclinations(table[:, 3:], table[:, :3])


def _rests(frames: RecordedFrames) -> list[tuple[int, int]]:
    """First and last multiframe of each rest."""
    still = np.array([_is_at_rest(frames, k) for k in range(len(frames))])
    edges = np.flatnonzero(np.diff(np.concatenate([[False], still, [False]]).astype(int)))
    pairs = zip(edges[::2], edges[1::2] - 1, strict=True)
    return [(int(a), int(b)) for a, b in pairs if b - a + 1 >= RESTS.min_frames]


def _is_at_rest(frames: RecordedFrames, k: int) -> bool:
    imu, frame = frames.imu, frames[k]
    assert imu is not None
    first, last = np.searchsorted(imu.t_ns, [frame.t_ns, frame.t_ns + frame.duration_ns])
    if last - first < RESTS.min_frames:
        return False
    turn, force = imu.gyro_rad_s[first:last], imu.accel_m_s2[first:last]
    return bool(
        turn.std(axis=0).max() < RESTS.rest_rad_s and force.std(axis=0).max() < RESTS.rest_m_s2
    )


def _floor_normal(frame: Multiframe, rig: Rig) -> Array | None:
    """Normal of the largest plane below the body, up, (3,); None if there is none."""
    p = np.concatenate(
        [
            sensor.T_body_sensor @ frame.xyz[frame.sensor == row].astype(np.float64)
            for row, sensor in enumerate(rig.sensors)
            if sensor.enabled
        ]
    )
    p = p[p[:, 2] < -RESTS.below_m]
    if len(p) < RESTS.min_points:
        return None
    counts, edges = np.histogram(p[:, 2], bins=np.arange(p[:, 2].min(), 0.1, 0.1))
    lowest = edges[int(np.argmax(counts))]
    kept: NDArray[np.bool_] = np.abs(p[:, 2] - lowest) < 0.3
    for _ in range(RESTS.rounds):
        if np.count_nonzero(kept) < RESTS.min_points:
            return None
        center = p[kept].mean(axis=0)
        normal: Array = np.linalg.svd(p[kept] - center, full_matrices=False)[2][-1]
        kept = np.abs((p - center) @ normal) < RESTS.thickness_m
    normal = normal * np.sign(normal[2])
    return normal if normal[2] > RESTS.flat else None
