"""Calibration of the GNSS receiver in a rig: lever arm and clock, checked on fixes not used."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from recon4.geometry.se3 import Array
from recon4.georeference.antenna_audit import audit_antenna, unexplained
from recon4.georeference.crs import GeodeticOrigin, to_enu
from recon4.georeference.gnss import align_heading
from recon4.georeference.gnss_priors import GnssPriors, positioned
from recon4.georeference.level import level
from recon4.georeference.tuning import GnssTuning
from recon4.georeference.tuning_clocks import ANTENNA_CALIBRATION
from recon4.model.calibration_figures import GNSS, GnssOutcome, ParameterFigures, ParameterStatus
from recon4.model.figures import AntennaFigures
from recon4.model.rig import Rig
from recon4.model.samples import GnssQuality, GnssSamples, ImuSamples
from recon4.model.trajectory import Trajectory
from recon4.settings import GnssSettings
from recon4.settings.tuning import tuned

_AXES = ("x", "y", "z", "")


@dataclass(frozen=True, slots=True)
class GnssRefusal:
    """Why a corrected receiver must not be used."""

    outcome: GnssOutcome
    names: tuple[str, ...] = ()
    """Parameters that another part of the walk gives another value for."""


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class AntennaCalibration:
    """What the fixes say of the receiver in the rig file."""

    rows: tuple[ParameterFigures, ...]
    """Lever arm along x, y, z of the body, and clock."""
    rig: Rig
    """With the values that are off corrected."""
    refusal: GnssRefusal | None
    """Why the corrected rig must not be used; None = it may."""

    @property
    def is_off(self) -> bool:
        """Whether the rig file contradicts the fixes."""
        return any(row.status == "off" for row in self.rows)


@dataclass(frozen=True, slots=True, eq=False)
class _Placed:
    """A walk on the earth."""

    trajectory: Trajectory
    """``T_enu_body``, dense."""
    origin: GeodeticOrigin

    def audit(self, gnss: GnssSamples, rig: Rig) -> AntennaFigures | None:
        return audit_antenna(self.trajectory, gnss, rig, origin=self.origin)

    def unexplained(self, gnss: GnssSamples, rig: Rig) -> float:
        return unexplained(self.trajectory, gnss, rig, origin=self.origin)


def calibrate_antenna(
    trajectory: Trajectory,
    gnss: GnssSamples | None,
    rig: Rig,
    *,
    imu: ImuSamples | None,
    settings: GnssSettings,
) -> AntennaCalibration | None:
    """Estimate lever arm and clock of the receiver, and check them on other parts of the walk.

    Args:
        trajectory: ``T_odom_body``, dense.
        gnss: The fixes, in the time of the rig.
        rig: Mounts, lever arm and clocks that the trajectory was made with.
        imu: Levels the walk, if the receiver measures no attitudes.
        settings: Gate of the fixes, to find the heading.

    Returns:
        None if there are too few fixes, or the walk cannot be placed on the earth.
    """
    placed = (
        _place(trajectory, gnss, rig, imu=imu, settings=tuned(GnssTuning, settings))
        if gnss
        else None
    )
    found = placed and gnss and placed.audit(gnss, rig)
    if not placed or not gnss or not found:
        return None
    change, sd = _change(found), _deviation(found)
    off = _off(found)
    rows = tuple(
        ParameterFigures(
            sensor=GNSS,
            quantity="position" if axis else "clock",
            axis=axis,
            unit="m" if axis else "s",
            change=float(change[k]),
            sd=float(sd[k]),
            status=_status(bool(off[k]), bool(sd[k] > ANTENNA_CALIBRATION.observable_sd[k])),
        )
        for k, axis in enumerate(_AXES)
    )
    return AntennaCalibration(
        rows=rows,
        rig=_corrected(rig, np.where(off, change, 0.0)),
        refusal=_refusal(placed, gnss, rig, off=off),
    )


def _status(off: bool, vague: bool) -> ParameterStatus:
    if off:
        return "off"
    return "not observable" if vague else "consistent"


def _off(found: AntennaFigures) -> NDArray[np.bool_]:
    """Which of the parameters the fixes contradict, (4,).

    All axes of the lever arm are judged together: the sway of a person shows its vertical part only
    roughly, and beside a large error of another axis.
    """
    change, sd = np.abs(_change(found)), _deviation(found)
    sigmas = np.array([found.arm_sigmas] * 3 + [change[3] / sd[3]])
    size = np.array([float(np.linalg.norm(change[:3]))] * 3 + [change[3]])
    tolerance = np.array(ANTENNA_CALIBRATION.tolerance)
    certain = (sigmas > ANTENNA_CALIBRATION.certain_sigmas) & (size > tolerance)
    return np.asarray(
        certain & (change > np.maximum(ANTENNA_CALIBRATION.sigmas * sd, 0.5 * tolerance))
    )


def _refusal(
    placed: _Placed, gnss: GnssSamples, rig: Rig, *, off: NDArray[np.bool_]
) -> GnssRefusal | None:
    """Why the corrected rig must not be used; None = it may."""
    if not off.any():
        return None
    odd = (gnss.t_ns - gnss.t_ns[0]) // ANTENNA_CALIBRATION.block_ns % 2 == 1
    used, others = gnss.take(~odd), gnss.take(odd)
    first = placed.audit(used, rig)
    error = np.array(ANTENNA_CALIBRATION.known_error)
    second = placed.audit(_later(others, error[3]), _corrected(rig, error))
    if first is None or second is None:
        return GnssRefusal(GnssOutcome.TOO_SHORT)
    apart = np.abs(_change(first) - _change(second) - error)
    scatter = ANTENNA_CALIBRATION.sigmas * np.hypot(_deviation(first), _deviation(second))
    wrong = off & (apart > np.maximum(scatter, 0.5 * np.abs(error)))
    if wrong.any():
        named = (f"position {axis}" if axis else "clock" for axis in _AXES)
        names = tuple(name for name, bad in zip(named, wrong, strict=True) if bad)
        return GnssRefusal(GnssOutcome.OTHER_VALUES, names)
    change = np.where(off, _change(first), 0.0)
    after = placed.unexplained(_later(others, change[3]), _corrected(rig, change))
    if not after < ANTENNA_CALIBRATION.better * placed.unexplained(others, rig):
        return GnssRefusal(GnssOutcome.NO_BETTER)
    return None


def _corrected(rig: Rig, change: Array) -> Rig:
    """The rig with a change of lever arm [m] and clock [s], (4,)."""
    return replace(
        rig,
        p_body_antenna=rig.p_body_antenna + change[:3],
        gnss_time_offset_s=rig.gnss_time_offset_s + float(change[3]),
    )


def _change(found: AntennaFigures) -> Array:
    return np.array([*found.arm_m, found.clock_s])


def _deviation(found: AntennaFigures) -> Array:
    return np.array([*found.arm_sd_m, found.clock_sd_s])


def _place(
    trajectory: Trajectory,
    gnss: GnssSamples,
    rig: Rig,
    *,
    imu: ImuSamples | None,
    settings: GnssTuning,
) -> _Placed | None:
    """Level a walk and turn it to the fixes; None if that is not possible."""
    good = (gnss.quality == GnssQuality.RTK_FIXED) & positioned(gnss)
    good &= (gnss.t_ns >= trajectory.t_ns[0]) & (gnss.t_ns <= trajectory.t_ns[-1])
    rows = np.flatnonzero(good)
    leveling = level(trajectory, imu, rig, gnss=gnss)
    if leveling.source == "none" or len(rows) < 2:
        return None
    leveled = Trajectory(trajectory.t_ns, leveling.T_level_odom @ trajectory.T_a_b)
    few = rows[:: 1 + len(rows) // 500]
    first = few[0]
    origin = GeodeticOrigin(
        float(gnss.lat_rad[first]), float(gnss.lon_rad[first]), float(gnss.height_m[first])
    )
    p_body = np.broadcast_to(rig.p_body_antenna, (len(few), 3))
    p_level = leveled.at(gnss.t_ns[few]) @ p_body
    priors = GnssPriors(
        t_ns=gnss.t_ns[few],
        row=few,
        p_enu=to_enu(
            origin, gnss.lat_rad[few], gnss.lon_rad[few], ellipsoidal_height_m=gnss.height_m[few]
        ),
        sd_m=np.fmax(gnss.sd_enu_m[few], settings.min_sd_m),
        node=np.arange(len(few)),
        p_node_antenna=p_body,
    )
    T_enu_level, near = align_heading(p_level, priors, settings=settings)
    extent_m = float(np.linalg.norm(np.ptp(p_level[near, :2], axis=0))) if near.any() else 0.0
    if extent_m < settings.min_extent_m:
        return None
    return _Placed(Trajectory(leveled.t_ns, T_enu_level @ leveled.T_a_b), origin)


def _later(gnss: GnssSamples, clock_s: float) -> GnssSamples:
    """The fixes in the time of a rig whose clock offset of the receiver is larger."""
    return replace(gnss, t_ns=gnss.t_ns + round(1e9 * clock_s))
