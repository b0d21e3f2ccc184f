"""Projects with an audited rig, written by the real writers."""

from __future__ import annotations

from dataclasses import replace
from functools import partial
from pathlib import Path
from typing import Any

import numpy as np

from recon4.calibration.held_out import Agreement
from recon4.calibration.result import CalibrationResult
from recon4.calibration.slices import LidarSlices
from recon4.geometry.se3 import SE3
from recon4.model.calibration_figures import (
    CalibrationFigures,
    CalibrationOutcome,
    ParameterFigures,
    RigOutcome,
)
from recon4.model.rig import Rig
from recon4.progress import Silent
from recon4.settings import Settings
from recon4.settings.reads import ReadsNothing
from recon4.store.frames import FrameWriter
from recon4.store.project import Project
from recon4.store.stage import Stage, StageContext, StageRunner
from tests.project_builder import build_project

TOML = """\
name = "field backpack"  # drawn by hand

[[sensor]]
name = "top"
model = "VLP-16"
xyz_m = [0.0, 0.0, 0.3]
rpy_deg = [1.0, 2.0, 3.0]

[[sensor]]
name = "back"
model = "HDL-32E"
address = "192.168.1.202"
xyz_m = [-0.12, 0.0, 0.1]
rpy_deg = [10.0, 90.0, 0.0]
"""


def _frames(context: StageContext, *, rig: Rig, **_: Any) -> None:
    with FrameWriter(context.out, rig):
        pass


def _parameters() -> tuple[ParameterFigures, ...]:
    """The vertical LiDAR is 1.36° off about y; the walk does not show the IMU's position."""
    rows = [
        ("vertical", "rotation", "x", "rad", 0.0004, 0.0003, "consistent"),
        ("vertical", "rotation", "y", "rad", 0.0237, 0.00035, "off"),
        ("vertical", "rotation", "z", "rad", -0.0002, 0.0003, "consistent"),
        ("vertical", "position", "x", "m", 0.0012, 0.0011, "consistent"),
        ("vertical", "position", "y", "m", -0.0008, 0.0009, "consistent"),
        ("vertical", "position", "z", "m", 0.0021, 0.0013, "consistent"),
        ("vertical", "clock", "", "s", 0.0001, 0.0002, "consistent"),
        ("imu", "position", "z", "m", 0.0, None, "not observable"),
    ]
    names = ("sensor", "quantity", "axis", "unit", "change", "sd", "status")
    return tuple(ParameterFigures(**dict(zip(names, row, strict=True))) for row in rows)


def _beams() -> tuple[ParameterFigures, ...]:
    """Two beams of the vertical LiDAR; the walk does not show the elevation of one."""
    rows = [
        ("beam range", "0", "m", 0.0035, 0.0002, "off"),
        ("beam range", "1", "m", -0.0012, 0.0003, "consistent"),
        ("beam elevation", "0", "rad", 0.0, None, "not observable"),
        ("beam elevation", "1", "rad", 0.0004, 0.0001, "off"),
        ("beam azimuth", "0", "rad", 0.0005, 0.00005, "off"),
        ("beam azimuth", "1", "rad", -0.0005, 0.00005, "off"),
    ]
    names = ("quantity", "axis", "unit", "change", "sd", "status")
    return tuple(
        ParameterFigures(sensor="vertical", **dict(zip(names, row, strict=True))) for row in rows
    )


def _calibration(context: StageContext, *, found: Rig | None, **_: Any) -> None:
    outcome = CalibrationOutcome(rig=RigOutcome.CALIBRATED if found else RigOutcome.CONTRADICTS)
    figures = CalibrationFigures(
        parameters=_parameters(),
        beams=_beams() if found else (),
        windows=8,
        rms_m=0.006,
        applied=found is not None,
        outcome=outcome,
    )
    before = Agreement(rms_m=0.0183, offset_m=0.0442, imu_rms=1.1)
    after = Agreement(rms_m=0.0061, offset_m=0.0012, imu_rms=float("nan"))
    pair = {"before": before, "after": after} if found else {}
    line = [[0.1 * k - 3.0, 2.0] for k in range(60)]
    slices = (
        LidarSlices(name="horizontal", before=line, after=line),
        LidarSlices(name="vertical", before=[[x, y + 0.3] for x, y in line], after=line),
    )
    CalibrationResult(figures=figures, rig=found, slices=slices, **pair).save(context.out)


def calibrated_project(root: Path, *, rig: Rig, found: Rig | None) -> None:
    """Make a project in an empty folder, with its audited rig.

    Args:
        root: Its folder.
        rig: Rig of the recording.
        found: The calibrated rig; None = it was only audited.
    """
    build_project(root, with_map=False)
    with Project.open(root) as project:
        runner = StageRunner(project, Settings(), Silent())
        runner.run(Stage("frames", 1, ReadsNothing, partial(_frames, rig=rig)))
        runner.run(Stage("calibration", 1, ReadsNothing, partial(_calibration, found=found)))


def tilted(rig: Rig) -> Rig:
    """The rig with its last sensor turned by 1.36° about y."""
    *others, last = rig.sensors
    turn = SE3.from_rpy(0.0, np.deg2rad(1.36), 0.0, t=[0.0, 0.0, 0.0])
    T = SE3(turn.R @ last.T_body_sensor.R, last.T_body_sensor.t)
    return replace(rig, sensors=(*others, replace(last, T_body_sensor=T)))
