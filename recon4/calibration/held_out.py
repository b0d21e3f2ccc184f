"""Whether a calibrated rig may be used: what another part of the walk says of it."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from recon4.calibration.equations import Fit
from recon4.calibration.joint import JointEstimate
from recon4.calibration.parameters import Parameters, Unit
from recon4.calibration.tuning_joint import HELD_OUT, JOINT
from recon4.geometry.se3 import Array
from recon4.model.calibration_figures import CalibrationOutcome, ParameterFigures, RigOutcome
from recon4.model.rig import Rig

_KNOWN_ERROR: dict[Unit, float] = {"rad": float(np.deg2rad(0.2)), "m": 0.01, "s": 0.005}
"""Wrong values that are put in on purpose; an estimate that does not find them proves nothing."""
_KNOWN_BEAM_ERROR: dict[Unit, float] = {"rad": float(np.deg2rad(0.03)), "m": 0.004}
"""The same of single beams."""


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


def with_known_errors(rig: Rig, parameters: Parameters) -> Rig:
    """The rig with errors in all parameters that another estimate must find."""
    return parameters.changed(rig, _known_errors(parameters))


def _known_errors(parameters: Parameters) -> Array:
    """The wrong values that are put in, with alternating signs, (P,)."""
    size = np.array(
        [
            (_KNOWN_BEAM_ERROR if parameter.of_beam else _KNOWN_ERROR)[parameter.unit]
            for parameter in parameters.listed
        ]
    )
    return size * np.where(np.arange(len(size)) % 2, -1.0, 1.0)


def not_observable(first: JointEstimate, second: JointEstimate | None) -> NDArray[np.bool_]:
    """Parameters that keep their values, (P,).

    Those that are not different while known errors may be missed; and those that are known no
    better than the known errors, however different they seem: at a constant turn rate heading and
    clock look alike, and all windows are wrong together.
    """
    if second is None:
        return np.zeros(len(first.parameters), dtype=bool)
    limit = np.abs(_known_errors(first.parameters))
    undetected = JOINT.sigmas * np.hypot(first.sd, second.sd) > limit
    vague = np.maximum(first.sd, second.sd) > limit
    return np.asarray(vague | (undetected & (np.abs(first.change) <= JOINT.sigmas * first.sd)))


def contradicted_beams(first: JointEstimate, second: JointEstimate | None) -> NDArray[np.bool_]:
    """Parameters of single beams that two estimates contradict each other about, (P,).

    Of some hundred parameters a few may, and these keep their values. If more do, none is
    returned: then the estimates contradict each other.
    """
    listed = first.parameters.listed
    of_beams = np.array([parameter.of_beam for parameter in listed], dtype=bool)
    if second is None:
        return np.zeros(len(listed), dtype=bool)
    contradicted = of_beams & _contradicted(first, second)
    few = contradicted.sum() <= HELD_OUT.few_beams * of_beams.sum()
    return np.asarray(contradicted & few)


def _contradicted(first: JointEstimate, second: JointEstimate) -> NDArray[np.bool_]:
    """Parameters that two estimates from different windows contradict each other about, (P,)."""
    apart = np.abs(first.parameters.between(first.rig, second.rig))
    scatter = JOINT.sigmas * np.hypot(first.sd, second.sd)
    return np.asarray(apart > np.maximum(scatter, 0.5 * np.abs(_known_errors(first.parameters))))


def refusal(
    rows: Sequence[ParameterFigures], first: JointEstimate, second: JointEstimate | None
) -> CalibrationOutcome | None:
    """Why two estimates from different windows must not be used; None = they agree.

    Args:
        rows: The table of the first.
        first: From the windows that are used.
        second: From the others, begun with known errors; None = there are too few.
    """
    if second is None:
        return CalibrationOutcome(rig=RigOutcome.TOO_SHORT)
    if not any(row.status == "off" for row in rows):
        beams = bool(first.parameters.beams)
        return CalibrationOutcome(rig=RigOutcome.BEAMS_AGREE if beams else RigOutcome.NOT_CONFIRMED)
    checked = np.array([row.status != "not observable" for row in rows])
    wrong = np.flatnonzero(checked & _contradicted(first, second))
    if len(wrong):
        names = tuple(first.parameters.listed[k].name for k in wrong)
        return CalibrationOutcome(rig=RigOutcome.OTHER_VALUES, names=names)
    return None


def unexplained(before: Agreement, after: Agreement) -> CalibrationOutcome | None:
    """Why a rig must not be used that explains other windows so; None = it may.

    Args:
        before: With the rig file.
        after: With the calibrated rig.
    """
    worse = [
        name
        for name, old, new in (
            ("planes", before.rms_m, after.rms_m),
            ("IMU", before.imu_rms, after.imu_rms),
        )
        if new > HELD_OUT.not_worse * old
    ]
    if worse:
        return CalibrationOutcome(rig=RigOutcome.EXPLAINED_WORSE, names=tuple(worse))
    gains = [after.rms_m / before.rms_m, after.imu_rms / before.imu_rms]
    if not np.nanmin(gains) < HELD_OUT.better:
        return CalibrationOutcome(rig=RigOutcome.NO_BETTER)
    return None


def _median(values: Sequence[float]) -> float:
    known = [value for value in values if np.isfinite(value)]
    return float(np.median(known)) if known else float("nan")
