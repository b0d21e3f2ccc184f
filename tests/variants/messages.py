"""Messages of bags, recorded at another time than their stamp."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from tests.robot_bags import RobotBag
from tests.variants.layouts import CODES

_CLOUD = "sensor_msgs/msg/PointCloud2"


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
