"""The frames of a robot in a bag: static transforms, constant ones of ``/tf``, joints.

What a bag states is hostile until proven: numbers, names and sizes are checked, and everything that
is left out is counted.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from itertools import islice
from math import acos, isfinite
from typing import Any

import numpy as np

from recon4.errors import CorruptFile
from recon4.geometry.se3 import SE3
from recon4.model.derived_kinds import DerivedKind
from recon4.model.finding import Value
from recon4.recording.formats.bags import JOINT_STATES, TEXT, Bag, BagTopic
from recon4.recording.formats.limits import clean_name
from recon4.recording.formats.typestore import TRANSFORMS
from recon4.recording.formats.urdf import UrdfJoint, urdf_joints
from recon4.recording.limits import LIMITS
from recon4.recording.mounts.driven_joints import DrivenJoint, driven_joint, stated_positions
from recon4.recording.mounts.frame_graph import (
    WORLD_FRAMES,
    FrameGraph,
    MovingJoint,
    StatedTransform,
    is_same,
    last_name,
)
from recon4.recording.mounts.tuning import TRANSFORM_LIMITS
from recon4.recording.report import ImportReport

_Numbers = tuple[float, ...]
"""x, y, z [m] and quaternion x, y, z, w."""
_Pair = tuple[str, str]
"""Parent and child."""


def has_frames(topics: Sequence[BagTopic]) -> bool:
    """Whether a bag may state transforms between frames."""
    return any(t.messages and (t.type in TRANSFORMS or _is_description(t)) for t in topics)


def read_frames(bag: Bag, frames: Sequence[str], report: ImportReport) -> FrameGraph:
    """Read what a bag states about its frames.

    Static transforms come first, then the fixed joints of a robot description, then its other
    joints at their positions by ``JointState``, then ``/tf``: transforms that do not change, and
    joints that move. Positions and ``/tf`` are only read if what comes before does not connect all
    frames with each other and with the robot. Where both state how a joint moves, ``/tf`` counts.

    Args:
        bag: An open bag.
        frames: The frames of the sensors.
        report: Counts what is left out.
    """
    names = [t.name for t in bag.topics if t.type in TRANSFORMS and t.messages]
    static = [name for name in names if last_name(name) == "tf_static"]
    moving = [name for name in names if name not in static]
    stated = _Statements(report)
    for name in static:
        stated.add_static(name, _messages(bag, name, most=LIMITS.transform_messages, report=report))
    for topic in filter(_is_description, bag.topics):
        stated.add_description(
            topic.name, _messages(bag, topic.name, most=LIMITS.descriptions, report=report)
        )
    if _is_complete(stated.graph(), frames):
        return stated.graph()
    for topic in bag.topics:
        if topic.type == JOINT_STATES and topic.messages and stated.drivers:
            most = LIMITS.transform_messages
            stated.add_positions(topic.name, _messages(bag, topic.name, most=most, report=report))
    for name in moving:
        stated.add_constant(
            name, _messages(bag, name, most=LIMITS.transform_messages, report=report)
        )
    return stated.graph()


def frame_of(message: Any) -> str:
    """The frame that a message names; empty = it has no header, or names none."""
    header = getattr(message, "header", None)
    return frame_name(header.frame_id) if header is not None else ""


def frame_name(raw: str) -> str:
    """The name of a frame; a slash at its front, as in ROS 1, means nothing."""
    return clean_name(raw.strip().lstrip("/"))


def _is_complete(graph: FrameGraph, frames: Sequence[str]) -> bool:
    """Whether the places of all frames on the robot are known."""
    known = all(frame in graph and graph.body_of(frame) for frame in frames)
    return known and graph.connected(frames)


def _is_description(topic: BagTopic) -> bool:
    return topic.type == TEXT and last_name(topic.name) == "robot_description"


def _messages(bag: Bag, name: str, *, most: int, report: ImportReport) -> Iterator[Any]:
    """The first messages of a topic, decoded; says so where there are more."""
    number = 0
    for number, message in enumerate(islice(bag.messages([name]), most), start=1):
        content = bag.decode(message)
        if content is not None:
            yield content
    if number == most:
        report.derive(DerivedKind.TRANSFORMS_CUT, topic=name, messages=most)


@dataclass(slots=True)
class _Statement:
    """What one topic says about two frames."""

    numbers: _Numbers
    count: int = 1
    differs: bool = False
    """Whether it is stated in different ways."""
    tilt_rad: float = 0.0
    """Largest angle between the vertical at first and later [rad]."""


class _Statements:
    """Collects transforms, each pair of frames once."""

    def __init__(self, report: ImportReport) -> None:
        self._report = report
        self._stated: list[StatedTransform] = []
        self._moving: list[MovingJoint] = []
        self._driven: dict[_Pair, DrivenJoint] = {}
        """Joints of descriptions that are not fixed."""
        self._children: set[str] = set()
        """Frames with a static parent: what others state about them is not asked for."""

    def graph(self) -> FrameGraph:
        """The frames so far."""
        return FrameGraph(self._stated, self._moving)

    @property
    def drivers(self) -> frozenset[str]:
        """Names of the joints whose positions would tell more."""
        return frozenset(joint.driver for joint in self._driven.values())

    def add_static(self, name: str, messages: Iterator[Any]) -> None:
        """Add static transforms; of several between two frames the last counts, as in tf2."""
        found = self._collect(name, messages, last=True)
        for pair, one in found.items():
            self._report.count("transforms_contradictory", int(one.differs))
            self._keep(pair, one, name)
        self._children |= {child for _, child in found}

    def add_constant(self, name: str, messages: Iterator[Any]) -> None:
        """Add the transforms of ``/tf`` that never change, and the joints that move."""
        for pair, one in self._collect(name, messages, last=False).items():
            if last_name(pair[0]) in WORLD_FRAMES or pair[1] in self._children:
                continue
            if one.differs:
                self._moving.append(MovingJoint(*pair, one.tilt_rad, name))
            else:
                self._keep(pair, one, name)

    def add_description(self, name: str, messages: Iterator[Any]) -> None:
        """Add the joints of a robot description; of several descriptions the last counts."""
        texts = [str(content.data) for content in messages]
        if not texts:
            return
        try:
            joints = urdf_joints(texts[-1])
        except CorruptFile as error:
            self._report.count("robot_descriptions_refused")
            self._report.derive(DerivedKind.DESCRIPTION_UNREAD, topic=name, error=error)
            return
        for joint in joints:
            self._add_joint(name, joint)

    def _add_joint(self, name: str, joint: UrdfJoint) -> None:
        turn = SE3.from_rpy(*joint.rpy_rad, t=joint.xyz_m)
        numbers = (*joint.xyz_m, *turn.quat_xyzw().tolist())
        pair = self._pair(name, (joint.parent, joint.child), numbers)
        if pair is None or len(self._stated) + len(self._driven) >= LIMITS.frame_pairs:
            return
        if joint.kind == "fixed":
            self._keep(pair, _Statement(numbers), name)
            return
        driven = driven_joint(joint, name)
        if driven is None:
            self._report.count("transforms_invalid")
            self._report.derive(DerivedKind.DESCRIPTION_UNREAD, topic=name, joint=joint.name)
        elif pair[1] not in self._children:
            self._driven[pair] = driven

    def add_positions(self, name: str, messages: Iterator[Any]) -> None:
        """Add the joints of descriptions that messages of positions move, or hold in one place."""
        found = stated_positions(messages, self.drivers, self._report)
        for pair, joint in list(self._driven.items()):
            stated = found.get(joint.driver)
            if stated is None:
                continue
            del self._driven[pair]
            if stated.moves(joint):
                self._moving.append(MovingJoint(*pair, stated.tilt_rad(joint), name, joint))
            else:
                T = joint.at(np.array([stated.first]))[0]
                numbers = (*T.t.tolist(), *T.quat_xyzw().tolist())
                if self._pair(name, pair, numbers) is not None:
                    self._keep(pair, _Statement(numbers), name)

    def _keep(self, pair: _Pair, one: _Statement, source: str) -> None:
        T_parent_child = SE3.from_quat(one.numbers[3:], one.numbers[:3])
        self._stated.append(StatedTransform(*pair, T_parent_child, source, one.differs))

    def _collect(
        self, name: str, messages: Iterator[Any], *, last: bool
    ) -> dict[_Pair, _Statement]:
        found: dict[_Pair, _Statement] = {}
        every = (one for content in messages for one in content.transforms)
        for number, one in enumerate(every):
            if number >= LIMITS.transforms:
                self._report.derive(
                    DerivedKind.TRANSFORMS_CUT, topic=name, transforms=LIMITS.transforms
                )
                break
            numbers = numbers_of(one.transform)
            pair = self._pair(name, (one.header.frame_id, one.child_frame_id), numbers)
            if pair is None:
                continue
            if pair in found:
                _repeat(found[pair], numbers, last=last)
            elif len(found) + len(self._stated) < LIMITS.frame_pairs:
                found[pair] = _Statement(numbers)
            else:
                self._report.count("transforms_beyond_limit")
                self._report.derive(
                    DerivedKind.TRANSFORMS_CUT, topic=name, pairs=LIMITS.frame_pairs
                )
        return found

    def _pair(self, name: str, pair: _Pair, numbers: _Numbers) -> _Pair | None:
        """The frames of a transform; None (counted) = it makes no sense."""
        pair = frame_name(pair[0]), frame_name(pair[1])
        wrong = transform_fault(pair, numbers)
        if not wrong:
            return pair
        self._report.count("transforms_invalid")
        self._report.derive(
            DerivedKind.TRANSFORM_LEFT_OUT, topic=name, parent=pair[0], child=pair[1], **wrong
        )
        return None


def numbers_of(transform: Any) -> tuple[float, ...]:
    """Position [m] and quaternion of a transform: x, y, z, qx, qy, qz, qw."""
    t, q = transform.translation, transform.rotation
    return t.x, t.y, t.z, q.x, q.y, q.z, q.w


def transform_fault(pair: tuple[str, str], numbers: tuple[float, ...]) -> dict[str, Value]:
    """Why a transform makes no sense, as values of `TRANSFORM_LEFT_OUT`; empty = it does."""
    if not all(pair):
        return {"expected": "names"}
    if pair[0] == pair[1]:
        return {"expected": "frames"}
    if not all(map(isfinite, numbers)):
        return {"expected": "numbers"}
    if abs(sum(value * value for value in numbers[3:]) - 1.0) > TRANSFORM_LIMITS.unit:
        return {"expected": "quaternion", "got": str([*numbers[3:]])}
    # Poses on the earth are no fault, but no mount either.
    longest_m = TRANSFORM_LIMITS.longest_m
    if max(map(abs, numbers[:3])) > longest_m and last_name(pair[0]) not in WORLD_FRAMES:
        return {"longest_m": longest_m, "got": str([*numbers[:3]])}
    return {}


def _repeat(one: _Statement, numbers: _Numbers, *, last: bool) -> None:
    """Count another statement; one that differed once stays so, however often it is stated."""
    one.count += 1
    if numbers == one.numbers:
        return
    if not one.differs:
        before, now = (SE3.from_quat(n[3:], n[:3]) for n in (one.numbers, numbers))
        one.differs = not is_same(before, now)
    if last:
        one.numbers = numbers
    else:
        one.tilt_rad = max(one.tilt_rad, _tilt_rad(one.numbers, numbers))


def _tilt_rad(first: _Numbers, now: _Numbers) -> float:
    """Angle between the verticals of a parent, as two poses of its child see them [rad]."""
    cosine = sum(a * b for a, b in zip(_vertical(first), _vertical(now), strict=True))
    return acos(max(-1.0, min(1.0, cosine)))


def _vertical(numbers: _Numbers) -> tuple[float, float, float]:
    """The parent's z axis in the child: last row of the rotation matrix."""
    x, y, z, w = numbers[3:]
    return 2.0 * (x * z - y * w), 2.0 * (y * z + x * w), 1.0 - 2.0 * (x * x + y * y)
