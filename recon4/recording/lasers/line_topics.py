"""Which topics of a bag belong to a backpack with a profiler, for ``recon4 info``."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

from recon4.locales.coded import CodedText
from recon4.recording.formats.bags import CLOUD, JOINT_STATES, LASER_SCAN, TEXT, Bag, BagTopic
from recon4.recording.formats.typestore import TRANSFORMS
from recon4.recording.report import ImportReport
from recon4.recording.rigs.profiler import profiler_rig

_MOVES = {
    **dict.fromkeys(TRANSFORMS, ("joint", "content-transforms")),
    TEXT: ("joint", "content-description"),
}
"""Type of a head's topic -> what it moves, and the code of what its messages are."""


@dataclass(frozen=True, slots=True)
class LineTopics:
    """Topics of a rig with a profiler, the shipped one or that of a laser on a joint."""

    sensors: tuple[tuple[BagTopic, str, CodedText], ...]
    """Topic, kind of sensor, and what its messages are."""
    missing: tuple[CodedText, ...]
    """What the rig has and the bag lacks."""


def line_topics(bag: Bag) -> LineTopics | None:
    """Topics of line scans and what belongs to them; None = the bag has no line scans."""
    rig = profiler_rig(bag, None, ImportReport())
    if rig is None:
        return None
    filled = {topic.name: topic for topic in bag.topics if topic.messages}
    contents = {"profiler": "content-line-scans", "laser2d": "content-scans"}
    names = {"profiler": "profiler", "laser2d": "2-D laser"}
    found, missing = [], []
    for sensor in rig.sensors:
        if sensor.topic in filled:
            content = CodedText(contents[sensor.kind])
            found.append((filled[sensor.topic], names[sensor.kind], content))
        else:
            missing.append(CodedText("missing-topic", kind=sensor.kind, topic=sensor.topic))
        if not sensor.head_topic:
            continue
        if sensor.head_topic in filled:
            head = filled[sensor.head_topic]
            moves, code = _MOVES.get(head.type, ("head", "content-angles"))
            found.append((head, moves, CodedText(code)))
        else:
            expected = {"topic": sensor.head_topic, "type": JOINT_STATES}
            missing.append(CodedText("missing-head-topic", **expected))
    return LineTopics(tuple(found), tuple(missing))


def line_topic(wanted: str, name: str, topics: Sequence[BagTopic]) -> str:
    """The topic a rig names, or the only one with the sensor's name in it; empty = none."""
    usable = [t.name for t in topics if t.type in (LASER_SCAN, CLOUD) and t.messages]
    if wanted in usable:
        return wanted
    alike = [topic for topic in usable if name.lower() in topic.lower()]
    return alike[0] if len(alike) == 1 and not wanted else ""
