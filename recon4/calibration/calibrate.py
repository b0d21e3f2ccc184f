"""Audit and calibration of a rig on one walk, with a check on windows that were not used."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from recon4.calibration.equations import Fit
from recon4.calibration.joint import ROUNDS, JointEstimate, calibrate_jointly, explain
from recon4.calibration.judgment import judge
from recon4.calibration.mount_search import search_mounts, without_others
from recon4.calibration.parameters import Parameters, Unit
from recon4.calibration.walk import RecordedWalk
from recon4.calibration.window import Window
from recon4.errors import ConfigError
from recon4.geometry.se3 import Array
from recon4.model.figures import GNSS, IMU, ParameterFigures
from recon4.model.rig import Rig
from recon4.progress import Progress
from recon4.settings import CalibrationSettings, Settings

_KNOWN_ERROR: dict[Unit, float] = {"rad": float(np.deg2rad(0.2)), "m": 0.01, "s": 0.005}
"""Wrong values that are put in on purpose; an estimate that does not find them proves nothing."""
_KNOWN_BEAM_ERROR: dict[Unit, float] = {"rad": float(np.deg2rad(0.03)), "m": 0.004}
"""The same of single beams."""
_SIGMAS = 3.0
_MIN_WINDOWS = 3
_FAR_RAD, _FAR_M, _FAR_S = float(np.deg2rad(2.5)), 0.1, 0.05
"""With a larger change from the rig file other mounts are tried too."""
_SEARCH_WINDOWS, _SEARCH_WINDOW_S = 3, 3.0
_CLEARLY = 1.2
"""How many times the points another mount must put on planes that two LiDARs see."""
_NOT_WORSE, _BETTER = 1.01, 0.99
"""Ratio of figures of fit, after against before."""


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


def reference_of(rig: Rig, settings: CalibrationSettings) -> int | None:
    """Row of the LiDAR whose mount and clock stay; None if no LiDAR is enabled.

    Raises:
        ConfigError: If the settings name a sensor that is not an enabled LiDAR of the rig.
    """
    names = _enabled(rig)
    if not settings.reference:
        return next(iter(names.values()), None)
    if settings.reference not in names:
        raise ConfigError(
            f"calibration.reference: expected a LiDAR of the rig ({', '.join(names)}), "
            f"got {settings.reference!r:.80}"
        )
    return names[settings.reference]


def calibrated_parameters(
    rig: Rig, *, reference: int, with_imu: bool, settings: CalibrationSettings
) -> Parameters:
    """The parameters to estimate; empty if nothing can be compared.

    Raises:
        ConfigError: If the settings name a sensor that is not in the rig.
    """
    names = _enabled(rig)
    wanted = settings.wanted
    unknown = [name for name in wanted if name not in names and name not in (IMU, GNSS)]
    if unknown:
        raise ConfigError(
            f"calibration.sensors: expected some of {', '.join([*names, IMU, GNSS])}, "
            f"got {unknown[0]!r:.80}"
        )
    lidars = tuple(
        row for name, row in names.items() if row != reference and (not wanted or name in wanted)
    )
    imu = with_imu and (not wanted or IMU in wanted)
    return Parameters.of(rig, reference=reference, lidars=lidars, imu=imu)


def chosen_lidars(rig: Rig, settings: CalibrationSettings) -> tuple[int, ...]:
    """Rows of the enabled LiDARs that the settings name, all of them if they name none."""
    wanted = settings.wanted
    return tuple(row for name, row in _enabled(rig).items() if not wanted or name in wanted)


def _enabled(rig: Rig) -> dict[str, int]:
    """Row of each enabled LiDAR by its name."""
    return {sensor.name: row for row, sensor in enumerate(rig.sensors) if sensor.enabled}


def audit(
    walk: RecordedWalk,
    start: Rig,
    parameters: Parameters,
    *,
    settings: Settings,
    progress: Progress,
) -> JointEstimate | None:
    """Estimate the rig from a few short windows; None if no window has planes.

    If the estimate is far from the rig file, mounts with exchanged axes are tried as well.

    Args:
        walk: The recording.
        start: Where to begin; the change is counted from the rig of the recording.
        parameters: What is estimated.
        settings: Number and length of the windows, noise of the IMU.
        progress: Counts rounds.
    """
    s = settings.calibration
    windows = walk.windows(s.audit_windows, s.audit_window_s)
    found = _estimate(windows, start, parameters, settings=settings, progress=progress)
    if found is not None and _is_near(found, walk.frames.rig):
        return _counted_from(found, walk.frames.rig)
    others = _from_other_mounts(walk, start, parameters, settings=settings, progress=progress)
    best = max([found, *others], key=_shared_points)
    if best is None or _shared_points(best) < _CLEARLY * _shared_points(found):
        best = found
    return best and _counted_from(best, walk.frames.rig)


def calibrate(
    walk: RecordedWalk,
    start: Rig,
    parameters: Parameters,
    *,
    settings: Settings,
    progress: Progress,
) -> Calibration | None:
    """Calibrate the rig on every second window and check it on the others.

    The windows are tracked again with the rig of the audit: a better trajectory to begin with.

    Args:
        walk: The recording.
        start: Where to begin, as `audit` found it.
        parameters: What is estimated.
        settings: Number and length of the windows, noise of the IMU.
        progress: Counts rounds.

    Returns:
        None if there are no windows with planes.
    """
    recorded = walk.frames.rig
    s = settings.calibration
    rows = walk.rows(2 * s.windows, s.window_s, with_lost=True)
    moved = walk.with_rig(start)
    windows = moved.tracked_windows(rows, start, settings, imu=moved.frames.imu)
    used, others = windows[::2], windows[1::2]
    first = _estimate(used, start, parameters, settings=settings, progress=progress)
    if first is None:
        return None
    first = _counted_from(first, recorded)
    second = _second_opinion(others, first, settings=settings, progress=progress)
    unknown = _not_observable(first, second)
    final = first
    if unknown.any():
        begin = parameters.keeping(unknown, recorded, first.rig)
        fixed = parameters.fixing(unknown)
        found = _estimate(used, begin, fixed, settings=settings, progress=progress)
        final = _counted_from(found, recorded) if found else first
    before = Agreement.of(explain(others, recorded, settings=settings))
    after = Agreement.of(explain(others, final.rig, settings=settings))
    rows_of_table = judge(final, not_observable=unknown)
    refusal = _refusal(rows_of_table, before, after, second=second, first=first)
    return Calibration(final, rows_of_table, before, after, refusal)


def _is_near(found: JointEstimate, recorded: Rig) -> bool:
    """Whether no parameter is certainly so far from the rig file that the estimate may be false."""
    change = np.abs(found.parameters.between(recorded, found.rig))
    noise = _SIGMAS * np.where(np.isfinite(found.sd), found.sd, 0.0)
    return bool(np.all(change < np.maximum(_far(found.parameters), noise)))


def _far(parameters: Parameters) -> Array:
    """Changes from which on other mounts are tried too, (P,)."""
    far = {"rad": _FAR_RAD, "m": _FAR_M, "s": _FAR_S}
    return np.array([far[parameter.unit] for parameter in parameters.listed])


def _counted_from(found: JointEstimate, recorded: Rig) -> JointEstimate:
    return replace(found, change=found.parameters.between(recorded, found.rig))


def _from_other_mounts(
    walk: RecordedWalk,
    start: Rig,
    parameters: Parameters,
    *,
    settings: Settings,
    progress: Progress,
) -> list[JointEstimate]:
    """Estimates that begin with exchanged axes or mounts, from windows of one LiDAR alone."""
    reference = parameters.reference
    rows = walk.rows(_SEARCH_WINDOWS, _SEARCH_WINDOW_S, with_lost=True)
    alone = without_others(start, reference)
    windows = walk.tracked_windows(rows, alone, settings, imu=None)
    found = [
        _estimate(windows, rig, parameters, settings=settings, progress=progress)
        for rig in search_mounts(windows, start, reference=reference)
    ]
    return [estimate for estimate in found if estimate is not None]


def _shared_points(found: JointEstimate | None) -> int:
    return sum(fit.shared_points for fit in found.fits) if found else 0


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
    size = np.array(
        [
            (_KNOWN_BEAM_ERROR if parameter.of_beam else _KNOWN_ERROR)[parameter.unit]
            for parameter in parameters.listed
        ]
    )
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
    if second is None:
        return "the walk is too short to check the calibrated rig on another part of it"
    if not any(row.status == "off" for row in rows):
        if first.parameters.beams:
            return "nothing is corrected: mounts, clocks and beams agree with the rig file"
        return "inconclusive: longer windows do not confirm what the audit found"
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
