"""What an estimate says of each parameter: consistent with the rig file, off, or not observable."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from recon4.calibration.joint import JointEstimate
from recon4.calibration.parameters import Parameter, Unit
from recon4.calibration.tuning_joint import JOINT
from recon4.model.calibration_figures import ParameterFigures, ParameterStatus, RigScatter
from recon4.model.plain import finite_or_none


@dataclass(frozen=True, slots=True)
class ParameterLimits:
    """Limits of one kind of parameter, in its unit."""

    tolerance: float
    """A smaller change is no reason to calibrate."""
    observable_sd: float
    """With a larger standard deviation the parameter counts as not observable."""


_LIMITS: dict[Unit, ParameterLimits] = {
    "rad": ParameterLimits(float(np.deg2rad(0.1)), float(np.deg2rad(0.1))),
    "m": ParameterLimits(0.01, 0.01),
    "s": ParameterLimits(1e-3, 1e-3),
}
_BEAM_LIMITS: dict[Unit, ParameterLimits] = {
    "rad": ParameterLimits(float(np.deg2rad(0.01)), float(np.deg2rad(0.01))),
    "m": ParameterLimits(0.002, 0.0015),
}


def judge(
    estimate: JointEstimate, *, not_observable: NDArray[np.bool_] | None = None
) -> tuple[ParameterFigures, ...]:
    """One row for each parameter.

    Args:
        estimate: The estimate.
        not_observable: Parameters that kept their values because the walk does not show them, (P,).
    """
    kept = np.zeros(len(estimate.sd), bool) if not_observable is None else not_observable
    sd, noises = (np.where(kept, np.inf, known) for known in (estimate.sd, estimate.noise))
    rows = zip(estimate.parameters.listed, estimate.change, sd, noises, strict=True)
    return tuple(
        ParameterFigures(
            sensor=parameter.sensor,
            quantity=parameter.quantity,
            axis=parameter.axis,
            unit=parameter.unit,
            change=float(change),
            sd=finite_or_none(sd_of_row),
            status=_status(
                float(change), parameter, sd=float(sd_of_row), noise=float(noise_of_row)
            ),
        )
        for parameter, change, sd_of_row, noise_of_row in rows
    )


def _status(change: float, parameter: Parameter, *, sd: float, noise: float) -> ParameterStatus:
    limits = (_BEAM_LIMITS if parameter.of_beam else _LIMITS)[parameter.unit]
    if abs(change) > max(noise, limits.tolerance):
        return "off"
    agrees = sd <= limits.observable_sd and abs(change) <= max(JOINT.sigmas * sd, limits.tolerance)
    return "consistent" if agrees else "not observable"


def scatter_of(estimate: JointEstimate) -> RigScatter:
    """What differs most of a rig that does not stay the same."""
    listed = estimate.parameters.listed
    k = int(np.argmax(estimate.scatter_sd / estimate.formal_sd))
    return RigScatter(
        sensor=listed[k].sensor,
        quantity=listed[k].quantity,
        axis=listed[k].axis,
        unit=listed[k].unit,
        sd=float(estimate.scatter_sd[k]),
        factor=float(np.sqrt(estimate.disagreement)),
    )


def split_beams(
    rows: Sequence[ParameterFigures],
) -> tuple[tuple[ParameterFigures, ...], tuple[ParameterFigures, ...]]:
    """The rows of mounts and clocks, and those of single beams."""
    mounts = tuple(row for row in rows if not row.quantity.startswith("beam"))
    return mounts, tuple(row for row in rows if row.quantity.startswith("beam"))
