"""The angle of a profiler's head at the time of each shot."""

from __future__ import annotations

from dataclasses import replace
from typing import Protocol

import numpy as np

from recon4.errors import RecordingError
from recon4.geometry.se3 import Array
from recon4.locales.coded import CodedText
from recon4.model.finding_kinds import FindingKind
from recon4.model.trajectory import Times
from recon4.recording.assembly.shots import Shots
from recon4.recording.mounts.tuning import JOINTS
from recon4.recording.report import ImportReport


class Head(Protocol):
    """What moves the beam of a profiler."""

    across: int
    """Second axis of the plane of a line; the first one is x: 1 = y, 2 = z."""

    def ready(self, end_ns: int) -> bool:
        """Whether it is known where the head points at a time."""
        ...

    def overdue(self, end_ns: int, now_ns: int) -> bool:
        """Whether a line that ended at ``end_ns`` has waited long enough."""
        ...

    def turn(self, line: Shots) -> tuple[Shots, float] | None:
        """A line in the frame that does not turn, and the angle of its first shot [rad].

        None = it is not known where the head pointed.
        """
        ...

    def finish(self, seconds: float) -> None:
        """Judge the head over the whole recording.

        Raises:
            RecordingError: If it stood still all the time.
        """
        ...


class HeadAngles:
    """Angles about z as they come in, interpolated linearly at the times of shots.

    Angles reported within one revolution are made continuous.
    """

    across = 2

    def __init__(self, name: str, rate_rad_s: float, report: ImportReport) -> None:
        """Prepare.

        Args:
            name: What the profiler is called in the report.
            rate_rad_s: Constant turn rate; 0 = angles are pushed.
            report: Receives what was repaired.
        """
        self._name, self._rate_rad_s, self._report = name, rate_rad_s, report
        self._t_ns: list[int] = []
        self._angle_rad: list[float] = []
        self._start_ns: int | None = None
        self._stands_since: tuple[int, float] | None = None
        self._stood_ns = 0

    def push(self, t_ns: int, angle_rad: float) -> None:
        """Add an angle; one that is not finite or out of order is counted and left out."""
        if not np.isfinite(angle_rad) or (self._t_ns and t_ns <= self._t_ns[-1]):
            self._report.count("head_angles_invalid")
            return
        self._watch(t_ns, angle_rad)
        if self._angle_rad:
            turns = np.round((self._angle_rad[-1] - angle_rad) / (2.0 * np.pi))
            angle_rad += float(turns) * 2.0 * np.pi
        self._t_ns.append(t_ns)
        self._angle_rad.append(angle_rad)

    def ready(self, end_ns: int) -> bool:
        """Whether the angle at a time can be interpolated, or is overdue."""
        if self._rate_rad_s:
            return True
        return bool(self._t_ns) and self._t_ns[-1] >= end_ns

    def overdue(self, end_ns: int, now_ns: int) -> bool:
        """Whether a line that ended at ``end_ns`` has waited long enough."""
        return now_ns - end_ns > JOINTS.wait_ns

    def at(self, t_ns: Times) -> Array | None:
        """Angles at increasing times [rad], (N,); None = there is none near enough."""
        if self._rate_rad_s:
            self._start_ns = int(t_ns[0]) if self._start_ns is None else self._start_ns
            return np.asarray(self._rate_rad_s * 1e-9 * (t_ns - self._start_ns), np.float64)
        if len(self._t_ns) < 2:
            return None
        self._forget(int(t_ns[0]))
        known = np.array(self._t_ns, np.int64)
        last = min(max(int(np.searchsorted(known, t_ns[-1])), 1), len(known) - 1)
        outside = max(known[0] - t_ns[0], t_ns[-1] - known[-1])
        if outside > JOINTS.beyond_ns:
            return None
        angle, at_ns = np.array(self._angle_rad), (known - known[0]).astype(np.float64)
        wanted = (t_ns - known[0]).astype(np.float64)
        found = np.interp(wanted, at_ns, angle)
        slope = (angle[last] - angle[last - 1]) / (at_ns[last] - at_ns[last - 1])
        found = np.where(wanted > at_ns[-1], angle[-1] + slope * (wanted - at_ns[-1]), found)
        return np.asarray(
            np.where(wanted < 0.0, angle[0] + slope * wanted, found), dtype=np.float64
        )

    def turn(self, line: Shots) -> tuple[Shots, float] | None:
        """See `Head.turn`."""
        angle = self.at(line.t_ns)
        if angle is None:
            return None
        c, s = np.cos(angle), np.sin(angle)
        x, y, z = line.xyz.astype(np.float64).T
        xyz = np.stack([c * x - s * y, s * x + c * y, z], axis=1).astype(np.float32)
        return replace(line, xyz=xyz), float(angle[0])

    def finish(self, seconds: float) -> None:
        """See `Head.finish`."""
        if self._rate_rad_s or self._stands_since is None:
            return
        self._close_standing(self._t_ns[-1] if self._t_ns else 0)
        if self._stood_ns * 1e-9 > 0.95 * seconds:
            raise RecordingError(
                CodedText(
                    "head-still",
                    name=self._name,
                    angle_deg=float(np.rad2deg(self._stands_since[1])),
                )
            )

    def _forget(self, first_ns: int) -> None:
        """Drop angles before the last one that is not after ``first_ns``."""
        while len(self._t_ns) > 256 and self._t_ns[128] < first_ns:
            del self._t_ns[:127], self._angle_rad[:127]

    def _watch(self, t_ns: int, angle_rad: float) -> None:
        if self._stands_since is None:
            self._stands_since = (t_ns, angle_rad)
        elif abs(angle_rad - self._stands_since[1]) > JOINTS.stuck_rad:
            self._close_standing(t_ns)
            self._stands_since = (t_ns, angle_rad)

    def _close_standing(self, t_ns: int) -> None:
        assert self._stands_since is not None
        since_ns, angle_rad = self._stands_since
        if t_ns - since_ns > JOINTS.stuck_ns:
            self._stood_ns += t_ns - since_ns
            self._report.count("head_stands")
            self._report.warn(
                FindingKind.HEAD_STANDS,
                sensor=self._name,
                angle_rad=float(angle_rad),
                seconds=(t_ns - since_ns) * 1e-9,
            )
