"""Poses of joints that move over the messages of a bag: by transforms, or by positions."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, field
from typing import Any

import numpy as np
from numpy.typing import NDArray

from recon4.geometry.se3 import SE3
from recon4.model.trajectory import Times, Trajectory
from recon4.recording.bags.messages import stamp_ns
from recon4.recording.clocks.compare import JOINT
from recon4.recording.clocks.stamps import strays
from recon4.recording.formats.bags import JOINT_STATES, Bag
from recon4.recording.limits import LIMITS
from recon4.recording.mounts.driven_joints import positions_of
from recon4.recording.mounts.frame_graph import MovingJoint
from recon4.recording.mounts.transform_messages import frame_name, numbers_of, transform_fault
from recon4.recording.report import ImportReport


@dataclass(frozen=True, slots=True)
class _StatedPoses:
    """What messages state about one joint."""

    t_ns: list[int] = field(default_factory=list)
    numbers: list[tuple[float, ...]] = field(default_factory=list)
    """Position and quaternion of its transform, or its position alone."""


def read_joint_poses(
    bag: Bag, joints: Sequence[MovingJoint], report: ImportReport
) -> dict[str, Trajectory]:
    """Poses of joints by their child frame, in order of time.

    Args:
        bag: An open bag.
        joints: Of one frame.
        report: Counts what is left out.
    """
    found = {joint.child: _StatedPoses() for joint in joints}
    wanted: dict[tuple[str, str], list[_StatedPoses]] = {}
    for joint in joints:
        by = (joint.source, joint.driven.driver) if joint.driven else (joint.parent, joint.child)
        wanted.setdefault(by, []).append(found[joint.child])
    for message in bag.messages({joint.source for joint in joints}):
        content = bag.decode(message)
        if content is None:
            continue
        is_position = message.type == JOINT_STATES
        stated = _positions(content, message.topic, report) if is_position else _transforms(content)
        for by, t_ns, numbers in stated:
            if by in wanted:
                report.note_lag(JOINT, message.t_ns - t_ns)
                _take(wanted[by], t_ns, numbers, report=report)
    return {joint.child: _trajectory(joint, found[joint.child], report) for joint in joints}


def _transforms(content: Any) -> Iterator[tuple[tuple[str, str], int, tuple[float, ...]]]:
    for one in content.transforms:
        pair, numbers = (
            (frame_name(one.header.frame_id), frame_name(one.child_frame_id)),
            numbers_of(one.transform),
        )
        if not transform_fault(pair, numbers):
            yield pair, stamp_ns(one.header.stamp), numbers


def _positions(
    content: Any, topic: str, report: ImportReport
) -> Iterator[tuple[tuple[str, str], int, tuple[float, ...]]]:
    t_ns = stamp_ns(content.header.stamp)
    for name, position in positions_of(content, report):
        yield (topic, name), t_ns, (position,)


def _take(
    takers: Sequence[_StatedPoses], t_ns: int, numbers: tuple[float, ...], *, report: ImportReport
) -> None:
    for one in takers:
        if len(one.t_ns) >= LIMITS.joint_poses:
            report.count("joint_poses_beyond_limit")
            continue
        one.t_ns.append(t_ns)
        one.numbers.append(numbers)


def _trajectory(joint: MovingJoint, stated: _StatedPoses, report: ImportReport) -> Trajectory:
    """Poses at increasing times; single ones of another time and repeated ones are left out."""
    t_ns = np.array(stated.t_ns, np.int64)
    kept = _in_order(t_ns, report)
    numbers = np.array(stated.numbers, np.float64).reshape(len(t_ns), 1 if joint.driven else 7)
    rows = numbers[kept]
    if joint.driven is not None:
        return Trajectory(t_ns[kept], joint.driven.at(rows[:, 0]))
    return Trajectory(t_ns[kept], SE3.from_quat(rows[:, 3:], rows[:, :3]))


def _in_order(t_ns: Times, report: ImportReport) -> NDArray[np.int64]:
    """Rows at increasing times, counted where they are left out, (K,)."""
    stray = strays(t_ns) | (t_ns <= 0)
    report.count("joint_poses_wrong_time", int(stray.sum()))
    order = np.flatnonzero(~stray)[np.argsort(t_ns[~stray], kind="stable")]
    later = np.diff(t_ns[order], prepend=np.int64(-1)) > 0
    report.count("joint_poses_repeated", int((~later).sum()))
    return np.asarray(order[later])
