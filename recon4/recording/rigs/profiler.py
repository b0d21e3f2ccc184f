"""The rig of a bag with a profiler: the given one, the shipped one, or a laser on a joint."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, replace

import numpy as np

from recon4.geometry.se3 import SE3
from recon4.model.derived_kinds import DerivedKind
from recon4.model.finding_kinds import FindingKind
from recon4.model.rig import Rig, Sensor, load_rig
from recon4.recording.bags.topic_choice import choose_imu, named_imu
from recon4.recording.formats.bags import IMU, LASER_SCAN, Bag
from recon4.recording.lasers.tuning import LASERS
from recon4.recording.mounts.bag_rig import Mounts, SampleTopics, read_mounts, rig_by_frames
from recon4.recording.mounts.frame_graph import FrameGraph
from recon4.recording.mounts.moving import MovingMount, moving_mount
from recon4.recording.mounts.transform_messages import has_frames
from recon4.recording.packets.messages import DATA_MESSAGES
from recon4.recording.report import ImportReport
from recon4.recording.rigs.choice import Stream
from recon4.settings import IngestSettings

WUERZBURG = "wuerzburg"


@dataclass(frozen=True, slots=True, eq=False)
class TiltingLaser:
    """A 2-D laser on a joint that tilts it: a profiler."""

    topic: str
    mount: MovingMount
    source: str
    """Topic of the transforms of the joint, or of the robot description that has it."""


def profiler_rig(bag: Bag, rig: Rig | None, report: ImportReport) -> Rig | None:
    """The rig, if it has a profiler; without a given one, what the bag has.

    Args:
        bag: An open bag.
        rig: The rig that was given.
        report: Receives that a rig was chosen, and why.

    Returns:
        None = the recording has no profiler.
    """
    if rig is not None:
        return rig if rig.row_of("profiler") is not None else None
    shipped = load_rig(WUERZBURG)
    row = shipped.row_of("profiler")
    if row is not None and shipped.sensors[row].topic in {topic.name for topic in bag.topics}:
        report.derive(DerivedKind.RIG_CHOSEN, preset=WUERZBURG, by_topics=True)
        return shipped
    return _tilting_rig(bag, report)


def _tilting_rig(bag: Bag, report: ImportReport) -> Rig | None:
    """The rig of a bag with a 2-D laser that tilts; None = there is none, or not alone."""
    scans = [t.name for t in bag.topics if t.type == LASER_SCAN and t.messages]
    lidars = any((t.is_points or t.type in DATA_MESSAGES) and t.messages for t in bag.topics)
    if not scans or lidars or not has_frames(bag.topics):
        return None
    has_imu = any(t.type == IMU and t.messages for t in bag.topics)
    quiet = ImportReport()
    imu = choose_imu(bag, named_imu(None, IngestSettings()), quiet).topic if has_imu else ""
    mounts = read_mounts(bag, [*scans, imu], quiet)
    tilting = next(tilting_lasers(bag, mounts, scans), None)
    if tilting is None:
        return None
    level = [t for t in scans if _is_level(mounts, t, tilting.mount.base)]
    if not imu and not level:
        return None
    if imu and mounts.graph.joints_above(mounts.frame_of(imu)):
        report.warn(FindingKind.IMU_ON_JOINT, topic=imu)
        return None
    report.derive(
        DerivedKind.MOUNT_MOVES,
        profiler=tilting.topic,
        moved_by=tilting.source,
        **tilting.mount.values,
    )
    return _rig(tilting, mounts, SampleTopics(imu), level=level, report=report)


def tilting_lasers(bag: Bag, mounts: Mounts, topics: list[str]) -> Iterator[TiltingLaser]:
    """The lasers whose plane a joint tilts."""
    for topic in topics:
        frame = mounts.frame_of(topic)
        joints = mounts.graph.joints_above(frame)
        if any(joint.tilt_rad > LASERS.tilted_rad for joint in joints):
            mount = moving_mount(bag, mounts.graph, frame, report=ImportReport())
            if mount is not None:
                yield TiltingLaser(topic, mount, joints[0].named_by)


def _rig(
    laser: TiltingLaser,
    mounts: Mounts,
    samples: SampleTopics,
    *,
    level: list[str],
    report: ImportReport,
) -> Rig:
    """The tilting laser in the frame of what carries its joint, and the level one if there is."""
    carried = replace(mounts, frames={**mounts.frames, laser.topic: laser.mount.base})
    stream = Stream(laser.topic, "generic", topic=laser.topic)
    rig = rig_by_frames([stream], samples, carried, report=report)
    profiler = replace(rig.sensors[0], name="profiler", kind="profiler", head_topic=laser.source)
    sensors: list[Sensor] = [profiler]
    for topic in level[:1]:
        T_base_laser = carried.T_a_b(laser.topic, topic)
        assert T_base_laser is not None
        report.derive(DerivedKind.LASER_OF_MOTION, topic=topic)
        sensors.append(
            Sensor(
                name="laser2d",
                model="generic",
                T_body_sensor=profiler.T_body_sensor @ T_base_laser,
                kind="laser2d",
                topic=topic,
            )
        )
    return replace(rig, sensors=tuple(sensors))


def _is_level(mounts: Mounts, topic: str, base: str) -> bool:
    """Whether a laser is mounted level on what carries the joint."""
    T_base_laser = _known(mounts.graph, base, mounts.frame_of(topic))
    return T_base_laser is not None and abs(T_base_laser.R[2, 2]) > np.cos(LASERS.tilted_rad)


def _known(graph: FrameGraph, a: str, b: str) -> SE3 | None:
    return graph.T_a_b(a, b) if a and b else None
