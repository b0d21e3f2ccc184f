"""Which groups of settings each stage reads: one record per stage.

A stage is given its record, made from all settings by `part_of`. What is not in it the stage cannot
read, and the key of its artifact does not depend on it.
"""

from __future__ import annotations

from dataclasses import dataclass, field, fields, is_dataclass
from typing import TypeVar

from recon4.settings.calibration import CalibrationSettings, RigSettings
from recon4.settings.georeference import GnssSettings, LevelSettings
from recon4.settings.graph import GraphSettings, RecognitionSettings, VerificationSettings
from recon4.settings.ingest import IngestSettings
from recon4.settings.intensity import IntensitySettings
from recon4.settings.lines import LineSettings
from recon4.settings.mapping import MapSettings
from recon4.settings.odometry import OdometrySettings
from recon4.settings.refine import RefineSettings
from recon4.settings.registration import RegistrationSettings
from recon4.settings.slam2d import Grid2dSettings, Loop2dSettings, Slam2dSettings

Reads = TypeVar("Reads")
"""What a stage reads."""


@dataclass(frozen=True, kw_only=True)
class ReadsNothing:
    """A stage without settings."""


@dataclass(frozen=True, kw_only=True)
class ImportReads:
    """Stages ``frames`` and ``scans_2d``."""

    ingest: IngestSettings


@dataclass(frozen=True, kw_only=True)
class OdometryReads:
    """Stage ``odometry`` of LiDARs, and whatever tracks a walk."""

    registration: RegistrationSettings
    odometry: OdometrySettings


@dataclass(frozen=True, kw_only=True)
class CalibrationReads(OdometryReads):
    """Stage ``calibration``."""

    calibration: CalibrationSettings
    graph: GraphSettings
    gnss: GnssSettings


@dataclass(frozen=True, kw_only=True)
class GraphReads(OdometryReads):
    """Stage ``graph`` of LiDARs."""

    graph: GraphSettings
    recognition: RecognitionSettings


@dataclass(frozen=True, kw_only=True)
class VerificationReads:
    """Stages ``verification`` and ``review``."""

    verification: VerificationSettings
    graph: GraphSettings


@dataclass(frozen=True, kw_only=True)
class RefineReads:
    """Stage ``refine`` of LiDARs."""

    odometry: OdometrySettings
    graph: GraphSettings
    refine: RefineSettings


@dataclass(frozen=True, kw_only=True)
class LevelReads:
    """Stage ``level``."""

    level: LevelSettings
    gnss: GnssSettings
    verification: VerificationSettings


@dataclass(frozen=True, kw_only=True)
class IntensityReads:
    """Stage ``intensity``."""

    intensity: IntensitySettings


@dataclass(frozen=True, kw_only=True)
class MapReads:
    """Stage ``map``."""

    map: MapSettings


@dataclass(frozen=True, kw_only=True)
class AuditReads:
    """Stage ``audit`` of 3-D maps."""

    gnss: GnssSettings = field(default_factory=GnssSettings)
    rig: RigSettings = field(default_factory=RigSettings)


@dataclass(frozen=True, kw_only=True)
class Odometry2dReads:
    """Stage ``odometry_2d``."""

    slam2d: Slam2dSettings


@dataclass(frozen=True, kw_only=True)
class Graph2dReads(Odometry2dReads):
    """Stage ``graph_2d``."""

    loops2d: Loop2dSettings


@dataclass(frozen=True, kw_only=True)
class Map2dReads(Odometry2dReads):
    """Stage ``map_2d``."""

    grid2d: Grid2dSettings


@dataclass(frozen=True, kw_only=True)
class Slam2dReads(Graph2dReads, Map2dReads):
    """All of 2-D SLAM."""

    verification: VerificationSettings


@dataclass(frozen=True, kw_only=True)
class LineOdometryReads(Slam2dReads):
    """Stage ``odometry`` of a profiler."""

    odometry: OdometrySettings
    lines: LineSettings


@dataclass(frozen=True, kw_only=True)
class LineGraphReads(OdometryReads):
    """Stage ``graph`` of a profiler: the turns of its head."""

    lines: LineSettings
    graph: GraphSettings


@dataclass(frozen=True, kw_only=True)
class LineRefineReads:
    """Stage ``refine`` of a profiler."""

    odometry: OdometrySettings
    lines: LineSettings


def groups_of(reads: type[object]) -> tuple[str, ...]:
    """Names of the groups that a record of this module has, sorted."""
    assert is_dataclass(reads)
    return tuple(sorted(field.name for field in fields(reads)))


def part_of(settings: object, reads: type[Reads]) -> Reads:
    """The part of all settings that a stage reads.

    Args:
        settings: All settings.
        reads: Record of the stage.
    """
    return reads(**{group: getattr(settings, group) for group in groups_of(reads)})
