"""A simulated recording as a rosbag2: packets, IMU and GNSS as a ROS driver would publish them."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from enum import IntEnum
from functools import partial
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from recon4.model.lidars import lidar_model
from recon4.model.rig import Rig
from recon4.model.samples import GnssQuality, GnssSamples, ImuSamples
from recon4.model.trajectory import Times
from recon4.recording.packets.livox.models import MODELS, LivoxModel, header_of, layout_of
from recon4.simulation.bag_packets import PACKET_MESSAGES, Packet, PacketMessage, Types
from recon4.units import SECOND_NS


class NavSatLevel(IntEnum):
    """Levels of ``sensor_msgs/NavSatStatus``."""

    NO_FIX = -1
    FIX = 0
    GBAS_FIX = 2


def _message_of(model: str) -> PacketMessage:
    maker = lidar_model(model).maker
    return livox_message(model) if maker == "Livox" else PACKET_MESSAGES[maker]


@contextmanager
def open_bag(folder: Path, rig: Rig) -> Iterator[BagWriter]:
    """Create a bag; it is complete when the block ends."""
    from rosbags.rosbag2 import StoragePlugin, Writer

    with Writer(folder, version=9, storage_plugin=StoragePlugin.SQLITE3) as writer:
        bag = BagWriter(writer, rig)
        yield bag
        bag.flush()


class BagWriter:
    """Writes messages of a few types; packets are collected to messages sensor by sensor."""

    def __init__(self, writer: Any, rig: Rig) -> None:
        from rosbags.typesys import Stores, get_types_from_msg, get_typestore

        self._writer = writer
        self._rig = rig
        self._store = get_typestore(Stores.ROS2_HUMBLE)
        self._messages = [_message_of(sensor.model) for sensor in rig.sensors]
        for one in {one.kind: one for one in self._messages}.values():
            for name, text in one.definitions.items():
                self._store.register(get_types_from_msg(text, name))
        self._topics = [
            self._connect(sensor.topic, message.kind)
            for sensor, message in zip(rig.sensors, self._messages, strict=True)
        ]
        self._waiting: list[list[tuple[int, NDArray[np.uint8]]]] = [[] for _ in rig.sensors]
        self._connections: dict[str, object] = {}

    def packets(self, row: int, t_ns: Times, payloads: NDArray[np.uint8]) -> None:
        """Append packets of a sensor, times of arrival (N,) and payloads (N, B)."""
        for t, data in zip(t_ns.tolist(), payloads, strict=True):
            self._waiting[row].append((t, data))
            if len(self._waiting[row]) == self._messages[row].collected:
                self._write_packets(row)

    def imu(self, samples: ImuSamples) -> None:
        """Append IMU samples on ``/imu/data``."""
        types = self._store.types
        vector, turn = types["geometry_msgs/msg/Vector3"], types["geometry_msgs/msg/Quaternion"]
        unknown = np.zeros(9)
        for t, gyro, accel in zip(
            samples.t_ns, samples.gyro_rad_s, samples.accel_m_s2, strict=True
        ):
            message = types["sensor_msgs/msg/Imu"](
                header=self._header(int(t), "imu"),
                orientation=turn(x=0.0, y=0.0, z=0.0, w=1.0),
                orientation_covariance=np.array([-1.0, *unknown[1:]]),
                angular_velocity=vector(*(float(v) for v in gyro)),
                angular_velocity_covariance=unknown,
                linear_acceleration=vector(*(float(v) for v in accel)),
                linear_acceleration_covariance=unknown,
            )
            self._write("/imu/data", "sensor_msgs/msg/Imu", int(t), message=message)

    def gnss(self, samples: GnssSamples) -> None:
        """Append positions on ``/gnss/fix``."""
        types = self._store.types
        status, service = types["sensor_msgs/msg/NavSatStatus"], 1
        levels = {GnssQuality.INVALID: NavSatLevel.NO_FIX, GnssQuality.SINGLE: NavSatLevel.FIX}
        for k, t in enumerate(samples.t_ns):
            level = levels.get(GnssQuality(int(samples.quality[k])), NavSatLevel.GBAS_FIX)
            message = types["sensor_msgs/msg/NavSatFix"](
                header=self._header(int(t), "gnss"),
                status=status(status=level, service=service),
                latitude=float(np.rad2deg(samples.lat_rad[k])),
                longitude=float(np.rad2deg(samples.lon_rad[k])),
                altitude=float(samples.height_m[k]),
                position_covariance=np.diag(samples.sd_enu_m[k] ** 2).ravel(),
                position_covariance_type=2,
            )
            self._write("/gnss/fix", "sensor_msgs/msg/NavSatFix", int(t), message=message)

    def flush(self) -> None:
        """Write the last messages of packets, which are shorter than the others."""
        for row, waiting in enumerate(self._waiting):
            if waiting:
                self._write_packets(row)

    def _write_packets(self, row: int) -> None:
        waiting, self._waiting[row] = self._waiting[row], []
        t_ns, message = waiting[-1][0], self._messages[row]
        content = message.make(
            self._store.types.__getitem__,
            self._header(t_ns, self._rig.sensors[row].name),
            [(self._time(t), data) for t, data in waiting],
        )
        self._writer.write(
            self._topics[row], t_ns, self._store.serialize_cdr(content, message.kind)
        )

    def _write(self, topic: str, kind: str, t_ns: int, *, message: Any) -> None:
        if topic not in self._connections:
            self._connections[topic] = self._connect(topic, kind)
        self._writer.write(self._connections[topic], t_ns, self._store.serialize_cdr(message, kind))

    def _connect(self, topic: str, kind: str) -> Any:
        return self._writer.add_connection(topic, kind, typestore=self._store)

    def _time(self, t_ns: int) -> Any:
        seconds, nanoseconds = divmod(t_ns, 1_000_000_000)
        return self._store.types["builtin_interfaces/msg/Time"](sec=seconds, nanosec=nanoseconds)

    def _header(self, t_ns: int, frame: str) -> Any:
        return self._store.types["std_msgs/msg/Header"](stamp=self._time(t_ns), frame_id=frame)


_HEAD = "std_msgs/Header header\nuint64 timebase\nuint32 point_num\nuint8 lidar_id\nuint8[3] rsvd\n"
_POINT = (
    "uint32 offset_time\nfloat32 x\nfloat32 y\nfloat32 z\n"
    "uint8 reflectivity\nuint8 tag\nuint8 line\n"
)


def livox_message(name: str) -> PacketMessage:
    """``CustomMsg`` of the driver for the protocol of a model, ten a second."""
    model = MODELS[name]
    driver = "livox_ros_driver" if model.sdk == 1 else "livox_ros_driver2"
    definitions = {
        f"{driver}/msg/CustomPoint": _POINT,
        f"{driver}/msg/CustomMsg": f"{_HEAD}{driver}/CustomPoint[] points\n",
    }
    shots = 100 if model.lines == 1 else 96
    collected = round(0.1 * model.shots_hz / shots)
    make = partial(_custom, driver=driver, model=model)
    return PacketMessage(f"{driver}/msg/CustomMsg", collected, make, definitions)


def _custom(
    types: Types, header: Any, packets: Sequence[Packet], *, driver: str, model: LivoxModel
) -> Any:
    """A message; its stamp is the time of its first point, as with the drivers."""
    payloads = np.stack([data for _, data in packets])
    layout = layout_of(payloads[0])
    assert layout is not None and not layout.is_spherical and layout.returns == 1
    stamps_ns = np.ascontiguousarray(header_of(payloads, layout.sdk)["stamp"]).view("<u8")[:, 0]
    base_ns = int(stamps_ns[0])
    k = np.arange(layout.shots)
    since_ns = (stamps_ns - stamps_ns[0])[:, None] + np.rint(1e9 * model.shot_s * k).astype("<u8")
    body = np.ascontiguousarray(payloads[:, layout.header.itemsize :])
    returns = body.view(layout.record)["returns"][:, :, 0]
    xyz_m = (returns["xyz"] * layout.unit_m).reshape(-1, 3)
    tag = returns["tag"] if layout.is_tagged else np.zeros_like(returns["reflectivity"])
    line = np.broadcast_to(k % model.lines, since_ns.shape)
    columns = (
        since_ns.ravel(),
        *xyz_m.T,
        returns["reflectivity"].ravel(),
        tag.ravel(),
        line.ravel(),
    )
    point = types(f"{driver}/msg/CustomPoint")
    points = [point(*row) for row in zip(*(c.tolist() for c in columns), strict=True)]
    seconds, nanoseconds = divmod(base_ns, SECOND_NS)
    stamp = types("builtin_interfaces/msg/Time")(sec=seconds, nanosec=nanoseconds)
    return types(f"{driver}/msg/CustomMsg")(
        header=types("std_msgs/msg/Header")(stamp=stamp, frame_id=header.frame_id),
        timebase=base_ns,
        point_num=len(points),
        lidar_id=0,
        rsvd=np.zeros(3, np.uint8),
        points=points,
    )
