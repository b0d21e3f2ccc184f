"""Joints of a robot description whose positions the messages of a bag state."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass, field
from typing import Any

import numpy as np

from recon4.errors import ConfigError
from recon4.geometry.se3 import SE3, Array, so3_exp
from recon4.locales.coded import CodedText
from recon4.recording.formats.urdf import UrdfJoint
from recon4.recording.mounts.tuning import JOINTS
from recon4.recording.report import ImportReport
from recon4.recording.tuning import LISTED


@dataclass(frozen=True, slots=True, eq=False)
class DrivenJoint:
    """How the position of a joint moves its child link in its parent link."""

    driver: str
    """Joint whose position is stated: itself, or the one that it mimics."""
    T_parent_joint: SE3
    """Pose of the child at position 0."""
    axis: Array
    """Axis in the frame of the child, unit vector, (3,)."""
    slides: bool
    """Whether it is prismatic: its position is in m, else in rad."""
    factor: float
    offset: float
    description: str
    """Topic of the robot description."""

    def at(self, positions: Array) -> SE3:
        """Poses of the child in the parent, by URDF: turned about or moved along the axis.

        Args:
            positions: Of the driver [rad or m], (N,).
        """
        moved = np.outer(self.factor * positions + self.offset, self.axis)
        nothing = np.zeros_like(moved)
        turn, shift = (nothing, moved) if self.slides else (moved, nothing)
        return self.T_parent_joint @ SE3(so3_exp(turn), shift)


def driven_joint(joint: UrdfJoint, description: str) -> DrivenJoint | None:
    """The motion of a joint that is not fixed; None = it has no name, no axis or no gear."""
    axis = np.array(joint.axis, np.float64)
    length, driver = float(np.max(np.abs(axis))), joint.mimics or joint.name
    geared = max(abs(joint.factor), abs(joint.offset)) < JOINTS.most_geared
    if not driver or not geared or not 1e-6 < length < JOINTS.most_geared:
        return None
    length = float(np.linalg.norm(axis))
    return DrivenJoint(
        driver,
        SE3.from_rpy(*joint.rpy_rad, t=joint.xyz_m),
        axis / length,
        joint.kind == "prismatic",
        joint.factor,
        joint.offset,
        description,
    )


@dataclass(slots=True)
class StatedPositions:
    """The positions of one joint over some messages."""

    first: float
    least: float = field(init=False)
    most: float = field(init=False)

    def __post_init__(self) -> None:
        """The first one is all so far."""
        self.least = self.most = self.first

    def add(self, position: float) -> None:
        """Take in another one."""
        self.least, self.most = min(self.least, position), max(self.most, position)

    def moves(self, joint: DrivenJoint) -> bool:
        """Whether it moves a joint, and does not only tremble."""
        stands_rad, stands_m = JOINTS.stands
        ratio = abs(joint.factor) * (self.most - self.least)
        return ratio > (stands_m if joint.slides else stands_rad)

    def tilt_rad(self, joint: DrivenJoint) -> float:
        """Largest angle between the vertical at first and later, in the axes of the child [rad]."""
        steps = np.linspace(self.least, self.most, JOINTS.tilt_steps)
        up = joint.at(np.append(self.first, steps)).R[:, 2, :]
        return float(np.arccos(np.clip(up @ up[0], -1.0, 1.0)).max())


def positions_of(content: Any, report: ImportReport) -> Iterator[tuple[str, float]]:
    """Names and positions in a message; what cannot be one is counted and left out."""
    names, positions = list(content.name), np.asarray(content.position, np.float64).tolist()
    if positions and len(names) != len(positions):
        report.count("joint_positions_invalid", len(positions))
        return
    for name, position in zip(names, positions, strict=False):  # messages of speeds have none
        if abs(position) < JOINTS.most_position:  # NaN is not
            yield str(name), position
        else:
            report.count("joint_positions_invalid")


def stated_positions(
    messages: Iterable[Any], drivers: frozenset[str], report: ImportReport
) -> dict[str, StatedPositions]:
    """The positions of some joints over the messages of a topic."""
    found: dict[str, StatedPositions] = {}
    for content in messages:
        for name, position in positions_of(content, report):
            if name in found:
                found[name].add(position)
            elif name in drivers:
                found[name] = StatedPositions(position)
    return found


def several_joints(topic: str, names: Sequence[str]) -> ConfigError:
    """Why the angle of a head is not taken from positions of several joints."""
    few = ", ".join(map(str, names[: LISTED.few]))
    return ConfigError(CodedText("head-joints", topic=topic, count=len(names), names=few))
