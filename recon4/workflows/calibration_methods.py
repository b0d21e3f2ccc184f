"""The ways to calibrate a rig, as ``recon4 calibrate --method`` selects them (requirements A2)."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np

from recon4.calibration.calibrate import calibrated_parameters, reference_of
from recon4.calibration.entropy import calibrate_by_entropy
from recon4.calibration.floors import find_inclinations, read_inclinations
from recon4.calibration.gravity_alignment import align_gravity
from recon4.calibration.line_entropy import (
    calibrate_profiler,
    profiler_parameters,
    profiler_walk,
)
from recon4.calibration.map_alignment import align_maps, with_mount
from recon4.calibration.parameters import Parameter
from recon4.calibration.pose_pairs import (
    PairAlignment,
    average_pairs,
    hand_eye,
    read_pose_pairs,
)
from recon4.calibration.recorded_walk import RecordedWalk
from recon4.calibration.slices import slice_points
from recon4.calibration.trajectory_pair import align_trajectories
from recon4.calibration.tuning import CalibrationTuning, EntropyTuning
from recon4.errors import CalibrationError, ConfigError
from recon4.geometry.se3 import SE3, Array
from recon4.locales.coded import CodedText
from recon4.model.calibration_figures import CalibrationFigures
from recon4.model.rig import Rig
from recon4.pipeline import calibrate_recording, track_lines
from recon4.progress import Progress
from recon4.recording.formats.poses import read_tum
from recon4.recording.sources import Sources
from recon4.report.calibration_page import CalibrationPage, CloudSlice
from recon4.report.rig import RigRow, change_text, parameter_rows, rig_outcome
from recon4.report.tuning import CALIBRATION_PAGE
from recon4.settings import Settings, override, preset
from recon4.settings.reads import CalibrationReads, part_of
from recon4.settings.tuning import tuned
from recon4.store.frames import FrameStore
from recon4.store.project import is_project, read_artifacts


@dataclass(frozen=True, slots=True, eq=False)
class MethodResult:
    """Result of a calibration method: a rig, or why there is none."""

    rig: Rig | None
    """None = nothing to write."""
    outcome: str
    rows: tuple[RigRow, ...] = ()
    """Parameters with their changes."""
    report_lines: tuple[str, ...] = ()
    """What else the method found, in sentences."""
    figures: CalibrationFigures | None = None
    """Of the method joint."""


@dataclass(frozen=True, slots=True)
class _Task:
    """What a method is given."""

    sources: Sources
    """The recording and its rig."""
    folder: Path
    """Project folder for multiframes and odometry."""
    sensors: str
    """Names of the sensors to calibrate; empty = all."""
    beams: bool
    """Whether single beams are calibrated, too."""
    progress: Progress


@dataclass(frozen=True, slots=True)
class CalibrationChoice:
    """What is calibrated, and how."""

    method: str = "joint"
    """``joint``, ``maps``, ``gravity``, ``entropy``, ``pairs`` or ``trajectories``."""
    sensors: str = ""
    """Names of the sensors to calibrate; empty = all."""
    beams: bool = False
    """Whether single beams are calibrated, too; by ``joint`` only."""


def check_choice(choice: CalibrationChoice) -> None:
    """Check the name of a method and what it can do.

    Raises:
        ConfigError: If there is no such method, or it does not calibrate beams.
    """
    method = choice.method
    if method not in _METHODS:
        raise ConfigError(
            CodedText("calibrate-method", method=method[:80], methods=", ".join(_METHODS))
        )
    if choice.beams and method != "joint":
        raise ConfigError(CodedText("calibrate-beams", method=method[:80]))


def calibrate_by(
    choice: CalibrationChoice, sources: Sources, folder: Path, *, progress: Progress
) -> MethodResult:
    """Calibrate a rig by one of the methods.

    Args:
        choice: The method, and what it calibrates.
        sources: The recording, or a CSV file for ``pairs`` and ``gravity``, two TUM files for
            ``trajectories``, and the rig.
        folder: Project folder for multiframes and odometry.
        progress: Who watches.

    Raises:
        ConfigError: If a sensor is not in the rig.
        CalibrationError: If the recording does not determine what the method estimates.
        Recon4Error: Whatever stops a stage.
    """
    check_choice(choice)
    method, rig = choice.method, sources.rig
    if method in _OF_LIDARS and rig is not None and rig.row_of("profiler") is not None:
        raise ConfigError(CodedText("calibrate-lidars", method=method, rig=rig.name[:80]))
    task = _Task(sources, folder, choice.sensors, choice.beams, progress)
    return _METHODS[method](task)


def calibration_report(
    method: str, found: MethodResult, sources: Sources, *, folder: Path
) -> CalibrationPage:
    """The page about a result, with a slice before and after if there is a recording.

    Args:
        method: As `calibrate_by`.
        found: Its result.
        sources: The recording and the rig.
        folder: The project folder that `calibrate_by` used.

    Raises:
        StoreError: If its artifacts are damaged.
    """
    assert sources.rig is not None
    slices = []
    if found.rig is not None and is_project(folder):
        walk = _recorded(folder)
        for name, rig in (("rig file", sources.rig), ("calibrated", found.rig)):
            points = slice_points(walk, rig, thickness_m=CALIBRATION_PAGE.thickness_m)
            slices.append(CloudSlice(name, tuple(points)))
    return CalibrationPage(
        title=sources.rig.name,
        method=method,
        outcome=found.outcome,
        figures=found.figures,
        rows=found.rows,
        report_lines=() if found.figures else found.report_lines,
        slices=slices,
    )


def _joint(task: _Task) -> MethodResult:
    chosen = _settings(
        f"calibration.sensors={task.sensors}",
        "calibration.mode=auto",
        f"calibration.beams={str(task.beams).lower()}",
    )
    figures, rig = calibrate_recording(
        task.sources, task.folder, settings=chosen, progress=task.progress
    )
    rows = parameter_rows((*figures.parameters, *figures.beams))
    return MethodResult(rig, rig_outcome(figures), tuple(rows), figures=figures)


def _maps(task: _Task) -> MethodResult:
    walk, chosen = _walk(task)
    rig = walk.frames.rig
    reference = _reference(rig, chosen)
    parameters = calibrated_parameters(
        rig, reference=reference, with_imu=False, settings=chosen.calibration
    )
    report_lines: list[str] = []
    reads = part_of(chosen, CalibrationReads)
    for row in parameters.lidars:
        found = align_maps(walk, walk.frames.rig, row, reference=reference, settings=reads)
        if found is None:
            raise CalibrationError(
                CodedText(
                    "calibrate-maps",
                    sensor=rig.sensors[reference].name,
                    other=rig.sensors[row].name,
                )
            )
        if not found.agrees:
            raise CalibrationError(
                CodedText(
                    "calibrate-windows",
                    sensors=rig.sensors[row].name,
                    windows=found.windows,
                    scatter_deg=float(np.rad2deg(found.scatter_rad)),
                    scatter_cm=100 * found.scatter_m,
                )
            )
        rig = with_mount(rig, row, found.T_body_sensor)
        report_lines.append(
            CodedText(
                "calibrated-windows",
                sensor=rig.sensors[row].name,
                windows=found.windows,
                scatter_rad=found.scatter_rad,
                scatter_mm=1e3 * found.scatter_m,
            )
        )
    rows = _changes(parameters.listed, parameters.between(walk.frames.rig, rig))
    return MethodResult(rig, CodedText("calibrated-by-maps"), rows, tuple(report_lines))


def _profiler_entropy(task: _Task, walk: RecordedWalk) -> MethodResult:
    parameters = profiler_parameters(walk.frames.rig)
    points = profiler_walk(walk.frames, walk.trajectory)
    task.progress.start("calibration", 0, "evaluations")
    found = calibrate_profiler(points, parameters, progress=task.progress.advance)
    rows = _changes(parameters.listed, found.change)
    fewer = 1.0 - found.costs[-1]
    note = CodedText("calibrated-profiler", evaluations=len(found.costs), fewer=fewer)
    return MethodResult(found.rig, CodedText("calibrated-by-entropy"), rows, (note,))


def _entropy(task: _Task) -> MethodResult:
    walk, chosen = _walk(task)
    if walk.frames.rig.row_of("profiler") is not None:
        return _profiler_entropy(task, walk)
    rig, settings = walk.frames.rig, EntropyTuning()
    parameters = calibrated_parameters(
        rig, reference=_reference(rig, chosen), with_imu=False, settings=chosen.calibration
    )
    few = tuned(CalibrationTuning, chosen.calibration)
    windows = walk.windows(few.audit_windows, few.audit_window_s)
    if not windows or not len(parameters):
        raise CalibrationError(CodedText("calibrate-entropy"))
    task.progress.start("calibration", settings.evaluations, "evaluations")
    found = calibrate_by_entropy(
        windows, rig, parameters, settings=settings, progress=task.progress.advance
    )
    rows = _changes(parameters.listed, found.change)
    first, last = found.costs[0], found.costs[-1]
    cost = CodedText("calibrated-cost", first=first, last=last, evaluations=len(found.costs))
    return MethodResult(found.rig, CodedText("calibrated-by-entropy"), rows, (cost,))


def _gravity(task: _Task) -> MethodResult:
    assert task.sources.rig is not None
    if task.sources.recordings[0].suffix == ".csv":
        rig, pairs = task.sources.rig, read_inclinations(task.sources.recordings[0])
    else:
        walk, _ = _walk(task)
        rig, pairs = walk.frames.rig, find_inclinations(walk.frames, walk.frames.rig)
    if len(pairs) < 2:
        raise CalibrationError(CodedText("calibrate-gravity", count=len(pairs)))
    found = align_gravity(pairs.normal_body, pairs.force_imu)
    report_lines = tuple(
        CodedText("calibrated-inclination", number=k + 1, residual_rad=float(residual))
        for k, residual in enumerate(found.residual_rad)
    )
    if not found.heading_observable:
        return MethodResult(None, CodedText("gravity-all-alike"), (), report_lines)
    turned = replace(rig, T_body_imu=SE3(found.R_body_imu, rig.T_body_imu.t))
    return MethodResult(turned, CodedText("calibrated-by-gravity"), (), report_lines)


def _pairs(task: _Task) -> MethodResult:
    assert task.sources.rig is not None
    rig, pairs = task.sources.rig, read_pose_pairs(task.sources.recordings[0])
    names = {sensor.name: row for row, sensor in enumerate(rig.sensors)}
    name = task.sensors or next(iter(names))
    if name not in names:
        raise ConfigError(CodedText("calibrate-sensor", names=", ".join(names), name=name[:80]))
    found = average_pairs(pairs)
    if found.contradictory:
        # Poses of two worlds: only their motions compare.
        found = hand_eye(pairs, before_m=rig.sensors[names[name]].T_body_sensor.t)
    report_lines: tuple[str, ...] = tuple(
        CodedText(
            "calibrated-pair", number=k + 1, turn_rad=float(turn), shift_mm=float(1e3 * shift)
        )
        for k, (turn, shift) in enumerate(zip(found.residual_rad, found.residual_m, strict=True))
    )
    if found.contradictory:
        return MethodResult(None, CodedText("pairs-contradictory"), (), report_lines)
    report_lines += _known_to(found)
    # The tracked marker is the body frame of the rig: T_marker_sensor is T_body_sensor.
    mounted = with_mount(rig, names[name], found.T_marker_sensor)
    outcome = CodedText("calibrated-by-pairs", sensor=name, count=len(found.residual_m))
    return MethodResult(mounted, outcome, (), report_lines)


def _known_to(found: PairAlignment) -> tuple[str, ...]:
    """What the pairs show of a mount, and what they do not."""
    x, y, z = 1e3 * found.sd_m
    known = CodedText("mount-known", sd_rad=float(found.sd_rad), x_mm=x, y_mm=y, z_mm=z)
    along = (", ".join(f"{part:+z.2f}" for part in direction) for direction in found.unknown)
    return known, *(CodedText("mount-not-observable", along=direction) for direction in along)


def _trajectories(task: _Task) -> MethodResult:
    rig, files = task.sources.rig, task.sources.recordings
    assert rig is not None
    if len(files) != 2:
        raise ConfigError(CodedText("calibrate-trajectories", count=len(files)))
    rows = {sensor.name: row for row, sensor in enumerate(rig.sensors)}
    names = task.sensors.split(",") if task.sensors else list(rows)[:2]
    if len(names) != 2 or not set(names) <= set(rows):
        raise ConfigError(
            CodedText("calibrate-sensors", rows=", ".join(rows), sensors=task.sensors)
        )
    first, second = (rig.sensors[rows[name]] for name in names)
    of_first, of_second = (read_tum(file) for file in files)
    found = align_trajectories(of_first, of_second)
    mounted = with_mount(rig, rows[second.name], first.T_body_sensor @ found.T_a_b)
    offset_s, rate = found.clock
    # What the first one's own clock is corrected by, where the second one's starts.
    late_s = (int(of_second.t_ns[0]) - int(of_first.t_ns[0])) / 1e9 + offset_s
    clocked = replace(
        mounted.sensors[rows[second.name]],
        time_offset_s=first.time_offset_s + offset_s + 1e-6 * first.clock_rate_ppm * late_s,
        clock_rate_ppm=first.clock_rate_ppm + 1e6 * rate,
    )
    sensors = [clocked if sensor.name == second.name else sensor for sensor in mounted.sensors]
    outcome = CodedText("calibrated-by-trajectories", second=second.name, first=first.name)
    return MethodResult(replace(mounted, sensors=tuple(sensors)), outcome, (), found.report_lines)


_METHODS: dict[str, Callable[[_Task], MethodResult]] = {
    "joint": _joint,
    "maps": _maps,
    "gravity": _gravity,
    "entropy": _entropy,
    "pairs": _pairs,
    "trajectories": _trajectories,
}


_OF_LIDARS = ("joint", "maps")
"""Methods that compare the LiDARs of a multiframe."""


def _settings(*assignments: str) -> Settings:
    return override(preset("indoor"), [text for text in assignments if not text.endswith("=")])


def _walk(task: _Task) -> tuple[RecordedWalk, Settings]:
    """The recording with its odometry; the stages run if they have not."""
    chosen = _settings(f"calibration.sensors={task.sensors}", "calibration.mode=off")
    rig = task.sources.rig
    if rig is not None and rig.row_of("profiler") is not None:
        track_lines(task.sources, task.folder, settings=Settings(), progress=task.progress)
    else:
        calibrate_recording(task.sources, task.folder, settings=chosen, progress=task.progress)
    return _recorded(task.folder), chosen


def _recorded(folder: Path) -> RecordedWalk:
    made = read_artifacts(folder)
    frames = FrameStore.open(made["frames"])
    return RecordedWalk.of(frames, made["odometry"], Settings().odometry)


def _reference(rig: Rig, settings: Settings) -> int:
    reference = reference_of(rig, settings.calibration)
    if reference is None:
        raise CalibrationError(CodedText("calibrate-no-lidar"))
    return reference


def _changes(listed: tuple[Parameter, ...], change: Array) -> tuple[RigRow, ...]:
    pairs = zip(listed, change, strict=True)
    return tuple(RigRow(one.name, change_text(value, None, one.unit), "") for one, value in pairs)
