"""A constant and a clock that are hidden by a slow drift, from measurements beside a trajectory.

A measurement differs from the trajectory by the drift of the trajectory and the slow error of the
receiver, by a constant that turns with the body, and by an error of the clock times a rate:

    measured - predicted  =  drift(t) + R constant + rate clock + noise

Of positions the constant is the lever arm and the rate the velocity; of attitudes they are the
mount of the receiver and the angular rate. Drift is a random walk: turns, stops and the sway of the
body tell the others from it.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.sparse import csr_array, diags_array, eye_array, kron
from scipy.sparse.linalg import splu

from recon4.geometry.se3 import Array
from recon4.georeference.tuning_clocks import DRIFT_FIT

UNKNOWNS = 4
"""Constant (3) and clock."""
_MEDIAN_CHI2_3 = 2.37
"""Median of chi-square with 3 degrees of freedom."""


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class DriftRows:
    """Measurements beside the trajectory. All in east, north, up."""

    t_s: Array
    """After the first of them [s], (N,)."""
    offset: Array
    """Measured minus predicted [m] or [rad], (N, 3)."""
    R_enu_body: Array
    """(N, 3, 3)."""
    rate: Array
    """Of what is measured [m/s] or [rad/s], (N, 3)."""
    sd: Array
    """White error of the measurements, in their unit, (N, 3)."""


@dataclass(frozen=True, slots=True, eq=False)
class DriftFit:
    """What explains the measurements besides the drift."""

    x: Array
    """Constant and clock [s], (4,)."""
    cov: Array
    """Covariance, from the residuals, (4, 4)."""
    rms: float
    """Root mean square of the normalized residuals, those of outliers reduced."""


def fit_drift(rows: DriftRows, *, drift: float, fixed: bool = False) -> DriftFit:
    """Estimate constant and clock; the drift is eliminated, so the work grows with the length.

    Args:
        rows: The measurements.
        drift: Random walk of the drift, in their unit per square root of a second.
        fixed: Keep constant and clock at zero: only the drift explains the measurements.
    """
    J, J_drift, walk = _design(rows, drift)
    if fixed:
        J = np.zeros_like(J)
    y = (rows.offset / rows.sd).ravel()
    weight = np.ones(len(y))
    for _ in range(DRIFT_FIT.rounds):
        weighted = J_drift.multiply(weight[:, None]).tocsc()
        solver = splu((J_drift.T @ weighted + walk).tocsc())
        cross, of_y = weighted.T @ J, weighted.T @ y
        eliminated = solver.solve(cross)
        H = (J * weight[:, None]).T @ J + DRIFT_FIT.prior * np.eye(UNKNOWNS) - cross.T @ eliminated
        x = np.linalg.solve(H, J.T @ (weight * y) - eliminated.T @ of_y)
        residual = y - J @ x - J_drift @ solver.solve(of_y - cross @ x)
        z2 = np.repeat((residual.reshape(-1, 3) ** 2).sum(axis=1), 3)
        scale2 = max(float(np.median(z2)) / _MEDIAN_CHI2_3, 1.0)
        weight = 1.0 / (1.0 + z2 / (scale2 * DRIFT_FIT.cauchy_sd**2))
    used = np.sqrt(weight) * residual
    inflated = scale2 * _correlation(used.reshape(-1, 3))
    return DriftFit(np.asarray(x), inflated * np.linalg.inv(H), float(np.sqrt(np.mean(used**2))))


def _design(rows: DriftRows, drift: float) -> tuple[Array, csr_array, csr_array]:
    """Jacobians of the normalized offsets, and the information of the drift.

    Returns:
        Of constant and clock, (3 N, 4); of the drift at its knots, (3 N, 3 K); (3 K, 3 K).
    """
    count = len(rows.t_s)
    at = rows.t_s / DRIFT_FIT.knot_s
    knots = int(at[-1]) + 2
    left = np.minimum(at.astype(np.int64), knots - 2)
    s = at - left
    J = np.concatenate([rows.R_enu_body, rows.rate[:, :, None]], axis=2)
    J = (J / rows.sd[:, :, None]).reshape(3 * count, UNKNOWNS)
    row = np.arange(count)
    between = csr_array(
        (np.concatenate([1.0 - s, s]), (np.tile(row, 2), np.concatenate([left, left + 1]))),
        shape=(count, knots),
    )
    J_drift = kron(between, np.eye(3), format="csr").multiply(1.0 / rows.sd.reshape(-1, 1)).tocsr()
    change = diags_array([-1.0, 1.0], offsets=[0, 1], shape=(knots - 1, knots))
    walk = kron(change.T @ change, np.eye(3)) / (drift**2 * DRIFT_FIT.knot_s)
    return J, J_drift, (walk + DRIFT_FIT.prior * eye_array(3 * knots)).tocsr()


def _correlation(residual: NDArray[np.float64]) -> float:
    """How many consecutive residuals (N, 3) count as one, at least 1."""
    centered = residual - residual.mean(axis=0)
    power = float((centered**2).sum())
    if power <= 0.0:
        return 1.0
    lags = [
        float((centered[lag:] * centered[:-lag]).sum()) / power
        for lag in range(1, min(DRIFT_FIT.lags, len(centered) - 1))
    ]
    first_negative = next((k for k, rho in enumerate(lags) if rho <= 0.0), len(lags))
    return 1.0 + 2.0 * float(sum(lags[:first_negative]))
