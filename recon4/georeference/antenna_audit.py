"""Audit of the GNSS receiver against the trajectory: lever arm of the antenna, and its clock.

A fix lies beside the antenna of the trajectory by an error of the lever arm, which turns with the
body, and by an error of the clock, which grows with the speed (`recon4.georeference.drift_fit`).
The attitudes of an INS lie beside those of the trajectory by the clock times the angular rate: in
the sway of the body a millisecond of it shows.

The audit of the antenna looks for small errors, by how fast the body moves. Seconds show in the
shape of the walk: where it begins, turns and stops.
"""

from __future__ import annotations

from typing import Literal

import numpy as np
from numpy.typing import NDArray

from recon4.geometry.se3 import SE3, Array, mean_rotation, so3_log
from recon4.georeference.crs import GeodeticOrigin, to_enu
from recon4.georeference.drift_fit import DriftFit, DriftRows, fit_drift
from recon4.georeference.gnss_priors import positioned
from recon4.georeference.ins_attitudes import attitudes
from recon4.georeference.tuning_clocks import ANTENNA_AUDIT, FIX_CLOCK
from recon4.model.figures import AntennaFigures
from recon4.model.rig import Rig
from recon4.model.samples import GnssQuality, GnssSamples
from recon4.model.trajectory import Times, Trajectory


def audit_antenna(
    trajectory: Trajectory, gnss: GnssSamples, rig: Rig, *, origin: GeodeticOrigin
) -> AntennaFigures | None:
    """Compare lever arm and clock of the rig file with the fixes.

    Args:
        trajectory: ``T_enu_body`` with x east, y north, z up, dense, without GNSS priors.
        gnss: The fixes; only those with decimeters or better are used.
        rig: Lever arm and time offset.
        origin: Of the local frame.

    Returns:
        What is to be added to the rig file's values, with standard deviations; None = too few
        fixes.
    """
    coarse_s = clock_s = _coarse_clock_s(trajectory, gnss, origin=origin)
    found = None
    for _ in range(1 + ANTENNA_AUDIT.relinearized):
        rows = _positions(trajectory, gnss, rig, origin=origin, clock_s=clock_s)
        if rows is None:
            break
        position = fit_drift(rows, drift=ANTENNA_AUDIT.drift_m)
        turned = _attitudes(trajectory, gnss, clock_s=clock_s)
        attitude = None if turned is None else fit_drift(turned, drift=ANTENNA_AUDIT.drift_rad)
        x, cov = _together(position, attitude)
        clock_s += float(x[3])
        found = x, cov, len(rows.t_s)
    if found is None or abs(clock_s - coarse_s) > ANTENNA_AUDIT.credible_s:
        return None
    x, cov, fixes = found
    sd = np.sqrt(np.diag(cov))
    return AntennaFigures(
        arm_m=_triple(x[:3]),
        arm_sd_m=_triple(sd[:3]),
        arm_sigmas=float(np.sqrt(x[:3] @ np.linalg.solve(cov[:3, :3], x[:3]))),
        clock_s=clock_s,
        clock_sd_s=float(sd[3]),
        fixes=fixes,
    )


def unexplained(
    trajectory: Trajectory, gnss: GnssSamples, rig: Rig, *, origin: GeodeticOrigin
) -> float:
    """What a drift does not explain of the fixes, normalized; infinite = too few fixes.

    Args:
        trajectory: As `audit_antenna`, and so are the others.
        gnss: The fixes.
        rig: Lever arm and time offset that are judged.
        origin: Of the local frame.
    """
    rows = _positions(trajectory, gnss, rig, origin=origin, clock_s=0.0)
    return np.inf if rows is None else fit_drift(rows, drift=ANTENNA_AUDIT.drift_m, fixed=True).rms


def turn_by_antenna(trajectory: Trajectory, found: AntennaFigures) -> float:
    """Turn about the vertical by which the error of an antenna bends a whole map [rad].

    Fixes that lie aside of the walk in one direction where it begins and in another where it ends
    turn the map that is fitted to them: by centimeters in meters, on a short walk.

    Args:
        trajectory: ``T_map_body`` with z up, at some times of the walk; at least two.
        found: The error of lever arm and clock.
    """
    T = trajectory.T_a_b
    speed_m_s = np.gradient(T.t, (trajectory.t_ns - trajectory.t_ns[0]) / 1e9, axis=0)
    aside = T.R @ np.array(found.arm_m) + found.clock_s * speed_m_s
    place, aside = T.t - T.t.mean(axis=0), aside - aside.mean(axis=0)
    turning = place[:, 0] * aside[:, 1] - place[:, 1] * aside[:, 0]
    spread = float((place[:, :2] ** 2).sum())
    return float(turning.sum()) / spread if spread > 0.0 else 0.0


AntennaDoubt = Literal["offset", "unchecked", "clock"]


def antenna_doubts(found: AntennaFigures) -> tuple[AntennaDoubt, ...]:
    """Whether the fixes contradict the lever arm and the clock, or could not check the arm.

    A horizontal lever arm that the walk cannot show is named, too: an error would move the map. Of
    the vertical one only the sway of a person tells; on a cart it must be measured with care.
    """
    doubts: list[AntennaDoubt] = []
    arm, sd = np.array(found.arm_m), np.array(found.arm_sd_m)
    if found.arm_sigmas > ANTENNA_AUDIT.sigmas and np.linalg.norm(arm) > ANTENNA_AUDIT.lever_arm_m:
        doubts.append("offset")
    elif sd[:2].max() > ANTENNA_AUDIT.unknown_m:
        doubts.append("unchecked")
    if abs(found.clock_s) > max(ANTENNA_AUDIT.sigmas * found.clock_sd_s, ANTENNA_AUDIT.clock_s):
        doubts.append("clock")
    return tuple(doubts)


def _coarse_clock_s(trajectory: Trajectory, gnss: GnssSamples, *, origin: GeodeticOrigin) -> float:
    """An error of the clock by seconds, as the shape of the walk shows it."""
    good = positioned(gnss) & (gnss.quality == GnssQuality.RTK_FIXED)
    p_enu = to_enu(
        origin, gnss.lat_rad[good], gnss.lon_rad[good], ellipsoidal_height_m=gnss.height_m[good]
    )
    return coarse_clock_s(trajectory, gnss.t_ns[good], p_enu[:, :2])


def _triple(v: Array) -> tuple[float, float, float]:
    x, y, z = v.tolist()
    return x, y, z


def _together(position: DriftFit, attitude: DriftFit | None) -> tuple[Array, Array]:
    """Lever arm and clock, (4,), and their covariance, (4, 4), from positions and attitudes.

    Attitudes that contradict the positions have another latency in the receiver: they are left out.
    """
    x, cov = position.x, ANTENNA_AUDIT.sd_factor**2 * position.cov
    if attitude is None:
        return x, cov
    clock_s, variance = float(attitude.x[3]), ANTENNA_AUDIT.sd_factor**2 * float(attitude.cov[3, 3])
    if abs(clock_s - x[3]) > ANTENNA_AUDIT.sigmas * np.sqrt(variance + cov[3, 3]):
        return x, cov
    gain = cov[:, 3] / (cov[3, 3] + variance)
    return x + gain * (clock_s - x[3]), cov - np.outer(gain, cov[3])


def _used(trajectory: Trajectory, gnss: GnssSamples, t_ns: Times) -> NDArray[np.bool_]:
    """Fixes with decimeters or better during the walk, (N,)."""
    sd_m = np.nan_to_num(gnss.sd_enu_m, nan=ANTENNA_AUDIT.min_sd_m)
    good = (gnss.quality == GnssQuality.RTK_FIXED) & (sd_m.max(axis=1) <= ANTENNA_AUDIT.max_sd_m)
    good &= positioned(gnss)
    good &= t_ns - ANTENNA_AUDIT.speed_ns >= trajectory.t_ns[0]
    return np.asarray(good & (t_ns + ANTENNA_AUDIT.speed_ns <= trajectory.t_ns[-1]))


def _positions(
    trajectory: Trajectory,
    gnss: GnssSamples,
    rig: Rig,
    *,
    origin: GeodeticOrigin,
    clock_s: float,
) -> DriftRows | None:
    t_ns = gnss.t_ns + round(1e9 * clock_s)
    good = _used(trajectory, gnss, t_ns)
    if good.sum() < ANTENNA_AUDIT.min_fixes:
        return None
    t_ns = t_ns[good]
    p_fix = to_enu(
        origin, gnss.lat_rad[good], gnss.lon_rad[good], ellipsoidal_height_m=gnss.height_m[good]
    )
    T_enu_body = trajectory.at(t_ns)
    before, after = (
        _antenna(trajectory.at(t_ns + d), rig)
        for d in (-ANTENNA_AUDIT.speed_ns, ANTENNA_AUDIT.speed_ns)
    )
    return DriftRows(
        t_s=(t_ns - t_ns[0]) / 1e9,
        offset=p_fix - _antenna(T_enu_body, rig),
        R_enu_body=T_enu_body.R,
        rate=(after - before) / (2e-9 * ANTENNA_AUDIT.speed_ns),
        sd=np.fmax(
            np.nan_to_num(gnss.sd_enu_m[good], nan=ANTENNA_AUDIT.min_sd_m), ANTENNA_AUDIT.min_sd_m
        ),
    )


def _attitudes(trajectory: Trajectory, gnss: GnssSamples, *, clock_s: float) -> DriftRows | None:
    """Attitudes of the INS beside those of the trajectory, whatever its mount; None = too few."""
    t_ns = gnss.t_ns + round(1e9 * clock_s)
    good = _used(trajectory, gnss, t_ns) & np.isfinite(gnss.rpy_ned_rad).all(axis=1)
    if good.sum() < ANTENNA_AUDIT.min_fixes:
        return None
    t_ns = t_ns[good]
    R_enu_body, R_enu_ins = trajectory.at(t_ns).R, attitudes(gnss.rpy_ned_rad[good])
    R_body_ins = mean_rotation(np.swapaxes(R_enu_body, 1, 2) @ R_enu_ins)
    before, after = (
        trajectory.at(t_ns + d).R for d in (-ANTENNA_AUDIT.speed_ns, ANTENNA_AUDIT.speed_ns)
    )
    return DriftRows(
        t_s=(t_ns - t_ns[0]) / 1e9,
        offset=so3_log(R_enu_ins @ np.swapaxes(R_enu_body @ R_body_ins, 1, 2)),
        R_enu_body=R_enu_body,
        rate=so3_log(after @ np.swapaxes(before, 1, 2)) / (2e-9 * ANTENNA_AUDIT.speed_ns),
        sd=np.full((len(t_ns), 3), ANTENNA_AUDIT.sd_rad),
    )


def _antenna(T_enu_body: SE3, rig: Rig) -> Array:
    return T_enu_body @ np.broadcast_to(rig.p_body_antenna, (len(T_enu_body), 3))


def coarse_clock_s(trajectory: Trajectory, t_ns: Times, p_fix: Array) -> float:
    """Seconds to be added to fixes so that their track has the shape of the trajectory's; 0 = none.

    Args:
        trajectory: ``T_a_body`` with z up; its heading and place do not matter.
        t_ns: Times of the fixes, increasing [ns], (N,).
        p_fix: East and north of them [m], (N, 2).
    """
    if len(t_ns) < FIX_CLOCK.min_steps:
        return 0.0
    begin_ns = np.arange(t_ns[0], t_ns[-1] - FIX_CLOCK.step_ns, FIX_CLOCK.step_ns)
    begin_ns = begin_ns[_gap_ns(t_ns, begin_ns) <= FIX_CLOCK.gap_ns]
    if len(begin_ns) < FIX_CLOCK.min_steps:
        return 0.0
    of_fixes = _displacements(begin_ns, t_ns, p_fix)
    size_m = np.abs(of_fixes)
    usual = size_m <= FIX_CLOCK.gross * np.percentile(size_m, 95.0)
    begin_ns, of_fixes = begin_ns[usual], of_fixes[usual]
    grid_s = np.arange(
        -FIX_CLOCK.largest_s, FIX_CLOCK.largest_s + 0.5 * FIX_CLOCK.grid_s, FIX_CLOCK.grid_s
    )
    differ = np.array([_differ(trajectory, begin_ns, of_fixes, clock_s=clock) for clock in grid_s])
    if not np.isfinite(differ).any():
        return 0.0
    best = int(np.nanargmin(differ))
    # Of the same fixes: those that another clock leaves out may be worse than the others.
    same = _inside(trajectory, begin_ns, clock_s=float(grid_s[best]))
    at_stamps = _differ(trajectory, begin_ns[same], of_fixes[same], clock_s=0.0)
    clear = differ[best] < FIX_CLOCK.clearly * at_stamps or np.isnan(at_stamps)
    return float(grid_s[best]) if clear and abs(grid_s[best]) >= FIX_CLOCK.least_s else 0.0


def _gap_ns(t_ns: Times, begin_ns: Times) -> Times:
    """Longest time between fixes around each displacement [ns], (K,)."""
    first = np.searchsorted(t_ns, begin_ns, side="right") - 1
    last = np.minimum(np.searchsorted(t_ns, begin_ns + FIX_CLOCK.step_ns), len(t_ns) - 1)
    gaps = np.append(np.diff(t_ns), 0)
    return np.maximum.reduceat(gaps, np.stack([first, last], axis=1).ravel())[::2]


def _differ(
    trajectory: Trajectory, begin_ns: Times, of_fixes: NDArray[np.complex128], *, clock_s: float
) -> float:
    """Mean square difference of the displacements at the best heading [m²]; NaN = no overlap."""
    inside = _inside(trajectory, begin_ns, clock_s=clock_s)
    if inside.sum() < max(FIX_CLOCK.min_steps, FIX_CLOCK.min_overlap * len(begin_ns)):
        return float("nan")
    moved_ns = begin_ns[inside] + round(1e9 * clock_s)
    seen = _displacements(moved_ns, trajectory.t_ns, trajectory.T_a_b.t[:, :2])
    fixed = of_fixes[inside]
    together = abs(np.vdot(seen, fixed))
    total = np.vdot(seen, seen).real + np.vdot(fixed, fixed).real - 2.0 * together
    return float(total) / len(fixed)


def _inside(trajectory: Trajectory, begin_ns: Times, *, clock_s: float) -> NDArray[np.bool_]:
    """Which displacements lie in the trajectory, (K,)."""
    moved_ns = begin_ns + round(1e9 * clock_s)
    within = (moved_ns >= trajectory.t_ns[0]) & (
        moved_ns + FIX_CLOCK.step_ns <= trajectory.t_ns[-1]
    )
    return np.asarray(within, np.bool_)


def _displacements(begin_ns: Times, t_ns: Times, p: Array) -> NDArray[np.complex128]:
    """East and, as imaginary part, north by which positions (N, 2) move in a step, (M,)."""
    # float64 represents nanoseconds exactly only after the start is subtracted.
    at, known = (np.asarray(times - t_ns[0], np.float64) for times in (begin_ns, t_ns))
    east, north = (
        np.interp(at + FIX_CLOCK.step_ns, known, x) - np.interp(at, known, x) for x in p.T
    )
    return np.asarray(east + 1j * north)
