"""Messages of bags, recorded at another time than their stamp."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from rosbags.typesys import get_types_from_msg

from recon4.model.laser_scans import LaserScans
from tests.robot_bags import RobotBag
from tests.variants.layouts import CODES

_CLOUD = "sensor_msgs/msg/PointCloud2"
_JOINTS = "sensor_msgs/msg/JointState"


class _At:
    """While it lasts, a bag records at one time, whatever the stamps are."""

    def __init__(self, bag: RobotBag, t_ns: int) -> None:
        self._bag, self._t_ns, self._write = bag, t_ns, bag.write

    def __enter__(self) -> None:
        self._bag.write = lambda topic, kind, _, message: self._write(
            topic, kind, self._t_ns, message
        )

    def __exit__(self, *_: object) -> None:
        del self._bag.write


@dataclass(frozen=True, slots=True, eq=False)
class CloudMessage:
    topic: str
    frame: str
    stamp_ns: int
    points: np.ndarray
    dense: bool = True
    """What ``is_dense`` says; drivers do not always know."""

    def __call__(self, bag: RobotBag, t_ns: int) -> None:
        dtype = self.points.dtype
        fields = [
            bag.make(
                "sensor_msgs/msg/PointField",
                name=name,
                offset=int(dtype.fields[name][1]),
                datatype=CODES[dtype.fields[name][0].str[1:]],
                count=1,
            )
            for name in dtype.names
        ]
        height, width = self.points.shape if self.points.ndim == 2 else (1, len(self.points))
        message = bag.make(
            _CLOUD,
            header=bag.header(self.stamp_ns, self.frame),
            height=height,
            width=width,
            fields=fields,
            is_bigendian=dtype["x"].byteorder == ">",
            point_step=dtype.itemsize,
            row_step=dtype.itemsize * width,
            data=np.frombuffer(self.points.tobytes(), np.uint8),
            is_dense=self.dense,
        )
        bag.write(self.topic, _CLOUD, t_ns, message)


@dataclass(frozen=True, slots=True, eq=False)
class ImuMessage:
    topic: str
    frame: str
    stamp_ns: int
    gyro: np.ndarray
    accel: np.ndarray
    absent: tuple[str, ...] = ()

    def __call__(self, bag: RobotBag, t_ns: int) -> None:
        bag.frame = self.frame
        with _At(bag, t_ns):
            bag.imu(self.topic, self.stamp_ns, self.gyro, self.accel, absent=self.absent)


@dataclass(frozen=True, slots=True)
class Fix:
    stamp_ns: int
    place: tuple[float, float, float]
    status: int

    def __call__(self, bag: RobotBag, t_ns: int) -> None:
        bag.frame = "gps"
        with _At(bag, t_ns):
            bag.fix("/fix", self.stamp_ns, *self.place, status=self.status)


@dataclass(frozen=True, slots=True, eq=False)
class PacketsMessage:
    """Raw packets of a Velodyne; the stamps are those of their arrival."""

    topic: str
    frame: str
    t_ns: np.ndarray
    payloads: np.ndarray

    def __call__(self, bag: RobotBag, t_ns: int) -> None:
        bag.frame = self.frame
        with _At(bag, t_ns):
            bag.scan(self.topic, self.t_ns, self.payloads)


@dataclass(frozen=True, slots=True)
class OdometryMessage:
    topic: str
    frame: str
    stamp_ns: int
    x_m: float
    child: str

    def __call__(self, bag: RobotBag, t_ns: int) -> None:
        bag.frame = self.frame
        with _At(bag, t_ns):
            bag.odometry(self.topic, self.stamp_ns, self.x_m, child=self.child)


DRIVER_MESSAGES = {
    "livox_ros_driver2/msg/CustomMsg": ("PointCloud2", "xfer_format"),
    "livox_ros_driver/msg/CustomMsg": ("PointCloud2", "xfer_format"),
    "sensor_msgs/msg/PointCloud": ("PointCloud2",),
}
"""Types of messages of LiDARs that are not read, and what a refusal must name."""


@dataclass(frozen=True, slots=True)
class DriverMessage:
    """Bytes in a message of a driver; what they are does not matter."""

    topic: str
    kind: str
    stamp_ns: int

    def __call__(self, bag: RobotBag, t_ns: int) -> None:
        if self.kind not in bag.store.types:
            text = "std_msgs/Header header\nuint8[] buf\n"
            bag.store.register(get_types_from_msg(text, self.kind))
        bag.write(self.topic, self.kind, t_ns, self._content(bag))

    def _content(self, bag: RobotBag) -> object:
        header = bag.header(self.stamp_ns)
        if self.kind == "sensor_msgs/msg/PointCloud":
            return bag.make(self.kind, header=header, points=[], channels=[])
        return bag.make(self.kind, header=header, buf=np.zeros(500, np.uint8))


@dataclass(frozen=True, slots=True, eq=False)
class ScanMessage:
    """A scan of a 2-D laser or a line of a profiler as ``LaserScan``."""

    topic: str
    stamp_ns: int
    scans: LaserScans
    row: int
    none: float
    """What stands for no return."""
    scale: float = 1.0
    """From meters to the unit of the ranges."""
    intensity: np.ndarray | None = None

    def __call__(self, bag: RobotBag, t_ns: int) -> None:
        ranges = self.scans.ranges(self.row).astype(np.float64)
        first = float(self.scans.angle_min_rad[self.row])
        step = float(self.scans.angle_step_rad[self.row])
        none = np.zeros(0, np.float32)
        message = bag.make(
            "sensor_msgs/msg/LaserScan",
            header=bag.header(self.stamp_ns, self.topic.strip("/").split("/")[0]),
            angle_min=first,
            angle_max=first + step * (len(ranges) - 1),
            angle_increment=step,
            time_increment=float(self.scans.time_step_s[self.row]),
            scan_time=0.0,
            range_min=0.1 * self.scale,
            range_max=float(self.scans.range_max_m) * self.scale,
            ranges=(np.where(np.isfinite(ranges), ranges, self.none) * self.scale).astype("<f4"),
            intensities=none if self.intensity is None else self.intensity.astype(np.float32),
        )
        bag.write(self.topic, "sensor_msgs/msg/LaserScan", t_ns, message)


@dataclass(frozen=True, slots=True)
class AnglesMessage:
    """Angles of joints, that of the head first."""

    topic: str
    stamp_ns: int
    positions: tuple[float, ...]

    def __call__(self, bag: RobotBag, t_ns: int) -> None:
        message = bag.make(
            _JOINTS,
            header=bag.header(self.stamp_ns, "profiler"),
            name=[f"joint_{k}" for k in range(len(self.positions))],
            position=np.array(self.positions, np.float64),
            velocity=np.zeros(0),
            effort=np.zeros(0),
        )
        bag.write(self.topic, _JOINTS, t_ns, message)
