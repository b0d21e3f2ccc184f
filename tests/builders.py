"""Small recordings for tests, written byte by byte. Deterministic."""

from __future__ import annotations

import struct
from pathlib import Path

import numpy as np
from rosbags.rosbag1 import Writer as Writer1
from rosbags.rosbag2 import StoragePlugin
from rosbags.rosbag2 import Writer as Writer2
from rosbags.typesys import Stores, get_types_from_msg, get_typestore

from recon4.recording.assembly.shots import Shots
from recon4.recording.packets.velodyne.encode import (
    PacketBlocks,
    PcapWriter,
    encode_packets,
)
from recon4.recording.packets.velodyne.models import MODELS

ROOM_M = np.array([8.0, 6.0, 3.0])
T0_NS = 1_700_000_000_000_000_000
ELEVATION = np.sort(MODELS["VLP-16"].elevation_rad)

_PCD_WORDS = ("FIELDS", "SIZE", "TYPE", "COUNT")
_SCAN = "velodyne_msgs/msg/VelodyneScan"
_PACKET = "velodyne_msgs/msg/VelodynePacket"


def room_range(azimuth, elevation):
    """Distance from the middle of a box room to its wall; azimuth counterclockwise from x."""
    direction = np.stack(
        [
            np.cos(elevation) * np.cos(azimuth),
            np.cos(elevation) * np.sin(azimuth),
            np.broadcast_to(np.sin(elevation), np.broadcast(azimuth, elevation).shape),
        ],
        axis=-1,
    )
    with np.errstate(divide="ignore"):
        distance = (ROOM_M / 2 / np.abs(direction)).min(axis=-1)
    return distance, direction


def spin(*, seconds=1.0, rate_hz=10.0, columns_per_turn=360, sensor=0, t0_ns=T0_NS, start_turn=0.0):
    """Shots of a clockwise turning sensor with the VLP-16's beams in the room."""
    columns = round(seconds * rate_hz * columns_per_turn)
    t_s = np.repeat(np.arange(columns) / (rate_hz * columns_per_turn), 16)
    ring = np.tile(np.arange(16, dtype=np.uint8), columns)
    azimuth = np.pi - 2 * np.pi * (start_turn + t_s * rate_hz)
    distance, direction = room_range(azimuth, ELEVATION[ring])
    return Shots(
        sensor,
        t0_ns + np.rint(t_s * 1e9).astype(np.int64),
        (distance[:, None] * direction).astype(np.float32),
        np.full(len(ring), 40, np.uint16),
        ring,
        np.zeros(len(ring), np.uint8),
    )


def room_cloud(**options):
    """One revolution as a table of fields: x y z intensity ring time."""
    shots = spin(**({"seconds": 0.1} | options))
    x, y, z = shots.xyz.T
    return {
        "x": x.copy(),
        "y": y.copy(),
        "z": z.copy(),
        "intensity": shots.intensity.astype(np.float32),
        "ring": shots.ring.astype(np.uint16),
        "time": ((shots.t_ns - shots.t_ns[0]) * 1e-9).astype(np.float32),
    }


def room_packets(*, seconds=1.0, rate_hz=10.0, t0_ns=T0_NS):
    """VLP-16 packets in the room: times (P,) and payloads (P, 1206)."""
    block_s, packet_s = 110.592e-6, 12 * 110.592e-6
    count = int(seconds / packet_s)
    t_packet_s = np.arange(count) * packet_s
    t_block_s = t_packet_s[:, None] + np.arange(12) * block_s
    turn_cdeg = 36000.0 * rate_hz
    azimuth_cdeg = np.rint(t_block_s * turn_cdeg).astype(np.int64)
    model = MODELS["VLP-16"]
    t_shot_s = t_block_s[..., None] + model.channel_time_s
    azimuth = -np.deg2rad(t_shot_s * turn_cdeg / 100)
    distance, _ = room_range(azimuth, np.tile(model.elevation_rad, 2))
    t_ns = t0_ns + np.rint(t_packet_s * 1e9).astype(np.int64)
    units = np.rint(distance / 0.002).astype(np.int64)
    blocks = PacketBlocks(azimuth_cdeg, units, np.full(units.shape, 40))
    payloads = encode_packets(t_ns // 1000, blocks, model=model)
    return t_ns, payloads


def write_room_pcap(path: Path, *, ports=(2368,), **options):
    """Capture file with one VLP-16 a port."""
    t_ns, payloads = room_packets(**options)
    with PcapWriter(path) as writer:
        for first in range(0, len(t_ns), 50):
            rows = slice(first, first + 50)
            for k, port in enumerate(ports):
                source = f"192.168.1.{201 + k}"
                writer.write(t_ns[rows], payloads[rows], source=source, port=port)
    return path


# -- cloud files


def write_pcd(path: Path, table, *, encoding="binary", padding=0):
    """PCD file; ``padding`` bytes of a field named ``_`` behind every point."""
    names = list(table)
    dtypes = [table[name].dtype for name in names]
    kind = {"f": "F", "i": "I", "u": "U"}
    fields = [(n, d.itemsize, kind[d.kind], 1) for n, d in zip(names, dtypes, strict=True)]
    if padding:
        fields.append(("_", 1, "U", padding))
    count = len(table[names[0]])
    header = "# .PCD v0.7\nVERSION 0.7\n"
    for word, column in zip(_PCD_WORDS, zip(*fields, strict=True), strict=True):
        header += f"{word} {' '.join(str(value) for value in column)}\n"
    header += f"WIDTH {count}\nHEIGHT 1\nVIEWPOINT 0 0 0 1 0 0 0\nPOINTS {count}\n"
    path.write_bytes(f"{header}DATA {encoding}\n".encode() + _body(table, encoding, padding))
    return path


def _body(table, encoding, padding):
    columns = list(table.values())
    if encoding == "ascii":
        rows = zip(*columns, strict=True)
        lines = [" ".join([repr(v.item()) for v in row] + ["0"] * padding) for row in rows]
        return ("\n".join(lines) + "\n").encode()
    if encoding == "binary_compressed":
        raw = b"".join(column.tobytes() for column in columns)
        raw += bytes(padding * len(columns[0]))
        packed = lzf_literals(raw)
        return struct.pack("<II", len(packed), len(raw)) + packed
    fields = [(f"f{k}", column.dtype) for k, column in enumerate(columns)]
    rows = np.zeros(len(columns[0]), [*fields, ("_", f"V{padding}")] if padding else fields)
    for (name, _), column in zip(fields, columns, strict=True):
        rows[name] = column
    return rows.tobytes()


def lzf_literals(raw: bytes) -> bytes:
    """Valid LZF without any back reference."""
    chunks = [raw[k : k + 32] for k in range(0, len(raw), 32)]
    return b"".join(bytes([len(chunk) - 1]) + chunk for chunk in chunks)


def write_ply(path: Path, table, *, encoding="binary_little_endian"):
    """PLY file of float and integer columns."""
    types = {"f4": "float", "f8": "double", "u2": "ushort", "u1": "uchar", "i4": "int"}
    header = f"ply\nformat {encoding} 1.0\nelement vertex {len(table['x'])}\n"
    for name, column in table.items():
        header += f"property {types[column.dtype.str[1:]]} {name}\n"
    body = _body(table, "ascii" if encoding == "ascii" else "binary", 0)
    path.write_bytes(header.encode() + b"end_header\n" + body)
    return path


def write_bin(path: Path, table):
    """KITTI BIN file."""
    columns = [table[k].astype("<f4") for k in ("x", "y", "z", "intensity")]
    path.write_bytes(np.column_stack(columns).tobytes())
    return path


def noisy(values, k):
    """The k-th sample of a real sensor at rest: values that differ from sample to sample, (3,)."""
    return np.array(values) + 1e-3 * np.sin((k + 1) * np.array([1.0, 2.0, 3.0]))


# -- bags


class Bag:
    """Writes a bag of kind ``bag1``, ``db3`` or ``mcap``."""

    def __init__(self, path: Path, kind: str) -> None:
        self.frame = "x"
        self.recorded_ns = 0
        """Time of recording of the next messages [ns]; 0 = their stamps."""
        self.ros1 = kind == "bag1"
        self.store = get_typestore(Stores.ROS1_NOETIC if self.ros1 else Stores.ROS2_HUMBLE)
        header = "std_msgs/Header header\n"
        self.store.register(
            get_types_from_msg("builtin_interfaces/Time stamp\nuint8[1206] data\n", _PACKET)
        )
        self.store.register(
            get_types_from_msg(f"{header}velodyne_msgs/VelodynePacket[] packets\n", _SCAN)
        )
        plugin = StoragePlugin.MCAP if kind == "mcap" else StoragePlugin.SQLITE3
        self.writer = (
            Writer1(path) if self.ros1 else Writer2(path, version=9, storage_plugin=plugin)
        )
        if self.ros1:
            self.writer.chunk_threshold = 64 * 1024
        self.connections = {}

    def __enter__(self):
        self.writer.open()
        return self

    def __exit__(self, *_):
        self.writer.close()

    def write(self, topic, kind, t_ns, message):
        if topic not in self.connections:
            self.connections[topic] = self.writer.add_connection(topic, kind, typestore=self.store)
        encode = self.store.serialize_ros1 if self.ros1 else self.store.serialize_cdr
        t_ns = self.recorded_ns or t_ns
        self.writer.write(self.connections[topic], t_ns, bytes(encode(message, kind)))

    def make(self, kind, **fields):
        return self.store.types[kind](**fields)

    def time(self, t_ns):
        sec, nanosec = divmod(int(t_ns), 1_000_000_000)
        return self.make("builtin_interfaces/msg/Time", sec=sec, nanosec=nanosec)

    def header(self, t_ns, frame=None):
        extra = {"seq": 0} if self.ros1 else {}
        frame = self.frame if frame is None else frame
        return self.make("std_msgs/msg/Header", stamp=self.time(t_ns), frame_id=frame, **extra)

    def scan(self, topic, t_ns, payloads):
        packets = [
            self.make(_PACKET, stamp=self.time(t), data=data)
            for t, data in zip(t_ns, payloads, strict=True)
        ]
        message = self.make(_SCAN, header=self.header(t_ns[0]), packets=packets)
        self.write(topic, _SCAN, int(t_ns[-1]), message)

    def imu(self, topic, t_ns, gyro, accel, *, absent=()):
        """A sample; ``absent`` = names of quantities that are declared as not measured."""
        vector = "geometry_msgs/msg/Vector3"
        zeros, declared = np.zeros(9), np.array([-1.0, *np.zeros(8)])
        message = self.make(
            "sensor_msgs/msg/Imu",
            header=self.header(t_ns),
            orientation=self.make("geometry_msgs/msg/Quaternion", x=0.0, y=0.0, z=0.0, w=1.0),
            orientation_covariance=zeros,
            angular_velocity=self.make(vector, x=gyro[0], y=gyro[1], z=gyro[2]),
            angular_velocity_covariance=declared if "gyro" in absent else zeros,
            linear_acceleration=self.make(vector, x=accel[0], y=accel[1], z=accel[2]),
            linear_acceleration_covariance=declared if "accel" in absent else zeros,
        )
        self.write(topic, "sensor_msgs/msg/Imu", int(t_ns), message)

    def fix(self, topic, t_ns, lat, lon, height, *, status=2):
        message = self.make(
            "sensor_msgs/msg/NavSatFix",
            header=self.header(t_ns),
            status=self.make("sensor_msgs/msg/NavSatStatus", status=status, service=1),
            latitude=lat,
            longitude=lon,
            altitude=height,
            position_covariance=np.diag([0.0001, 0.0004, 0.0009]).ravel(),
            position_covariance_type=2,
        )
        self.write(topic, "sensor_msgs/msg/NavSatFix", int(t_ns), message)

    def odometry(self, topic, t_ns, x, *, child="body"):
        point = self.make("geometry_msgs/msg/Point", x=x, y=0.0, z=0.0)
        turn = self.make("geometry_msgs/msg/Quaternion", x=0.0, y=0.0, z=0.0, w=1.0)
        vector = self.make("geometry_msgs/msg/Vector3", x=0.0, y=0.0, z=0.0)
        pose = self.make("geometry_msgs/msg/Pose", position=point, orientation=turn)
        twist = self.make("geometry_msgs/msg/Twist", linear=vector, angular=vector)
        zeros = np.zeros(36)
        message = self.make(
            "nav_msgs/msg/Odometry",
            header=self.header(t_ns),
            child_frame_id=child,
            pose=self.make("geometry_msgs/msg/PoseWithCovariance", pose=pose, covariance=zeros),
            twist=self.make("geometry_msgs/msg/TwistWithCovariance", twist=twist, covariance=zeros),
        )
        self.write(topic, "nav_msgs/msg/Odometry", int(t_ns), message)

    def cloud(self, topic, t_ns, table):
        kinds = ("i1", "u1", "i2", "u2", "i4", "u4", "f4", "f8", "i8", "u8")
        codes = {kind: code for code, kind in enumerate(kinds, start=1)}
        dtype = np.dtype([(name, column.dtype) for name, column in table.items()])
        points = np.zeros(len(next(iter(table.values()))), dtype)
        fields = []
        for name, column in table.items():
            points[name] = column
            code = codes[column.dtype.str[1:]]
            offset = dtype.fields[name][1]
            field = "sensor_msgs/msg/PointField"
            fields.append(self.make(field, name=name, offset=offset, datatype=code, count=1))
        message = self.make(
            "sensor_msgs/msg/PointCloud2",
            header=self.header(t_ns),
            height=1,
            width=len(points),
            fields=fields,
            is_bigendian=False,
            point_step=dtype.itemsize,
            row_step=dtype.itemsize * len(points),
            data=points.view(np.uint8).reshape(-1),
            is_dense=False,
        )
        self.write(topic, "sensor_msgs/msg/PointCloud2", int(t_ns), message)


def bag_path(folder: Path, kind: str) -> Path:
    """Where a bag of a kind goes: a file for rosbag1, else a folder."""
    return folder / ("room.bag" if kind == "bag1" else f"room_{kind}")


def storage_file(path: Path) -> Path:
    """The file that holds the messages of a bag."""
    if path.is_file():
        return path
    return next(f for f in path.iterdir() if f.suffix in (".db3", ".mcap"))


def write_room_bag(folder: Path, kind: str, *, topics=("/velodyne_packets",), **options):
    """A bag with packets (`room_packets`), IMU at 100 Hz, positions at 5 Hz and poses at 10 Hz."""
    t_ns, payloads = room_packets(**options)
    path = bag_path(folder, kind)
    with Bag(path, kind) as bag:
        for first in range(0, len(t_ns), 75):
            rows = slice(first, first + 75)
            for topic in topics:
                bag.scan(topic, t_ns[rows], payloads[rows])
            start = int(t_ns[first])
            bag.odometry("/odom", start, first / 75)
            for k in range(10):
                gyro, accel = (noisy((0.0, 0.0, z), first + k) for z in (0.1, 9.8))
                bag.imu("/imu", start + k * 10_000_000, gyro, accel)
            if first % 150 == 0:
                bag.fix("/fix", start, 50.0, 14.0, 300.0 + first)
    return path
