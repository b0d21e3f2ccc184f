"""What an estimate says of each parameter: consistent with the rig file, off, or not observable."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from recon4.calibration.joint import SIGMAS, JointEstimate
from recon4.calibration.parameters import Parameter, Unit
from recon4.model.figures import GNSS, IMU, ParameterFigures, ParameterStatus
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
_NAMES = {IMU: "IMU", GNSS: "GNSS antenna"}
_SHOWN: dict[Unit, tuple[float, str]] = {
    "rad": (float(np.rad2deg(1.0)), "°"),
    "m": (100.0, " cm"),
    "s": (1e3, " ms"),
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
    agrees = sd <= limits.observable_sd and abs(change) <= max(SIGMAS * sd, limits.tolerance)
    return "consistent" if agrees else "not observable"


def changed_text(estimate: JointEstimate) -> str:
    """A sentence about a rig that does not stay the same; it names what differs most."""
    listed = estimate.parameters.listed
    k = int(np.argmax(estimate.scatter_sd / estimate.formal_sd))
    factor, unit = _SHOWN[listed[k].unit]
    name = _NAMES.get(listed[k].sensor, f"LiDAR {listed[k].sensor!r}")
    relation = "about" if listed[k].quantity == "rotation" else "along"
    axis = f" {relation} {listed[k].axis}" if listed[k].axis else ""
    return (
        "The rig does not stay the same during the walk: parts of the walk disagree by "
        f"{np.sqrt(estimate.disagreement):.0f} times what noise explains, most in the "
        f"{listed[k].quantity}{axis} of the {name} against the other sensors (they scatter by "
        f"{factor * estimate.scatter_sd[k]:.2f}{unit}). A mount has slipped, or a clock has "
        "jumped: walls are doubled, and no calibration corrects that. Fix it and record again."
    )


def split_beams(
    rows: Sequence[ParameterFigures],
) -> tuple[tuple[ParameterFigures, ...], tuple[ParameterFigures, ...]]:
    """The rows of mounts and clocks, and those of single beams."""
    mounts = tuple(row for row in rows if not row.quantity.startswith("beam"))
    return mounts, tuple(row for row in rows if row.quantity.startswith("beam"))


def contradictions(rows: Sequence[ParameterFigures], *, applied: bool = False) -> tuple[str, ...]:
    """A sentence for each sensor that is not where, or when, the rig file says.

    Args:
        rows: What the recording says of the parameters.
        applied: Whether the calibrated rig is used.
    """
    sensors = dict.fromkeys(row.sensor for row in rows if row.status == "off")
    advice = (
        "The calibrated rig is used for this map."
        if applied
        else "Calibrate the rig (recon4 calibrate)."
    )
    return tuple(
        f"{_sentence(name, [row for row in rows if row.sensor == name])} {advice}"
        for name in sensors
    )


def _sentence(sensor: str, rows: Sequence[ParameterFigures]) -> str:
    parts = [part for quantity in ("rotation", "position") for part in _vector(rows, quantity)]
    parts += [
        f"its clock by {_amount(row)}" for row in rows
        if row.quantity == "clock" and row.status == "off"
    ]  # fmt: skip
    parts += _beams(rows)
    name = _NAMES.get(sensor, f"LiDAR {sensor!r}")
    return (
        f"The rig file contradicts the recording: the {name} differs from it by "
        f"{' and '.join(parts)}."
    )


def _vector(rows: Sequence[ParameterFigures], quantity: str) -> list[str]:
    """``1.36° ± 0.02° (rotation, mostly about y)``, if any axis is off."""
    of_kind = [row for row in rows if row.quantity == quantity]
    if not any(row.status == "off" for row in of_kind):
        return []
    change = np.array([row.change for row in of_kind])
    length = float(np.linalg.norm(change))
    sd_of_axes = np.array([row.sd or 0.0 for row in of_kind])
    sd = float(np.linalg.norm(change / length * sd_of_axes))
    main = of_kind[int(np.argmax(np.abs(change)))]
    factor, unit = _SHOWN[main.unit]
    relation = "about" if quantity == "rotation" else "along"
    return [
        f"{length * factor:.2f}{unit} ± {sd * factor:.2f}{unit} "
        f"({quantity}, mostly {relation} {main.axis})"
    ]


def _beams(rows: Sequence[ParameterFigures]) -> list[str]:
    """``the range of 7 beams by up to 8.1 mm``, and the same of elevation and azimuth."""
    parts = []
    for quantity in ("range", "elevation", "azimuth"):
        off = [row for row in rows if row.quantity == f"beam {quantity}" and row.status == "off"]
        if off:
            most = max(abs(row.change) for row in off)
            size = f"{1e3 * most:.1f} mm" if quantity == "range" else f"{np.rad2deg(most):.3f}°"
            parts.append(f"the {quantity} of {len(off)} beams by up to {size}")
    return parts


def _amount(row: ParameterFigures) -> str:
    factor, unit = _SHOWN[row.unit]
    return f"{row.change * factor:.1f}{unit} ± {(row.sd or 0.0) * factor:.1f}{unit}"
