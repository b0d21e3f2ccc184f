"""Recordings of a backpack with a profiler, as bags and as tables."""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import cache
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from recon4.geometry.se3 import Array
from recon4.model.laser_scans import LaserScans, joined_scans
from recon4.model.rig import Rig
from recon4.model.samples import ImuSamples
from recon4.model.trajectory import Trajectory
from recon4.simulation.backpack import (
    BackpackModels,
    BackpackSetup,
    measured_seconds,
    prepare_backpack,
)
from recon4.simulation.imu import simulate_imu
from recon4.simulation.profiler import Laser2dModel, ProfilerModel
from recon4.simulation.truth import true_trajectory
from tests.builders import bag_path
from tests.line_tables import laser_columns, line_columns, write_csv, write_npz
from tests.robot_bags import RobotBag
from tests.variants.messages import AnglesMessage, ImuMessage, ScanMessage
from tests.variants.variant import Draw, Variant

_MODELS = BackpackModels(
    profiler=ProfilerModel(lines_hz=60.0, shots=120),
    laser2d=Laser2dModel(scans_hz=10.0, beams=271, angle_step_rad=np.deg2rad(1.0)),
)
_LATE_NS = 5_000_000


@dataclass(frozen=True, slots=True, eq=False)
class LineWalk:
    """A walk with profiler, 2-D laser and IMU, with its truth."""

    lines: LaserScans
    intensity: NDArray[np.uint8]
    """(L, S)."""
    head_rad: Array
    """Angle of the head at each line, (L,)."""
    scans: LaserScans
    imu: ImuSamples
    rig: Rig
    truth: Trajectory
    """Of the body."""


@cache
def line_walk(seconds: float) -> LineWalk:
    """Simulate the walk."""
    setup = prepare_backpack("hall", seed=5, figure="circle", seconds=seconds, models=_MODELS)
    lines, scans = zip(*measured_seconds(setup), strict=True)
    t_ns = setup.epoch_ns + np.concatenate([part.t_ns for part in lines])
    model = setup.profiler.model
    laser = joined_scans([part for part in scans if part is not None])
    return LineWalk(
        LaserScans.of_rows(
            t_ns,
            np.concatenate([part.range_m for part in lines]),
            angles=(model.lowest_rad, (model.highest_rad - model.lowest_rad) / (model.shots - 1)),
            range_max_m=model.errors.max_range_m,
            time_step_s=setup.profiler.shot_s,
        ),
        np.concatenate([part.intensity for part in lines]),
        np.concatenate([part.head_rad for part in lines]),
        replace(laser, t_ns=laser.t_ns + setup.epoch_ns),
        _imu(setup),
        setup.rig,
        true_trajectory(setup.walk, epoch_ns=setup.epoch_ns),
    )


def _imu(setup: BackpackSetup) -> ImuSamples:
    return simulate_imu(
        setup.walk, setup.rig, setup.models.imu, epoch_ns=setup.epoch_ns, rng=setup.rng(2)
    )


def write_line_walk(draw: Draw, walk: LineWalk, folder: Path) -> Variant:
    """Draw and write a recording of a backpack with a profiler."""
    kind = draw.one("bag1", "db3", "mcap", "csv", "npz")
    variant = Variant(f"profiler, {kind}", rig=walk.rig)
    variant.points = int(np.isfinite(walk.lines.range_m).sum())
    variant.samples = len(walk.imu) - 6
    if kind in ("csv", "npz"):
        _write_tables(draw, walk, folder, variant, kind=kind)
        return variant
    variant.path = bag_path(folder, kind)
    with RobotBag(variant.path, kind) as bag:
        for t_ns, write in sorted(_messages(draw, walk, variant), key=lambda one: one[0]):
            write(bag, t_ns)
    return variant


# -- tables


def _write_tables(draw, walk, folder, variant, *, kind):
    variant.path = folder / "walk"
    variant.path.mkdir()
    write = {"csv": write_csv, "npz": write_npz}[kind]
    columns = line_columns(walk.lines, lambda t_ns: walk.head_rad)
    columns["intensity"] = walk.intensity.ravel()
    if draw.chance(0.5):
        variant.say("shots without a return left out")
        rows = np.isfinite(columns["range_m"])
        columns = {name: column[rows] for name, column in columns.items()}
    if draw.chance(0.3):
        variant.say("no intensities")
        del columns["intensity"]
    if draw.chance(0.3):
        variant.say("columns in another order")
        columns = dict(reversed(columns.items()))
    write(variant.path / f"lines.{kind}", columns)
    if draw.chance(0.8):
        write(variant.path / f"laser2d.{kind}", laser_columns(walk.scans))
    else:
        variant.say("no 2-D laser")
        variant.exact = False
    names = ("t_ns", "gx_rad_s", "gy_rad_s", "gz_rad_s", "ax_m_s2", "ay_m_s2", "az_m_s2")
    imu = [walk.imu.t_ns, *walk.imu.gyro_rad_s.T, *walk.imu.accel_m_s2.T]
    write_csv(variant.path / "imu.csv", dict(zip(names, imu, strict=True)))
    _damage_lines(draw, variant, variant.path / f"lines.{kind}")


def _damage_lines(draw, variant, path):
    if path.suffix != ".csv" or not draw.chance(0.4):
        return
    variant.say("damaged lines")
    lines = path.read_text().splitlines()
    for k in draw.rows(len(lines) - 2, 20):
        lines[k + 1] = draw.one("", "x", lines[k + 1][:12])
    path.write_text("\n".join(lines) + "\n")
    variant.points -= 20


# -- bags


def _messages(draw, walk, variant):
    topics = _topics(draw, walk, variant)
    scale = draw.one(1.0, 1.0, 1.0, 100.0, 1000.0)
    none = draw.one(np.inf, np.nan, 0.0)
    variant.say(f"no return = {none}, ranges times {scale:g}")
    lost = set(draw.rows(len(walk.lines) - 2, 4)) if draw.chance(0.3) else set()
    variant.say(f"{len(lost)} lines missing") if lost else None
    unstamped = set(draw.rows(len(walk.lines) - 2, 2)) if draw.chance(0.2) else set()
    variant.say("lines without stamps") if unstamped else None
    for k, t_ns in enumerate(walk.lines.t_ns.tolist()):
        if k in lost:
            variant.points -= int(np.isfinite(walk.lines.ranges(k)).sum())
            continue
        stamp_ns = 0 if k in unstamped else t_ns
        yield (
            t_ns + _LATE_NS,
            ScanMessage(topics["lines"], stamp_ns, walk.lines, k, none, scale, walk.intensity[k]),
        )
    yield from _angles(draw, walk, variant, topic=topics["head"])
    if draw.chance(0.85):
        for k, t_ns in enumerate(walk.scans.t_ns.tolist()):
            yield t_ns + _LATE_NS, ScanMessage(topics["scans"], t_ns, walk.scans, k, none)
    else:
        variant.say("no 2-D laser")
        variant.exact = False
    gyro, accel = walk.imu.gyro_rad_s, walk.imu.accel_m_s2
    if draw.chance(0.15):
        variant.say("IMU in g")
        accel = accel / 9.80665
    for k, t_ns in enumerate(walk.imu.t_ns.tolist()):
        yield t_ns + _LATE_NS, ImuMessage("/imu/data", "imu", t_ns, gyro[k], accel[k])


def _topics(draw, walk, variant):
    """Topics of the shipped rig, found without a rig file, or others that a rig file names."""
    if draw.chance(0.5):
        variant.say("no rig file")
        variant.rig = None
        return {"lines": "/profiler/line", "head": "/profiler/head", "scans": "/laser2d/scan"}
    topics = {"lines": "/riegl/scan", "head": "/joint_states", "scans": "/lms100"}
    laser, profiler = walk.rig.sensors
    sensors = (
        replace(laser, topic=topics["scans"]),
        replace(profiler, topic=topics["lines"], head_topic=topics["head"]),
    )
    variant.say("other topics")
    variant.rig = replace(walk.rig, sensors=sensors)
    return topics


def _angles(draw, walk, variant, *, topic):
    """Angles of the head; its encoder may be faster, or turn on without end."""
    how = draw.one("", "", "unwrapped", "some not a number", "some empty", "other joints behind")
    if how:
        variant.say(f"head {how}")
    angles = walk.head_rad + (4 * np.pi if how == "unwrapped" else 0.0)
    bad = set(draw.rows(len(angles) - 2, 3))
    for k, t_ns in enumerate(walk.lines.t_ns.tolist()):
        positions = [angles[k]]
        if k in bad and how.startswith("some"):
            positions = [np.nan] if "number" in how else []
        elif how == "other joints behind":
            positions = [angles[k], 0.3]
        yield t_ns + 1_000_000, AnglesMessage(topic, t_ns, tuple(positions))


def error_m(walk: LineWalk, found: Trajectory) -> float:
    """Largest horizontal distance of the body from the truth [m], aligned at the first pose."""
    rows = (found.t_ns >= walk.truth.t_ns[0]) & (found.t_ns <= walk.truth.t_ns[-1])
    true, made = walk.truth.at(found.t_ns[rows]), found.T_a_b[rows]
    off = (true[0].inverse() @ true).t - (made[0].inverse() @ made).t
    return float(np.hypot(off[:, 0], off[:, 1]).max())
