"""Audit and calibration of a rig on one walk, with a check on windows that were not used."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from recon4.calibration.equations import Fit
from recon4.calibration.joint import ROUNDS, JointEstimate, calibrate_jointly, explain
from recon4.calibration.judgment import judge
from recon4.calibration.parameters import Parameters, Unit
from recon4.calibration.selection import choose_windows
from recon4.calibration.window import Window, cut_window
from recon4.errors import ConfigError
from recon4.geometry.se3 import Array
from recon4.model.figures import ParameterFigures
from recon4.model.frames import RecordedFrames
from recon4.model.rig import Rig
from recon4.model.trajectory import Trajectory
from recon4.progress import Progress
from recon4.settings import CalibrationSettings, Settings

IMU = "imu"
"""Name of the IMU among the sensors of a calibration."""
_KNOWN_ERROR: dict[Unit, float] = {"rad": float(np.deg2rad(0.2)), "m": 0.01, "s": 0.005}
"""Wrong values that are put in on purpose; an estimate that does not find them proves nothing."""
_SIGMAS = 3.0
_MIN_WINDOWS = 2
_NOT_WORSE, _BETTER = 1.01, 0.99
"""Ratio of figures of fit, after against before."""


@dataclass(frozen=True, slots=True, eq=False)
class Walk:
    """A recording with its odometry."""

    frames: RecordedFrames
    trajectory: Trajectory
    """``T_odom_body``, dense."""
    lost: NDArray[np.bool_]
    """Multiframes where tracking was lost, (N,)."""

    def windows(self, count: int, seconds: float) -> list[Window]:
        """Windows spread over the walk where the body turns most."""
        t_ns = self.frames.t_mid_ns
        if len(t_ns) < 2:
            return []
        period_s = float(np.median(np.diff(t_ns))) * 1e-9
        length = max(2, round(seconds / period_s))
        rows = choose_windows(self.trajectory, t_ns, self.lost, count=count, length=length)
        return [cut_window(self.frames, self.trajectory, part) for part in rows]


@dataclass(frozen=True, slots=True, kw_only=True)
class Agreement:
    """How well windows that were not used are explained by a rig."""

    rms_m: float
    """Distance of points from common planes, median of the windows [m]."""
    offset_m: float
    """Between one surface as seen by two LiDARs [m]; NaN = none is."""
    imu_rms: float
    """Of the normalized residuals of the IMU; NaN = no IMU."""

    @staticmethod
    def of(fits: Sequence[Fit | None]) -> Agreement:
        """Medians over the windows."""
        known = [fit for fit in fits if fit is not None]
        return Agreement(
            rms_m=_median([fit.rms_m for fit in known]),
            offset_m=_median([fit.offset_m for fit in known]),
            imu_rms=_median([fit.imu_rms for fit in known]),
        )


@dataclass(frozen=True, slots=True, eq=False)
class Calibration:
    """A calibrated rig with its evidence."""

    estimate: JointEstimate
    rows: tuple[ParameterFigures, ...]
    before: Agreement
    """Of windows that were not used, with the rig file."""
    after: Agreement
    """Of the same windows, with the calibrated rig."""
    refusal: str
    """Why it must not be used; empty = it may."""


def calibrated_parameters(
    rig: Rig, *, with_imu: bool, settings: CalibrationSettings
) -> Parameters | None:
    """The parameters to estimate; None if nothing can be compared.

    Raises:
        ConfigError: If the settings name a sensor that is not in the rig.
    """
    enabled = [row for row, sensor in enumerate(rig.sensors) if sensor.enabled]
    names = {rig.sensors[row].name: row for row in enabled}
    wanted = [name.strip() for name in settings.sensors.split(",") if name.strip()]
    for name in [*wanted, *([settings.reference] if settings.reference else [])]:
        if name not in names and (name != IMU or name == settings.reference):
            raise ConfigError(
                f"calibration: expected names of sensors of the rig "
                f"({', '.join([*names, IMU])}), got {name!r:.80}"
            )
    if not enabled:
        return None
    reference = names[settings.reference] if settings.reference else enabled[0]
    lidars = tuple(
        row for name, row in names.items() if row != reference and (not wanted or name in wanted)
    )
    imu = with_imu and (not wanted or IMU in wanted)
    if not lidars and not imu:
        return None
    return Parameters.of(rig, reference=reference, lidars=lidars, imu=imu)


def audit(
    walk: Walk, parameters: Parameters, *, settings: Settings, progress: Progress
) -> JointEstimate | None:
    """Estimate the rig from a few short windows; None if no window has planes."""
    s = settings.calibration
    windows = walk.windows(s.audit_windows, s.audit_window_s)
    return _estimate(windows, walk.frames.rig, parameters, settings=settings, progress=progress)


def calibrate(
    walk: Walk, parameters: Parameters, *, settings: Settings, progress: Progress
) -> Calibration | None:
    """Calibrate the rig on every second window and check it on the others.

    Returns:
        None if there are no windows with planes.
    """
    s, rig = settings.calibration, walk.frames.rig
    windows = walk.windows(2 * s.windows, s.window_s)
    used, others = windows[::2], windows[1::2]
    first = _estimate(used, rig, parameters, settings=settings, progress=progress)
    if first is None:
        return None
    second = _second_opinion(others, first, settings=settings, progress=progress)
    unknown = _not_observable(first, second)
    final = first
    if unknown.any():
        fixed = parameters.fixing(unknown)
        found = _estimate(used, rig, fixed, settings=settings, progress=progress)
        final = found or first
    before = Agreement.of(explain(others, rig, settings=settings))
    after = Agreement.of(explain(others, final.rig, settings=settings))
    rows = judge(final, not_observable=unknown)
    refusal = _refusal(rows, before, after, second=second, first=first)
    return Calibration(final, rows, before, after, refusal)


def _estimate(
    windows: Sequence[Window],
    rig: Rig,
    parameters: Parameters,
    *,
    settings: Settings,
    progress: Progress,
) -> JointEstimate | None:
    if not windows:
        return None
    progress.start("calibration", len(ROUNDS), "rounds")
    found = calibrate_jointly(
        windows, rig, parameters, settings=settings, progress=progress.advance
    )
    return found if found.fits else None


def _second_opinion(
    windows: Sequence[Window], first: JointEstimate, *, settings: Settings, progress: Progress
) -> JointEstimate | None:
    """An estimate from other windows that begins with known errors; None without windows."""
    if len(windows) < _MIN_WINDOWS:
        return None
    wrong = first.parameters.changed(first.rig, _known_errors(first.parameters))
    return _estimate(windows, wrong, first.parameters, settings=settings, progress=progress)


def _known_errors(parameters: Parameters) -> Array:
    """The wrong values that are put in, with alternating signs, (P,)."""
    size = np.array([_KNOWN_ERROR[parameter.unit] for parameter in parameters.listed])
    return size * np.where(np.arange(len(size)) % 2, -1.0, 1.0)


def _not_observable(first: JointEstimate, second: JointEstimate | None) -> NDArray[np.bool_]:
    """Parameters that keep their values: not different, and known errors may be missed, (P,)."""
    if second is None:
        return np.zeros(len(first.parameters), dtype=bool)
    limit = np.abs(_known_errors(first.parameters))
    undetected = _SIGMAS * np.hypot(first.sd, second.sd) > limit
    return np.asarray(undetected & (np.abs(first.change) <= _SIGMAS * first.sd))


def _refusal(
    rows: Sequence[ParameterFigures],
    before: Agreement,
    after: Agreement,
    *,
    second: JointEstimate | None,
    first: JointEstimate,
) -> str:
    """Why a calibrated rig must not be used; empty = it may."""
    if not any(row.status == "off" for row in rows):
        return "the rig file agrees with the recording"
    if second is None:
        return "the walk is too short to check the calibrated rig on another part of it"
    apart = np.abs(first.parameters.between(first.rig, second.rig))
    scatter = _SIGMAS * np.hypot(first.sd, second.sd)
    limit = np.maximum(scatter, 0.5 * np.abs(_known_errors(first.parameters)))
    checked = np.array([row.status != "not observable" for row in rows])
    wrong = np.flatnonzero(checked & (apart > limit))
    if len(wrong):
        names = ", ".join(first.parameters.listed[k].name for k in wrong)
        return f"inconclusive: another part of the walk gives another value for {names}"
    worse = [
        name
        for name, old, new in (
            ("the distance of points from planes", before.rms_m, after.rms_m),
            ("the residual of the IMU", before.imu_rms, after.imu_rms),
        )
        if new > _NOT_WORSE * old
    ]
    if worse:
        return f"inconclusive: {' and '.join(worse)} grows in another part of the walk"
    gains = [after.rms_m / before.rms_m, after.imu_rms / before.imu_rms]
    if not np.nanmin(gains) < _BETTER:
        return "inconclusive: another part of the walk is explained no better"
    return ""


def _median(values: Sequence[float]) -> float:
    known = [value for value in values if np.isfinite(value)]
    return float(np.median(known)) if known else float("nan")
