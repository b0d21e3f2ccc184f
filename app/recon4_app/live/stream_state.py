"""State of a running capture for the phones, and the part of it that each phone lacks."""

from __future__ import annotations

import asyncio
import math
import time
from bisect import bisect_left
from collections import deque
from dataclasses import dataclass, field

from recon4.live.findings_so_far import WalkSoFar
from recon4.live.newest_messages import Newest
from recon4.live.protocol import Done, Mark, Message, Path, Points, Pose, Status, kind_of
from recon4_app.live.phone_message import (
    LocatedMark,
    MarksPart,
    PathPart,
    PhoneMessage,
    PointsPart,
    StretchesPart,
)
from recon4_app.live.tuning import STREAM

_SENT = ("status", "notes", "fix", "plan", "gaps", "loop", "motion", "pose")
"""Kinds of messages of which phones get the newest."""


@dataclass(slots=True)
class Cursor:
    """What one phone has received."""

    generation: int = -1
    points: int = 0
    path: int = 0
    marks: int = 0
    stretches: int = 0
    """Those that do not change any more."""
    stretches_changed: int = 0
    """`Stretches.changed` as of then."""
    versions: dict[str, int] = field(default_factory=dict)


class StreamState:
    """Collects the messages of recorder and mapper and returns to each phone what it lacks.

    Memory is bounded by the preview (400 k points) and the path, independent of the number of
    phones: a phone that does not read only has an old cursor.
    """

    def __init__(self) -> None:
        self._changed = asyncio.Event()
        self.version = 0
        self.newest = Newest()
        self.so_far = WalkSoFar()
        self._versions: dict[str, int] = {}
        self._generation, self._voxel_m = 0, 0.0
        self._voxels, self._values = bytearray(), bytearray()
        self._path: list[list[float]] = []
        self._marks: list[LocatedMark] = []
        self._pending_marks: list[Mark] = []
        """Marks of times the mapping has not reached."""
        self._track: deque[tuple[int, list[float]]] = deque(maxlen=STREAM.track)
        """Time [ns] and position of the newest poses."""

    @property
    def points(self) -> int:
        """Number of points."""
        return len(self._values)

    def take(self, message: Message) -> None:
        """Add a message of recorder or mapper."""
        kept = self.newest.take(message) and kind_of(message) in _SENT
        if kept:
            self._bump(kind_of(message))
        match message:
            case Points():
                self._take_points(message)
            case Path():
                self._take_path(message)
            case Pose():
                self._take_pose(message)
            case Mark():
                self._take_mark(message)
            case Status():
                self._locate_marks(message.t_ns - STREAM.located_within_ns)
            case Done():
                self._locate_marks(None)
            case _ if not kept:
                return
        self.version += 1
        self._changed.set()
        self._changed = asyncio.Event()

    def restore_marks(self, marks: list[Mark]) -> None:
        """Add the marks received by an earlier server; their positions are lost."""
        self._marks = [_located(mark, None) for mark in marks]

    async def news(self, version: int, *, timeout_s: float) -> None:
        """Wait until the state is newer than a version, at most for a time."""
        if self.version != version:
            return
        try:
            async with asyncio.timeout(timeout_s):
                await self._changed.wait()
        except TimeoutError:
            return

    def lacking(
        self, cursor: Cursor, *, most: int = STREAM.points_at_once
    ) -> tuple[PhoneMessage, bytes]:
        """The state a phone with this cursor lacks, with at most ``most`` points; moves the cursor.

        Returns:
            A message, and the points it announces under ``points``: int16 x, y, z
            of each, then a uint8 value of each.
        """
        message = PhoneMessage(t=time.time())
        for kind, version in self._versions.items():
            if cursor.versions.get(kind) != version:
                setattr(message, kind, getattr(self.newest, kind))
                cursor.versions[kind] = version
        if cursor.path > len(self._path):
            cursor.path = 0
        if cursor.path < len(self._path):
            message.path = PathPart(cursor.path, self._path[cursor.path :])
            cursor.path = len(self._path)
        if cursor.marks > len(self._marks):
            cursor.marks = 0
        if cursor.marks < len(self._marks):
            message.marks = MarksPart(cursor.marks, self._marks[cursor.marks :])
            cursor.marks = len(self._marks)
        self._add_stretches(cursor, message)
        return message, self._lacking_points(cursor, message, min(most, STREAM.points_at_once))

    def _add_stretches(self, cursor: Cursor, message: PhoneMessage) -> None:
        """The stretches that are new, and the last one as long as it grows."""
        stretches = self.so_far.stretches
        if cursor.stretches_changed == stretches.changed:
            return
        start = cursor.stretches
        message.stretches = StretchesPart(start, stretches.marked[start:])
        cursor.stretches = max(0, len(stretches.marked) - 1)
        cursor.stretches_changed = stretches.changed

    def complete(self, cursor: Cursor) -> bool:
        """Whether a phone with this cursor has all points."""
        return cursor.generation == self._generation and cursor.points >= self.points

    def _lacking_points(self, cursor: Cursor, message: PhoneMessage, most: int) -> bytes:
        if cursor.generation != self._generation or cursor.points > self.points:
            cursor.generation, cursor.points = self._generation, 0
        start, end = cursor.points, min(cursor.points + most, self.points)
        if start == end:
            return b""
        message.points = PointsPart(
            self._generation, start, end - start, self._voxel_m, self.points
        )
        cursor.points = end
        return bytes(self._voxels[6 * start : 6 * end] + self._values[start:end])

    def _extend_path(self, place: list[float]) -> None:
        if not self._path or math.dist(self._path[-1], place) >= STREAM.path_step_m:
            self._path.append([round(value, 2) for value in place])

    def _take_path(self, path: Path) -> None:
        self._path = []
        for place in path.points:
            self._extend_path(place)

    def _take_pose(self, pose: Pose) -> None:
        self.so_far.take(pose)
        self._track.append((pose.t_ns, pose.p))
        if not pose.lost:
            self._extend_path(pose.p)
        self._locate_marks(pose.t_ns)

    def _take_mark(self, mark: Mark) -> None:
        self._pending_marks.append(mark)
        if mark.what != "point":
            self._locate_marks(mark.t_ns)

    def _locate_marks(self, until_ns: int | None) -> None:
        """Locate marks at the position of their time: those until a time, or all."""
        due = [m for m in self._pending_marks if until_ns is None or m.t_ns <= until_ns]
        self._pending_marks = [mark for mark in self._pending_marks if mark not in due]
        self._marks += [_located(mark, self._position_at(mark.t_ns)) for mark in due]

    def _position_at(self, t_ns: int) -> list[float] | None:
        """Position at a time; the newest one if the mapping has not reached that time."""
        if not self._track:
            return None
        row = bisect_left(self._track, t_ns, key=lambda one: one[0])
        return self._track[min(row, len(self._track) - 1)][1]

    def _take_points(self, message: Points) -> None:
        if message.generation != self._generation or message.start == 0:
            self._generation, self._voxel_m = message.generation, message.voxel_m
            self._voxels.clear()
            self._values.clear()
        if message.start != self.points:
            return  # received twice around a new connection
        self._voxels += message.voxels
        self._values += message.values

    def _bump(self, kind: str) -> None:
        self._versions[kind] = self._versions.get(kind, 0) + 1


def _located(mark: Mark, p: list[float] | None) -> LocatedMark:
    return LocatedMark(mark.t_ns, mark.what, mark.text, mark.who, p)
