"""Recordings of a 2-D laser alone: CARMEN logs, bags and captures of its datagrams."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from recon4.errors import EmptyRecording, UnknownFormat
from recon4.geometry.se2 import between, from_se3
from recon4.geometry.se3 import Array
from recon4.locales.coded import CodedText
from recon4.model.derived_kinds import DerivedKind
from recon4.model.finding_kinds import FindingKind
from recon4.model.laser_scans import LaserScans, Ranges, joined_scans
from recon4.model.rig import Rig
from recon4.model.trajectory import Times, Trajectory
from recon4.recording.bags.messages import SampleBatch, join_poses, pose_row, stamp_clock
from recon4.recording.bags.topic_choice import LASER_KIND, ODOMETRY_KIND, Named, choose_topic
from recon4.recording.clocks.set_back import going_on, say_set_back
from recon4.recording.clocks.stamps import filled, strays
from recon4.recording.formats.bags import LASER_SCAN, Bag
from recon4.recording.formats.carmen import REAR, CarmenScans, is_carmen, read_carmen
from recon4.recording.kinds import RecordingKind, bag_paths, capture_files, recognize
from recon4.recording.lasers.mount import LaserMount, LaserRecording, mount_of_bag
from recon4.recording.lasers.range_units import in_meters
from recon4.recording.lasers.scan_capture import is_scan_capture, read_scan_captures
from recon4.recording.lasers.scan_messages import ScanCollector
from recon4.recording.lasers.tables import is_laser_table, read_laser_table
from recon4.recording.lasers.tuning import LASERS
from recon4.recording.packets.messages import DATA_MESSAGES
from recon4.recording.packets.streams import require_one_capture
from recon4.recording.report import ImportReport
from recon4.recording.rigs.profiler import profiler_rig
from recon4.settings import IngestSettings

Rows = NDArray[np.intp]


def is_laser2d(path: Path, kind: RecordingKind | None = None, *, rig: Rig | None = None) -> bool:
    """Whether a path is a recording of a 2-D laser without any LiDAR or profiler.

    Args:
        path: A file or folder.
        kind: Of the recording; None = not known yet.
        rig: A rig without a profiler that was given; None = none was given.

    Raises:
        RecordingError: If it cannot be read.
    """
    if path.is_file() and (is_carmen(path) or is_laser_table(path)):
        return True
    kind = kind or recognize(path)
    if kind is RecordingKind.PCAP:
        return is_scan_capture(capture_files(path))
    if kind not in (RecordingKind.BAG1, RecordingKind.BAG2):
        return False
    report = ImportReport()
    with Bag(bag_paths(path), report) as bag:
        kinds = {topic.type for topic in bag.topics if topic.messages}
        has_lines = rig is None and profiler_rig(bag, None, report) is not None
        lidars = any(t.is_points or t.type in DATA_MESSAGES for t in bag.topics if t.messages)
        return LASER_SCAN in kinds and not lidars and not has_lines


def read_laser2d(
    paths: Sequence[Path], report: ImportReport, *, settings: IngestSettings | None = None
) -> LaserScans:
    """Read the scans of a recording as the laser measured them, see `read_laser_recording`."""
    return read_laser_recording(paths, report, settings=settings).scans


def read_laser_recording(
    paths: Sequence[Path],
    report: ImportReport,
    *,
    settings: IngestSettings | None = None,
    topic: str = "",
) -> LaserRecording:
    """Read the scans of a recording, and how the laser is mounted; repairs are counted.

    Args:
        paths: A CARMEN log, or bags or capture files that belong together.
        report: Receives counts, repairs and warnings.
        settings: Name the topics of a bag; None = chosen by content.
        topic: Of the laser in a bag by a rig file, if no setting names one; empty = by content.

    Raises:
        RecordingError: If it cannot be read or has no scan.
        ConfigError: If the settings name a topic that is not there.
    """
    if paths[0].is_file() and is_carmen(paths[0]):
        if len(paths) > 1:
            raise UnknownFormat(CodedText("carmen-one", count=len(paths)))
        scans = _of_carmen(read_carmen(paths[0], report), paths[0].name, report)
        return LaserRecording(in_meters(scans, report))
    if paths[0].is_file() and is_laser_table(paths[0]):
        if len(paths) > 1:
            raise UnknownFormat(CodedText("laser-table-one", count=len(paths)))
        return LaserRecording(in_meters(read_laser_table(paths[0], report), report))
    if recognize(paths[0]) is RecordingKind.PCAP:
        files = [file for path in paths for file in capture_files(path)]
        require_one_capture(files)
        return LaserRecording(in_meters(read_scan_captures(files, report), report))
    settings = settings or IngestSettings()
    named = Named(settings.lidar_topic, topic), Named(settings.odometry_topic)
    scans, mount = _of_bags(paths, named, report=report)
    return LaserRecording(in_meters(scans, report), mount, of_robot=True)


# -- CARMEN


def _of_carmen(log: CarmenScans, name: str, report: ImportReport) -> LaserScans:
    rows, t_ns = _in_order(log, name, report)
    range_max_m, ranges = _without_largest(log, report)
    odometry = _odometry(log, report)
    report.count("scans", len(rows))
    beams = np.diff(log.start)[rows]
    start = np.concatenate([[0], np.cumsum(beams)])
    sorted_ranges = np.repeat(log.start[rows] - start[:-1], beams) + np.arange(start[-1])
    return LaserScans(
        t_ns=t_ns,
        range_m=ranges[sorted_ranges],
        start=start,
        angle_min_rad=log.angle_min_rad[rows],
        angle_step_rad=log.angle_step_rad[rows],
        time_step_s=np.zeros(len(rows)),
        range_max_m=range_max_m,
        odometry=None if odometry is None else odometry[rows],
    )


def _in_order(log: CarmenScans, name: str, report: ImportReport) -> tuple[Rows, Times]:
    """Rows in the order of measurement, each time once, and their times [ns], (N,).

    Lines are in order where their times go back for good: the clock was set. Single times that are
    far from those of the lines around are replaced by these.
    """
    apart = strays(log.t_ns)
    report.count("scans_wrong_time", int(np.count_nonzero(apart)))
    log = replace(log, t_ns=filled(log.t_ns, ~apart))
    clock = going_on(log.t_ns)
    if clock is not None:
        say_set_back(name, clock.steps, report)
        log = replace(log, t_ns=log.t_ns + clock.shift_ns)
    rows = _sorted_rows(log, name, report)
    return rows, log.t_ns[rows]


def _sorted_rows(log: CarmenScans, name: str, report: ImportReport) -> Rows:
    t_ns = log.t_ns
    order = np.argsort(t_ns, kind="stable")
    shuffled = int((np.diff(t_ns) < 0).sum())
    if shuffled:
        report.count("scans_unsorted", shuffled)
        report.warn(FindingKind.SCANS_UNSORTED, where=name, scans=shuffled)
    later = np.diff(t_ns[order], prepend=t_ns[order[0]] - 1) > 0
    again = np.flatnonzero(~later)
    copies = sum(np.array_equal(log.ranges(order[k]), log.ranges(order[k - 1])) for k in again)
    report.count("scans_repeated", copies)
    report.count("scans_duplicate", len(again) - copies)
    return order[later]


def _without_largest(log: CarmenScans, report: ImportReport) -> tuple[float, Ranges]:
    """The largest range the sensor reports [m], and ranges with NaN where there was no return."""
    ranges = log.range_m.copy()
    bad = ~np.isfinite(ranges) | (ranges < 0.0)
    report.count("ranges_not_numbers", int(bad.sum()))
    if bad.any():
        report.warn(FindingKind.RANGES_INVALID, ranges=int(bad.sum()))
    ranges[bad | (ranges == 0.0)] = np.nan
    if not np.isfinite(ranges).any():
        raise EmptyRecording(CodedText("laser-no-range"))
    largest = float(np.nanmax(ranges))
    # SICK lasers report several error codes within a percent of the largest range.
    at_largest = ranges >= 0.99 * largest
    if log.range_max_m.all():
        at_largest = ranges >= np.repeat(log.range_max_m, np.diff(log.start))
        largest = float(log.range_max_m.max())
    elif largest >= LASERS.shortest_reach_m and int(at_largest.sum()) >= LASERS.repeated:
        report.derive(DerivedKind.RANGE_LARGEST, limit_m=0.99 * largest)
    else:
        return largest, ranges
    ranges[at_largest] = np.nan
    return largest, ranges


def _odometry(log: CarmenScans, report: ImportReport) -> Array | None:
    """Raw odometry of the laser; corrected logs have it only for the robot."""
    if log.laser is None or log.robot is None:
        report.derive(DerivedKind.ODOMETRY_MISSING)
        return None
    if not np.ptp(log.laser, axis=0).any() and not np.ptp(log.robot, axis=0).any():
        report.derive(DerivedKind.ODOMETRY_STILL)
        return None
    if log.message.encode() in REAR and np.array_equal(log.robot, log.laser):
        report.derive(DerivedKind.ODOMETRY_OF_REAR)
        return log.robot + np.array([0.0, 0.0, np.pi])
    mounted = between(log.robot, log.laser)
    mounted[:, 2] = np.unwrap(mounted[:, 2])
    if float(np.std(mounted, axis=0).max()) < LASERS.mounting_sd:
        return log.laser
    report.derive(DerivedKind.ODOMETRY_RAW)
    return log.robot


# -- bags


def _of_bags(
    paths: Sequence[Path], named: tuple[Named, Named], *, report: ImportReport
) -> tuple[LaserScans, LaserMount | None]:
    """Scans and mount of a laser, by what names the topics of laser and odometry."""
    files = [file for path in paths for file in bag_paths(path)]
    poses = SampleBatch(pose_row, join_poses, report)
    parts: list[LaserScans] = []
    walks: list[Trajectory] = []
    with Bag(files, report) as bag:
        topic = choose_topic(bag, named[0], LASER_KIND, report=report)
        odometry = choose_topic(bag, named[1], ODOMETRY_KIND, report=report)
        collector = ScanCollector(0, report, stamps=stamp_clock(bag, topic))
        mount = mount_of_bag(bag, topic, odometry, report=report)
        for message in bag.messages({topic, odometry} - {""}):
            report.count("messages")
            content = bag.decode(message)
            if content is None:
                continue
            if message.topic == topic:
                parts += collector.push(message, content)
            else:
                walks += poses.push(message, content)
    parts += collector.flush()
    walks += poses.flush()
    if not parts:
        why = "" if topic else "".join(f"; {text}" for text in report.said())
        raise EmptyRecording(
            CodedText(
                "laser-no-scan-of",
                name=paths[0].name,
                topic=topic or CodedText("laser-any"),
                why=why,
            )
        )
    out_of_order = report.counts["scans_out_of_order"]
    if out_of_order:
        report.warn(FindingKind.SCANS_LATE, where=topic, scans=out_of_order)
    scans = joined_scans(parts)
    return replace(scans, odometry=_at_scans(scans, walks, report)), mount


def _at_scans(scans: LaserScans, walks: Sequence[Trajectory], report: ImportReport) -> Array | None:
    """Odometry of a bag at the times of the scans; None = there is none for all of them."""
    if not walks:
        report.derive(DerivedKind.ODOMETRY_MISSING)
        return None
    t_ns = np.concatenate([walk.t_ns for walk in walks])
    pose = np.concatenate([from_se3(walk.T_a_b) for walk in walks])
    first = np.concatenate([[True], np.diff(np.maximum.accumulate(t_ns)) > 0])
    t_ns, pose = t_ns[first], pose[first]
    if len(pose) > 1 and not np.ptp(pose, axis=0).any():
        report.derive(DerivedKind.ODOMETRY_STILL)
        return None
    slack_ns = 500_000_000
    if scans.t_ns[0] < t_ns[0] - slack_ns or scans.t_ns[-1] > t_ns[-1] + slack_ns:
        report.warn(FindingKind.ODOMETRY_SHORT)
        return None
    since = (scans.t_ns - t_ns[0]) / 1e9
    known = (t_ns - t_ns[0]) / 1e9
    yaw = np.interp(since, known, np.unwrap(pose[:, 2]))
    columns = [np.interp(since, known, pose[:, 0]), np.interp(since, known, pose[:, 1]), yaw]
    return np.stack(columns, axis=1)
