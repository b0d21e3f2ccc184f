"""The rig of a bag: the given one, compared with what the bag itself states about its mounts."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass

import numpy as np

from recon4.geometry.se3 import SE3
from recon4.model.derived_kinds import DerivedKind
from recon4.model.finding_kinds import FindingKind
from recon4.model.rig import Rig
from recon4.recording.mounts.bag_rig import (
    Mounts,
    SampleTopics,
    is_placeholder,
    rig_by_frames,
    say_frames,
    why_no_rig,
)
from recon4.recording.mounts.frame_graph import difference, mount_value
from recon4.recording.mounts.tuning import SAME_MOUNT
from recon4.recording.report import ImportReport
from recon4.recording.rigs.choice import Stream, assign_topics, choose_rig


@dataclass(frozen=True, slots=True, eq=False)
class _Part:
    """A sensor of the rig that the bag knows too."""

    name: str
    topic: str
    T_body_part: SE3
    turned: bool = True
    """Whether it has axes; an antenna has none."""


def mounted_rig(
    rig: Rig | None,
    streams: Sequence[Stream],
    samples: SampleTopics,
    *,
    mounts: Mounts,
    report: ImportReport,
) -> Rig:
    """The rig of a bag with LiDARs.

    Args:
        rig: The given one, which counts; None = by the transforms of the bag, or a shipped one.
        streams: The LiDARs of the bag.
        samples: Topics of IMU and GNSS.
        mounts: What the bag states.
        report: Receives where mounts come from, and what contradicts them.

    Raises:
        ConfigError: If the rig does not fit, or nobody says how several LiDARs are mounted.
    """
    say_frames(mounts, [stream.topic for stream in streams], report)
    why = why_no_rig(streams, mounts)
    if rig is None and not why:
        return rig_by_frames(streams, samples, mounts, report=report)
    chosen = rig or choose_rig(streams, report, why=why)
    chosen = assign_topics(chosen, streams, report)
    compare_mounts(chosen, samples, mounts, report=report)
    return chosen


def compare_mounts(
    rig: Rig, samples: SampleTopics, mounts: Mounts, *, report: ImportReport
) -> None:
    """Warn about mounts of a rig that the bag contradicts; the rig is used.

    The mounts of pairs of sensors are compared, because the frame of the body has no name in a rig.

    Args:
        rig: With the topics of its sensors.
        samples: Topics of IMU and GNSS.
        mounts: Of the bag.
        report: Receives a warning a sensor.
    """
    limit = SAME_MOUNT.calibrated if rig.calibration else SAME_MOUNT.stated
    parts = list(_parts(rig, samples, mounts))
    for k, part in enumerate(parts):
        first = next((one for one in parts[:k] if _apart(mounts, one, part)), None)
        by_bag = mounts.T_a_b(first.topic, part.topic) if first else None
        if first is None or by_bag is None:
            continue
        by_rig = first.T_body_part.inverse() @ part.T_body_part
        angle_rad, distance_m = difference(by_rig, by_bag)
        angle_rad *= part.turned
        if angle_rad <= limit[0] and distance_m <= limit[1]:
            continue
        values = _facts(first, part, mounts, by_rig=by_rig, by_bag=by_bag)
        if is_placeholder(by_bag):
            report.derive(DerivedKind.MOUNT_PLACEHOLDER, **values)
            continue
        report.warn(
            FindingKind.MOUNT_CONTRADICTED,
            sensor=part.name,
            angle_rad=angle_rad,
            distance_m=distance_m,
            rig=rig.name,
            **values,
        )


def _apart(mounts: Mounts, a: _Part, b: _Part) -> bool:
    """Whether the bag connects the frames of two sensors that are not one frame."""
    frames = mounts.frame_of(a.topic), mounts.frame_of(b.topic)
    return frames[0] != frames[1] and mounts.graph.connected(frames)


def _parts(rig: Rig, samples: SampleTopics, mounts: Mounts) -> Iterator[_Part]:
    """Sensors whose frames are known; that of a profiler turns with its head."""
    for sensor in rig.sensors:
        if sensor.enabled and sensor.kind != "profiler" and mounts.frame_of(sensor.topic):
            yield _Part(sensor.name, sensor.topic, sensor.T_body_sensor)
    if mounts.frame_of(samples.imu):
        yield _Part("IMU", samples.imu, rig.T_body_imu)
    if mounts.frame_of(samples.fixes):
        antenna = SE3(np.eye(3), rig.p_body_antenna)
        yield _Part("GNSS antenna", samples.fixes, antenna, turned=False)


def _facts(
    first: _Part, part: _Part, mounts: Mounts, *, by_rig: SE3, by_bag: SE3
) -> dict[str, str]:
    a, b = mounts.frame_of(first.topic), mounts.frame_of(part.topic)
    return {
        "part": part.name,
        "other": first.name,
        "by_rig": _values(by_rig, part),
        "by_bag": _values(by_bag, part),
        "source": ", ".join(sorted({one.source for one in mounts.graph.path(a, b)})),
        "parent": a,
        "child": b,
    }


def _values(T: SE3, part: _Part) -> str:
    numbers = mount_value(T).split()
    return " ".join(numbers if part.turned else numbers[:3])
