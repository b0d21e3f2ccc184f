"""The stage ``calibration``: compare the rig with the recording and, if requested, calibrate it."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import msgspec
import numpy as np
from numpy.typing import NDArray

from recon4.calibration.antenna import with_antenna
from recon4.calibration.calibrate import (
    Calibration,
    audit,
    calibrate,
    chosen_lidars,
    reference_of,
)
from recon4.calibration.calibrate import calibrated_parameters as parameters_of
from recon4.calibration.joint import JointEstimate
from recon4.calibration.judgment import judge, scatter_of, split_beams
from recon4.calibration.mount_search import exchanged_mount
from recon4.calibration.parameters import Parameters
from recon4.calibration.recorded_walk import RecordedWalk
from recon4.calibration.result import CalibrationResult
from recon4.calibration.rig_file_note import calibration_note
from recon4.calibration.slices import lidar_slices
from recon4.calibration.start import Start, find_start
from recon4.calibration.tuning_joint import BEAMS
from recon4.calibration.tuning_methods import CALIBRATION_STAGE
from recon4.geometry.distinct import distinct
from recon4.model.beams import BEAMS_OF_MODEL
from recon4.model.calibration_figures import (
    CalibrationFigures,
    CalibrationOutcome,
    ParameterFigures,
    RigOutcome,
)
from recon4.model.frames import RecordedFrames
from recon4.model.odometry_figures import ImuFault
from recon4.model.rig import Rig
from recon4.progress import Progress
from recon4.settings.reads import CalibrationReads
from recon4.store.frames import FrameStore


def run_calibration(
    frames: FrameStore, odometry: Path, *, settings: CalibrationReads, progress: Progress
) -> CalibrationResult:
    """Compare the rig of a recording with what its sensors measured.

    Args:
        frames: The multiframes with their rig and IMU.
        odometry: Folder of the stage ``odometry``.
        settings: Uses calibration, those of the odometry, and graph.
        progress: Counts rounds; a rig that is off is an event.
    """
    if settings.calibration.mode == "off":
        return CalibrationResult(figures=_of(RigOutcome.OFF))
    walk = RecordedWalk.of(frames, odometry, settings.odometry)
    reference = reference_of(frames.rig, settings.calibration)
    if reference is None:
        return CalibrationResult(figures=_of(RigOutcome.NO_LIDAR))
    start = find_start(walk, reference=reference, settings=settings)
    parameters = parameters_of(
        frames.rig, reference=reference, with_imu=start.imu_usable, settings=settings.calibration
    )
    found = _audit(walk, start, parameters, settings=settings, progress=progress)
    if settings.calibration.mode == "auto" and not found.figures.changes:
        begin, parameters = _to_calibrate(walk, found, parameters, settings=settings)
        calibrated = begin and calibrate(
            walk, begin, parameters, settings=settings, progress=progress
        )
        if calibrated:
            found = _calibrated(found, calibrated, recorded_ns=walk.start_ns)
    found = with_antenna(found, walk, settings=settings, progress=progress)
    if found.rig is not None:
        found = replace(found, slices=lidar_slices(walk, found.rig))
    return found


def _audit(
    walk: RecordedWalk,
    start: Start,
    parameters: Parameters,
    *,
    settings: CalibrationReads,
    progress: Progress,
) -> CalibrationResult:
    if not len(parameters):
        return _nothing(RigOutcome.NOTHING_TO_COMPARE, start.faults)
    estimate = audit(walk, start.rig, parameters, settings=settings, progress=progress)
    if estimate is None:
        return _nothing(RigOutcome.NO_PLANES, start.faults)
    rows, exchanged = judge(estimate), _exchanged(walk.frames.rig, estimate)
    changes = estimate.changes and not exchanged
    # Of a rig that changes no parameter has one value.
    figures = CalibrationFigures(
        parameters=rows,
        windows=len(estimate.fits),
        rms_m=estimate.rms_m,
        imu_faults=start.faults,
        exchanged=exchanged,
        scatter=scatter_of(estimate) if changes else None,
        changes=changes,
    )
    outcome = RigOutcome.CONTRADICTS if figures.contradicts else _consistent(rows)
    figures = msgspec.structs.replace(figures, outcome=CalibrationOutcome(rig=outcome))
    return CalibrationResult(figures=figures, begin=estimate.rig)


def _to_calibrate(
    walk: RecordedWalk,
    audited: CalibrationResult,
    parameters: Parameters,
    *,
    settings: CalibrationReads,
) -> tuple[Rig | None, Parameters]:
    """Where a calibration begins, None = there is none, and what it estimates."""
    rig = walk.frames.rig
    if not settings.calibration.beams:
        return (audited.begin if audited.figures.contradicts else None), parameters
    counts = beam_counts(walk.frames, chosen_lidars(rig, settings.calibration))
    if not counts:
        return (audited.begin if audited.figures.contradicts else None), parameters
    return audited.begin or rig, parameters.with_beams(rig, counts)


def _of(outcome: RigOutcome) -> CalibrationFigures:
    return CalibrationFigures(outcome=CalibrationOutcome(rig=outcome))


def _nothing(outcome: RigOutcome, faults: tuple[ImuFault, ...]) -> CalibrationResult:
    return CalibrationResult(figures=msgspec.structs.replace(_of(outcome), imu_faults=faults))


def _exchanged(rig: Rig, found: JointEstimate) -> tuple[tuple[str, str], ...]:
    """Whether two LiDARs have each other's mount in the rig file."""
    reference = found.parameters.reference
    pairs = []
    for row in found.parameters.lidars:
        there = found.rig.sensors[row].T_body_sensor
        apart = exchanged_mount(rig, row, reference).inverse() @ there
        moved = rig.sensors[row].T_body_sensor.inverse() @ there
        if (
            apart.angle() < CALIBRATION_STAGE.same_rad < moved.angle()
            and np.linalg.norm(apart.t) < CALIBRATION_STAGE.same_m
        ):
            pairs.append((rig.sensors[reference].name, rig.sensors[row].name))
    return tuple(pairs)


def _consistent(rows: tuple[ParameterFigures, ...]) -> RigOutcome:
    unobserved = all(row.status == "not observable" for row in rows)
    return RigOutcome.UNOBSERVED if unobserved else RigOutcome.AGREES


def _calibrated(
    audited: CalibrationResult, found: Calibration, *, recorded_ns: int
) -> CalibrationResult:
    """What follows from a calibration; where it must not be used, the audit's findings stand."""
    mounts, beams = split_beams(found.rows)
    if found.refusal:
        figures = msgspec.structs.replace(audited.figures, outcome=found.refusal, beams=beams)
        return replace(audited, figures=figures, before=found.before, after=found.after)
    figures = CalibrationFigures(
        parameters=mounts,
        beams=beams,
        windows=len(found.estimate.fits),
        rms_m=found.estimate.rms_m,
        applied=True,
        outcome=CalibrationOutcome(rig=RigOutcome.CALIBRATED),
        imu_faults=audited.figures.imu_faults,
    )
    note = calibration_note("joint", figures, recorded_ns=recorded_ns)
    rig = replace(found.estimate.rig, calibration=note)
    return CalibrationResult(figures=figures, rig=rig, before=found.before, after=found.after)


def beam_counts(frames: RecordedFrames, rows: tuple[int, ...]) -> dict[int, int]:
    """Number of beams of each LiDAR that has rings of single beams, by its row.

    Bands of elevation in place of rings, and clouds in another frame, are left out.

    Args:
        frames: The multiframes.
        rows: LiDARs that are looked at.
    """
    sampled = np.unique(np.linspace(0, len(frames) - 1, BEAMS.sampled).astype(int)).tolist()
    found = {}
    for row in rows:
        parts = [(frames[k].xyz, frames[k].ring, frames[k].sensor == row) for k in sampled]
        xyz = np.concatenate([p[mine] for p, _, mine in parts])
        ring = np.concatenate([of_point[mine] for _, of_point, mine in parts])
        if not len(ring):
            continue
        count = BEAMS_OF_MODEL.get(frames.rig.sensors[row].model, int(ring.max()) + 1)
        if count <= BEAMS.most and ring.max() < count and _are_cones(xyz, ring):
            found[row] = count
    return found


def _are_cones(xyz: NDArray[np.float32], ring: NDArray[np.uint8]) -> bool:
    elevation = np.arctan2(xyz[:, 2], np.hypot(xyz[:, 0], xyz[:, 1]))
    parts = (elevation[ring == one] for one in distinct(ring))
    spread = [np.median(np.abs(part - np.median(part))) for part in parts]
    return bool(np.median(spread) < BEAMS.max_spread_rad)
