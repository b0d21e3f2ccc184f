"""Messages of a bag as tables and rows of numbers."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from itertools import islice
from typing import Any

import numpy as np
from numpy.typing import NDArray

from recon4.geometry.se3 import SE3
from recon4.model.samples import GnssQuality, GnssSamples, ImuSamples
from recon4.model.trajectory import Times, Trajectory
from recon4.recording.bags.tuning import BAG_IMU
from recon4.recording.clocks.stamps import StampClock
from recon4.recording.formats.bags import Bag, BagMessage
from recon4.recording.report import ImportReport
from recon4.recording.samples.measured_channels import declared_absent
from recon4.recording.tuning import PROBE

_FIX_QUALITY = {
    **{-2: GnssQuality.SINGLE, 0: GnssQuality.SINGLE},
    **{1: GnssQuality.DIFFERENTIAL, 2: GnssQuality.RTK_FIXED},
}
"""Of each ``NavSatStatus``; -2 is a driver that does not tell."""
_NOTHING = (np.nan, np.nan, np.nan)


# -- samples


class SampleBatch:
    """Collects rows of one topic and delivers them in batches."""

    def __init__(
        self,
        row: Any,
        join: Any,
        report: ImportReport,
        *,
        kind: str = "poses",
        stamps: StampClock | None = None,
    ) -> None:
        """Prepare.

        Args:
            row: Turns a message into numbers.
            join: Turns times and rows into samples.
            report: Receives the count of samples with a stamp of another time.
            kind: Start of the name of that count.
            stamps: Of the topic.
        """
        self._row, self._join, self._report = row, join, report
        self._kind, self._stamps = kind, stamps or StampClock()
        self._rows: list[tuple[float, ...]] = []
        self._t_ns: list[int] = []

    def push(self, message: BagMessage, content: Any) -> Iterator[Any]:
        t_ns = stamp_ns(content.header.stamp)
        if t_ns <= 0 and self._stamps.offset_ns is None:
            t_ns = message.t_ns
            self._report.count(f"{self._kind}_without_stamp")
        elif self._stamps.is_sound(t_ns, message.t_ns):
            self._report.note_lag(self._kind.upper(), message.t_ns - t_ns)
            for row in range(max(0, len(self._t_ns) - self._stamps.set_before), len(self._t_ns)):
                self._t_ns[row] -= self._stamps.set_ns
        else:
            self._report.count(f"{self._kind}_wrong_time")
            return
        self._t_ns.append(t_ns + self._stamps.shift_ns)
        self._rows.append(self._row(content))
        if len(self._rows) >= BAG_IMU.batch:
            yield from self.flush()

    def flush(self) -> Iterator[Any]:
        rows, t_ns = self._rows, self._t_ns
        self._rows, self._t_ns = [], []
        if rows:
            yield self._join(np.array(t_ns, np.int64), np.array(rows, np.float64))


def stamp_clock(bag: Bag, topic: str) -> StampClock:
    """The clock of the stamps of a topic, from its first messages; without one, a new clock."""
    return set_clock(bag, topic, first_stamps(bag, topic) if topic else [])


def set_clock(bag: Bag, topic: str, head: Sequence[tuple[int, int]]) -> StampClock:
    """The clock of the stamps of a topic, whose jumps are those of the bag.

    Args:
        bag: An open bag.
        topic: Its name.
        head: Stamps and times of recording of its first messages [ns].
    """
    jumps = bag.stamp_jumps
    return StampClock(head, lambda ns: jumps.exact_ns(topic, ns, bag.report), jumps.of_recorder)


def first_stamps(bag: Bag, topic: str) -> list[tuple[int, int]]:
    """Stamps and times of recording of the first messages of a topic [ns]."""
    messages = islice(bag.messages([topic]), PROBE.stamps)
    found = ((message, bag.decode(message)) for message in messages)
    return [(stamp_ns(m.header.stamp), at.t_ns) for at, m in found if m is not None]


def stamp_ns(stamp: Any) -> int:
    """Nanoseconds of a stamp of ROS 1 or 2."""
    return int(stamp.sec) * 1_000_000_000 + int(stamp.nanosec)


def imu_row(message: Any) -> tuple[float, ...]:
    """Six numbers of a ``sensor_msgs/Imu``; NaN = declared as not measured."""
    w, a = message.angular_velocity, message.linear_acceleration
    turns, forces = (w.x, w.y, w.z), (a.x, a.y, a.z)
    turns = _NOTHING if declared_absent(message.angular_velocity_covariance) else turns
    forces = _NOTHING if declared_absent(message.linear_acceleration_covariance) else forces
    return *turns, *forces


def turns_row(message: Any) -> tuple[float, ...]:
    """The angular rates alone of a ``sensor_msgs/Imu``."""
    return *imu_row(message)[:3], *_NOTHING


def forces_row(message: Any) -> tuple[float, ...]:
    """The accelerations alone of a ``sensor_msgs/Imu``."""
    return *_NOTHING, *imu_row(message)[3:]


def join_imu(t_ns: Times, rows: NDArray[np.float64]) -> ImuSamples:
    """Samples of rows of `imu_row`."""
    return ImuSamples(t_ns, rows[:, :3], rows[:, 3:])


def fix_row(message: Any) -> tuple[float, ...]:
    """Seven numbers of a ``sensor_msgs/NavSatFix``."""
    variance = np.asarray(message.position_covariance, np.float64)[[0, 4, 8]]
    known = message.position_covariance_type > 0
    sd = np.sqrt(np.where(variance >= 0, variance, np.nan)) if known else np.full(3, np.nan)
    quality = _FIX_QUALITY.get(int(message.status.status), GnssQuality.INVALID)
    return message.latitude, message.longitude, message.altitude, *sd.tolist(), float(quality)


def join_fixes(t_ns: Times, rows: NDArray[np.float64]) -> GnssSamples:
    """Samples of rows of `fix_row`."""
    return GnssSamples(
        t_ns,
        np.deg2rad(rows[:, 0]),
        np.deg2rad(rows[:, 1]),
        rows[:, 2],
        rows[:, 3:6],
        rows[:, 6].astype(np.uint8),
        np.full((len(rows), 3), np.nan),
    )


def pose_row(message: Any) -> tuple[float, ...]:
    """Position and quaternion of a ``nav_msgs/Odometry``."""
    p, q = message.pose.pose.position, message.pose.pose.orientation
    return p.x, p.y, p.z, q.x, q.y, q.z, q.w


def join_poses(t_ns: Times, rows: NDArray[np.float64]) -> Trajectory:
    """Poses of rows of `pose_row`; invalid ones and those out of order are left out."""
    length = np.linalg.norm(rows[:, 3:], axis=1)
    good = np.all(np.isfinite(rows), axis=1) & (np.abs(length - 1.0) < 0.01)
    t_ns, rows = t_ns[good], rows[good]
    later = np.diff(np.maximum.accumulate(t_ns), prepend=np.int64(-1)) > 0
    return Trajectory(t_ns[later], SE3.from_quat(rows[later, 3:], rows[later, :3]))
