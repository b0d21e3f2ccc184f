"""Rigid transforms between named frames, as a bag states them; no cycle or contradiction harms."""

from __future__ import annotations

from collections import deque
from collections.abc import Iterable, Sequence
from dataclasses import dataclass

import numpy as np

from recon4.geometry.se3 import SE3
from recon4.locales.numbers import mount_text
from recon4.recording.mounts.driven_joints import DrivenJoint
from recon4.recording.mounts.tuning import SAME_MOUNT

WORLD_FRAMES = frozenset({"map", "odom", "world", "earth", "utm", "enu", "camera_init"})
"""Frames of places, not of parts of a robot (REP 105 and usual ones)."""
BODY_FRAMES = ("base_link", "base_footprint", "base_stabilized", "base")
"""Frames of a robot with x forward and z up (REP 105, REP 120), the best first."""


@dataclass(frozen=True, slots=True, eq=False)
class StatedTransform:
    """A rigid transform between two frames, and who states it."""

    parent: str
    child: str
    T_parent_child: SE3
    source: str
    """As ``/tf_static``."""
    disputed: bool = False
    """Whether the same source states it in different ways."""

    @property
    def text(self) -> str:
        """Frames and values."""
        mount = mount_text(mount_value(self.T_parent_child))
        return f"{self.parent} -> {self.child} {mount} ({self.source})"


@dataclass(frozen=True, slots=True, eq=False)
class MovingJoint:
    """Two frames that move against each other during the recording."""

    parent: str
    child: str
    tilt_rad: float
    """Largest angle between the vertical at first and later, in the axes of the child [rad]."""
    source: str
    """Topic with its transforms, or with its positions."""
    driven: DrivenJoint | None = None
    """How positions move it; None = transforms state its poses."""

    @property
    def named_by(self) -> str:
        """Topic that tells this joint as the head of a profiler: transforms, or a description."""
        return self.driven.description if self.driven else self.source


class FrameGraph:
    """All frames that rigid transforms connect.

    Each connected group of frames has a spanning tree. A transform beyond the tree, as of a cycle
    or of a second parent, is compared with it: `contradictions`.
    """

    def __init__(
        self, stated: Iterable[StatedTransform], moving: Iterable[MovingJoint] = ()
    ) -> None:
        """Connect the frames; of several transforms between two frames the first is used."""
        self._stated = tuple(stated)
        self._moving = {joint.child: joint for joint in moving}
        self._near: dict[str, list[tuple[str, int]]] = {}
        """Frame -> frames one transform away, with its row."""
        for row, one in enumerate(self._stated):
            self._near.setdefault(one.parent, []).append((one.child, row))
            self._near.setdefault(one.child, []).append((one.parent, row))
        self._parents = {one.child: one.parent for one in reversed(self._stated)}
        self._root: dict[str, str] = {}
        self._T_root: dict[str, SE3] = {}
        self._via: dict[str, tuple[str, int]] = {}
        """The frame before it on the path from the root, and the row of the transform."""
        for frame in self._near:
            if frame not in self._root:
                self._grow(frame)

    def __contains__(self, frame: str) -> bool:
        return frame in self._near

    def __len__(self) -> int:
        return len(self._near)

    def meant_by(self, frame: str) -> list[str]:
        """The frame itself, or else those that differ from it by a prefix alone; none = unknown.

        Drivers and `robot_state_publisher` add the name of a robot (``tf_prefix``, namespaces), not
        always both of them.
        """
        if frame in self or not frame:
            return [frame] * (frame in self)
        return sorted(one for one in self._near if last_name(one) == last_name(frame))

    def connected(self, frames: Sequence[str]) -> bool:
        """Whether the transforms between all of these frames are known."""
        if len(set(frames)) <= 1:
            return True
        return all(f in self for f in frames) and len({self._root[f] for f in frames}) == 1

    def T_a_b(self, a: str, b: str) -> SE3 | None:
        """The transform that maps points of frame ``b`` into ``a``; None = it is not known."""
        if not self.connected([a, b]):
            return None
        return SE3.identity() if a == b else self._T_root[a].inverse() @ self._T_root[b]

    def path(self, a: str, b: str) -> list[StatedTransform]:
        """The transforms between two connected frames."""
        rows_a, rows_b = self._to_root(a), self._to_root(b)
        return [self._stated[row] for row in sorted(rows_a ^ rows_b)]

    def body_of(self, frame: str) -> str:
        """The frame of the robot that a frame is mounted on; empty = none of a usual name."""
        mates = [name for name in self._near if self.connected([name, frame])]
        for usual in BODY_FRAMES:
            found = [name for name in mates if last_name(name) == usual]
            if found:
                return found[0]
        return ""

    def top_of(self, frame: str) -> str:
        """The part of the robot that a frame hangs on in the end; of a cycle the frame itself."""
        seen, at = {frame}, frame
        while (above := self._parents.get(at)) is not None and last_name(above) not in WORLD_FRAMES:
            if above in seen:
                return frame
            seen.add(above)
            at = above
        return at

    def joints_above(self, frame: str) -> list[MovingJoint]:
        """The joints that move between a frame and the robot, which may tilt as a whole."""
        found, seen, at = [], {frame}, frame
        while last_name(at) not in BODY_FRAMES:
            joint = self._moving.get(at)
            above = joint.parent if joint else self._parents.get(at, "")
            if not above or above in seen or last_name(above) in WORLD_FRAMES:
                break
            found += [joint] if joint else []
            seen.add(above)
            at = above
        return found

    def contradictions(self) -> list[StatedTransform]:
        """Transforms that differ from what the others say about the same two frames."""
        in_tree = {row for _, row in self._via.values()}
        found = []
        for row, one in enumerate(self._stated):
            others = None if row in in_tree else self.T_a_b(one.parent, one.child)
            if others is not None and not is_same(one.T_parent_child, others):
                found.append(one)
        return found

    def _to_root(self, frame: str) -> set[int]:
        rows = set()
        while frame in self._via:
            frame, row = self._via[frame]
            rows.add(row)
        return rows

    def _grow(self, root: str) -> None:
        """Breadth first, so that the paths are the shortest ones."""
        self._root[root], self._T_root[root] = root, SE3.identity()
        waiting = deque([root])
        while waiting:
            at = waiting.popleft()
            for near, row in self._near[at]:
                if near in self._root:
                    continue
                one = self._stated[row]
                T_at_near = one.T_parent_child if one.parent == at else one.T_parent_child.inverse()
                self._root[near], self._T_root[near] = root, self._T_root[at] @ T_at_near
                self._via[near] = at, row
                waiting.append(near)


def is_same(T_a: SE3, T_b: SE3) -> bool:
    """Whether two statements of one transform agree."""
    angle_rad, distance_m = difference(T_a, T_b)
    return angle_rad <= SAME_MOUNT.rad and distance_m <= SAME_MOUNT.m


def difference(T_a: SE3, T_b: SE3) -> tuple[float, float]:
    """Angle [rad] and distance [m] between two transforms of the same frames."""
    angle_rad = float(SE3(T_a.R.T @ T_b.R, T_a.t).angle())
    return angle_rad, float(np.linalg.norm(T_a.t - T_b.t))


def last_name(frame: str) -> str:
    """A frame without the namespace of its robot."""
    return frame.rsplit("/", 1)[-1]


def mount_value(T: SE3) -> str:
    """A mount as a value that texts quote: x, y, z [m], roll, pitch, yaw [rad]."""
    angles = T.rpy()
    if abs(T.R[2, 0]) > SAME_MOUNT.vertical:  # roll and yaw turn about one axis there
        angles = np.array([np.arctan2(-T.R[1, 2], T.R[1, 1]), angles[1], 0.0])
    return " ".join(f"{value:.6f}" for value in (*T.t, *angles))
