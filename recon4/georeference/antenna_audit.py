"""Audit of the GNSS receiver against the trajectory: lever arm of the antenna, and its clock.

A fix lies beside the antenna of the trajectory by the drift of the trajectory and the slow error of
GNSS, by an error of the lever arm, which turns with the body, and by an error of the clock, which
grows with the speed:

    p_fix - (p_body + R p_body_antenna)  =  drift(t) + R d_arm + v d_clock + noise

Drift is a random walk. Turns, stops and the sway of the body tell the others from it.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.sparse import csr_array, diags_array, eye_array, kron
from scipy.sparse.linalg import splu

from recon4.geometry.se3 import SE3, Array
from recon4.georeference.crs import GeodeticOrigin, to_enu
from recon4.model.figures import AntennaFigures
from recon4.model.rig import Rig
from recon4.model.samples import GnssQuality, GnssSamples
from recon4.model.trajectory import Times, Trajectory

_KNOT_S = 2.0
"""The drift is linear between knots this far apart [s]."""
_DRIFT_M = 0.01
"""Random walk of the drift [m/sqrt(s)]: of the trajectory and of the slow error of GNSS."""
_MIN_SD_M = 0.008
"""No fix has a smaller white error [m]."""
_MAX_SD_M = 0.1
"""Fixes with a larger stated standard deviation are not used [m]."""
_SPEED_NS = 50_000_000
"""The velocity is measured over this time before and after a fix [ns]."""
_CAUCHY_SD = 3.0
_ROUNDS = 8
_CREDIBLE_S = 1.0
"""A larger error of the clock is one of the trajectory: nothing can be compared [s]."""
_RELINEARIZED = 2
"""How many times the fixes are shifted by the clock: a body sways within 100 ms."""
_MIN_FIXES = 50
_LAGS = 30
"""Longest lag of the residuals' correlation, in fixes."""
_PARAMETERS = 4
"""Lever arm (3) and clock."""
_PRIOR = 1e-6
"""Information of every unknown, so that all are determined."""
_LEVER_ARM_M, _CLOCK_S = 0.05, 0.02
"""Smaller errors are not announced."""
_SIGMAS = 4.5
_SD_FACTOR = 1.5
"""True errors of the estimate against the stated ones, on 32 walks with a drift of 5 mm/sqrt(s)."""
_UNKNOWN_M = 0.05
"""With a larger standard deviation the walk says nothing of a lever arm [m]."""


@dataclass(frozen=True, slots=True, eq=False)
class FixRows:
    """Fixes beside the trajectory. All in east, north, up."""

    t_s: Array
    """After the first of them [s], (N,)."""
    offset_m: Array
    """Measured minus predicted position of the antenna, (N, 3)."""
    R_enu_body: Array
    """(N, 3, 3)."""
    velocity_m_s: Array
    """Of the antenna, (N, 3)."""
    sd_m: Array
    """(N, 3)."""


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
    rows = _beside(trajectory, gnss, rig, origin=origin, clock_s=0.0)
    if rows is None:
        return None
    x, cov = _solve(rows)
    clock_s = float(x[3])
    for _ in range(_RELINEARIZED):
        shifted = _beside(trajectory, gnss, rig, origin=origin, clock_s=clock_s)
        if shifted is None:
            break
        rows = shifted
        x, cov = _solve(rows)
        clock_s += float(x[3])
    if abs(clock_s) > _CREDIBLE_S:
        return None
    sd = np.sqrt(np.diag(cov))
    return AntennaFigures(
        arm_m=_triple(x[:3]),
        arm_sd_m=_triple(sd[:3]),
        arm_sigmas=float(np.sqrt(x[:3] @ np.linalg.solve(cov[:3, :3], x[:3]))),
        clock_s=clock_s,
        clock_sd_s=float(sd[3]),
        fixes=len(rows.t_s),
    )


def antenna_contradictions(found: AntennaFigures) -> tuple[str, ...]:
    """A sentence for a lever arm, and one for a clock, that the fixes contradict.

    A horizontal lever arm that the walk cannot show is said, too: an error would move the map. Of
    the vertical one only the sway of a person tells; on a cart it must be measured with care.
    """
    texts = []
    arm, sd = np.array(found.arm_m), np.array(found.arm_sd_m)
    if found.arm_sigmas > _SIGMAS and np.linalg.norm(arm) > _LEVER_ARM_M:
        parts = (
            f"{name} {100 * value:+.0f} cm ± {100 * sd_of:.0f} cm"
            for name, value, sd_of in zip("xyz", arm, sd, strict=True)
        )
        texts.append(
            "The rig file contradicts the GNSS fixes: the antenna differs from it by "
            f"{', '.join(parts)} in axes of the body. Measure the lever arm."
        )
    elif sd[:2].max() > _UNKNOWN_M:
        texts.append(
            "The lever arm of the GNSS antenna could not be checked "
            f"(± {100 * sd[:2].max():.0f} cm): the walk has too few turns. An error of the rig "
            "file moves the map by as much."
        )
    if abs(found.clock_s) > max(_SIGMAS * found.clock_sd_s, _CLOCK_S):
        texts.append(
            "The rig file contradicts the GNSS fixes: their clock differs by "
            f"{1e3 * found.clock_s:.0f} ms ± {1e3 * found.clock_sd_s:.0f} ms. Check the time "
            "offset of the receiver."
        )
    return tuple(texts)


def _triple(v: Array) -> tuple[float, float, float]:
    x, y, z = v.tolist()
    return x, y, z


def _beside(
    trajectory: Trajectory,
    gnss: GnssSamples,
    rig: Rig,
    *,
    origin: GeodeticOrigin,
    clock_s: float,
) -> FixRows | None:
    t_ns = gnss.t_ns + round(1e9 * clock_s)
    sd_m = np.nan_to_num(gnss.sd_enu_m, nan=_MIN_SD_M)
    good = (gnss.quality == GnssQuality.RTK_FIXED) & (sd_m.max(axis=1) <= _MAX_SD_M)
    good &= np.isfinite(gnss.lat_rad) & np.isfinite(gnss.lon_rad) & np.isfinite(gnss.height_m)
    good &= t_ns - _SPEED_NS >= trajectory.t_ns[0]
    good &= t_ns + _SPEED_NS <= trajectory.t_ns[-1]
    if good.sum() < _MIN_FIXES:
        return None
    t_ns = t_ns[good]
    p_fix = to_enu(origin, gnss.lat_rad[good], gnss.lon_rad[good], height_m=gnss.height_m[good])
    T_enu_body = trajectory.at(t_ns)
    return FixRows(
        t_s=(t_ns - t_ns[0]) / 1e9,
        offset_m=p_fix - _antenna(T_enu_body, rig),
        R_enu_body=T_enu_body.R,
        velocity_m_s=_velocity(trajectory, rig, t_ns),
        sd_m=np.maximum(sd_m[good], _MIN_SD_M),
    )


def _antenna(T_enu_body: SE3, rig: Rig) -> Array:
    return T_enu_body @ np.broadcast_to(rig.p_body_antenna, (len(T_enu_body), 3))


def _velocity(trajectory: Trajectory, rig: Rig, t_ns: Times) -> Array:
    before, after = (_antenna(trajectory.at(t_ns + d), rig) for d in (-_SPEED_NS, _SPEED_NS))
    return np.asarray((after - before) / (2e-9 * _SPEED_NS))


def _solve(rows: FixRows) -> tuple[Array, Array]:
    """Lever arm and clock, (4,), and their covariance from the residuals, (4, 4).

    The drift has three unknowns every two seconds; it is eliminated, so that the work grows with
    the length of the walk.
    """
    J, J_drift, walk = _design(rows)
    y = (rows.offset_m / rows.sd_m).ravel()
    weight = np.ones(len(y))
    for _ in range(_ROUNDS):
        weighted = J_drift.multiply(weight[:, None]).tocsc()
        drift = splu((J_drift.T @ weighted + walk).tocsc())
        cross, of_y = weighted.T @ J, weighted.T @ y
        eliminated = drift.solve(cross)
        H = (J * weight[:, None]).T @ J + _PRIOR * np.eye(_PARAMETERS) - cross.T @ eliminated
        x = np.linalg.solve(H, J.T @ (weight * y) - eliminated.T @ of_y)
        residual = y - J @ x - J_drift @ drift.solve(of_y - cross @ x)
        z2 = np.repeat((residual.reshape(-1, 3) ** 2).sum(axis=1), 3)
        scale2 = max(float(np.median(z2)) / 2.37, 1.0)  # the median of chi-square with 3 degrees
        weight = 1.0 / (1.0 + z2 / (scale2 * _CAUCHY_SD**2))
    used = np.sqrt(weight) * residual
    inflated = _SD_FACTOR**2 * scale2 * _correlation(used.reshape(-1, 3))
    return np.asarray(x, np.float64), np.asarray(inflated * np.linalg.inv(H), np.float64)


def _design(rows: FixRows) -> tuple[Array, csr_array, csr_array]:
    """Jacobians of the normalized offsets, and the information of the drift.

    Returns:
        Of lever arm and clock, (3 N, 4); of the drift at its knots, (3 N, 3 K); (3 K, 3 K).
    """
    count = len(rows.t_s)
    at = rows.t_s / _KNOT_S
    knots = int(at[-1]) + 2
    left = np.minimum(at.astype(np.int64), knots - 2)
    s = at - left
    J = np.concatenate([rows.R_enu_body, rows.velocity_m_s[:, :, None]], axis=2)
    J = (J / rows.sd_m[:, :, None]).reshape(3 * count, _PARAMETERS)
    fix = np.arange(count)
    between = csr_array(
        (np.concatenate([1.0 - s, s]), (np.tile(fix, 2), np.concatenate([left, left + 1]))),
        shape=(count, knots),
    )
    J_drift = (
        kron(between, np.eye(3), format="csr").multiply(1.0 / rows.sd_m.reshape(-1, 1)).tocsr()
    )
    change = diags_array([-1.0, 1.0], offsets=[0, 1], shape=(knots - 1, knots))
    walk = kron(change.T @ change, np.eye(3)) / (_DRIFT_M**2 * _KNOT_S)
    return J, J_drift, (walk + _PRIOR * eye_array(3 * knots)).tocsr()


def _correlation(residual: NDArray[np.float64]) -> float:
    """How many consecutive residuals (N, 3) count as one, at least 1."""
    centered = residual - residual.mean(axis=0)
    power = float((centered**2).sum())
    if power <= 0.0:
        return 1.0
    lags = [
        float((centered[lag:] * centered[:-lag]).sum()) / power
        for lag in range(1, min(_LAGS, len(centered) - 1))
    ]
    first_negative = next((k for k, rho in enumerate(lags) if rho <= 0.0), len(lags))
    return 1.0 + 2.0 * float(sum(lags[:first_negative]))
