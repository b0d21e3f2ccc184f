"""Contents of a recording without reading all of it; shown by ``recon4 info``."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from itertools import islice
from pathlib import Path

import numpy as np

from recon4.errors import ConfigError, EmptyRecording, RecordingError
from recon4.locales.coded import CodedText, text_of
from recon4.locales.texts import Shown
from recon4.model.derived import Derived
from recon4.model.derived_kinds import DerivedKind
from recon4.model.finding_kinds import FindingKind
from recon4.model.lidars import lidar_model
from recon4.model.point_recipes import PointRecipe
from recon4.model.rig import Rig
from recon4.model.trajectory import Times
from recon4.recording.assembly.assembler import TimeGap
from recon4.recording.bags.lidar_choice import shared_topics
from recon4.recording.bags.packets import BagPackets
from recon4.recording.bags.recording import lidar_streams
from recon4.recording.clouds.point_fields import (
    INTENSITY_FIELDS,
    RING_FIELDS,
    TIME_FIELDS,
    find_field,
)
from recon4.recording.formats.bags import IMU, NAVSATFIX, ODOMETRY, Bag, BagTopic
from recon4.recording.formats.cloud_files import cloud_fields
from recon4.recording.formats.cloud_tables import cloud_table
from recon4.recording.formats.typestore import TRANSFORMS
from recon4.recording.frame_files.folders import (
    folder_gaps,
    frames_label,
    list_frames,
    time_warnings,
)
from recon4.recording.info.captures import SCAN_CAPTURE, describe_capture
from recon4.recording.info.head import RecordingHead, judge_samples, kind_of_walk, read_head
from recon4.recording.info.lines import describe_line_tables
from recon4.recording.info.nearby_samples import missing_samples
from recon4.recording.info.records import RecordingInfo, SensorInfo
from recon4.recording.info.samples import describe_samples
from recon4.recording.kinds import (
    BAGS,
    CAPTURES,
    PLANAR,
    RecordingKind,
    bag_paths,
    located_kind,
)
from recon4.recording.lasers.laser2d import is_laser2d, read_laser_recording
from recon4.recording.lasers.line_topics import line_topics
from recon4.recording.lasers.mount import mounted_scans
from recon4.recording.lasers.tuning import LASERS
from recon4.recording.mandeye.info import describe_walk
from recon4.recording.open import KINDS, open_recording
from recon4.recording.openers.frames import frames_model
from recon4.recording.openers.request import OpenRequest
from recon4.recording.packets.companions import companion_paths, companions_of
from recon4.recording.packets.messages import PACKET_MESSAGES
from recon4.recording.recipes.bag_points import declared_recipes
from recon4.recording.report import ImportReport
from recon4.recording.rigs.choice import RigToComplete
from recon4.recording.rigs.first import first_rig_of
from recon4.recording.tuning import PROBE, IngestTuning
from recon4.settings import IngestSettings
from recon4.settings.tuning import tuned


def describe(
    path: Path,
    *,
    settings: IngestSettings | None = None,
    near: Sequence[Path] = (),
    fields: PointRecipe | None = None,
) -> RecordingInfo:
    """Read a small recording completely, and head and directory of a large one.

    Args:
        path: File or folder.
        settings: Of the stage that reads it; None = the usual ones.
        near: Files beside it, for a process that may not list its folder.
        fields: What the columns of its points are, if they have no common names.

    Raises:
        RecordingError: If it cannot be read or is nothing that recon4 knows.
        ConfigError: If the fields do not fit.
    """
    settings = settings or IngestSettings()
    given = path
    path, kind = located_kind(path)
    info = RecordingInfo(
        path=path.relative_to(given.parent).as_posix(), kind=kind.text, bytes=_size(path)
    )
    if kind in PLANAR or (kind in (*BAGS, RecordingKind.PCAP) and is_laser2d(path, kind)):
        if kind is RecordingKind.PCAP:
            info = replace(info, kind=SCAN_CAPTURE)
        return _describe_laser2d(info, path, settings)
    if kind not in KINDS:
        return describe_samples(info, path, kind)
    report = ImportReport()
    if kind is RecordingKind.LINE_TABLES:
        return describe_line_tables(info, path)
    beside = companion_paths([path], near) if kind in (*CAPTURES, *BAGS) else []
    request = OpenRequest((path, *beside), None, settings, report, fields=fields)
    if kind in CAPTURES:
        info = describe_capture(info, path, companions_of(request.paths))
    elif kind is RecordingKind.FRAMES:
        info = _describe_frames(info, path, settings)
    elif kind is RecordingKind.MANDEYE:
        info = describe_walk(info, path)
    elif kind in BAGS:
        info = _describe_bag(info, request)
    return _with_head(info, request)


def _size(path: Path) -> int:
    files = [path] if path.is_file() else [f for f in path.iterdir() if f.is_file()]
    return sum(file.stat().st_size for file in files)


# -- bags


def _describe_bag(info: RecordingInfo, request: OpenRequest) -> RecordingInfo:
    # What is counted while it is described is counted again where its head is read.
    seen = ImportReport()
    with Bag(bag_paths(request.paths[0]), seen) as bag:
        bag.use_sources(shared_topics(bag, seen))
        bag.use_recipes(declared_recipes(bag, None, request.fields, report=ImportReport()))
        packets = BagPackets(bag, companions_of(request.paths))
        try:
            streams = lidar_streams(packets, None, request.settings, report=seen)
        except (RigToComplete, EmptyRecording):
            streams = []  # what is missing is said when the recording is opened, once
        topics = {topic.name: topic for topic in bag.topics}
        sensors = tuple(_bag_sensor(bag, topics[stream.topic], stream.model) for stream in streams)
        whole = info.bytes <= PROBE.whole_bytes
        gaps = _bag_gaps(bag, [s.topic for s in streams]) if whole else ()
        lines = line_topics(bag)
        if lines is not None:
            sensors += tuple(
                _line_sensor(bag, topic, model, content=content)
                for topic, model, content in lines.sensors
            )
        if lines is not None and whole:
            gaps += _bag_gaps(bag, [topic.name for topic, _, _ in lines.sensors])
        known = {s.label for s in sensors}
        other = [t for t in bag.topics if t.name not in known]
        describing = packets.describing_topics
        return replace(
            info,
            t_first_ns=bag.t_first_ns,
            t_last_ns=bag.t_last_ns,
            sensors=sensors,
            samples=tuple(_topic_samples(t, bag.seconds, describing) for t in other if t.messages),
            gaps=gaps,
            missing=lines.missing if lines else (),
        )


def _line_sensor(bag: Bag, topic: BagTopic, model: str, *, content: CodedText) -> SensorInfo:
    rate_hz = (topic.messages - 1) / bag.seconds if bag.seconds > 0 else float("nan")
    return SensorInfo(
        label=topic.name, model=model, content=content, count=topic.messages, rate_hz=rate_hz
    )


def _bag_sensor(bag: Bag, topic: BagTopic, model: str) -> SensorInfo:
    return SensorInfo(
        label=topic.name,
        model=model,
        content=CodedText("content-clouds" if topic.is_points else "content-packet-scans"),
        count=topic.messages,
        rate_hz=(topic.messages - 1) / bag.seconds if bag.seconds > 0 else float("nan"),
        fields=_message_fields(bag, topic) if topic.is_points else (),
    )


def _message_fields(bag: Bag, topic: BagTopic) -> tuple[str, ...]:
    for message in islice(bag.messages([topic.name]), PROBE.messages):
        cloud = bag.decode(message)
        if cloud is not None:
            try:
                return tuple(f"{k} ({v.dtype})" for k, v in cloud_table(cloud).items())
            except RecordingError:
                continue
    return ()


def _bag_gaps(bag: Bag, topics: Sequence[str]) -> tuple[TimeGap, ...]:
    """Gaps between messages of more than twice the usual step."""
    times: dict[str, list[int]] = {topic: [] for topic in topics}
    for message in bag.messages(topics):
        times[message.topic].append(message.t_ns)
    return tuple(gap for topic, t_ns in times.items() for gap in _gaps(topic, np.array(t_ns)))


def _gaps(name: str, t_ns: Times) -> list[TimeGap]:
    steps = np.diff(t_ns)
    if not len(steps):
        return []
    wide = np.flatnonzero(steps > 2 * np.median(steps) + 100_000_000)
    return [TimeGap(name, int(t_ns[k]), float(steps[k]) / 1e9) for k in wide]


def _topic_samples(topic: BagTopic, seconds: float, describing: set[str]) -> CodedText:
    words = {IMU: "imu", NAVSATFIX: "gnss", ODOMETRY: "odometry"}
    words |= dict.fromkeys(TRANSFORMS, "transforms")
    words |= dict.fromkeys(PACKET_MESSAGES, "packets")
    rate_hz = topic.messages / seconds if seconds > 0 else 0.0
    counted: dict[str, Shown] = {"topic": topic.name, "messages": topic.messages}
    counted["rate_hz"] = rate_hz
    what = "describes" if topic.name in describing else words.get(topic.type, "")
    if not what:
        return CodedText("samples-topic-unread", type=topic.type, **counted)
    return CodedText("samples-topic", what=what, **counted)


# -- 2-D lasers


def _describe_laser2d(info: RecordingInfo, path: Path, settings: IngestSettings) -> RecordingInfo:
    report = ImportReport()
    scans = mounted_scans(
        read_laser_recording([path], report, settings=settings), None, report=report
    ).scans
    first, last = int(scans.t_ns[0]), int(scans.t_ns[-1])
    returns = float(np.isfinite(scans.range_m).mean())
    sensor = SensorInfo(
        label=path.name,
        model="2-D laser",
        content=scans.layout,
        count=len(scans),
        rate_hz=(len(scans) - 1) * 1e9 / (last - first) if last > first else float("nan"),
        remarks=(CodedText("remark-ranges", farthest_m=scans.range_max_m, returns=returns),),
    )
    return replace(
        info,
        walk=Derived(kind=DerivedKind.WALK_PLANAR),
        t_first_ns=first,
        t_last_ns=last,
        sensors=(sensor,),
        samples=(CodedText("samples-robot"),) if scans.odometry is not None else (),
        gaps=tuple(g for g in _gaps(path.name, scans.t_ns) if g.seconds > LASERS.gap_s),
        derived=tuple(report.derived),
        missing=() if scans.odometry is not None else (CodedText("missing-odometry"),),
        lost=tuple(report.losses()),
        repaired=tuple(report.repairs()),
        findings=tuple(report.findings),
    )


# -- frames


def _describe_frames(info: RecordingInfo, path: Path, settings: IngestSettings) -> RecordingInfo:
    frames = list_frames(path)
    fields = tuple(cloud_fields(frames.files[0]))
    absent = [
        word
        for word, aliases in (
            ("intensity", INTENSITY_FIELDS),
            ("ring", RING_FIELDS),
            ("time", TIME_FIELDS),
        )
        if not find_field(fields, aliases)
    ]
    sensor = SensorInfo(
        label=path.name,
        model=frames_model(frames.files, None),
        content=frames_label(frames),
        count=len(frames.files),
        rate_hz=frames.rate_hz,
        fields=fields,
    )
    return replace(
        info,
        t_first_ns=int(frames.t_ns[0]),
        t_last_ns=int(frames.t_ns[-1]) + frames.period_ns,
        sensors=(sensor,),
        gaps=tuple(folder_gaps(frames, path.name, tuned(IngestTuning, settings).gap_s)),
        missing=tuple(CodedText("missing-field", field=word) for word in absent),
        findings=time_warnings(frames),
    )


# -- head


def _with_rotation(
    sensors: tuple[SensorInfo, ...], rig: Rig | None, head: RecordingHead
) -> tuple[SensorInfo, ...]:
    """The sensors with the rotation of their points, where their packets do not tell it."""
    if rig is None or len(sensors) != len(rig.sensors):
        return sensors
    return tuple(
        s
        if np.isfinite(s.rotation_hz) or not lidar_model(s.model).has_rings
        else replace(s, rotation_hz=head.rotation_hz.get(k, float("nan")))
        for k, s in enumerate(sensors)
    )


def _with_head(info: RecordingInfo, request: OpenRequest) -> RecordingInfo:
    """Add the findings of opening the recording and reading its first second."""
    path, settings, report = request.paths[0], request.settings, request.report
    head, missing = RecordingHead(), list(info.missing)
    rig: Rig | None = None
    to_complete: RigToComplete | None = None
    try:
        recording = open_recording(request)
        rig = recording.rig
        whole = info.bytes <= PROBE.whole_bytes
        head = read_head(recording, settings, whole=whole, report=report)
        if whole and not head.points:
            counts = report.counted()
            report.warn(
                FindingKind.NO_POINTS, **({"counts": counts} if counts else {"nothing": True})
            )
        judge_samples(head, rig, settings, whole=whole, report=report)
    except ConfigError as error:
        if request.fields is not None:
            raise
        to_complete = error if isinstance(error, RigToComplete) else None
        missing.append(CodedText("missing-rig", error=text_of(error), what="rig"))
    except RecordingError as error:
        missing.append(CodedText("missing-contents", error=text_of(error)))
    samples = [*info.samples]
    there = {text.values.get("what") for text in samples}
    if head.imu and "imu" not in there:
        samples.append(CodedText("samples-in-packets", what="imu"))
    has_imu, has_gnss = bool(head.imu) or "imu" in there, bool(head.gnss) or "gnss" in there
    if rig is not None:
        missing += missing_samples(path, RecordingKind.IMU_CSV, has=has_imu)
    missing += missing_samples(path, RecordingKind.GNSS_FILE, has=has_gnss)
    sensors = _with_rotation(info.sensors, rig, head)
    report.count("clock_jumps_back", len(head.jumps))
    is_capture = info.kind in {kind.text for kind in CAPTURES}  # on the recorder's clock
    set_ns = head.set_back_ns - sum(report.recorder_set_ns) if is_capture else 0
    return replace(
        info,
        t_last_ns=info.t_last_ns + set_ns,
        sensors=sensors,
        walk=kind_of_walk(rig) if rig is not None else None,
        gaps=(*info.gaps, *head.jumps),
        samples=tuple(samples),
        missing=tuple(missing),
        derived=tuple(report.derived),
        lost=tuple(report.losses()),
        repaired=tuple(report.repairs()),
        findings=tuple(report.findings),
        first_rig=first_rig_of(rig, to_complete, path),
    )
