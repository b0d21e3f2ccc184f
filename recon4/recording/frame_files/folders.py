"""Folders of point cloud files, one file per multiframe, and single cloud files."""

from __future__ import annotations

import re
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np

from recon4.errors import CorruptFile, EmptyRecording, RecordingError, UnknownFormat
from recon4.geometry.se3 import SE3
from recon4.locales.coded import CodedText, at, text_of
from recon4.model.derived import Derived
from recon4.model.derived_kinds import DerivedKind
from recon4.model.finding import Finding, Value
from recon4.model.finding_kinds import FindingKind
from recon4.model.multiframe import Multiframe
from recon4.model.point_recipes import PointRecipe
from recon4.model.rig import Sensor
from recon4.model.trajectory import Times, Trajectory
from recon4.recording.assembly.assembler import TimeGap, moved
from recon4.recording.assembly.range_limits import drop_invalid
from recon4.recording.assembly.shots import Shots
from recon4.recording.clocks.even_stamps import EvenStamps
from recon4.recording.clocks.tuning import FRAME_TIMES
from recon4.recording.clouds.cloud_points import CloudDecoder
from recon4.recording.formats.cloud_files import (
    CLOUD_SUFFIXES,
    Table,
    is_mesh,
    is_plausible_cloud,
    read_cloud,
)
from recon4.recording.formats.point_messages import POINTS
from recon4.recording.formats.three_dtk import POSE_SUFFIX, SCAN_SUFFIX, read_pose
from recon4.recording.frame_files.clock import FrameClock
from recon4.recording.frame_files.numbers import without_strangers
from recon4.recording.frame_files.times import first_words, frame_times
from recon4.recording.recipes.apply import as_points
from recon4.recording.report import ImportReport, warning
from recon4.recording.tuning import LISTED
from recon4.settings import IngestSettings


@dataclass(frozen=True, slots=True)
class FrameFiles:
    """Files in the order of their times."""

    files: tuple[Path, ...]
    t_ns: Times
    """Timestamps [ns], (N,)."""
    period_ns: int
    """Length of a frame [ns]."""
    times_from: str
    """Origin of the timestamps; empty = 10 Hz is assumed."""
    findings: tuple[Finding, ...] = ()
    """Why times that are there were not used, or which are damaged."""
    out_of_order: int = 0
    """How many files had an earlier time than one before them by number; they are sorted."""
    absent: int = 0
    """How many numbers the names lack; their time is left empty."""
    derived: tuple[Derived, ...] = ()
    """Which files are left out, and which numbers are missing."""
    clock: FrameClock | None = None
    """Where the clock of the times was set back."""

    @property
    def rate_hz(self) -> float:
        """Files a second by their times; NaN = unknown."""
        steps = np.diff(self.t_ns)
        usual = float(np.median(steps)) if len(steps) else 0.0
        return 1e9 / usual if usual > 0.0 else float("nan")

    @property
    def are_static(self) -> bool:
        """Whether they are scans of 3DTK, which have no motion inside."""
        return self.files[0].suffix.lower() == SCAN_SUFFIX


def natural(path: Path) -> list[tuple[int, int, str]]:
    """Key that sorts 8.pcd before 10.pcd."""
    parts = re.split(r"(\d+)", path.name)
    return [(0, int(p), "") if p.isdigit() else (1, 0, p) for p in parts if p]


def list_frames(path: Path) -> FrameFiles:
    """Find the frames of a folder, or take a single file as one frame.

    Raises:
        EmptyRecording: If there is no cloud file.
        UnknownFormat: If files of several kinds are mixed.
    """
    found = [path] if path.is_file() else sorted(_cloud_files(path), key=natural)
    if not found:
        raise EmptyRecording(
            CodedText("frames-none", file=path.name, cloud_suffixes=", ".join(CLOUD_SUFFIXES))
        )
    kinds = sorted({file.suffix.lower() for file in found})
    if len(kinds) > 1:
        raise UnknownFormat(CodedText("frames-mixed", file=path.name, kinds=", ".join(kinds)))
    numbered = without_strangers(found)
    found = list(numbered.files)
    times = frame_times(path, found)
    absent = times.absent
    derived = numbered.left_out + ((_absent(found, absent),) if absent else ())
    steps = np.diff(times.t_ns)
    period = int(np.median(steps)) if len(steps) else FRAME_TIMES.assumed_ns
    if not FRAME_TIMES.shortest_ns <= period <= FRAME_TIMES.longest_ns:
        period = FRAME_TIMES.assumed_ns
    if times.order is not None:
        found = [found[row] for row in times.order]
    return FrameFiles(
        tuple(found),
        times.t_ns,
        period,
        times.source,
        times.findings,
        times.out_of_order,
        absent,
        derived,
        times.clock,
    )


def _absent(files: Sequence[Path], absent: int) -> Derived:
    values: dict[str, Value] = {"absent": absent, "first": files[0].name, "last": files[-1].name}
    return Derived(kind=DerivedKind.FRAMES_ABSENT, values=values)


def time_warnings(frames: FrameFiles) -> tuple[Finding, ...]:
    """What the operator must know of the times; the shape of the map depends on them."""
    found = [*frames.findings, *_several_sensors(frames), *_set_back(frames)]
    if not frames.times_from and len(frames.files) > 1:
        rate_hz = 1e9 / FRAME_TIMES.assumed_ns
        found.append(warning(FindingKind.FRAMES_UNTIMED, rate_hz=rate_hz))
    return tuple(found)


def _several_sensors(frames: FrameFiles) -> Iterator[Finding]:
    """A finding if the names of the files seem to be those of several sensors."""
    starts = first_words(frames.files)
    if len(starts) > 1:
        some = ", ".join(repr(name) for name in starts[: LISTED.few])
        yield warning(FindingKind.FRAMES_MIXED, ways=len(starts), some=some)


def _set_back(frames: FrameFiles) -> Iterator[Finding]:
    """A finding for each time the clock was set back."""
    for step in frames.clock.steps if frames.clock else ():
        since_s = (step.t_ns - int(frames.t_ns[0])) / 1e9
        yield warning(
            FindingKind.CLOCK_BACK,
            sensor=frames.files[0].parent.name,
            start_s=since_s,
            end_s=since_s,
            seconds=step.back_ns / 1e9,
        )


def read_frames(
    frames: FrameFiles, sensor: Sensor, *, settings: IngestSettings, report: ImportReport
) -> Iterator[Multiframe | Trajectory]:
    """Read file by file; a damaged one is skipped, counted and reported.

    A pose beside a file follows it as `Trajectory`.

    Raises:
        RecordingError: If not one of the files can be read.
    """
    read_as = replace(settings, deskewed=True) if frames.are_static else settings
    decoder = CloudDecoder(0, sensor, report=report, points_lead=True, settings=read_as)
    _say_files(frames, report)
    later = frames.clock.shift_ns if frames.clock else np.zeros_like(frames.t_ns)
    frame_id, last_ns, failed = 0, None, None
    even = EvenStamps()
    stamps_ns = even.each(frames.t_ns + round(sensor.time_offset_s * 1e9))
    for file, stamp_ns, shift_ns in zip(frames.files, stamps_ns, later, strict=True):
        try:
            at_ns = stamp_ns - int(shift_ns)
            table = read_points(file, sensor.fields)
            shots = _shots(decoder, table, file.name, t_ns=at_ns, period_ns=frames.period_ns)
        except RecordingError as error:
            failed = error
            report.count("files_corrupt")
            report.outcome = "lossy"
            report.warn(FindingKind.FILE_LEFT_OUT, error=error)
            continue
        goes_on = decoder.absolute and _is_later(shots, last_ns, frames.period_ns)
        shots = shots if goes_on else moved(shots, int(shift_ns))
        if not decoder.absolute:
            shots, stamp_ns = _evened(shots, stamp_ns, even)
        start_ns = _start_ns(shots, stamp_ns, absolute=decoder.absolute)
        shots = drop_invalid(shots, settings=settings, report=report)
        if not len(shots):
            report.count("frames_empty")
            continue
        frame = _multiframe(shots, frame_id, start_ns, period_ns=frames.period_ns)
        if last_ns is not None and start_ns <= last_ns:
            report.count("frames_moved")
            report.warn(FindingKind.FRAMES_OVERLAP)
            frame = replace(frame, t_ns=last_ns + frames.period_ns)
        last_ns, frame_id = frame.t_ns, frame_id + 1
        yield frame
        pose = file.with_suffix(POSE_SUFFIX)
        if frames.are_static and pose.is_file():
            yield _pose_at(frame.t_ns, pose)
    even.say(frames.files[0].parent.name, report)
    if not frame_id and failed is not None:
        raise failed


def _say_files(frames: FrameFiles, report: ImportReport) -> None:
    for found in time_warnings(frames):
        report.add(found)
    report.count("files", len(frames.files))
    report.count("files_out_of_order", frames.out_of_order)
    report.count("files_absent", frames.absent)
    report.count("clock_jumps_back", len(frames.clock.steps) if frames.clock else 0)


def _evened(shots: Shots, stamp_ns: int, even: EvenStamps) -> tuple[Shots, int]:
    """A cloud and its stamp [ns] where even ones would be."""
    late_ns = even.late_ns(stamp_ns, shots.t_ns) if len(shots) else 0
    return moved(shots, -late_ns), stamp_ns - late_ns


def _start_ns(shots: Shots, stamp_ns: int, *, absolute: bool) -> int:
    """Begin of a cloud [ns]: its stamp, but for points that are earlier or have own times."""
    first_ns = int(shots.t_ns[0]) if len(shots) else stamp_ns
    return first_ns if absolute else min(first_ns, stamp_ns)


def _is_later(shots: Shots, last_ns: int | None, period_ns: int) -> bool:
    """Whether the own times of points go on, whatever the clock of the stamps does."""
    return not len(shots) or last_ns is None or int(shots.t_ns[0]) > last_ns + period_ns // 2


def frames_label(frames: FrameFiles) -> CodedText:
    """Description of the files, for example ``PCD files, times from times.txt``."""
    kind = frames.files[0].suffix[1:].upper()
    if not frames.times_from:
        return CodedText("content-files", kind=kind)
    return CodedText("content-files-timed", kind=kind, times=frames.times_from)


def folder_gaps(frames: FrameFiles, name: str, gap_s: float) -> list[TimeGap]:
    """Gaps between times that exceed the usual step by more than ``gap_s``, and clocks set back."""
    if len(frames.t_ns) < 2:
        return []
    steps = np.diff(frames.t_ns)
    usual = int(np.median(steps))
    gaps = [
        TimeGap(name, int(frames.t_ns[k]), float(steps[k]) / 1e9)
        for k in np.flatnonzero(steps > usual + gap_s * 1e9)
    ]
    back = frames.clock.steps if frames.clock else ()
    gaps += [TimeGap(name, step.t_ns, -step.back_ns / 1e9) for step in back]
    return sorted(gaps, key=lambda gap: gap.t_ns)


def read_points(file: Path, fields: PointRecipe | None) -> Table:
    """The points of a file; with a recipe in columns with common names.

    Raises:
        CorruptFile: If it is damaged, or lacks a column.
    """
    table = read_cloud(file)
    if fields is None:
        return table
    try:
        return as_points(fields, {POINTS: table})
    except CorruptFile as error:
        raise CorruptFile(at(file.name, text_of(error))) from error


def _shots(decoder: CloudDecoder, table: Table, name: str, *, t_ns: int, period_ns: int) -> Shots:
    try:
        return decoder.decode(table, t_ns=t_ns, period_ns=period_ns)
    except UnknownFormat as error:
        raise CorruptFile(at(name, text_of(error))) from error


def _multiframe(shots: Shots, frame_id: int, start_ns: int, *, period_ns: int) -> Multiframe:
    """The whole cloud as one multiframe."""
    return Multiframe(
        frame_id,
        start_ns,
        period_ns,
        shots.xyz,
        shots.intensity,
        shots.ring,
        np.zeros(len(shots), np.uint8),
        shots.echo,
        np.clip(shots.t_ns - start_ns, 0, 2**31 - 1).astype(np.int32),
    )


def _pose_at(t_ns: int, path: Path) -> Trajectory:
    T = read_pose(path)
    return Trajectory(np.array([t_ns]), SE3(T.R[None], T.t[None]))


def _cloud_files(folder: Path) -> list[Path]:
    found = [f for f in folder.iterdir() if f.suffix.lower() in CLOUD_SUFFIXES and f.is_file()]
    found = [f for f in found if not is_mesh(f)]
    # A damaged file among good ones must be counted: few endings need the content.
    return [f for f in found if is_plausible_cloud(f)]
