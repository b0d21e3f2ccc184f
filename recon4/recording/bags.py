"""ROS bags of every kind as one stream of messages; damaged files are salvaged.

Only the message types below are decoded, with definitions from here: code is never generated from
definitions found inside a bag.
"""

from __future__ import annotations

import heapq
from collections.abc import Collection, Iterator, Sequence
from contextlib import ExitStack
from dataclasses import dataclass
from functools import cache
from pathlib import Path
from types import TracebackType
from typing import Any, Self

from recon4.errors import CorruptFile, EmptyRecording, RecordingError
from recon4.recording.folders import natural
from recon4.recording.report import ImportReport
from recon4.recording.salvage import Salvage, open_salvage

SCAN = "velodyne_msgs/msg/VelodyneScan"
CLOUD = "sensor_msgs/msg/PointCloud2"
IMU = "sensor_msgs/msg/Imu"
FIX = "sensor_msgs/msg/NavSatFix"
ODOMETRY = "nav_msgs/msg/Odometry"

_DEFINITIONS = {
    "velodyne_msgs/msg/VelodynePacket": "builtin_interfaces/Time stamp\nuint8[1206] data\n",
    SCAN: "std_msgs/Header header\nvelodyne_msgs/VelodynePacket[] packets\n",
}
STORAGE_SUFFIXES = (".db3", ".mcap")


@dataclass(frozen=True, slots=True)
class BagTopic:
    """One topic of a recording."""

    name: str
    type: str
    """ROS 2 spelling, as ``sensor_msgs/msg/Imu``."""
    messages: int


@dataclass(frozen=True, slots=True)
class BagMessage:
    """One message, not decoded."""

    topic: str
    type: str
    t_ns: int
    """When it was recorded [ns]."""
    data: bytes


class Bag:
    """One or several bag files read as one; use as a context manager."""

    def __init__(self, paths: Sequence[Path], report: ImportReport) -> None:
        """Nothing is opened yet.

        Args:
            paths: rosbag1 files, rosbag2 folders, ``.db3`` or ``.mcap`` files; not mixed.
            report: Told what had to be salvaged.
        """
        self._paths = paths
        self.report = report
        """Told what is damaged; may be changed once the bag is open."""
        self._stack = ExitStack()
        self._sources: list[Any] = []
        self.ros1 = False
        self.topics: tuple[BagTopic, ...] = ()
        self.t_first_ns, self.t_last_ns = 0, 0

    def __enter__(self) -> Self:
        """Open all files.

        Raises:
            CorruptFile: If a file is no bag, or not a message of it is left.
            EmptyRecording: If there are no messages.
        """
        try:
            for path in self._paths:
                self._sources += self._open(path)
            self._summarize()
        except BaseException:
            self._stack.close()
            raise
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, _: TracebackType | None
    ) -> None:
        self._stack.close()

    @property
    def seconds(self) -> float:
        """From the first message to the last [s]."""
        return (self.t_last_ns - self.t_first_ns) / 1e9

    def messages(self, topics: Collection[str]) -> Iterator[BagMessage]:
        """Messages of some topics in order of recording, as a stream."""
        streams = [self._of_source(source, set(topics)) for source in self._sources]
        yield from heapq.merge(*streams, key=lambda message: message.t_ns)

    def decode(self, message: BagMessage) -> Any | None:
        """The message as an object with its fields; None (counted) when its bytes are damaged."""
        store = _typestore(self.ros1)
        try:
            if self.ros1:
                return store.deserialize_ros1(message.data, message.type)
            return store.deserialize_cdr(message.data, message.type)
        except Exception:  # damaged bytes raise errors of many kinds in generated code
            self.report.count("messages_corrupt")
            self.report.warn(f"{message.topic}: messages that cannot be decoded are left out")
            return None

    # -- opening

    def _open(self, path: Path) -> list[Any]:
        try:
            return [self._open_whole(path)]
        except RecordingError:
            raise
        except Exception as error:  # rosbags raises many kinds on damaged files
            if path.is_dir():
                return self._open_folder(path, error)
            self.report.warn(f"{path.name}: {_reason(error)}; salvaging what is left")
        source = self._stack.enter_context(open_salvage(path, self.report))
        self.ros1 = source.ros1
        return [source]

    def _open_whole(self, path: Path) -> Any:
        if path.is_file() and path.stat().st_size == 0:
            raise EmptyRecording(f"{path.name}: the file is empty (0 bytes)")
        self.ros1 = path.is_file() and _is_bag1(path)
        if self.ros1:
            from rosbags.rosbag1 import Reader as Reader1

            return self._stack.enter_context(Reader1(path))
        from rosbags.rosbag2 import Reader as Reader2

        return self._stack.enter_context(Reader2(path))

    def _open_folder(self, path: Path, error: Exception) -> list[Any]:
        """A folder whose description is missing or wrong: its files one by one."""
        files = sorted((f for f in path.iterdir() if f.suffix in STORAGE_SUFFIXES), key=natural)
        if not files:
            raise CorruptFile(f"{path.name}: no readable rosbag2: {_reason(error)}") from error
        self.report.warn(f"{path.name}: {_reason(error)}; its files are read one by one")
        return [source for file in files for source in self._open(file)]

    def _summarize(self) -> None:
        counts: dict[tuple[str, str], int] = {}
        for source in self._sources:
            for connection in source.connections:
                key = (connection.topic, connection.msgtype)
                counts[key] = counts.get(key, 0) + int(connection.msgcount or 0)
        self.topics = tuple(BagTopic(n, t, c) for (n, t), c in sorted(counts.items()))
        filled = [s for s in self._sources if s.message_count]
        if not filled:
            names = ", ".join(path.name for path in self._paths)
            raise EmptyRecording(f"{names}: a bag without messages")
        self.t_first_ns = min(int(source.start_time) for source in filled)
        self.t_last_ns = max(int(source.end_time) for source in filled) - 1

    # -- reading

    def _of_source(self, source: Any, topics: set[str]) -> Iterator[BagMessage]:
        if isinstance(source, Salvage):
            for topic, kind, t_ns, data in source.messages(topics):
                yield BagMessage(topic, kind, t_ns, data)
            return
        wanted = [c for c in source.connections if c.topic in topics]
        if not wanted:
            return
        try:
            for connection, t_ns, data in source.messages(wanted):
                yield BagMessage(connection.topic, connection.msgtype, int(t_ns), bytes(data))
        except Exception as error:  # rosbags raises many kinds on damaged files
            self.report.outcome = "lossy"
            self.report.count("files_cut")
            self.report.warn(f"{_name(source)}: damaged, read up to there: {_reason(error)}")


@cache
def _typestore(ros1: bool) -> Any:
    from rosbags.typesys import Stores, get_types_from_msg, get_typestore

    store = get_typestore(Stores.ROS1_NOETIC if ros1 else Stores.ROS2_HUMBLE)
    for name, text in _DEFINITIONS.items():
        store.register(get_types_from_msg(text, name))
    return store


def _is_bag1(path: Path) -> bool:
    with path.open("rb") as file:
        return file.read(9) == b"#ROSBAG V"


def _name(source: Any) -> str:
    return Path(str(getattr(source, "path", "bag"))).name


def _reason(error: Exception) -> str:
    text = str(error).strip().splitlines()
    return (text[0] if text else type(error).__name__).rstrip(".")[:200]
