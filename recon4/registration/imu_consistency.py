"""Consistency check of the IMU against the LiDARs, with a correction of the gyroscope bias."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from itertools import pairwise

import numpy as np

from recon4.geometry.se3 import Array, so3_log
from recon4.model.frames import RecordedFrames
from recon4.model.odometry_figures import ImuChoice, ImuOutcome
from recon4.model.samples import ImuSamples
from recon4.registration.motion import ImuMotion
from recon4.registration.odometry import Odometry
from recon4.settings import Settings

_FRAMES = 10
"""Multiframes of one trial."""
_SETTLING = 10
"""A trial that begins within a turn knows neither the tilt nor the velocity of the body: what looks
like a wrong accelerometer is tried again from this many multiframes before."""
_REST_NS = 500_000_000
"""The gyroscope bias is its mean over this time from the start, if the body is stationary [ns]."""
_ZERO_RAD_S = 0.06
"""Odometry estimates a smaller bias itself (its prior is a third of this)."""
_CLEARLY = 0.75
"""An alternative is used if its error is below this fraction of the best one's …"""
_CLEARLY_M = 0.002
"""… and smaller by at least this [m]."""
_TYPICAL = 0.8
"""Quantile of the errors that is compared: a single bad frame has no influence."""
_EXPLAINED = 0.3
"""The gyroscope explains the turns that the LiDARs see without it if this ratio of them is left. A
clock 20 ms off leaves 0.07, a rotated LiDAR 0.12, a clock 300 ms off 0.7, swapped axes 2."""
_AS_RECORDED = ImuChoice(outcome="as recorded")
_NEVER_M = 1.0
"""The error of a trial that found no match [m]."""


@dataclass(frozen=True, slots=True)
class Trial:
    """Result of registering some multiframes with one variant of the IMU samples."""

    lost: int
    error_m: float
    """Distance of the matched segments from the local map that most frames stay below [m]."""
    turns: Sequence[tuple[int, int, Array]]
    """Times [ns] of two multiframes in a row that were tracked, and the turn between, (3, 3)."""

    def clearly_better(self, other: Trial) -> bool:
        """Whether no more frames are lost and the error is much smaller."""
        if self.lost < other.lost:
            return self.error_m < other.error_m
        gain_m = other.error_m - self.error_m
        return self.lost == other.lost and gain_m > max(
            (1.0 - _CLEARLY) * other.error_m, _CLEARLY_M
        )

    def unexplained(self, motion: ImuMotion) -> float:
        """Part of the turns that a gyroscope does not measure, 0..; infinite without turns."""
        seen = np.array([so3_log(R) for _, _, R in self.turns]).reshape(-1, 3)
        measured = [so3_log(motion.turn(first, last)) for first, last, _ in self.turns]
        total = float((seen**2).sum())
        left = float(((seen - np.array(measured).reshape(-1, 3)) ** 2).sum())
        return float(np.sqrt(left / total)) if total > 0.0 else float("inf")


def consistent_imu(
    frames: RecordedFrames, settings: Settings, *, trusted: bool = False
) -> tuple[ImuSamples | None, ImuChoice]:
    """The IMU samples as recorded, with the gyroscope bias removed, or None.

    The first multiframes and those of the fastest turn are registered with each variant. A variant
    other than the recorded samples is used if it fits the LiDAR clearly better. A gyroscope may
    have a bias of tens of degrees a second (HDL-32E), its axes may be swapped, its clock may be
    offset. A gyroscope that measures the turns which the LiDARs see without it is not at fault.

    Args:
        frames: The multiframes with their rig and IMU.
        settings: Settings of the odometry.
        trusted: Whether nothing but a bias is wrong with it: who walks along contradicts an IMU.

    Returns:
        The samples to use, and what is wrong with them.
    """
    imu = frames.imu
    planes = settings.registration.solver == "planes"
    if imu is None or len(imu) < 2 or not settings.odometry.use_imu or not planes:
        return imu, _AS_RECORDED
    chosen: tuple[ImuSamples | None, ImuChoice] = imu, _AS_RECORDED
    best = _try(frames, imu, settings)
    zero_rad_s = _zero(imu, frames)
    if np.linalg.norm(zero_rad_s) > _ZERO_RAD_S:
        zeroed = ImuSamples(imu.t_ns, imu.gyro_rad_s - zero_rad_s, imu.accel_m_s2)
        found = _try(frames, zeroed, settings)
        if found.clearly_better(best):
            best = found
            x, y, z = zero_rad_s.tolist()
            chosen = zeroed, ImuChoice(outcome="bias removed", bias_rad_s=(x, y, z))
    if trusted:
        return chosen
    found = _try(frames, None, settings)
    used = chosen[0]
    if used is None or not found.clearly_better(best):
        return chosen
    motion = ImuMotion(used, frames.rig, settings.odometry)
    if found.unexplained(motion) < _EXPLAINED:
        return _without_forces(frames, used, whole=best, settings=settings) or chosen
    return None, _contradicted("not used", best, found)


def _without_forces(
    frames: RecordedFrames, imu: ImuSamples, *, whole: Trial, settings: Settings
) -> tuple[ImuSamples, ImuChoice] | None:
    """The gyroscope alone, if the accelerometer is at fault; None = it is not.

    A rotated LiDAR raises the error too, and no IMU is at fault then.
    """
    turns_only = ImuSamples(imu.t_ns, imu.gyro_rad_s, np.full_like(imu.accel_m_s2, np.nan))
    if not _try(frames, turns_only, settings).clearly_better(whole):
        return None
    settling = min(_SETTLING, max(len(frames) - _FRAMES, 0))
    best, found = (
        _try(frames, samples, settings, settling=settling) for samples in (imu, turns_only)
    )
    if not found.clearly_better(best):
        return None
    return turns_only, _contradicted("accelerometer not used", best, found)


def _contradicted(outcome: ImuOutcome, with_it: Trial, without: Trial) -> ImuChoice:
    return ImuChoice(outcome=outcome, with_m=with_it.error_m, without_m=without.error_m)


def _try(
    frames: RecordedFrames, imu: ImuSamples | None, settings: Settings, *, settling: int = 0
) -> Trial:
    """Register some multiframes; of the first ``settling`` of each trial nothing counts."""
    lost, errors = 0, []
    turns: list[tuple[int, int, Array]] = []
    for first in _starts(frames):
        odometry = Odometry(frames.rig, settings, imu)
        begin = max(first - settling, 0)
        end = min(begin + settling + _FRAMES, len(frames))
        steps = [odometry.push(frames[k]) for k in range(begin, end)][settling:]
        lost += sum(step.lost for step in steps)
        errors += [step.error_m for step in steps[1:]]
        turns += [
            (a.t_mid_ns, b.t_mid_ns, a.T_odom_body.R.T @ b.T_odom_body.R)
            for a, b in pairwise(steps)
            if not (a.lost or b.lost)
        ]
    known = np.nan_to_num(np.array(errors), nan=_NEVER_M)
    return Trial(lost, float(np.quantile(known, _TYPICAL)) if len(known) else 0.0, turns)


def _starts(frames: RecordedFrames) -> list[int]:
    """The first multiframe, and the one from which the IMU turns most."""
    imu = frames.imu
    last = len(frames) - _FRAMES
    if imu is None or last <= _FRAMES:
        return [0]
    off = imu.gyro_rad_s - np.median(imu.gyro_rad_s, axis=0)
    turned_rad = np.cumsum(np.linalg.norm(off, axis=1) * np.gradient(imu.t_ns * 1e-9))
    at = np.interp(
        (frames.t_mid_ns - imu.t_ns[0]) * 1e-9, (imu.t_ns - imu.t_ns[0]) * 1e-9, turned_rad
    )
    return [0, int(np.argmax(at[_FRAMES:] - at[:-_FRAMES]))]


def _zero(imu: ImuSamples, frames: RecordedFrames) -> np.ndarray[tuple[int], np.dtype[np.float64]]:
    start_ns = max(int(imu.t_ns[0]), int(frames[0].t_ns))
    rows = (imu.t_ns >= start_ns) & (imu.t_ns < start_ns + _REST_NS)
    return np.asarray(imu.gyro_rad_s[rows].mean(axis=0)) if rows.any() else np.zeros(3)
