"""What an opener is given, and the recording that it returns."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass
from pathlib import Path

from recon4.model.clock_jump import ClockJump
from recon4.model.laser_scans import LaserScans
from recon4.model.line_scans import LineScans
from recon4.model.multiframe import Multiframe
from recon4.model.point_recipes import PointRecipe
from recon4.model.rig import Rig
from recon4.model.samples import GnssSamples, ImuSamples
from recon4.model.trajectory import Trajectory
from recon4.recording.assembly.assembler import TimeGap
from recon4.recording.assembly.shots import Shots
from recon4.recording.assembly.tuning import ASSEMBLY
from recon4.recording.formats.pcap import OpenFile, open_plain
from recon4.recording.report import ImportReport
from recon4.settings import IngestSettings

Item = Shots | Multiframe | ImuSamples | GnssSamples | Trajectory | LineScans | LaserScans


@dataclass(frozen=True, slots=True)
class OpenRequest:
    """What is to be opened."""

    paths: tuple[Path, ...]
    """One recording, or several files of one kind that belong together."""
    rig: Rig | None
    """The rig that was given; None = the opener chooses one from what is in the recording."""
    settings: IngestSettings
    report: ImportReport
    """Receives what was found and detected."""
    open_file: OpenFile = open_plain
    """Opens capture files; a live capture uses a tail file."""
    fields: PointRecipe | None = None
    """What the columns of the points are, where no rig says it."""
    jumps: tuple[ClockJump, ...] = ()
    """Where all clocks were set ahead, as a first reading showed."""


@dataclass(frozen=True, slots=True)
class Recording:
    """A recording that can be streamed once."""

    rig: Rig
    read: Callable[[], Iterator[Item]]
    """Shots, which must be assembled, or multiframes of cloud files."""
    seconds: float = 0.0
    """Approximate duration [s]; 0 = unknown."""
    gaps: tuple[TimeGap, ...] = ()
    """Gaps known before reading."""
    wait_s: float = ASSEMBLY.wait_s
    """Largest lead of one sensor's shots over another's [s], see `Assembler`."""
    seen: str = ""
    """What it has against the rig that was given, for a reading without points; empty = nothing to
    say."""
    kind: str = ""
    """What it is, for people; empty = the kind of its files."""


Opener = Callable[[OpenRequest], Recording | None]
"""Opens recordings of one sensor family; None = the contents are not of this family.

Raises:
    RecordingError: If they are of this family and cannot be read.
    ConfigError: If the rig is wrong or cannot be chosen.
"""
