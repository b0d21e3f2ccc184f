"""All groups of settings together, and the presets."""

from __future__ import annotations

from dataclasses import dataclass, field

from recon4.errors import ConfigError
from recon4.locales.coded import CodedText
from recon4.settings.calibration import CalibrationSettings, RigSettings
from recon4.settings.georeference import GnssSettings, LevelSettings
from recon4.settings.graph import GraphSettings, RecognitionSettings, VerificationSettings
from recon4.settings.ingest import IngestSettings
from recon4.settings.intensity import IntensitySettings
from recon4.settings.lines import LineSettings
from recon4.settings.mapping import MapSettings
from recon4.settings.odometry import OdometrySettings
from recon4.settings.refine import RefineSettings
from recon4.settings.registration import (
    RegistrationSettings,
)
from recon4.settings.renamed import EARLIER_PRESETS
from recon4.settings.slam2d import (
    Grid2dSettings,
    Loop2dSettings,
    Slam2dSettings,
)


@dataclass(frozen=True, slots=True, kw_only=True)
class Settings:
    """All groups of settings. ``--set group.field=value`` changes one field of a preset."""

    ingest: IngestSettings = field(default_factory=IngestSettings)
    registration: RegistrationSettings = field(default_factory=RegistrationSettings)
    odometry: OdometrySettings = field(default_factory=OdometrySettings)
    calibration: CalibrationSettings = field(default_factory=CalibrationSettings)
    rig: RigSettings = field(default_factory=RigSettings)
    graph: GraphSettings = field(default_factory=GraphSettings)
    recognition: RecognitionSettings = field(default_factory=RecognitionSettings)
    verification: VerificationSettings = field(default_factory=VerificationSettings)
    refine: RefineSettings = field(default_factory=RefineSettings)
    lines: LineSettings = field(default_factory=LineSettings)
    level: LevelSettings = field(default_factory=LevelSettings)
    gnss: GnssSettings = field(default_factory=GnssSettings)
    intensity: IntensitySettings = field(default_factory=IntensitySettings)
    map: MapSettings = field(default_factory=MapSettings)
    slam2d: Slam2dSettings = field(default_factory=Slam2dSettings)
    loops2d: Loop2dSettings = field(default_factory=Loop2dSettings)
    grid2d: Grid2dSettings = field(default_factory=Grid2dSettings)


PRESET_TEXTS = {
    "indoor": "Rooms, corridors, staircases, halls",
    "outdoor": "Streets, squares, fields: voxels of 3 cm, ranges up to 100 m",
    "hector": "A 2-D laser, matched as hector_slam does; no loop closures",
    "wuerzburg": "A backpack with a profiler, by the methods of its publication",
    "thesis": "The algorithm of the 4RECON thesis as published",
}
"""Preset -> what it is for, in a line."""

PRESETS: dict[str, Settings] = {
    "indoor": Settings(),
    "outdoor": Settings(
        map=MapSettings(voxel_m=0.03, max_range_m=100.0, tile_m=20.0, normal_cell_m=0.15)
    ),
    "hector": Settings(
        slam2d=Slam2dSettings(method="hector", use_odometry=False, min_range_m=0.4),
        loops2d=Loop2dSettings(enabled=False),
        verification=VerificationSettings(robust="none"),
    ),
    "wuerzburg": Settings(
        slam2d=Slam2dSettings(method="hector", use_odometry=False, min_range_m=0.4),
        loops2d=Loop2dSettings(enabled=False),
        lines=LineSettings(method="published"),
        verification=VerificationSettings(robust="none"),
    ),
    "thesis": Settings(
        calibration=CalibrationSettings(mode="off"),
        registration=RegistrationSettings(solver="svd"),
        odometry=OdometrySettings(
            use_imu=False,
            use_gnss=False,
            history=1,
            history_mode="averaged",
            leave_out_moving=False,
            line_sd_rad=0.02,
        ),
        graph=GraphSettings(
            mode="verification",
            pairs="published",
            exhaustive=True,
        ),
        recognition=RecognitionSettings(enabled=False),
        verification=VerificationSettings(robust="none"),
        gnss=GnssSettings(judge_edges=False),
        intensity=IntensitySettings(method="bins", min_contrast=0.0),
        map=MapSettings(surface="raw"),
    ),
}


def preset(name: str) -> Settings:
    """The settings of a preset.

    Raises:
        ConfigError: If there is no such preset.
    """
    name = EARLIER_PRESETS.get(name, name)
    if name not in PRESETS:
        raise ConfigError(
            CodedText("preset-unknown", name=f"{name!r}", known=", ".join(sorted(PRESETS)))
        )
    return PRESETS[name]
