"""The stage ``calibration``: compare the rig with the recording and, if requested, calibrate it."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path

from recon4.calibration.calibrate import Agreement, Calibration, Walk, audit, calibrate
from recon4.calibration.calibrate import calibrated_parameters as parameters_of
from recon4.calibration.judgment import contradictions, judge
from recon4.calibration.parameters import Parameters
from recon4.calibration.rig_file import RIG_FILE
from recon4.model.events import Warned
from recon4.model.figures import CalibrationFigures, ParameterFigures
from recon4.model.frames import RecordedFrames
from recon4.model.plain import to_plain
from recon4.model.rig import Rig, format_rig
from recon4.model.samples import ImuSamples
from recon4.progress import Progress
from recon4.settings import Settings
from recon4.store.arrays import load_arrays, load_trajectory
from recon4.store.atomic import write_json


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class CalibrationResult:
    """What the stage found."""

    figures: CalibrationFigures
    rig: Rig | None = None
    """The calibrated rig, if it is used."""
    before: Agreement | None = None
    after: Agreement | None = None

    def save(self, out: Path) -> CalibrationFigures:
        """Write ``calibration.json`` and, if the calibrated rig is used, ``rig.toml``."""
        record = {"figures": self.figures, "before": self.before, "after": self.after}
        write_json(out / "calibration.json", to_plain(record))
        if self.rig is not None:
            (out / RIG_FILE).write_text(format_rig(self.rig), "utf-8")
        return self.figures


def run_calibration(
    frames: RecordedFrames, odometry: Path, *, settings: Settings, progress: Progress
) -> CalibrationResult:
    """Compare the rig of a recording with what its sensors measured.

    Args:
        frames: The multiframes with their rig and IMU.
        odometry: Folder of the stage ``odometry``.
        settings: Uses calibration, odometry and graph.
        progress: Counts rounds; a rig that is off is an event.
    """
    if settings.calibration.mode == "off":
        return CalibrationResult(figures=CalibrationFigures(outcome="switched off"))
    with_imu = _usable(frames.imu) and settings.odometry.use_imu
    parameters = parameters_of(frames.rig, with_imu=with_imu, settings=settings.calibration)
    if parameters is None:
        text = "one LiDAR without an IMU: nothing to compare"
        return CalibrationResult(figures=CalibrationFigures(outcome=text))
    lost = load_arrays(odometry / "steps.npz", ["lost"])["lost"].astype(bool)
    walk = Walk(frames, load_trajectory(odometry / "trajectory.npz"), lost)
    found = _audit(walk, parameters, settings=settings, progress=progress)
    if settings.calibration.mode == "auto" and found.figures.warnings:
        calibrated = calibrate(walk, parameters, settings=settings, progress=progress)
        if calibrated is not None:
            found = _applied(calibrated)
    for text in found.figures.warnings:
        progress.event(Warned(text=text))
    return found


def _audit(
    walk: Walk, parameters: Parameters, *, settings: Settings, progress: Progress
) -> CalibrationResult:
    estimate = audit(walk, parameters, settings=settings, progress=progress)
    if estimate is None:
        text = "no window of the walk has planes to compare"
        return CalibrationResult(figures=CalibrationFigures(outcome=text))
    rows = judge(estimate)
    warnings = contradictions(rows)
    outcome = "the rig file contradicts the recording" if warnings else _consistent(rows)
    return CalibrationResult(
        figures=CalibrationFigures(
            parameters=rows,
            windows=len(estimate.fits),
            rms_m=estimate.rms_m,
            outcome=outcome,
            warnings=warnings,
        )
    )


def _consistent(rows: tuple[ParameterFigures, ...]) -> str:
    unknown = sum(row.status == "not observable" for row in rows)
    text = "the rig file agrees with the recording"
    return f"{text}; {unknown} of {len(rows)} parameters are not observable" if unknown else text


def _applied(found: Calibration) -> CalibrationResult:
    applied = not found.refusal
    figures = CalibrationFigures(
        parameters=found.rows,
        windows=len(found.estimate.fits),
        rms_m=found.estimate.rms_m,
        applied=applied,
        outcome=found.refusal or "calibrated: windows that were not used confirm it",
        warnings=contradictions(found.rows, applied=applied),
    )
    rig = found.estimate.rig if applied else None
    return CalibrationResult(figures=figures, rig=rig, before=found.before, after=found.after)


def _usable(imu: ImuSamples | None) -> bool:
    return imu is not None and len(imu) > 1
