"""Topics of LiDARs in messages of their own drivers, which are not read, and what to do instead."""

from __future__ import annotations

from collections.abc import Sequence

from recon4.model.derived_kinds import DerivedKind
from recon4.model.finding_kinds import FindingKind
from recon4.recording.formats.bags import CLOUD, LASER_SCAN, BagTopic
from recon4.recording.formats.point_messages import POINT_MESSAGES
from recon4.recording.packets.messages import DATA_MESSAGES
from recon4.recording.report import ImportReport
from recon4.recording.tuning import LISTED

_BY_REPLAY = "play the bag back through the driver and record the PointCloud2 that it publishes"
_DRIVERS = (
    *("ouster", "os_ros", "pandar", "hesai", "rslidar", "robosense"),
    *("sick_scan", "cepton", "innovusion", "seyond", "blickfeld"),
)
"""Beginnings of names of types."""
_NOT_LIDARS = ("imu", "info", "status", "diagnos", "string", "metadata", "laserscan")


def driver_topics(topics: Sequence[BagTopic]) -> list[BagTopic]:
    """Topics of LiDARs in messages of their drivers that are not read."""
    return [one for one in topics if one.messages and not one.is_points and _is_of_driver(one)]


def _is_of_driver(topic: BagTopic) -> bool:
    kind = topic.type.lower()
    return kind.startswith(_DRIVERS) and not any(word in kind for word in _NOT_LIDARS)


def warn_of_drivers(topics: Sequence[BagTopic], report: ImportReport) -> None:
    """Warn of each of `driver_topics`."""
    for topic in driver_topics(topics):
        report.warn(FindingKind.DRIVER_UNREAD, topic=topic.name, type=short_type(topic.type))


def say_drivers(topics: Sequence[BagTopic], report: ImportReport) -> None:
    """State each of `driver_topics` where another LiDAR is read."""
    for topic in driver_topics(topics):
        kind = short_type(topic.type)
        report.derive(DerivedKind.TOPIC_OF_DRIVER, topic=topic.name, type=kind)


def unread_text(topics: Sequence[BagTopic]) -> str:
    """A sentence for each LiDAR in messages of its driver; empty = there is none."""
    return "; ".join(
        f"{topic.name} is of a LiDAR, but {short_type(topic.type)} is not read: {_BY_REPLAY}"
        for topic in driver_topics(topics)
    )


def no_lidar_text(name: str, topics: Sequence[BagTopic]) -> str:
    """Why a bag has no LiDAR data that is read: what there is, what is read, what to do."""
    listed = ", ".join(f"{t.name} ({t.type})" for t in topics[: LISTED.names])
    listed += " …" * (len(topics) > LISTED.names)
    types = [*sorted(POINT_MESSAGES), *sorted(DATA_MESSAGES)]
    kinds = ", ".join(short_type(kind) for kind in (CLOUD, *types, LASER_SCAN))
    why = unread_text(topics) or f"read are {kinds}"
    if any(topic.type == CLOUD and topic.messages for topic in topics):
        why += (
            "; the clouds are of a depth camera or a map (one is read with lidar_topic of ingest; "
            "page: All settings; command: --set ingest.lidar_topic=TOPIC)"
        )
    unknown = [topic for topic in topics if topic.columns and not topic.is_points]
    why += "".join(f"; {needed_text(t.name, t.columns)}" for t in unknown[: LISTED.names])
    return f"{name}: no LiDAR data; topics: {listed or 'none'}; {why}"


def needed_text(name: str, columns: Sequence[str]) -> str:
    """What points of unknown columns lack to be read.

    Args:
        name: Topic or file.
        columns: Their names.
    """
    names = ", ".join(column[:40] for column in columns[: LISTED.names])
    return (
        f"{name} has lists of {names}: it is read as points of a LiDAR if they are named x, y, z, "
        "and a time, ring or intensity, or if a rig file says which columns they are: fields = "
        '{ x = "COLUMN", y = "COLUMN", z = "COLUMN", time = "COLUMN" } (or range, azimuth, '
        "elevation) in its [[sensor]]"
    )


def short_type(kind: str) -> str:
    """``sensor_msgs/PointCloud2`` for ``sensor_msgs/msg/PointCloud2``."""
    return kind.replace("/msg/", "/")
