"""Rigid motions of the plane as arrays (..., 3): x [m], y [m], yaw [rad].

``T_a_b`` maps points of frame ``b`` into frame ``a``, as in `recon4.geometry.se3`.
"""

from __future__ import annotations

import numpy as np

from recon4.geometry.se3 import SE3, Array, so3_exp


def wrap(angle_rad: Array) -> Array:
    """Angles in -pi to pi [rad]."""
    return np.asarray((np.asarray(angle_rad) + np.pi) % (2.0 * np.pi) - np.pi)


def compose(T_a_b: Array, T_b_c: Array) -> Array:
    """``T_a_c``; leading axes broadcast."""
    yaw = T_a_b[..., 2]
    c, s = np.cos(yaw), np.sin(yaw)
    x = T_a_b[..., 0] + c * T_b_c[..., 0] - s * T_b_c[..., 1]
    y = T_a_b[..., 1] + s * T_b_c[..., 0] + c * T_b_c[..., 1]
    return np.stack([x, y, wrap(yaw + T_b_c[..., 2])], axis=-1)


def inverse(T_a_b: Array) -> Array:
    """``T_b_a``."""
    c, s = np.cos(T_a_b[..., 2]), np.sin(T_a_b[..., 2])
    x = -c * T_a_b[..., 0] - s * T_a_b[..., 1]
    y = s * T_a_b[..., 0] - c * T_a_b[..., 1]
    return np.stack([x, y, wrap(-T_a_b[..., 2])], axis=-1)


def between(T_a_b: Array, T_a_c: Array) -> Array:
    """``T_b_c``: the second pose seen from the first."""
    return compose(inverse(T_a_b), T_a_c)


def transform(T_a_b: Array, p_b: Array) -> Array:
    """Points (P, 2) of frame ``b`` in frame ``a``; one motion (3,), or one for each point."""
    c, s = np.cos(T_a_b[..., 2]), np.sin(T_a_b[..., 2])
    x = c * p_b[..., 0] - s * p_b[..., 1] + T_a_b[..., 0]
    y = s * p_b[..., 0] + c * p_b[..., 1] + T_a_b[..., 1]
    return np.stack([x, y], axis=-1)


def to_se3(T_a_b: Array) -> SE3:
    """The motions in space: no height, no roll, no pitch."""
    T = np.asarray(T_a_b, dtype=np.float64)
    zero = np.zeros_like(T[..., 2])
    omega = np.stack([zero, zero, T[..., 2]], axis=-1)
    return SE3(so3_exp(omega), np.stack([T[..., 0], T[..., 1], zero], axis=-1))


def from_se3(T_a_b: SE3) -> Array:
    """The horizontal part of motions in space, (..., 3)."""
    yaw = np.arctan2(T_a_b.R[..., 1, 0], T_a_b.R[..., 0, 0])
    return np.stack([T_a_b.t[..., 0], T_a_b.t[..., 1], yaw], axis=-1)
