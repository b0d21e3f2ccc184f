"""Mount and clock of a profiler by the sharpness of the map (requirements L-CAL-1).

A place is measured again only after a turn of the head, so the whole walk is one map, and there are
too few points to look for their neighbors: the entropy is that of order 0, the number of cubes with
a point, which Powell's method minimizes. The trajectory of IMU and 2-D laser stays as it is.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from scipy.optimize import minimize

from recon4.calibration.entropy import EntropyEstimate
from recon4.calibration.parameters import Parameters
from recon4.calibration.tuning_methods import LINE_ENTROPY
from recon4.geometry.cubes import count_cubes
from recon4.geometry.se3 import Array, so3_exp
from recon4.kernels.imu import place_points
from recon4.model.rig import Rig
from recon4.model.trajectory import Times, Trajectory
from recon4.store.frames import FrameStore

_UNIT = {"rad": np.deg2rad(0.25), "m": 0.01, "s": 0.003}
"""What Powell's method counts as one, for each kind of parameter."""
_SKEW = so3_exp(np.array([0.4, 0.7, 0.3]))
"""Turns the cubes: a tilt would bring a floor along their faces into one layer of them."""


@dataclass(frozen=True, slots=True, eq=False)
class ProfilerWalk:
    """Points of the line scans of a walk, in the frame of the profiler, and its trajectory."""

    t_ns: Times
    """Times by the clock of the recorded rig, increasing, (N,)."""
    p_sensor: Array
    """[m], (N, 3)."""
    trajectory: Trajectory
    """``T_map_body``, dense."""
    recorded: Rig
    """The rig whose clock offset is in the times."""


def profiler_walk(frames: FrameStore, trajectory: Trajectory) -> ProfilerWalk:
    """Some points of all line scans, without those of the carrier."""
    rig = frames.rig
    row = rig.row_of("profiler")
    assert row is not None
    every = max(1, frames.points // LINE_ENTROPY.points)
    times, points = [], []
    for frame in frames:
        rows = np.flatnonzero(frame.sensor == row)[frame.frame_id % every :: every]
        xyz = frame.xyz[rows].astype(np.float64)
        away = np.linalg.norm(xyz, axis=1) > LINE_ENTROPY.carrier_m
        times.append(frame.t_ns + frame.dt_ns[rows[away]].astype(np.int64))
        points.append(xyz[away])
    return ProfilerWalk(np.concatenate(times), np.concatenate(points), trajectory, rig)


def profiler_parameters(rig: Rig) -> Parameters:
    """Rotation, position and clock of the profiler; on a level floor its height stays as it is."""
    row = rig.row_of("profiler")
    assert row is not None
    listed = Parameters.of(rig, reference=rig.row_of("laser2d") or 0, lidars=(row,), imu=False)
    known = [p.quantity == "position" and p.axis == "z" for p in listed.listed]
    return listed.fixing(np.array(known))


def calibrate_profiler(
    walk: ProfilerWalk,
    parameters: Parameters,
    *,
    progress: Callable[[], None] = lambda: None,
) -> EntropyEstimate:
    """Minimize the number of cubes with a point.

    Args:
        walk: Some 100 000 points of the whole walk.
        parameters: Of `profiler_parameters`.
        progress: Called after each evaluation.
    """
    free = np.flatnonzero(parameters.prior_sd > 1e-6)
    unit = np.array([_UNIT[parameters.listed[k].unit] for k in free])
    lowest: list[float] = []
    found, converged = np.zeros(len(free)), True

    def change_of(x: Array) -> Array:
        change = np.zeros(len(parameters))
        change[free] = x * unit
        return change

    for cube_m in LINE_ENTROPY.cubes_m:
        before = occupied(walk, walk.recorded, cube_m=cube_m)

        def cost(x: Array, cube_m: float = cube_m, before: int = before) -> float:
            rig = parameters.changed(walk.recorded, change_of(x))
            value = occupied(walk, rig, cube_m=cube_m) / before
            lowest.append(value)
            progress()
            return value

        result = minimize(
            cost,
            found,
            method="Powell",
            options={"ftol": 1e-4, "xtol": 0.02, "maxfev": LINE_ENTROPY.evaluations},
        )
        found, converged = np.asarray(result.x, np.float64), bool(result.success)
    change = change_of(found)
    rig = parameters.changed(walk.recorded, change)
    return EntropyEstimate(rig, parameters, change, np.array(lowest), converged)


def occupied(walk: ProfilerWalk, rig: Rig, *, cube_m: float) -> int:
    """Number of cubes with a point, if the profiler is mounted as a rig says."""
    row = rig.row_of("profiler")
    assert row is not None
    sensor, recorded = rig.sensors[row], walk.recorded.sensors[row]
    later_s = sensor.time_offset_s - recorded.time_offset_s
    zero = int(walk.trajectory.t_ns[0])
    t_s = (walk.trajectory.t_ns - zero).astype(np.float64) * 1e-9
    at_s = (walk.t_ns - zero).astype(np.float64) * 1e-9
    inside = (at_s > LINE_ENTROPY.margin_s) & (at_s < t_s[-1] - LINE_ENTROPY.margin_s)
    T = walk.trajectory.T_a_b
    p_body = sensor.T_body_sensor @ walk.p_sensor[inside]
    p = place_points(t_s, T.R, T.t, at_s[inside] + later_s, np.ascontiguousarray(p_body))
    return count_cubes(p @ _SKEW, cube_m)
