"""A simulated recording of line scans as a rosbag2, as ROS drivers would publish it."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from recon4.geometry.se3 import Array
from recon4.model.laser_scans import LaserScans
from recon4.model.samples import ImuSamples
from recon4.model.trajectory import Times

_SCAN, _JOINTS, _IMU = (
    "sensor_msgs/msg/LaserScan",
    "sensor_msgs/msg/JointState",
    "sensor_msgs/msg/Imu",
)


@contextmanager
def open_line_bag(folder: Path) -> Iterator[LineBag]:
    """Create a bag; it is complete when the block ends."""
    from rosbags.rosbag2 import StoragePlugin, Writer

    with Writer(folder, version=9, storage_plugin=StoragePlugin.SQLITE3) as writer:
        yield LineBag(writer)


class LineBag:
    """Writes line scans, scans of a 2-D laser, angles of a head and IMU samples."""

    def __init__(self, writer: Any) -> None:
        from rosbags.typesys import Stores, get_typestore

        self._writer = writer
        self._store = get_typestore(Stores.ROS2_HUMBLE)
        self._connections: dict[str, object] = {}

    def scans(
        self, topic: str, scans: LaserScans, intensity: NDArray[np.uint8] | None = None
    ) -> None:
        """Append scans as ``sensor_msgs/LaserScan``; no return is infinity (REP 117)."""
        message = self._store.types[_SCAN]
        none = np.zeros(0, np.float32)
        for k, t in enumerate(scans.t_ns):
            ranges = np.where(np.isnan(scans.ranges(k)), np.float32(np.inf), scans.ranges(k))
            first, step = float(scans.angle_min_rad[k]), float(scans.angle_step_rad[k])
            self._write(
                topic,
                _SCAN,
                int(t),
                message=message(
                    header=self._header(int(t), topic.split("/")[1]),
                    angle_min=first,
                    angle_max=first + step * (len(ranges) - 1),
                    angle_increment=step,
                    time_increment=float(scans.time_step_s[k]),
                    scan_time=float(scans.duration_s[k]),
                    range_min=0.1,
                    range_max=float(scans.range_max_m),
                    ranges=ranges.astype(np.float32),
                    intensities=none if intensity is None else intensity[k].astype(np.float32),
                ),
            )

    def head(self, topic: str, t_ns: Times, angle_rad: Array) -> None:
        """Append angles of the head as ``sensor_msgs/JointState``."""
        message = self._store.types[_JOINTS]
        none = np.zeros(0)
        for t, angle in zip(t_ns, angle_rad, strict=True):
            state = message(
                header=self._header(int(t), "profiler"),
                name=["head"],
                position=np.array([angle]),
                velocity=none,
                effort=none,
            )
            self._write(topic, _JOINTS, int(t), message=state)

    def imu(self, samples: ImuSamples) -> None:
        """Append IMU samples on ``/imu/data``."""
        types, unknown = self._store.types, np.zeros(9)
        vector, turn = types["geometry_msgs/msg/Vector3"], types["geometry_msgs/msg/Quaternion"]
        for t, gyro, accel in zip(
            samples.t_ns, samples.gyro_rad_s, samples.accel_m_s2, strict=True
        ):
            message = types[_IMU](
                header=self._header(int(t), "imu"),
                orientation=turn(x=0.0, y=0.0, z=0.0, w=1.0),
                orientation_covariance=np.array([-1.0, *unknown[1:]]),
                angular_velocity=vector(*(float(v) for v in gyro)),
                angular_velocity_covariance=unknown,
                linear_acceleration=vector(*(float(v) for v in accel)),
                linear_acceleration_covariance=unknown,
            )
            self._write("/imu/data", _IMU, int(t), message=message)

    def _write(self, topic: str, kind: str, t_ns: int, *, message: Any) -> None:
        if topic not in self._connections:
            self._connections[topic] = self._writer.add_connection(
                topic, kind, typestore=self._store
            )
        self._writer.write(self._connections[topic], t_ns, self._store.serialize_cdr(message, kind))

    def _header(self, t_ns: int, frame: str) -> Any:
        seconds, nanoseconds = divmod(t_ns, 1_000_000_000)
        types = self._store.types
        stamp = types["builtin_interfaces/msg/Time"](sec=seconds, nanosec=nanoseconds)
        return types["std_msgs/msg/Header"](stamp=stamp, frame_id=frame)
