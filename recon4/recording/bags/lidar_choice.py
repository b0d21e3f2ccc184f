"""Which clouds of a bag are of LiDARs as measured: not maps, filtered copies or depth cameras."""

from __future__ import annotations

from collections.abc import Collection, Iterator, Mapping, Sequence, Set
from dataclasses import dataclass, field
from itertools import repeat
from typing import Any, ClassVar

import numpy as np
from numpy.typing import NDArray

from recon4.errors import RecordingError
from recon4.model.derived_kinds import DerivedKind
from recon4.model.finding import Value
from recon4.recording.bags.topic_contents import Contents, read_contents, say_left_out
from recon4.recording.bags.tuning import LIDAR_CHOICE
from recon4.recording.clouds.point_fields import EXACT_TIME, RING_FIELDS, TIME_FIELDS, find_field
from recon4.recording.formats.bags import IMU, ODOMETRY, Bag, BagTopic
from recon4.recording.formats.cloud_tables import cloud_table
from recon4.recording.formats.shared_topics import TopicSource, sources_of
from recon4.recording.mounts.frame_graph import BODY_FRAMES, WORLD_FRAMES, last_name
from recon4.recording.mounts.transform_messages import frame_name, has_frames, read_frames
from recon4.recording.packets.messages import PACKET_MESSAGES
from recon4.recording.packets.senders import OwnPackets, parts_of
from recon4.recording.report import ImportReport
from recon4.recording.tuning import SHARED_TOPICS

_COLORS = ("rgb", "rgba", "bgr", "r", "red")
_INTENSITIES = ("intensity", "reflectivity", "signal", "i")
_TIMES = (EXACT_TIME, *TIME_FIELDS)
_ROBOT_FRAMES = {*BODY_FRAMES, "body", "base", "vehicle"}


@dataclass(frozen=True, slots=True, eq=False)
class CloudTopic:
    """A topic of clouds, and why it is none of a LiDAR as measured."""

    FULL_DETAIL: ClassVar[int] = 2
    """`detail` of clouds with times and rings."""

    topic: BagTopic
    frame: str
    points: int
    """Usual number of points."""
    fields: frozenset[str]
    clouds: Mapping[int, NDArray[np.float64]]
    """Stamp of the first messages [ns] -> their finite points [m], (N, 3)."""
    is_camera: bool = False
    why_not: Mapping[str, Value] = field(default_factory=dict)
    """Values of `DerivedKind.TOPIC_LEFT_OUT` that say why; empty = it is read."""

    @property
    def stamps(self) -> Set[int]:
        """Of the first messages [ns]."""
        return self.clouds.keys()

    @property
    def has_places(self) -> bool:
        """Whether there are columns x, y and z; without a message nobody knows."""
        return not self.fields or {"x", "y", "z"} <= self.fields

    @property
    def is_placed(self) -> bool:
        """Whether a program has placed the points in a map, by the name of their frame."""
        return last_name(self.frame) in WORLD_FRAMES

    @property
    def is_measured(self) -> bool:
        """Whether nothing shows that the points are of a depth camera or a map."""
        return not self.is_camera and not self.is_placed

    @property
    def detail(self) -> int:
        """How much of what a LiDAR measures is there: times and rings of the points.

        Negative = a camera.
        """
        return -self.is_camera + sum(
            bool(find_field(self.fields, names)) for names in (_TIMES, RING_FIELDS)
        )


def judged_clouds(bag: Bag, clouds: Sequence[BagTopic], keep: Collection[str]) -> list[CloudTopic]:
    """The clouds of an open bag, and which of them are not read and why.

    Args:
        bag: An open bag.
        clouds: Its topics of clouds; the only one is read, whatever it is.
        keep: Topics that a rig file names: they are read.
    """
    contents = read_contents(bag, clouds)
    found = [_described(one) for one in contents.values()]
    fixed = _frames_of_poses(bag, {one.frame for one in found}) if len(found) > 1 else set()
    reasons = {one.topic.name: _why_not(one, found, fixed) for one in found}
    reasons |= {name: {} for name in keep}
    if not any(not reasons[one.topic.name] for one in found):
        reasons = {}
    return [
        CloudTopic(
            one.topic, one.frame, one.points, one.fields, one.clouds, one.is_camera,
            reasons.get(one.topic.name, {}),
        )
        for one in found
    ]  # fmt: skip


def say_clouds_left_out(
    used: Sequence[CloudTopic], found: Sequence[CloudTopic], report: ImportReport
) -> None:
    """State which clouds are not read beside those that are."""
    names = ", ".join(one.topic.name for one in used)
    for one in found if used else ():
        if one.why_not:
            left = {"topic": one.topic.name, **one.why_not}
            say_left_out("LiDAR", names, left, report=report)


def _frames_of_poses(bag: Bag, frames: Collection[str]) -> set[str]:
    """Those of some frames in which odometry states poses, and which are no part of the robot.

    Some drivers write the frame of the sensor where that of the map belongs: it is the frame of the
    body too, or of an IMU, or fixed to the robot.
    """
    types = (ODOMETRY, IMU)
    contents = read_contents(bag, [t for t in bag.topics if t.type in types])
    poses = [one for one in contents.values() if one.topic.type == ODOMETRY and one.messages]
    parts = {one.frame for one in contents.values() if one.topic.type == IMU}
    bodies = {one.topic.name: frame_name(one.messages[0].child_frame_id) for one in poses}
    stated = {one.frame for one in poses if bodies[one.topic.name] not in ("", one.frame)}
    fixed = (stated & set(frames)) - parts - {""}
    if not fixed or not has_frames(bag.topics):
        return fixed
    graph = read_frames(bag, sorted(fixed), ImportReport())
    return {frame for frame in fixed if frame not in graph or not graph.body_of(frame)}


def _described(found: Contents) -> CloudTopic:
    counts = [int(m.width) * int(m.height) for m in found.messages]
    names = frozenset(f.name.lower() for m in found.messages[:1] for f in m.fields)
    return CloudTopic(
        topic=found.topic,
        frame=found.frame,
        points=int(np.median(counts)) if counts else 0,
        fields=names,
        clouds={t: _points(m) for t, m in zip(found.t_ns, found.messages, strict=True)},
        is_camera=_is_camera(found, names),
    )


def _why_not(
    one: CloudTopic, others: Sequence[CloudTopic], fixed: Collection[str]
) -> dict[str, Value]:
    """Why a cloud is not as a LiDAR measured it; empty = it is."""
    if not one.points:
        return {"no_points": True}
    better = [o for o in others if o is not one and o.points and not o.is_camera]
    in_detail = [o.topic.name for o in better if o.detail > one.detail]
    if one.is_camera:
        return {"camera": True}
    if one.is_placed or _is_in_frame_of_poses(one, better, fixed):
        return {"fixed_frame": one.frame}
    if in_detail and last_name(one.frame) in _ROBOT_FRAMES:
        return {"robot_frame": one.frame, "better": in_detail[0]}
    for other in better:
        if other.frame == one.frame and _has_less(one, other):
            return {"copy_of": other.topic.name, "lesser": True}
        if _has_same_points(one, other) and _rank(one) < _rank(other):
            return {"copy_of": other.topic.name, "whole": True}
    return {}


def _is_in_frame_of_poses(
    one: CloudTopic, others: Sequence[CloudTopic], fixed: Collection[str]
) -> bool:
    """Whether odometry states poses in the frame of a cloud, and another one is as measured."""
    measured = [o for o in others if not o.is_placed and o.frame not in fixed]
    return one.frame in fixed and any(o.detail >= one.detail for o in measured)


def _has_less(one: CloudTopic, other: CloudTopic) -> bool:
    """Whether a cloud is made of another one: the same stamps, and less detail or fewer points."""
    fewer = min(len(one.stamps), len(other.stamps))
    same = len(one.stamps & other.stamps) >= LIDAR_CHOICE.same_stamps * fewer
    less = (one.detail, one.points) < (other.detail, LIDAR_CHOICE.fewer * other.points)
    return same and less and one.detail <= other.detail


def _has_same_points(one: CloudTopic, other: CloudTopic) -> bool:
    """Whether a cloud is another one again: relayed, sent more rarely, or turned to another frame.

    The same numbers in another frame are no copy: nothing has turned them.
    """
    for t_ns in one.stamps & other.stamps:
        a, b = one.clouds[t_ns], other.clouds[t_ns]
        if len(a) == len(b) > 1 and (one.frame == other.frame or not np.array_equal(a, b)):
            same = np.abs(_steps_m(a) - _steps_m(b)) < LIDAR_CHOICE.same_step_m
            return bool(np.mean(same) >= LIDAR_CHOICE.same_steps)
    return False


def _steps_m(points: NDArray[np.float64]) -> NDArray[np.float64]:
    """Distance from each point to the next [m], (N - 1,)."""
    return np.asarray(np.linalg.norm(np.diff(points, axis=0), axis=1))


def _rank(one: CloudTopic) -> tuple[object, ...]:
    """Which of equal clouds is read: one of a sensor's own frame, then the one with the most."""
    own = not one.is_placed and last_name(one.frame) not in _ROBOT_FRAMES
    return own, one.detail, one.topic.messages, -len(one.topic.name), one.topic.name


def _is_camera(found: Contents, fields: Collection[str]) -> bool:
    """Whether clouds are of a camera: a narrow view, and colors or an image without intensities."""
    kinds: Mapping[str, tuple[str, ...]] = {"time": _TIMES, "ring": RING_FIELDS}
    if any(find_field(fields, names) for names in kinds.values()):
        return False
    image = any(int(m.height) > 1 for m in found.messages)
    colored = bool(find_field(fields, _COLORS))
    plain = image and not find_field(fields, _INTENSITIES)
    return (colored or plain) and _is_narrow(found)


def _is_narrow(found: Contents) -> bool:
    for message in found.messages:
        p = _points(message)
        p = p[p.any(axis=1)]
        if not len(p):
            continue
        rays = p / np.linalg.norm(p, axis=1, keepdims=True)
        middle = rays.mean(axis=0)
        cosine = rays @ middle / max(float(np.linalg.norm(middle)), 1e-9)
        return bool(np.percentile(cosine, 5) > np.cos(LIDAR_CHOICE.widest_camera_rad))
    return False


def _points(message: Any) -> NDArray[np.float64]:
    """The finite points of a cloud [m], (N, 3); none of one that cannot be read."""
    try:
        table = cloud_table(message)
    except RecordingError:
        return np.zeros((0, 3))
    if not {"x", "y", "z"} <= set(table):
        return np.zeros((0, 3))
    p = np.column_stack([table[axis] for axis in "xyz"]).astype(np.float64)
    return p[np.isfinite(p).all(axis=1)]


def shared_topics(bag: Bag, report: ImportReport) -> dict[str, tuple[TopicSource, ...]]:
    """Topics of points or packets that several LiDARs share, with the sources of their heads.

    Args:
        bag: An open bag.
        report: Receives which they are.
    """
    found = {}
    for topic in bag.topics:
        if not (is_cloud(topic) or (topic.type in PACKET_MESSAGES and topic.messages)):
            continue
        if sources := sources_of(_sources_at_head(bag, topic)):
            found[topic.name] = sources
            report.derive(
                DerivedKind.TOPIC_SHARED,
                topic=topic.name,
                lidars=len(sources),
                sources=", ".join(map(str, sources)),
            )
    return found


def _sources_at_head(bag: Bag, topic: BagTopic) -> Iterator[TopicSource]:
    """Of each part of the first messages: of each packet, or of each cloud."""
    left = 0 if is_cloud(topic) else SHARED_TOPICS.packets
    for number, message in enumerate(bag.messages([topic.name])):
        if number >= SHARED_TOPICS.head and left <= 0:
            return
        content = bag.decode(message, as_sent=True)
        parts = {} if content is None else parts_of(topic.type, content)
        for source, part in parts.items():
            packets = len(part.packets) if isinstance(part, OwnPackets) else 1
            left -= packets
            yield from repeat(source, packets)


def is_cloud(topic: BagTopic) -> bool:
    """Whether a topic has clouds."""
    return topic.is_points and topic.messages > 0
