"""What the messages of a topic hold, from its first ones: which of several topics to read."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from recon4.model.derived_kinds import DerivedKind
from recon4.model.finding import Value
from recon4.model.samples import ImuSamples
from recon4.recording.bags.messages import imu_row, pose_row, stamp_ns
from recon4.recording.bags.tuning import TOPIC_CONTENTS
from recon4.recording.formats.bags import Bag, BagTopic
from recon4.recording.mounts.transform_messages import frame_of
from recon4.recording.packets.messages import DATA_MESSAGES
from recon4.recording.report import ImportReport
from recon4.recording.samples.measured_channels import imu_channels
from recon4.recording.samples.tuning import IMU_UNITS

_DERIVED_WORDS = ("filtered", "fused", "odometry", "estimate")
"""In names of topics: positions that a program has worked out of those of a receiver."""


@dataclass(frozen=True, slots=True, eq=False)
class Contents:
    """The first messages of a topic."""

    topic: BagTopic
    messages: tuple[Any, ...]
    t_ns: tuple[int, ...]
    """Their stamps, or times of recording [ns]."""
    seconds: float
    """Duration of the whole bag [s]."""

    @property
    def frame(self) -> str:
        """The frame of the messages; empty = not known."""
        return frame_of(self.messages[0]) if self.messages else ""

    @property
    def rate_hz(self) -> float:
        """Messages a second; NaN = unknown."""
        steps = np.diff(np.array(self.t_ns, np.int64))
        usual = float(np.median(steps)) if len(steps) else 0.0
        return 1e9 / usual if usual > 0.0 else float("nan")

    @property
    def covered(self) -> float:
        """Part of the bag that the messages cover at their rate, 0..1."""
        if not self.seconds > 1.0 or not self.rate_hz > 0.0:
            return 1.0
        return min(1.0, self.topic.messages / self.rate_hz / self.seconds)


@dataclass(frozen=True, slots=True)
class Fault:
    """What speaks against a topic."""

    weight: float
    what: str
    """A value of `DerivedKind.TOPIC_LEFT_OUT`."""
    value: Value = True


def say_left_out(
    what: str, read: str, left: Mapping[str, Value], *, frame: str = "", report: ImportReport
) -> None:
    """State that one of several topics is not read.

    Args:
        what: Kind of the topics.
        read: Topic that is read in its place.
        left: Values of `DerivedKind.TOPIC_LEFT_OUT`: the ``topic``, and those that say why.
        frame: Of the topic that is read; empty = not said.
        report: Receives it.
    """
    of: dict[str, Value] = {"frame": frame} if frame else {"frameless": True}
    report.derive(DerivedKind.TOPIC_LEFT_OUT, what=what, read=read, **left, **of)


def read_contents(
    bag: Bag, topics: Sequence[BagTopic], *, as_sent: bool = False
) -> dict[str, Contents]:
    """Decode the first messages of some topics, in one pass over the head of an open bag.

    Args:
        bag: An open bag.
        topics: Some of its topics.
        as_sent: Points without their recipes.
    """
    large = {*DATA_MESSAGES, *(topic.type for topic in topics if topic.is_points or topic.columns)}
    most = dict.fromkeys(large, TOPIC_CONTENTS.probed_clouds)
    waiting = {
        t.name: min(t.messages, most.get(t.type, TOPIC_CONTENTS.probed_messages))
        for t in topics
        if t.messages
    }
    found: dict[str, list[tuple[int, Any]]] = {t.name: [] for t in topics}
    end_ns: int | None = None
    for message in bag.messages(list(waiting)):
        end_ns = message.t_ns + TOPIC_CONTENTS.probed_ns if end_ns is None else end_ns
        if message.t_ns > end_ns:
            break
        if waiting[message.topic] <= 0:
            continue
        waiting[message.topic] -= 1
        content = bag.decode(message, as_sent=as_sent)
        if content is not None:
            header = getattr(content, "header", None)  # messages of packets may have none
            t_ns = stamp_ns(header.stamp) if header is not None else 0
            found[message.topic].append((t_ns if t_ns > 0 else message.t_ns, content))
        if not any(left > 0 for left in waiting.values()):
            break
    return {
        t.name: Contents(
            t,
            tuple(content for _, content in found[t.name]),
            tuple(t_ns for t_ns, _ in found[t.name]),
            bag.seconds,
        )
        for t in topics
    }


def imu_rows(found: Contents) -> ImuSamples:
    """The samples of the messages, NaN where they are declared as not measured."""
    rows = np.array([imu_row(m) for m in found.messages], np.float64).reshape(-1, 6)
    return ImuSamples(np.array(found.t_ns, np.int64), rows[:, :3], rows[:, 3:])


def imu_faults(found: Contents) -> list[Fault]:
    """What speaks against an IMU: channels that it does not measure, other units, holes."""
    channels = imu_channels(imu_rows(found))
    out = []
    if channels.no_gyroscope:
        out.append(Fault(4.0, "no_gyroscope"))
    elif float(np.nanpercentile(_lengths(channels.imu.gyro_rad_s), 90)) > IMU_UNITS.fastest_rad_s:
        out.append(Fault(1.0, "unit_unknown"))
    if channels.no_accelerometer:
        out.append(Fault(2.0, "no_accelerometer"))
    else:
        usual = float(np.nanmedian(_lengths(channels.imu.accel_m_s2)))
        units = (IMU_UNITS.gravity_m_s2, IMU_UNITS.gravity_g)
        if not any(low < usual < high for low, high in units):
            out.append(Fault(2.0, "usual_m_s2", usual))
    if found.rate_hz < TOPIC_CONTENTS.slow_hz:
        out.append(Fault(1.0, "rate_hz", found.rate_hz))
    return out


def fix_faults(found: Contents) -> list[Fault]:
    """What speaks against positions: no fix, none that changes, the output of a filter."""
    good = [m for m in found.messages if m.status.status != -1 and _is_place(m)]
    out = []
    if not good:
        out.append(Fault(4.0, "without_fix", len(found.messages)))
    elif len(good) >= 10 and len({(m.latitude, m.longitude) for m in good}) == 1:
        out.append(Fault(4.0, "one_position"))
    if any(word in found.topic.name.lower() for word in _DERIVED_WORDS):
        out.append(Fault(0.5, "filtered"))
    return out


def fix_quality(found: Contents) -> float:
    """Median ``NavSatStatus`` of the messages: 2 = by ground stations, as RTK."""
    levels = [int(m.status.status) for m in found.messages]
    return float(np.median(levels)) if levels else -1.0


def odometry_faults(found: Contents) -> list[Fault]:
    """What speaks against poses: no numbers, or always the same."""
    rows = np.array([pose_row(m) for m in found.messages], np.float64).reshape(-1, 7)
    if not np.isfinite(rows).all(axis=1).any():
        return [Fault(4.0, "no_poses")]
    return [Fault(2.0, "still")] if not np.ptp(rows, axis=0).any() else []


def laser_faults(found: Contents) -> list[Fault]:
    """What speaks against scans: no returns, or a narrow view."""
    ranges = np.concatenate([np.zeros(0), *(np.asarray(m.ranges) for m in found.messages)])
    out = []
    if not np.any(np.isfinite(ranges) & (ranges > 0.0)):
        out.append(Fault(4.0, "no_returns"))
    if view_deg(found) < TOPIC_CONTENTS.wide_deg:
        out.append(Fault(1.0, "view_rad", float(np.deg2rad(view_deg(found)))))
    return out


def view_deg(found: Contents) -> float:
    """Median field of view of scans [deg]."""
    views = [abs(m.angle_increment) * len(m.ranges) for m in found.messages]
    return float(np.rad2deg(np.median(views))) if views else 0.0


def common_faults(found: Contents) -> list[Fault]:
    """What speaks against a topic of any kind."""
    if not found.messages:
        return [Fault(8.0, "unreadable")]
    if found.covered < TOPIC_CONTENTS.covered:
        return [Fault(2.0, "covered", found.covered)]
    return []


def near(found: Contents, others: Mapping[str, Contents]) -> int:
    """How near a sensor is to LiDARs by names: 2 = one frame, 1 = one driver, 0 = unknown."""
    if any(found.frame and found.frame == other.frame for other in others.values()):
        return 2
    here = {_first(found.frame), _first(found.topic.name)} - {""}
    there = {_first(name) for o in others.values() for name in (o.frame, o.topic.name)}
    return int(bool(here & there))


def _first(name: str) -> str:
    """The part of a name that sensors of one driver have in common, as ``os`` of ``os_imu``."""
    words = name.lower().replace("/", "_").replace("-", "_").split("_")
    return next((word for word in words if word), "")


def _lengths(vectors: Any) -> Any:
    return np.linalg.norm(vectors, axis=1)


def _is_place(fix: Any) -> bool:
    numbers = (fix.latitude, fix.longitude)
    return bool(np.isfinite(numbers).all()) and any(abs(x) > 1e-6 for x in numbers)
