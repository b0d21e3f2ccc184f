"""Settings of tests with other tuning than that of the product."""

from dataclasses import replace
from functools import partial

from recon4.calibration.tuning import CalibrationTuning
from recon4.georeference.tuning import GnssTuning
from recon4.intensity.tuning import IntensityTuning
from recon4.pose_graph.tuning import (
    GraphTuning,
    RecognitionTuning,
    VerificationTuning,
    graph_tuning,
)
from recon4.profiler.tuning import LineTuning
from recon4.recording.tuning import IngestTuning
from recon4.registration.tuning import OdometryTuning, RegistrationTuning, registration_tuning
from recon4.semi_rigid.tuning import RefineTuning
from recon4.settings import Settings
from recon4.settings.tuning import tuned
from recon4.slam2d.tuning import Grid2dTuning, Loop2dTuning, Slam2dTuning

RECORDS = {
    "ingest": IngestTuning,
    "odometry": OdometryTuning,
    "recognition": RecognitionTuning,
    "verification": VerificationTuning,
    "refine": RefineTuning,
    "lines": LineTuning,
    "gnss": GnssTuning,
    "intensity": IntensityTuning,
    "calibration": CalibrationTuning,
    "slam2d": Slam2dTuning,
    "loops2d": Loop2dTuning,
    "grid2d": Grid2dTuning,
}


COMPLETE_RECORDS = {**RECORDS, "graph": GraphTuning, "registration": RegistrationTuning}
COMPLETED = {"graph": graph_tuning, "registration": registration_tuning}


def with_tuning(settings: Settings, *assignments: str) -> Settings:
    """The settings with values ``group.name=value`` of settings or tuning."""
    for text in assignments:
        path, _, value = text.partition("=")
        group, _, name = path.partition(".")
        given = getattr(settings, group)
        complete = COMPLETED.get(group, partial(tuned, RECORDS.get(group, type(given))))
        record = complete(given)
        kind = type(getattr(record, name))
        read = value == "true" if kind is bool else kind(value)
        settings = replace(settings, **{group: replace(record, **{name: read})})
    return settings
