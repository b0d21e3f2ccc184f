"""All settings of the pipeline, each declared once, one file per stage.

Code, command line, API and docs are generated from these declarations. A stage receives only its
own groups, so that a changed setting reruns only the stages that depend on it.
"""

from recon4.settings.assign import canonical, override, to_json, values_by_group
from recon4.settings.calibration import CalibrationSettings, RigSettings
from recon4.settings.georeference import GnssSettings, LevelSettings
from recon4.settings.graph import GraphSettings, RecognitionSettings, VerificationSettings
from recon4.settings.ingest import IngestSettings
from recon4.settings.intensity import IntensitySettings
from recon4.settings.lines import LineSettings
from recon4.settings.mapping import MapSettings
from recon4.settings.odometry import OdometrySettings
from recon4.settings.presets import PRESET_TEXTS, PRESETS, Settings, preset
from recon4.settings.refine import RefineSettings
from recon4.settings.registration import (
    RegistrationSettings,
)
from recon4.settings.renamed import changed_retired, current_values
from recon4.settings.slam2d import (
    Grid2dSettings,
    Loop2dSettings,
    Slam2dSettings,
)

__all__ = [
    "PRESETS",
    "PRESET_TEXTS",
    "CalibrationSettings",
    "GnssSettings",
    "GraphSettings",
    "Grid2dSettings",
    "IngestSettings",
    "IntensitySettings",
    "LevelSettings",
    "LineSettings",
    "Loop2dSettings",
    "MapSettings",
    "OdometrySettings",
    "RecognitionSettings",
    "RefineSettings",
    "RegistrationSettings",
    "RigSettings",
    "Settings",
    "Slam2dSettings",
    "VerificationSettings",
    "canonical",
    "changed_retired",
    "current_values",
    "override",
    "preset",
    "to_json",
    "values_by_group",
]
