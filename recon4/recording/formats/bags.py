"""ROS bags of every kind as one stream of messages; damaged files are salvaged.

Code is never generated from definitions found inside a bag: types of points that a bag defines are
read by `recon4.recording.formats.message_schema`, the other types below with definitions from here.
What a file may ask for is in `recon4.recording.formats.limits`.
"""

from __future__ import annotations

import heapq
from collections.abc import Collection, Iterator, Mapping, Sequence
from contextlib import ExitStack
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any, Protocol, Self

from recon4.errors import CorruptFile, EmptyRecording
from recon4.locales.coded import CodedText
from recon4.model.finding import Value
from recon4.model.finding_kinds import FindingKind
from recon4.model.point_recipes import PointRecipe
from recon4.recording.clocks.stamps import RecorderJump, StampJumps
from recon4.recording.formats import db3
from recon4.recording.formats.backward import turn_round
from recon4.recording.formats.bag1 import Bag1, is_bag1
from recon4.recording.formats.bag_clock import say_steps
from recon4.recording.formats.bag_folder import (
    BagMetadata,
    read_metadata,
    say_undescribed,
    storage_files,
    with_files_there,
)
from recon4.recording.formats.chunks import BagIndex, RawMessage
from recon4.recording.formats.cloud_tables import cloud_lists
from recon4.recording.formats.file_times import FileTimes, require_one_walk
from recon4.recording.formats.limits import (
    MAX_MESSAGE_BYTES,
    MAX_RATIO,
    RATIO_FLOOR_BYTES,
    Budget,
    RecordFile,
    decompress_partly,
    is_zstd,
)
from recon4.recording.formats.mcap_file import Mcap
from recon4.recording.formats.message_limits import check_message
from recon4.recording.formats.point_messages import PointMessage, PointReader, point_readers
from recon4.recording.formats.scratch import scratch_folder
from recon4.recording.formats.shared_topics import SharedTopics, TopicSource
from recon4.recording.formats.typestore import MessageTypes
from recon4.recording.formats.zstd_file import decompress_file
from recon4.recording.frame_files.copies import is_new
from recon4.recording.packets.messages import DATA_MESSAGES, PACKET_MESSAGES, SCANS_WITH_HEADER
from recon4.recording.packets.senders import parts_of
from recon4.recording.recipes.apply import as_points
from recon4.recording.report import ImportReport

CLOUD = "sensor_msgs/msg/PointCloud2"
IMU = "sensor_msgs/msg/Imu"
NAVSATFIX = "sensor_msgs/msg/NavSatFix"
ODOMETRY = "nav_msgs/msg/Odometry"
LASER_SCAN = "sensor_msgs/msg/LaserScan"
TEXT = "std_msgs/msg/String"
JOINT_STATES = "sensor_msgs/msg/JointState"
_HEADED = frozenset({CLOUD, IMU, NAVSATFIX, ODOMETRY, LASER_SCAN, *SCANS_WITH_HEADER})
_MEASURED = frozenset({*DATA_MESSAGES, CLOUD, IMU, NAVSATFIX, ODOMETRY, LASER_SCAN})
"""Types whose messages come when something is measured. With simulated time, messages that are sent
once, such as static transforms, may be recorded at time 0."""


@dataclass(frozen=True, slots=True)
class BagTopic:
    """One topic of a recording."""

    name: str
    type: str
    """ROS 2 spelling, as ``sensor_msgs/msg/Imu``."""
    messages: int
    columns: tuple[str, ...] = ()
    """Fields of a point, lower case, if the type is one of points that the bag itself defines."""
    is_points: bool = False
    """Whether its messages are points whose fields are known, or have a recipe."""


@dataclass(frozen=True, slots=True)
class BagMessage:
    """One message, not decoded."""

    topic: str
    type: str
    t_ns: int
    """Recording time [ns]."""
    data: bytes
    content: Any | None = None
    """Decoded, or the part of one sensor of it, if it had to be to know whose it is."""


class StorageFile(Protocol):
    """One storage file."""

    ros1: bool
    index: BagIndex
    report: ImportReport

    def messages(self, topics: set[str]) -> Iterator[RawMessage]:
        """Messages of some topics in order of time."""
        ...

    def go_on(self) -> None:
        """Continue the times where the recorder was set back."""
        ...


class Bag:
    """One or several bag files read as one; use as a context manager."""

    def __init__(self, paths: Sequence[Path], report: ImportReport) -> None:
        """Nothing is opened yet.

        Args:
            paths: rosbag1 files, rosbag2 folders, ``.db3`` or ``.mcap`` files; not mixed.
            report: Receives what had to be salvaged.
        """
        self.paths = paths
        """The files and folders that are read."""
        self._shared = SharedTopics({})
        self.recipes: Mapping[str, PointRecipe] = {}
        self.report = report  # receives damage; may be replaced while the bag is open
        self.stamp_jumps = StampJumps()  # of the clocks of all topics
        self._stack = ExitStack()
        self._sources: list[StorageFile] = []
        self._origins: list[Path] = []
        """Of each source: its file, or the folder whose description names it."""
        self._files: list[Path] = []  # opened, or tried
        self._copies = 0  # files that have the bytes of another one: not opened
        self._points: dict[str, PointReader] = {}
        self._types = MessageTypes()
        """Of the types of points other than ``PointCloud2``."""
        self.ros1, self._stored_bytes = False, 0
        self.topics: tuple[BagTopic, ...] = ()
        self.t_first_ns, self.t_last_ns = 0, 0

    def __enter__(self) -> Self:
        """Open all files.

        Raises:
            CorruptFile: If a file is no bag, or not a message of it is left.
            EmptyRecording: If there are no messages.
            UnknownFormat: If the files are of several walks.
        """
        try:
            for path in self.paths:
                self._open(path)
            self._summarize()
        except BaseException:
            self._stack.close()
            raise
        return self

    def __exit__(self, *_: object) -> None:
        self._stack.close()

    @property
    def seconds(self) -> float:
        """Time from the first measured message to the last one [s]."""
        return (self.t_last_ns - self.t_first_ns) / 1e9

    @property
    def strays(self) -> frozenset[str]:
        """Names of what is in shared topics and of none of their sensors."""
        return self._shared.strays

    def use_sources(self, sources: Mapping[str, Sequence[TopicSource]]) -> None:
        """Read topics that several LiDARs share as one topic for each, ``TOPIC#SOURCE``."""
        self._shared = SharedTopics(sources)
        names = {topic.name: self._shared.names(topic.name) for topic in self.topics}
        self.topics = tuple(
            replace(t, name=name, messages=t.messages // len(names[t.name]))
            for t in self.topics
            for name in names[t.name]
        )

    def use_recipes(self, recipes: Mapping[str, PointRecipe]) -> None:
        """Decode the messages of some topics to points with common names, by recipes."""
        self.recipes = recipes
        self.topics = tuple(self._topic(t.name, t.type, t.messages) for t in self.topics)

    def messages(self, topics: Collection[str]) -> Iterator[BagMessage]:
        """Messages of some topics in order of recording, as a stream.

        Raises:
            CorruptFile: If not one chunk of a file can be read.
        """
        budget = Budget(self._stored_bytes)
        stored = self._shared.stored(topics)
        streams = [self._of_source(source, stored, budget) for source in self._sources]
        merged = heapq.merge(*streams, key=lambda message: message.t_ns)
        yield from self._shared.routed(merged, topics, self._parts)

    def decode(self, message: BagMessage, *, as_sent: bool = False) -> Any | None:
        """Decode a message to an object with its fields; None (counted) if it is damaged.

        Args:
            message: One of `messages`.
            as_sent: Without the recipe of its topic.
        """
        try:
            content = self._decoded(message) if message.content is None else message.content
            recipe = None if as_sent else self.recipes.get(message.topic)
            if recipe is None:
                return content
            table = as_points(recipe, cloud_lists(content))
            return PointMessage(content.header, table, content.data)
        except CorruptFile as error:
            self._left_out(message.topic, error=error)
        except Exception:  # damaged bytes raise errors of many kinds in generated code
            self._left_out(message.topic, undecoded=True)
        return None

    def _parts(self, message: BagMessage) -> dict[TopicSource, BagMessage]:
        """What a message has of each sensor."""
        content = self.decode(message, as_sent=True)
        parts = {} if content is None else parts_of(message.type, content)
        return {source: replace(message, content=part) for source, part in parts.items()}

    def _decoded(self, message: BagMessage) -> Any:
        if message.type in self._points:
            return self._points[message.type].read(message.data, ros1=self.ros1)
        check_message(message.type, message.data, ros1=self.ros1)
        return self._types.decode(message.type, message.data, ros1=self.ros1)

    def _left_out(self, topic: str, **why: Value | Exception) -> None:
        self.report.count("messages_corrupt")
        self.report.outcome = "lossy"
        self.report.warn(FindingKind.MESSAGE_LEFT_OUT, where=topic, **why)

    # -- opening

    def _open(self, path: Path) -> None:
        (self._open_folder if path.is_dir() else self._open_file)(path)

    def _open_folder(self, path: Path) -> None:
        """The files that the description lists; without one, all storage files."""
        before, described, copies = len(self._sources), True, self._copies
        try:
            metadata = read_metadata(path)
        except CorruptFile as error:
            say_undescribed(path, error, self.report)
            metadata, described = BagMetadata(storage_files(path, error), "", 0), False
        if described:
            metadata = with_files_there(path, metadata, self.report)
        files = metadata.files
        if metadata.compression == "file":
            files = self._decompressed(files)
        for file in files:
            try:
                self._open_file(file)
            except (CorruptFile, EmptyRecording) as error:
                if len(files) == 1:
                    raise
                self.report.outcome = "lossy"
                self.report.count("files_damaged")
                self.report.warn(FindingKind.FILE_LEFT_OUT, name=path.name, error=error)
        if described:
            self._origins[before:] = [path] * (len(self._sources) - before)
        if self._copies == copies:
            self._compare(path, self._sources[before:], metadata.messages)

    def _compare(self, path: Path, sources: Sequence[StorageFile], expected: int) -> None:
        found = sum(source.index.message_count for source in sources)
        if found < expected:
            self.report.outcome = "lossy"
            self.report.count("messages_missing", expected - found)
            self.report.warn(
                FindingKind.MESSAGES_MISSING, name=path.name, expected=expected, found=found
            )

    def _decompressed(self, files: Sequence[Path]) -> tuple[Path, ...]:
        """Decompressed copies of compressed files, while the bag is open."""
        needed = sum(file.stat().st_size for file in files)
        folder = self._stack.enter_context(scratch_folder(needed))
        budget = Budget(needed)
        return tuple(decompress_file(file, folder, budget) for file in files)

    def _open_file(self, path: Path) -> None:
        if not is_new(path, self._files, self.report):
            self._copies += 1
            return
        if is_bag1(path):
            self.ros1 = True
            file = self._stack.enter_context(RecordFile(path))
            self._sources.append(self._bag1(file))
        elif db3.is_db3(path):
            database = db3.Db3(path, self.report)
            self._stack.callback(database.close)
            self._sources.append(database)
        else:
            self._sources.append(self._mcap(self._stack.enter_context(RecordFile(path))))
        self._sources[-1].go_on()
        steps = self._sources[-1].index.steps
        say_steps(path.name, steps, self.report)
        self.stamp_jumps.of_recorder += [RecorderJump(one.t_ns, -one.shift_ns) for one in steps]
        self._origins.append(path)
        self._stored_bytes += path.stat().st_size

    def _bag1(self, file: RecordFile) -> StorageFile:
        try:
            return Bag1(file, self.report)
        except CorruptFile as error:
            self.report.warn(FindingKind.FILE_SALVAGED, name=file.name, error=error)
        source = Bag1.scan(file, self.report)
        self._salvaged(source, file.name)
        return source

    def _mcap(self, file: RecordFile) -> StorageFile:
        reason = ""
        try:
            return Mcap(file, self.report)
        except CorruptFile as error:
            reason = str(error)
        source, whole = Mcap.scan(file, self.report)
        if not whole:
            self.report.warn(FindingKind.FILE_SALVAGED, name=file.name, error=reason)
            self._salvaged(source, file.name)
        return source

    def _salvaged(self, source: StorageFile, name: str) -> None:
        count = source.index.message_count
        if not count:
            self.report.outcome = "nothing"
            raise CorruptFile(CodedText("bag-nothing-left", name=name))
        self.report.outcome = "lossy"
        self.report.count("files_cut")
        self.report.count("messages_salvaged", count)
        self.report.warn(FindingKind.FILE_SALVAGED, name=name, messages=count)

    def _summarize(self) -> None:
        counts: dict[tuple[str, str], int] = {}
        definitions: dict[str, str] = {}
        for source in self._sources:
            for topic in source.index.topics.values():
                key = (topic.topic, topic.msgtype)
                counts[key] = counts.get(key, 0) + topic.msgcount
                known = definitions.get(topic.msgtype)
                definitions[topic.msgtype] = known or topic.definition
        points = {k: text for k, text in definitions.items() if k not in PACKET_MESSAGES}
        self._points, self._types = point_readers(points), MessageTypes(definitions)
        self.topics = tuple(self._topic(n, t, c) for (n, t), c in sorted(counts.items()))
        filled = [s.index for s in self._sources if s.index.message_count]
        require_one_walk(
            [
                FileTimes(path, one.index.start_time, one.index.end_time)
                for path, one in zip(self._origins, self._sources, strict=True)
                if one.index.message_count
            ]
        )
        if not filled:
            names = ", ".join(path.name for path in self.paths)
            raise EmptyRecording(CodedText("bag-empty", names=names))
        self.t_first_ns = min(index.start_time for index in filled)
        self.t_last_ns = max(index.end_time for index in filled) - 1
        turn_round(self._sources, {t.name for t in self.topics if t.type in _HEADED}, self.report)
        first = self._first_measured()
        self.t_first_ns = first.t_ns if first is not None else self.t_first_ns

    def _topic(self, name: str, kind: str, messages: int) -> BagTopic:
        reader = self._points.get(kind)
        columns = reader.columns if reader else ()
        is_known = reader.is_known if reader else kind == CLOUD
        is_points = is_known or (bool(columns) and name in self.recipes)
        return BagTopic(name, kind, messages, columns, is_points)

    def _first_measured(self) -> BagMessage | None:
        report, self.report = self.report, ImportReport()  # damage is reported when it is read
        try:
            kinds = {*_MEASURED, *(topic.type for topic in self.topics if topic.is_points)}
            names = [topic.name for topic in self.topics if topic.type in kinds]
            return next(self.messages(names), None) if names else None
        except CorruptFile:
            return None
        finally:
            self.report = report

    # -- reading

    def _of_source(
        self, source: StorageFile, topics: set[str], budget: Budget
    ) -> Iterator[BagMessage]:
        source.report = self.report
        for topic, kind, t_ns, data in source.messages(topics):
            if self.ros1 or not is_zstd(data):
                yield BagMessage(topic, kind, t_ns, data)
                continue
            most = min(MAX_MESSAGE_BYTES, max(RATIO_FLOOR_BYTES, MAX_RATIO * len(data)))
            plain = decompress_partly("zstd", data, most=most, where=topic)
            budget.charge(len(plain), f"{self.paths[0].name}: {topic}")
            yield BagMessage(topic, kind, t_ns, plain)
