"""Mounts of the sensors of a bag as its own transforms state them; derives a rig from them."""

from __future__ import annotations

from collections import Counter
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, replace
from itertools import combinations, islice

import numpy as np

from recon4.geometry.se3 import SE3
from recon4.locales.numbers import mount_text
from recon4.model.derived_kinds import DerivedKind
from recon4.model.finding import Value
from recon4.model.finding_kinds import FindingKind
from recon4.model.rig import Rig
from recon4.recording.formats.bags import Bag
from recon4.recording.mounts.frame_graph import (
    BODY_FRAMES,
    WORLD_FRAMES,
    FrameGraph,
    difference,
    last_name,
    mount_value,
)
from recon4.recording.mounts.moving import MovingMount, moving_mount
from recon4.recording.mounts.transform_messages import frame_of, has_frames, read_frames
from recon4.recording.mounts.tuning import SAME_MOUNT
from recon4.recording.report import ImportReport
from recon4.recording.rigs.choice import Stream, single_rig
from recon4.recording.tuning import LISTED, PROBE


@dataclass(frozen=True, slots=True, eq=False)
class Mounts:
    """What a bag states about the frames of its sensors."""

    graph: FrameGraph
    frames: Mapping[str, str]
    """Topic -> frame of its messages; topics without a readable message or a name are missing."""
    any_stated: bool
    """Whether the bag has transforms or a description of a robot at all."""
    moving: Mapping[str, MovingMount] = field(default_factory=dict)
    """Topic of a LiDAR on a joint that moves -> its mount; its frame is that of the base."""

    def frame_of(self, topic: str) -> str:
        """The frame of a topic; empty = not known."""
        return self.frames.get(topic, "")

    def T_a_b(self, topic_a: str, topic_b: str) -> SE3 | None:
        """Mount of the sensor of topic ``b`` in the frame of ``a``; None = it is not stated."""
        a, b = self.frame_of(topic_a), self.frame_of(topic_b)
        return self.graph.T_a_b(a, b) if a and b else None


@dataclass(frozen=True, slots=True)
class SampleTopics:
    """Topics of the samples beside the points; empty = there are none."""

    imu: str = ""
    fixes: str = ""


def read_mounts(bag: Bag, topics: Sequence[str], report: ImportReport) -> Mounts:
    """Read the frames of some topics, and what an open bag states about them.

    Args:
        bag: An open bag.
        topics: Topics of the sensors that are used; empty ones are passed over.
        report: Receives remarks.
    """
    found = {topic: _frame_of(bag, topic) for topic in topics if topic}
    frames = {topic: frame for topic, frame in found.items() if frame}
    if not has_frames(bag.topics):
        return Mounts(FrameGraph(()), frames, any_stated=False)
    graph = read_frames(bag, list(frames.values()), report)
    mounts = Mounts(graph, _without_prefixes(frames, graph, report), any_stated=True)
    _warn_disputed(mounts, report)
    return mounts


def _frame_of(bag: Bag, topic: str) -> str:
    for message in islice(bag.messages([topic]), PROBE.messages):
        content = bag.decode(message)
        if content is not None:
            return frame_of(content)
    return ""


def _without_prefixes(
    frames: Mapping[str, str], graph: FrameGraph, report: ImportReport
) -> dict[str, str]:
    """The frames of topics as the transforms name them, where that is certain."""
    meant = {frame: graph.meant_by(frame) for frame in frames.values()}
    claimed = Counter(names[0] for names in meant.values() if len(names) == 1)
    named = {}
    for topic, frame in frames.items():
        names = meant[frame]
        named[topic] = frame
        if not names or names == [frame]:
            continue
        if len(names) == 1 and claimed[names[0]] == 1:
            named[topic] = names[0]
            report.derive(DerivedKind.FRAME_NAMED, topic=topic, frame=frame, name=names[0])
        else:
            report.derive(
                DerivedKind.FRAME_UNCERTAIN,
                topic=topic,
                frame=frame,
                names=", ".join(names[: LISTED.few]),
                several=len(names) > 1,
                shared=len(names) == 1,
            )
    return named


def _warn_disputed(mounts: Mounts, report: ImportReport) -> None:
    """Contradictions between the sensors; those of other parts of a robot do not matter."""
    graph, frames = mounts.graph, sorted(set(mounts.frames.values()))
    bodies = {graph.body_of(frame) for frame in frames if frame in graph} - {""}
    between = [
        one
        for a, b in combinations([*frames, *sorted(bodies)], 2)
        if a in graph and graph.connected([a, b])
        for one in graph.path(a, b)
    ]
    on_path = {name for one in between for name in (one.parent, one.child)}
    for one in between:
        if one.disputed:
            report.warn(FindingKind.MOUNT_DISPUTED, source=one.source, used=one.text)
    for one in graph.contradictions():
        report.count("transforms_contradictory")
        if one.child in on_path:
            report.warn(FindingKind.MOUNT_LOOP, transform=one.text)


def on_their_joints(
    bag: Bag, mounts: Mounts, *, lidars: Sequence[str], imu: str, report: ImportReport
) -> Mounts:
    """The mounts with LiDARs on joints that move in the frame of what carries the joint.

    Args:
        bag: An open bag.
        mounts: What it states.
        lidars: Topics of its LiDARs.
        imu: Topic of the IMU; one that moves with a LiDAR feels the motion of the joint, too.
        report: Receives which joints move.
    """
    of_imu = {joint.child for joint in mounts.graph.joints_above(mounts.frame_of(imu))}
    moving: dict[str, MovingMount] = {}
    for topic in lidars:
        frame = mounts.frame_of(topic)
        joints = {joint.child for joint in mounts.graph.joints_above(frame)}
        if joints and joints == of_imu:
            report.derive(DerivedKind.MOUNT_TURNS_TOGETHER, topic=topic, imu=imu)
            continue
        mount = moving_mount(bag, mounts.graph, frame, report=report)
        if mount is not None:
            moving[topic] = mount
            report.derive(DerivedKind.MOUNT_MOVES, placed=topic, **mount.values)
    frames = {**mounts.frames, **{topic: mount.base for topic, mount in moving.items()}}
    return replace(mounts, frames=frames, moving=moving)


# -- a rig


def rig_by_frames(
    streams: Sequence[Stream], samples: SampleTopics, mounts: Mounts, *, report: ImportReport
) -> Rig:
    """The sensors of a bag, mounted as its transforms say; noted in the report.

    The body has its origin in the only LiDAR, and the axes of the robot where they are known. With
    several LiDARs, which `why_no_rig` must allow, it is the frame of the robot.
    """
    if len(streams) == 1:
        rig, T_body_first = _of_one(streams[0], mounts, report)
        T_body_imu = T_body_first
    else:
        rig, T_body_first = _of_several(streams, mounts, report)
        T_body_imu = SE3.identity()
    p_body_antenna = rig.p_body_antenna
    first = streams[0].topic
    imu = stated_mount(mounts, first, samples.imu, what="IMU", report=report)
    antenna = stated_mount(mounts, first, samples.fixes, what="GNSS antenna", report=report)
    if imu is not None:
        T_body_imu = T_body_first @ imu
    if antenna is not None:
        p_body_antenna = (T_body_first @ antenna).t
    return replace(rig, T_body_imu=T_body_imu, p_body_antenna=p_body_antenna)


def why_no_rig(streams: Sequence[Stream], mounts: Mounts) -> str:
    """Why a bag does not say how its LiDARs are mounted; empty = it does, or there is only one."""
    if len(streams) == 1:
        return ""
    if not mounts.any_stated:
        return "the bag has no transforms (tf)"
    frames = [mounts.frame_of(stream.topic) for stream in streams]
    if not mounts.graph.connected(frames):
        known = ", ".join(f"{s.topic} in {f!r}" for s, f in zip(streams, frames, strict=True))
        return f"the transforms of the bag (tf) do not connect their frames: {known}"
    for a, b in combinations(frames, 2):
        T_a_b = mounts.graph.T_a_b(a, b)
        assert T_a_b is not None
        if is_placeholder(T_a_b):
            return f"the transforms of the bag (tf) put {a} and {b} at one place: a placeholder"
        if _is_far(T_a_b):
            mount = mount_text(mount_value(T_a_b))
            return f"the transforms of the bag (tf) put {a} far from {b}: {mount}"
    return ""


def is_placeholder(T_a_b: SE3) -> bool:
    """Whether two sensors were at one place with the same axes, which nobody has measured."""
    angle_rad, distance_m = difference(T_a_b, SE3.identity())
    return angle_rad < 1e-6 and distance_m < 1e-6


def stated_mount(
    mounts: Mounts, topic_a: str, topic_b: str, *, what: str, report: ImportReport
) -> SE3 | None:
    """The mount of the sensor of topic ``b`` in the frame of ``a``, with a remark; None = unknown.

    Args:
        mounts: Of the bag.
        topic_a: Topic of the one sensor.
        topic_b: Topic of the other one; empty = there is none.
        what: Name of the other one.
        report: Receives where the mount comes from, or why it is not known.
    """
    a, b = mounts.frame_of(topic_a), mounts.frame_of(topic_b)
    if not mounts.any_stated or not topic_b or a == b:
        return None
    T_a_b = mounts.T_a_b(topic_a, topic_b)
    if T_a_b is None:
        report.derive(
            DerivedKind.MOUNT_UNSTATED,
            what=what,
            parent=a or "no-frame",
            child=b or "no-frame",
        )
        return None
    if _is_far(T_a_b):
        report.warn(FindingKind.MOUNT_FAR, what=what, parent=a, child=b, mount=mount_value(T_a_b))
        return None
    report.derive(DerivedKind.MOUNT_STATED, **stated_values(mounts, a, b, what=what))
    return T_a_b


def stated_values(mounts: Mounts, a: str, b: str, *, what: str) -> dict[str, Value]:
    """Where a mount comes from, and what it is, as values of `DerivedKind.MOUNT_STATED`."""
    T_a_b = mounts.graph.T_a_b(a, b)
    assert T_a_b is not None
    sources = sorted({one.source for one in mounts.graph.path(a, b)})
    values: dict[str, Value] = {"what": what, "parent": a, "child": b}
    values |= {"placeholder": True} if is_placeholder(T_a_b) else {"mount": mount_value(T_a_b)}
    return values | {"sources": ", ".join(sources)}


def _is_far(T_a_b: SE3) -> bool:
    return float(np.linalg.norm(T_a_b.t)) > SAME_MOUNT.farthest_m


def _of_one(stream: Stream, mounts: Mounts, report: ImportReport) -> tuple[Rig, SE3]:
    """The rig of one LiDAR, and its mount."""
    rig = single_rig(stream)
    frame = mounts.frame_of(stream.topic)
    base = mounts.graph.body_of(frame)
    T_base_lidar = mounts.graph.T_a_b(base, frame) if base else None
    if (
        T_base_lidar is None
        or difference(SE3(T_base_lidar.R, np.zeros(3)), SE3.identity())[0] < 1e-6
    ):
        report.derive(DerivedKind.RIG_CHOSEN, model=stream.model, own_frame=True)
        return rig, SE3.identity()
    report.derive(DerivedKind.RIG_CHOSEN, model=stream.model, axes_of=base)
    report.derive(DerivedKind.MOUNT_STATED, **stated_values(mounts, base, frame, what="LiDAR"))
    T_body_lidar = SE3(T_base_lidar.R, np.zeros(3))
    sensor = replace(rig.sensors[0], T_body_sensor=T_body_lidar)
    return replace(rig, sensors=(sensor,)), T_body_lidar


def _of_several(streams: Sequence[Stream], mounts: Mounts, report: ImportReport) -> tuple[Rig, SE3]:
    """The rig of several LiDARs, and the mount of the first."""
    frames = [mounts.frame_of(stream.topic) for stream in streams]
    body = mounts.graph.body_of(frames[0]) or mounts.graph.top_of(frames[0])
    report.derive(DerivedKind.RIG_CHOSEN, lidars=len(streams), frame=body)
    sensors = []
    for stream, frame in zip(streams, frames, strict=True):
        T_body_sensor = mounts.graph.T_a_b(body, frame)
        assert T_body_sensor is not None
        stated = stated_values(mounts, body, frame, what=f"LiDAR {stream.topic}")
        report.derive(DerivedKind.MOUNT_STATED, **stated)
        sensor = single_rig(stream).sensors[0]
        sensors.append(replace(sensor, name=frame, T_body_sensor=T_body_sensor))
    rig = replace(single_rig(streams[0]), name="by tf", sensors=tuple(sensors))
    return rig, sensors[0].T_body_sensor


# -- frames that are none of a sensor


def say_frames(mounts: Mounts, topics: Sequence[str], report: ImportReport) -> None:
    """State which points are not given in the frame of their sensor."""
    for topic in topics:
        frame = mounts.frame_of(topic)
        if last_name(frame) in WORLD_FRAMES:
            report.derive(DerivedKind.FRAME_OF_POINTS, topic=topic, frame=frame, placed=True)
        elif last_name(frame) in BODY_FRAMES:
            report.derive(DerivedKind.FRAME_OF_POINTS, topic=topic, frame=frame, on_robot=True)
