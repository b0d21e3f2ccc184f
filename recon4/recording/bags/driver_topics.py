"""Topics of LiDARs in messages of their own drivers, which are not read, and what to do instead."""

from __future__ import annotations

from collections.abc import Sequence

from recon4.locales.coded import CodedText, joined
from recon4.model.derived_kinds import DerivedKind
from recon4.model.finding_kinds import FindingKind
from recon4.recording.formats.bags import CLOUD, LASER_SCAN, BagTopic
from recon4.recording.formats.point_messages import POINT_MESSAGES
from recon4.recording.packets.messages import DATA_MESSAGES
from recon4.recording.report import ImportReport
from recon4.recording.tuning import LISTED

_DRIVERS = (
    *("ouster", "os_ros", "pandar", "hesai", "rslidar", "robosense"),
    *("sick_scan", "cepton", "innovusion", "seyond", "blickfeld"),
    "point_cloud_interfaces",  # compressed clouds of any LiDAR
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
    return joined(
        CodedText("topic-unread", topic=topic.name, type=short_type(topic.type))
        for topic in driver_topics(topics)
    )


def no_lidar_text(name: str, topics: Sequence[BagTopic]) -> CodedText:
    """Why a bag has no LiDAR data that is read: what there is, what is read, what to do."""
    listed = ", ".join(f"{t.name} ({t.type})" for t in topics[: LISTED.names])
    listed += " …" * (len(topics) > LISTED.names)
    types = [*sorted(POINT_MESSAGES), *sorted(DATA_MESSAGES)]
    kinds = ", ".join(short_type(kind) for kind in (CLOUD, *types, LASER_SCAN))
    why = [unread_text(topics) or CodedText("topics-read", kinds=kinds)]
    if any(topic.type == CLOUD and topic.messages for topic in topics):
        why.append(CodedText("topics-other-clouds"))
    unknown = [topic for topic in topics if topic.columns and not topic.is_points]
    why += [needed_text(t.name, t.columns) for t in unknown[: LISTED.names]]
    return CodedText("bag-no-lidar", file=name, topics=listed or "–", why=joined(why))


def needed_text(name: str, columns: Sequence[str]) -> CodedText:
    """What points of unknown columns lack to be read.

    Args:
        name: Topic or file.
        columns: Their names.
    """
    names = ", ".join(column[:40] for column in columns[: LISTED.names])
    fields = '{ x = "COLUMN", y = "COLUMN", z = "COLUMN", time = "COLUMN" }'
    return CodedText("columns-needed", name=name, columns=names, fields=fields)


def short_type(kind: str) -> str:
    """``sensor_msgs/PointCloud2`` for ``sensor_msgs/msg/PointCloud2``."""
    return kind.replace("/msg/", "/")
