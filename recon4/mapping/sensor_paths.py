"""Where the sensors of a map were: times and ranges of its points follow from it."""

from __future__ import annotations

from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from recon4.errors import StoreError
from recon4.geometry.se3 import Array
from recon4.kernels.voxels import face_sensor
from recon4.mapping.tuning import TILES
from recon4.model.rig import Rig
from recon4.model.trajectory import Times, Trajectory
from recon4.store.arrays import load_arrays, save_arrays


@dataclass(frozen=True, slots=True, eq=False)
class SensorPaths:
    """When the multiframes of a map began, and where its sensors were."""

    frame_ns: Times = field(default_factory=lambda: np.empty(0, np.int64))
    """Start of each multiframe [ns], (F,)."""
    t_ns: Times = field(default_factory=lambda: np.empty(0, np.int64))
    """Times of the positions [ns], increasing, (K,)."""
    p_map: Array = field(default_factory=lambda: np.empty((0, 0, 3)))
    """Positions of the sensors in the map [m], float64 (S, K, 3)."""

    @staticmethod
    def of(frame_ns: Times, trajectory: Trajectory, rig: Rig) -> SensorPaths:
        """The paths of all sensors of a walk.

        Args:
            frame_ns: Start of each multiframe [ns], (F,).
            trajectory: ``T_map_body``, which covers them.
            rig: The sensors.
        """
        if not len(frame_ns):
            return SensorPaths()
        first = min(int(frame_ns[0]), int(trajectory.t_ns[0]))
        stop = max(int(frame_ns[-1]), int(trajectory.t_ns[-1])) + TILES.path_step_ns
        t_ns = np.arange(first, stop, TILES.path_step_ns, dtype=np.int64)
        T_map_body = trajectory.at(t_ns, slack_ns=stop - first)
        p_map = [T_map_body @ np.tile(p, (len(t_ns), 1)) for p in rig.T_body_sensor.t]
        return SensorPaths(frame_ns, t_ns, np.stack(p_map))

    @staticmethod
    def load(path: Path) -> SensorPaths:
        """Read what `save` wrote.

        Raises:
            StoreError: If the file is missing or damaged.
        """
        found = load_arrays(path, ["frame_ns", "t_ns", "p_map"])
        frame_ns, t_ns, p_map = found["frame_ns"], found["t_ns"], found["p_map"]
        good = frame_ns.dtype == t_ns.dtype == np.int64 and p_map.dtype == np.float64
        good = good and frame_ns.ndim == t_ns.ndim == 1 and p_map.ndim == 3
        if not good or p_map.shape[1:] != (len(t_ns), 3) or np.any(np.diff(t_ns) <= 0):
            raise StoreError(f"{path.name}: expected paths of sensors, got {_shapes(found)}")
        return SensorPaths(frame_ns, t_ns, p_map)

    def save(self, path: Path) -> None:
        """Write them as a file of arrays."""
        save_arrays(path, {"frame_ns": self.frame_ns, "t_ns": self.t_ns, "p_map": self.p_map})

    @property
    def known(self) -> bool:
        """Whether there are positions of sensors."""
        return len(self.t_ns) > 0

    def began_ns(self, frame_id: NDArray[np.uint32]) -> Times:
        """Start of the multiframe of each point [ns], (N,); zeros if none is known.

        Raises:
            StoreError: If there is no such multiframe.
        """
        if not len(self.frame_ns):
            return np.zeros(len(frame_id), np.int64)
        if len(frame_id) and int(frame_id.max()) >= len(self.frame_ns):
            raise StoreError(
                f"the map has points of multiframe {frame_id.max()}, "
                f"but the times of only {len(self.frame_ns)}"
            )
        return self.frame_ns[frame_id]

    def at(self, t_ns: Times, sensor: NDArray[np.uint8]) -> Array:
        """Position of the sensor of each point at its time [m], (N, 3).

        Raises:
            StoreError: If there is no such sensor.
        """
        if len(sensor) and int(sensor.max()) >= len(self.p_map):
            raise StoreError(
                f"the map has points of sensor {sensor.max()}, "
                f"but the paths of only {len(self.p_map)}"
            )
        left = np.searchsorted(self.t_ns, t_ns, side="right") - 1
        left = np.clip(left, 0, max(len(self.t_ns) - 2, 0))
        right = np.minimum(left + 1, len(self.t_ns) - 1)
        span = np.maximum(self.t_ns[right] - self.t_ns[left], 1)
        part = ((t_ns - self.t_ns[left]) / span)[:, None]
        return (1.0 - part) * self.p_map[sensor, left] + part * self.p_map[sensor, right]


def range_and_incidence(
    to_sensor_m: Array, normal: NDArray[np.float16]
) -> dict[str, NDArray[np.float32]]:
    """``range_m`` and ``incidence_rad`` of points, (N,) each.

    Args:
        to_sensor_m: From where each point was measured to its sensor [m], (N, 3).
        normal: Of the surface, zeros where there is none, (N, 3).
    """
    range_m, incidence_rad = np.empty((2, len(normal)), np.float32)
    face_sensor(normal.astype(np.float32), to_sensor_m.astype(np.float32), range_m, incidence_rad)
    return {"range_m": range_m, "incidence_rad": incidence_rad}


def _shapes(arrays: dict[str, NDArray[Any]]) -> str:
    return ", ".join(f"{name} {values.dtype}{values.shape}" for name, values in arrays.items())
