"""Messages of points other than ``PointCloud2``: a table of types, and types that a bag defines.

All become a `PointMessage`; its table takes the path of a cloud
(`recon4.recording.clouds.cloud_points`).
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from types import SimpleNamespace
from typing import Any

import numpy as np
from numpy.typing import NDArray

from recon4.errors import CorruptFile
from recon4.locales.coded import CodedText
from recon4.recording.clouds.point_fields import (
    EXACT_TIME,
    INTENSITY_FIELDS,
    RING_FIELDS,
    TIME_FIELDS,
)
from recon4.recording.formats.message_schema import (
    Columns,
    MessageSchema,
    parse_schema,
    read_message,
)
from recon4.recording.packets.livox.tags import echo_of_tag, is_noise

_CUSTOM = """std_msgs/Header header
uint64 timebase
uint32 point_num
uint8 lidar_id
uint8[3] rsvd
livox_ros_driver/CustomPoint[] points
===
MSG: livox_ros_driver/CustomPoint
uint32 offset_time
float32 x
float32 y
float32 z
uint8 reflectivity
uint8 tag
uint8 line
"""
_CLOUD1 = """std_msgs/Header header
geometry_msgs/Point32[] points
sensor_msgs/ChannelFloat32[] channels
===
MSG: sensor_msgs/ChannelFloat32
string name
float32[] values
"""


POINTS, ARRAYS = "points", "arrays"
"""Names of the list of points of a known type, and of that made of lists of numbers."""
WHOLE = "*"
"""Name of the list with the numbers of a message as a whole, (1,) each."""
_LATEST_NS = 1 << 62
"""Later times do not occur."""


@dataclass(frozen=True, slots=True, eq=False)
class PointMessage:
    """A message of points as a table, with the names of a ``PointCloud2`` for what they share."""

    header: Any
    """With ``stamp.sec``, ``stamp.nanosec`` and ``frame_id``."""
    table: Columns
    """Fields by lower-case name; none if the message has none with common names."""
    data: NDArray[np.uint8]
    """The whole message."""
    lists: Mapping[str, Columns] = field(default_factory=dict)
    """All lists of points in it by name, for recipes."""
    lidar_id: int | str = ""
    """Number of the LiDAR among those of one driver; empty = not said."""

    @property
    def width(self) -> int:
        """Number of points."""
        return len(next(iter(self.table.values()), ()))

    @property
    def height(self) -> int:
        """Of a cloud without rows."""
        return 1

    @property
    def fields(self) -> tuple[Any, ...]:
        """Names of the columns."""
        return tuple(SimpleNamespace(name=name) for name in self.table)


@dataclass(frozen=True, slots=True)
class PointRow:
    """How a type of message becomes a table."""

    definition: str
    """For bags that do not bring it."""
    table: Callable[[Any], Columns]
    """Columns of a message."""


def _of_livox(message: Any, *, noise: bool) -> Columns:
    """Points of Livox's drivers; their times count from that of the message.

    The first driver had an even step from point to point, and neither times nor tags; forks name
    the reflectivity an intensity.
    """
    points: Columns = message.points
    stamp = message.header.stamp
    base = message.timebase or stamp.sec * 1_000_000_000 + stamp.nanosec
    table: Columns = {
        name: points[name] for name in ("x", "y", "z", "tag", "line") if name in points
    }
    table["intensity"] = points["reflectivity" if "reflectivity" in points else "intensity"]
    step_ns = int(getattr(message, "timestep", 0))
    since = points.get("offset_time", np.arange(len(table["x"])) * step_ns if step_ns else None)
    if since is not None:
        table[EXACT_TIME] = since.astype(np.int64) + min(base, _LATEST_NS)
    if noise and "tag" in points:
        table |= {"noise": is_noise(points["tag"]), "echo": echo_of_tag(points["tag"])}
    return table


def _of_driver1(message: Any) -> Columns:
    """The first driver serves sensors whose tags name noise."""
    return _of_livox(message, noise=True)


def _of_driver2(message: Any) -> Columns:
    """The second driver serves the Mid-360, whose tags name none, and the HAP."""
    return _of_livox(message, noise=False)


def _of_cloud1(message: Any) -> Columns:
    """``PointCloud`` of ROS 1: each channel with a value for each point is a column."""
    table = dict(message.points)
    for channel in message.channels:
        if len(channel.values) == len(table["x"]):
            table[channel.name.lower()] = channel.values
    return table


_COMMON_PACKAGES = frozenset(
    {
        *("geometry_msgs", "nav_msgs", "sensor_msgs", "shape_msgs", "std_msgs", "stereo_msgs"),
        *("tf", "tf2_msgs", "trajectory_msgs", "velodyne_msgs", "visualization_msgs"),
    }
)
"""Lists of structures in their messages are no points of a LiDAR."""
_OF_LIDARS = (*TIME_FIELDS, *RING_FIELDS, *INTENSITY_FIELDS)
POINT_MESSAGES = {
    "livox_ros_driver/msg/CustomMsg": PointRow(_CUSTOM, _of_driver1),
    "livox_interfaces/msg/CustomMsg": PointRow(_CUSTOM, _of_driver1),
    "livox_ros_driver2/msg/CustomMsg": PointRow(_CUSTOM, _of_driver2),
    "sensor_msgs/msg/PointCloud": PointRow(_CLOUD1, _of_cloud1),
}
"""Types of messages that are read without a word of the user."""


@dataclass(frozen=True, slots=True)
class PointReader:
    """Reads the messages of points of one type."""

    schema: MessageSchema
    table: Callable[[Any], Columns] | None
    """The points of a type that is known; None = of the bag's own lists."""
    columns: tuple[str, ...]
    """Names of the fields of a point, lower case; empty = they are in the messages."""

    @property
    def is_known(self) -> bool:
        """Whether the fields have common names: coordinates, and something that a LiDAR measures.

        Corners of polygons and poses are lists of points too, and so may be lists of numbers.
        """
        names = set(self.columns)
        if self.table is not None:
            return True
        return (
            len(self.schema.lists()) == 1
            and {"x", "y", "z"} <= names
            and not names.isdisjoint(_OF_LIDARS)
        )

    def read(self, data: bytes, *, ros1: bool) -> PointMessage:
        """Read a message.

        Raises:
            CorruptFile: If its bytes are not those of its definition.
        """
        message = read_message(self.schema, data, ros1=ros1)
        try:
            lists = _lists(self.schema, message) if self.table is None else {}
            table = self.table(message) if self.table else next(iter(lists.values()))
        except (KeyError, TypeError, AttributeError) as error:
            raise CorruptFile(CodedText("message-no-field", why=str(error))) from error
        header = getattr(message, "header", None)
        if self.schema.kind_of("header") != "std_msgs/Header":
            header = SimpleNamespace(stamp=SimpleNamespace(sec=0, nanosec=0), frame_id="")
        table = _lower(table)
        number = getattr(message, "lidar_id", "")
        return PointMessage(
            header,
            table,
            np.frombuffer(data, np.uint8),
            lists or {POINTS: table},
            number if isinstance(number, int) else "",
        )


def point_readers(definitions: Mapping[str, str]) -> dict[str, PointReader]:
    """Readers of the types of a bag that are of points, other than ``PointCloud2``.

    Args:
        definitions: Type of messages -> its definition; empty = the bag has none.
    """
    own = {
        kind: text
        for kind, text in definitions.items()
        if kind in POINT_MESSAGES or kind.partition("/")[0] not in _COMMON_PACKAGES
    }
    readers = {kind: point_reader(kind, text) for kind, text in own.items()}
    return {kind: reader for kind, reader in readers.items() if reader is not None}


def point_reader(kind: str, definition: str) -> PointReader | None:
    """The reader of a type of messages; None = it is none of points.

    Args:
        kind: The type, as ``livox_ros_driver/msg/CustomMsg``.
        definition: That of the bag; empty = it has none.
    """
    row = POINT_MESSAGES.get(kind)
    text = definition or (row.definition if row else "")
    if not text:
        return None
    try:
        schema = parse_schema(kind, text)
    except CorruptFile:
        return point_reader(kind, "") if row and definition else None
    if row is not None:
        return PointReader(schema, row.table, ())
    columns = [c for of_list in schema.lists().values() for c in of_list if len(of_list) >= 3]
    numbers = schema.number_lists()
    columns += numbers if len(numbers) >= 3 else ()
    if not columns:
        return None
    return PointReader(schema, None, tuple(dict.fromkeys(one.lower() for one in columns)))


def _lists(schema: MessageSchema, message: Any) -> dict[str, Columns]:
    """The lists of points of a message: of structures, and numbers in lists of one length.

    A message without any has an empty one. The numbers of the message as a whole are `WHOLE`.
    """
    found = {
        name.lower(): _lower(getattr(message, name))
        for name, columns in schema.lists().items()
        if len(columns) >= 3
    }
    numbers = {name: getattr(message, name) for name in schema.number_lists()}
    lengths = [len(values) for values in numbers.values()]
    count = max(set(lengths), key=lambda n: (lengths.count(n), n), default=0)
    alike = {name: values for name, values in numbers.items() if len(values) == count}
    if len(alike) >= 3:
        found[ARRAYS] = _lower(alike)
    single = {name.lower(): _number(message, name) for name in schema.numbers()}
    return (found or {ARRAYS: {}}) | ({WHOLE: single} if single else {})


def _number(message: Any, name: str) -> NDArray[Any]:
    """A number of a message, inner ones as ``header.stamp.sec``, (1,)."""
    value = message
    for part in name.split("."):
        value = getattr(value, part)
    return np.array([value])


def _lower(columns: Columns) -> Columns:
    return {name.lower(): column for name, column in columns.items()}
