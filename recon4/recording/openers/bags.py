"""Openers of ROS bags: line scans of a profiler, clouds and packets of LiDARs."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

from recon4.model.rig import Rig
from recon4.recording.bags.recording import BagRecording, Given
from recon4.recording.formats.bags import Bag
from recon4.recording.info.files_near import COMPANION_SUFFIXES
from recon4.recording.kinds import bag_paths
from recon4.recording.lasers.line_recording import LineRecording
from recon4.recording.openers.request import OpenRequest, Recording
from recon4.recording.packets.companions import companions_of
from recon4.recording.report import ImportReport
from recon4.recording.rigs.mismatch import mismatch_text
from recon4.recording.rigs.profiler import profiler_rig


def open_line_bag(request: OpenRequest) -> Recording | None:
    """Line scans of a profiler, if the rig has one or the topics are those of the shipped rig."""
    files = _files(request)
    rig = _profiler_rig(files, request)
    if rig is None:
        return None
    bag = LineRecording(files, rig, report=request.report, settings=request.settings)
    return Recording(bag.rig, bag.read, bag.seconds)


def open_lidar_bag(request: OpenRequest) -> Recording:
    """Clouds or packets of LiDARs, in the topics that the rig or their contents name."""
    bag = BagRecording(
        _files(request),
        request.rig,
        settings=request.settings,
        report=request.report,
        given=Given(companions_of(request.paths), request.fields),
    )
    there = ", ".join(f"{one.label} {one.model}" for one in bag.streams)
    seen = mismatch_text(request.rig, there) if request.rig is not None else ""
    return Recording(bag.rig, bag.read, bag.seconds, seen=seen)


def _files(request: OpenRequest) -> list[Path]:
    recordings = [p for p in request.paths if p.suffix.lower() not in COMPANION_SUFFIXES]
    return [file for path in recordings for file in bag_paths(path)]


def _profiler_rig(files: Sequence[Path], request: OpenRequest) -> Rig | None:
    """The rig of a bag with line scans; None = it has none."""
    with Bag(files, ImportReport()) as bag:
        return profiler_rig(bag, request.rig, request.report)
