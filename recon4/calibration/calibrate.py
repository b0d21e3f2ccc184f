"""Audit and calibration of a rig on one walk, with a check on windows that were not used."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from recon4.calibration.equations import RoundBounds
from recon4.calibration.held_out import (
    Agreement,
    contradicted_beams,
    not_observable,
    refusal,
    unexplained,
    with_known_errors,
)
from recon4.calibration.joint import (
    LAST_ROUNDS,
    NEAR_ROUNDS,
    ROUNDS,
    JointEstimate,
    calibrate_jointly,
    explain,
    thinned_rounds,
)
from recon4.calibration.judgment import judge
from recon4.calibration.mount_search import search_mounts, without_others
from recon4.calibration.parameters import Parameters
from recon4.calibration.recorded_walk import RecordedWalk
from recon4.calibration.tuning import CalibrationTuning
from recon4.calibration.tuning_joint import AUDIT, JOINT
from recon4.calibration.window import Window, few_points, thinning
from recon4.errors import ConfigError
from recon4.geometry.se3 import Array
from recon4.locales.coded import CodedText
from recon4.model.calibration_figures import GNSS, IMU, CalibrationOutcome, ParameterFigures
from recon4.model.rig import Rig
from recon4.progress import Progress, track
from recon4.settings import CalibrationSettings
from recon4.settings.reads import CalibrationReads
from recon4.settings.tuning import tuned


@dataclass(frozen=True, slots=True, eq=False)
class Calibration:
    """A calibrated rig with its evidence."""

    estimate: JointEstimate
    rows: tuple[ParameterFigures, ...]
    before: Agreement
    """Of windows that were not used, with the rig file."""
    after: Agreement
    """Of the same windows, with the calibrated rig."""
    refusal: CalibrationOutcome | None
    """Why it must not be used; None = it may."""


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
            CodedText(
                "calibration-reference", names=", ".join(names), reference=settings.reference[:80]
            )
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
            CodedText(
                "calibration-sensors", value=", ".join([*names, IMU, GNSS]), unknown=unknown[0][:80]
            )
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
    settings: CalibrationReads,
    progress: Progress,
) -> JointEstimate | None:
    """Estimate the rig from a few short windows; None if no window has planes.

    If the estimate is far from the rig file, mounts with exchanged axes are tried as well, on
    all points: those of a LiDAR whose mount is wrong pass for points on moving objects.

    Args:
        walk: The recording.
        start: Where to begin; the change is counted from the rig of the recording.
        parameters: What is estimated.
        settings: Number and length of the windows, noise of the IMU.
        progress: Counts rounds.
    """
    s = tuned(CalibrationTuning, settings.calibration)
    estimator = _Estimator(settings, progress)
    windows = walk.windows(s.audit_windows, s.audit_window_s)
    found = estimator.estimate(windows, start, parameters)
    if found is not None and _is_near(found, walk.frames.rig):
        return _counted_from(found, walk.frames.rig)
    if walk.frames.hidden is not None:
        walk = walk.with_all_points()
        windows = walk.windows(s.audit_windows, s.audit_window_s)
        found = estimator.estimate(windows, start, parameters)
    others = _from_other_mounts(walk, start, parameters, settings=settings, progress=progress)
    best = max([found, *others], key=_shared_points)
    if best is None or _shared_points(best) < AUDIT.clearly * _shared_points(found):
        best = found
    return best and _counted_from(best, walk.frames.rig)


def calibrate(
    walk: RecordedWalk,
    start: Rig,
    parameters: Parameters,
    *,
    settings: CalibrationReads,
    progress: Progress,
) -> Calibration | None:
    """Calibrate the rig on every second window and check it on the others.

    If both halves of the walk agree and the others are explained better by the rig of the first,
    the rig that is used comes from all windows. They are tracked again with the rig of the audit:
    a better trajectory to begin with.

    Args:
        walk: The recording.
        start: Where to begin, as `audit` found it.
        parameters: What is estimated.
        settings: Number and length of the windows, noise of the IMU.
        progress: Counts rounds.

    Returns:
        None if there are no windows with planes.
    """
    recorded, s = walk.frames.rig, tuned(CalibrationTuning, settings.calibration)
    rows = walk.rows(2 * s.windows, s.window_s, with_lost=True)
    moved, few = walk.with_rig(start), few_points(len(rows))
    revolutions = max(1, sum(map(len, rows)) * len(_enabled(recorded)))
    windows = moved.tracked_windows(
        rows, start, settings,
        imu=moved.frames.imu, points=max(few, s.points // revolutions),
    )  # fmt: skip
    used, others = windows[::2], windows[1::2]
    estimator = _Estimator(settings, progress, every=thinning(windows, few * revolutions))
    first = estimator.estimate(used, start, parameters, rounds=estimator.of_half)
    if first is None:
        return None
    first = _counted_from(first, recorded)
    second = estimator.second(others, first)
    unknown = not_observable(first, second) | contradicted_beams(first, second)
    table = judge(first, not_observable=unknown)
    before, after = (
        Agreement.of(explain(others, rig, every=estimator.every, settings=settings))
        for rig in (recorded, parameters.keeping(unknown, recorded, first.rig))
    )
    why_not = refusal(table, first, second) or unexplained(before, after)
    if why_not:
        return Calibration(first, table, before, after, why_not)
    final = estimator.of_all(windows, first, unknown, recorded=recorded)
    return Calibration(*final, before, after, None)


def _is_near(found: JointEstimate, recorded: Rig) -> bool:
    """Whether no LiDAR is certainly so far from the rig file that the estimate may be false.

    Of the IMU nothing is asked: other mounts of LiDARs would not explain it, and a walk that only
    turns about the vertical hardly shows its position.
    """
    change = np.abs(found.parameters.between(recorded, found.rig))
    noise = JOINT.sigmas * np.where(np.isfinite(found.sd), found.sd, 0.0)
    of_lidars = np.array([parameter.sensor != IMU for parameter in found.parameters.listed])
    near = change < np.maximum(_far(found.parameters), noise)
    return bool(np.all(near[of_lidars]))


def _far(parameters: Parameters) -> Array:
    """Changes from which on other mounts are tried too, (P,)."""
    far = {"rad": AUDIT.far_rad, "m": AUDIT.far_m, "s": AUDIT.far_s}
    return np.array([far[parameter.unit] for parameter in parameters.listed])


def _counted_from(found: JointEstimate, recorded: Rig) -> JointEstimate:
    return replace(found, change=found.parameters.between(recorded, found.rig))


def _from_other_mounts(
    walk: RecordedWalk,
    start: Rig,
    parameters: Parameters,
    *,
    settings: CalibrationReads,
    progress: Progress,
) -> list[JointEstimate]:
    """Estimates that begin with exchanged axes or mounts, from windows of one LiDAR alone."""
    reference = parameters.reference
    rows = walk.rows(AUDIT.search_windows, AUDIT.search_window_s, with_lost=True)
    alone = without_others(start, reference)
    windows = walk.tracked_windows(rows, alone, settings, imu=None)
    found = [
        _Estimator(settings, progress).estimate(windows, rig, parameters)
        for rig in search_mounts(windows, start, reference=reference)
    ]
    return [estimate for estimate in found if estimate is not None]


def _shared_points(found: JointEstimate | None) -> int:
    return sum(fit.shared_points for fit in found.fits) if found else 0


@dataclass(frozen=True, slots=True, eq=False)
class _Estimator:
    """Joint estimates of one calibration."""

    settings: CalibrationReads
    progress: Progress
    """Counts their rounds."""
    every: int = 1
    """Every so-many-th point leads near the solution."""

    @property
    def of_half(self) -> Sequence[RoundBounds]:
        """Rounds of one half of the windows: only beams need all points for a comparison."""
        dense = JOINT.dense_rounds if self.settings.calibration.beams else 0
        return thinned_rounds(NEAR_ROUNDS, self.every, dense=dense)

    def estimate(
        self,
        windows: Sequence[Window],
        rig: Rig,
        parameters: Parameters,
        *,
        rounds: Sequence[RoundBounds] = ROUNDS,
    ) -> JointEstimate | None:
        """From some windows, begun at a rig; None if none has planes."""
        if not windows:
            return None
        counted = track(rounds, self.progress, what="calibration", unit="rounds")
        found = calibrate_jointly(windows, rig, parameters, rounds=counted, settings=self.settings)
        return found if found.fits else None

    def second(self, windows: Sequence[Window], first: JointEstimate) -> JointEstimate | None:
        """From other windows, begun with known errors; None if there are too few."""
        if len(windows) < AUDIT.min_windows:
            return None
        wrong = with_known_errors(first.rig, first.parameters)
        return self.estimate(windows, wrong, first.parameters, rounds=self.of_half)

    def of_all(
        self,
        windows: Sequence[Window],
        first: JointEstimate,
        unknown: NDArray[np.bool_],
        *,
        recorded: Rig,
    ) -> tuple[JointEstimate, tuple[ParameterFigures, ...]]:
        """From all windows, and what it says of each parameter.

        What the walk does not show, (P,) bool and what all windows say, is estimated along with
        the others and then keeps the value of the rig file: held at a wrong value, it would pull
        the others away from theirs (20 cm along a straight walk).
        """
        rounds = thinned_rounds(LAST_ROUNDS, self.every, dense=JOINT.dense_rounds)
        found = self.estimate(windows, first.rig, first.parameters, rounds=rounds) or first
        table = judge(_counted_from(found, recorded), not_observable=unknown)
        kept = np.array([row.status == "not observable" for row in table])
        rig = first.parameters.keeping(kept, recorded, found.rig)
        final = _counted_from(replace(found, rig=rig), recorded)
        return final, judge(final, not_observable=kept)
