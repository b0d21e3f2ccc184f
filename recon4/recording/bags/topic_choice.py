"""Which of several topics of a bag is read: the one that was named, else the best by its content.

The choice and what speaks against the others go to the report.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass

from recon4.errors import ConfigError
from recon4.locales.coded import CodedText
from recon4.model.derived_kinds import DerivedKind
from recon4.model.finding import Value
from recon4.model.finding_kinds import FindingKind
from recon4.model.rig import Rig
from recon4.recording.bags.messages import (
    SampleBatch,
    forces_row,
    imu_row,
    join_imu,
    stamp_clock,
    turns_row,
)
from recon4.recording.bags.topic_contents import (
    Contents,
    Fault,
    common_faults,
    fix_faults,
    fix_quality,
    imu_faults,
    laser_faults,
    near,
    odometry_faults,
    read_contents,
    say_left_out,
    view_deg,
)
from recon4.recording.bags.tuning import LIDAR_CHOICE
from recon4.recording.formats.bags import IMU, LASER_SCAN, NAVSATFIX, ODOMETRY, Bag, BagTopic
from recon4.recording.mounts.transform_messages import has_frames, read_frames
from recon4.recording.report import ImportReport
from recon4.settings import IngestSettings

_NO_FORCES, _NO_TURNS = "no_accelerometer", "no_gyroscope"


def _nothing(found: Contents) -> float:
    return 0.0


def _is_wide(found: Contents) -> float:
    return float(view_deg(found) >= LIDAR_CHOICE.wide_deg)


@dataclass(frozen=True, slots=True, kw_only=True)
class Kind:
    """A kind of topic of which one is read."""

    type: str
    label: str
    setting: str
    """Names the topic."""
    faults: Callable[[Contents], list[Fault]]
    """What speaks against a topic."""
    value: Callable[[Contents], float] = _nothing
    """Ranks topics of equal faults."""
    less: str = "as_good"
    """What a topic of equal faults and a lower value is, as a value of `TOPIC_LEFT_OUT`."""
    rig_key: str = ""
    """Table of the rig file whose ``topic`` names it too; empty = none."""
    decisive: bool = True
    """Whether the map depends on it, so that a choice between equals is a warning."""


IMU_KIND = Kind(
    type=IMU,
    label="IMU",
    setting="ingest.imu_topic",
    faults=imu_faults,
    less="elsewhere",
    rig_key="imu",
)
FIX_KIND = Kind(
    type=NAVSATFIX,
    label="GNSS",
    setting="ingest.gnss_topic",
    faults=fix_faults,
    value=fix_quality,
    less="lower_status",
    rig_key="gnss",
)
ODOMETRY_KIND = Kind(
    type=ODOMETRY,
    label="odometry",
    setting="ingest.odometry_topic",
    faults=odometry_faults,
    decisive=False,
)
LASER_KIND = Kind(
    type=LASER_SCAN,
    label="2-D laser",
    setting="ingest.lidar_topic",
    faults=laser_faults,
    value=_is_wide,
    less="narrower",
    rig_key="[sensor]",
)


@dataclass(frozen=True, slots=True)
class Named:
    """A topic that somebody named; both empty = chosen by content."""

    by_setting: str = ""
    by_rig: str = ""


def named_imu(rig: Rig | None, settings: IngestSettings) -> Named:
    """The topic of the IMU that settings or rig name."""
    return Named(settings.imu_topic, rig.imu_topic if rig is not None else "")


def named_fixes(rig: Rig | None, settings: IngestSettings) -> Named:
    """The topic of the positions that settings or rig name."""
    return Named(settings.gnss_topic, rig.gnss_topic if rig is not None else "")


@dataclass(frozen=True, slots=True)
class ImuTopics:
    """Where the samples of an IMU come from."""

    topic: str = ""
    """Empty = there is none."""
    forces: str = ""
    """Topic of its accelerations, if they are apart from the angular rates."""


@dataclass(frozen=True, slots=True, eq=False)
class _Candidate:
    found: Contents
    faults: tuple[Fault, ...]
    rank: tuple[float, ...]
    """Compared where faults weigh the same."""

    @property
    def key(self) -> tuple[float, ...]:
        return (-sum(fault.weight for fault in self.faults), *self.rank)

    def why_not(self, best: _Candidate, kind: Kind) -> dict[str, Value]:
        """Why it is not the best one, as values of `DerivedKind.TOPIC_LEFT_OUT`."""
        if self.faults:
            return {fault.what: fault.value for fault in self.faults}
        if self.rank[:-1] != best.rank[:-1]:
            return {kind.less: True}
        return {"fewer" if self.rank[-1] < best.rank[-1] else "as_good": True}


def choose_imu(
    bag: Bag, named: Named, report: ImportReport, *, lidars: Sequence[BagTopic] = ()
) -> ImuTopics:
    """The IMU of an open bag: one with gyroscope and accelerometer, near the LiDARs.

    Raises:
        ConfigError: If a setting names a topic that is not there.
    """
    topics = _of_kind(bag, IMU_KIND)
    known = _known(topics, named, IMU_KIND, report=report)
    if known is not None:
        return ImuTopics(known)
    contents = read_contents(bag, [*topics, *lidars])
    beside = {topic.name: contents.pop(topic.name) for topic in lidars}
    mounted = _mounted_with(bag, contents, beside)
    candidates = [
        _candidate(one, IMU_KIND, 2 * near(one, beside) + (name in mounted))
        for name, one in contents.items()
    ]
    best = _best(candidates)
    forces = _forces_beside(best, candidates)
    if forces:
        name = best.found.topic.name
        report.derive(DerivedKind.IMU_JOINED, turns=name, forces=forces)
    others = [c for c in candidates if c is not best and c.found.topic.name != forces]
    _say(best, others, IMU_KIND, report=report)
    return ImuTopics(best.found.topic.name, forces)


def _mounted_with(
    bag: Bag, contents: Mapping[str, Contents], lidars: Mapping[str, Contents]
) -> set[str]:
    """Topics whose frames the transforms of a bag connect with those of the LiDARs."""
    frames = {one.frame for one in lidars.values()} - {""}
    if len(contents) < 2 or not frames or not has_frames(bag.topics):
        return set()
    all_frames = sorted(frames | {one.frame for one in contents.values()} - {""})
    graph = read_frames(bag, all_frames, ImportReport())
    return {
        name
        for name, one in contents.items()
        if one.frame and any(graph.connected([one.frame, frame]) for frame in frames)
    }


def imu_batches(bag: Bag, imu: ImuTopics, report: ImportReport) -> dict[str, SampleBatch]:
    """Topic -> what collects its samples, from an open bag."""
    rows = {imu.topic: turns_row, imu.forces: forces_row} if imu.forces else {imu.topic: imu_row}
    return {
        topic: SampleBatch(row, join_imu, report, kind="imu", stamps=stamp_clock(bag, topic))
        for topic, row in rows.items()
    }


def choose_topic(bag: Bag, named: Named, kind: Kind, *, report: ImportReport) -> str:
    """The topic of a kind of an open bag that is read; empty = none.

    Raises:
        ConfigError: If a setting names a topic that is not there.
    """
    topics = _of_kind(bag, kind)
    known = _known(topics, named, kind, report=report)
    if known is not None:
        return known
    contents = read_contents(bag, topics).values()
    candidates = [_candidate(one, kind, kind.value(one)) for one in contents]
    best = _best(candidates)
    _say(best, [c for c in candidates if c is not best], kind, report=report)
    return best.found.topic.name


def _candidate(found: Contents, kind: Kind, value: float) -> _Candidate:
    faults = [*common_faults(found), *(kind.faults(found) if found.messages else ())]
    return _Candidate(found, tuple(faults), (value, found.topic.messages))


def _of_kind(bag: Bag, kind: Kind) -> list[BagTopic]:
    return [t for t in bag.topics if t.type == kind.type and t.messages]


def _known(
    topics: Sequence[BagTopic], named: Named, kind: Kind, *, report: ImportReport
) -> str | None:
    """The topic that was named or is the only one, empty if there is none; None = choose."""
    there = [topic.name for topic in topics]
    if named.by_setting:
        require_topic(named.by_setting, there, kind.setting)
        return named.by_setting
    if not named.by_rig:
        return None if len(there) > 1 else "".join(there)
    if named.by_rig in there:
        return named.by_rig
    report.warn(
        FindingKind.TOPIC_NOT_RECORDED,
        topic=named.by_rig,
        table=kind.rig_key,
        there=", ".join(there),
        none=not there,
        what=kind.label,
        setting=kind.setting,
    )
    return ""


def require_topic(topic: str, there: Sequence[str], setting: str) -> None:
    """Check that a topic named by a setting is there.

    Raises:
        ConfigError: If it is not.
    """
    if topic not in there:
        raise ConfigError(
            CodedText(
                "topic-not-there",
                setting=setting,
                topic=topic[:200],
                there=", ".join(there) or CodedText("no-such-topic"),
            )
        )


def _best(candidates: Sequence[_Candidate]) -> _Candidate:
    ordered = sorted(candidates, key=lambda one: one.found.topic.name)
    return max(ordered, key=lambda one: one.key)


def _forces_beside(best: _Candidate, candidates: Sequence[_Candidate]) -> str:
    """The topic of accelerations alone that belongs to one of angular rates alone; else empty."""
    if _NO_FORCES not in {fault.what for fault in best.faults}:
        return ""
    beside: Mapping[str, Contents] = {"": best.found}
    alone = [
        one
        for one in candidates
        if [fault.what for fault in one.faults if fault.weight > 1.0] == [_NO_TURNS]
        and near(one.found, beside)
    ]
    return alone[0].found.topic.name if len(alone) == 1 else ""


def _say(
    best: _Candidate, others: Sequence[_Candidate], kind: Kind, *, report: ImportReport
) -> None:
    if not others:
        return
    frame = best.found.frame
    is_rival = [one.key[:-1] == best.key[:-1] and one.found.frame != frame for one in others]
    rivals = [one for one, equal in zip(others, is_rival, strict=True) if equal and kind.decisive]
    worse = [one for one in others if one not in rivals]
    for one in worse:
        left = {"topic": one.found.topic.name} | one.why_not(best, kind)
        say_left_out(kind.label, best.found.topic.name, left, frame=frame, report=report)
    if not rivals:
        return
    by_rig: dict[str, Value] = {"table": kind.rig_key} if kind.rig_key else {"settable": True}
    report.warn(
        FindingKind.TOPICS_EQUAL,
        what=kind.label,
        read=best.found.topic.name,
        frame=frame,
        frameless=not frame,
        rivals=", ".join(f"{one.found.topic.name} (frame {one.found.frame})" for one in rivals),
        setting=kind.setting,
        **by_rig,
    )
