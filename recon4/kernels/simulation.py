"""Kernels of the simulation: poses of shots, rays, and returns."""

from __future__ import annotations

import math

import numpy as np
from numba import njit
from numpy.typing import NDArray


@njit(cache=True, nogil=True, error_model="numpy")
def evaluate_polynomials(
    coefficients: NDArray[np.float64],
    step_s: float,
    t_s: NDArray[np.float64],
    derivative: int,
    out: NDArray[np.float64],
) -> None:
    """Evaluate piecewise polynomials around the middles of equal intervals.

    Args:
        coefficients: (intervals, degree + 1, K), ascending powers of the time from the middle.
        step_s: Length of an interval [s].
        t_s: Times [s], (N,); the ends are extrapolated.
        derivative: 0, 1 or 2.
        out: (N, K), filled.
    """
    intervals, terms, width = coefficients.shape
    for i in range(len(t_s)):
        k = min(max(math.floor(t_s[i] / step_s), 0), intervals - 1)
        h = t_s[i] - (k + 0.5) * step_s
        for j in range(width):
            value = 0.0
            for p in range(terms - 1, derivative - 1, -1):
                factor = 1.0
                for d in range(derivative):
                    factor *= p - d
                value = value * h + factor * coefficients[k, p, j]
            out[i, j] = value


@njit(cache=True, nogil=True, error_model="numpy")
def make_rays(
    state: NDArray[np.float64],
    mount_R: NDArray[np.float64],
    mount_t: NDArray[np.float64],
    shot: NDArray[np.float64],
    rays: NDArray[np.float32],
) -> None:
    """Central and a second ray of each shot, in the map.

    Args:
        state: x, y, z [m], roll, pitch, yaw [rad] of the body at the time of each shot, (N, 6).
        mount_R: ``R_body_sensor``, (3, 3).
        mount_t: Sensor in the body [m], (3,).
        shot: Azimuth, elevation [rad], height of the beam's origin [m], azimuth and elevation of
            the second ray relative to the first [rad], x and y of the origin [m], (N, 7).
        rays: (2 N, 6) float32, filled: first the N central rays, then the N second ones.
    """
    n = len(state)
    for i in range(n):
        cr, sr = math.cos(state[i, 3]), math.sin(state[i, 3])
        cp, sp = math.cos(state[i, 4]), math.sin(state[i, 4])
        cy, sy = math.cos(state[i, 5]), math.sin(state[i, 5])
        r00, r01, r02 = cy * cp, cy * sp * sr - sy * cr, cy * sp * cr + sy * sr
        r10, r11, r12 = sy * cp, sy * sp * sr + cy * cr, sy * sp * cr - cy * sr
        r20, r21, r22 = -sp, cp * sr, cp * cr
        x, y, z = shot[i, 5], shot[i, 6], shot[i, 2]
        bx = mount_t[0] + mount_R[0, 2] * z + mount_R[0, 0] * x + mount_R[0, 1] * y
        by = mount_t[1] + mount_R[1, 2] * z + mount_R[1, 0] * x + mount_R[1, 1] * y
        bz = mount_t[2] + mount_R[2, 2] * z + mount_R[2, 0] * x + mount_R[2, 1] * y
        ox = state[i, 0] + r00 * bx + r01 * by + r02 * bz
        oy = state[i, 1] + r10 * bx + r11 * by + r12 * bz
        oz = state[i, 2] + r20 * bx + r21 * by + r22 * bz
        for second in range(2):
            azimuth = shot[i, 0] + second * shot[i, 3]
            elevation = shot[i, 1] + second * shot[i, 4]
            ce = math.cos(elevation)
            sx, sy_, sz = ce * math.cos(azimuth), -ce * math.sin(azimuth), math.sin(elevation)
            dx = mount_R[0, 0] * sx + mount_R[0, 1] * sy_ + mount_R[0, 2] * sz
            dy = mount_R[1, 0] * sx + mount_R[1, 1] * sy_ + mount_R[1, 2] * sz
            dz = mount_R[2, 0] * sx + mount_R[2, 1] * sy_ + mount_R[2, 2] * sz
            row = i + second * n
            rays[row, 0], rays[row, 1], rays[row, 2] = ox, oy, oz
            rays[row, 3] = r00 * dx + r01 * dy + r02 * dz
            rays[row, 4] = r10 * dx + r11 * dy + r12 * dz
            rays[row, 5] = r20 * dx + r21 * dy + r22 * dz


@njit(cache=True, nogil=True, error_model="numpy")
def hits_carrier(
    shot: NDArray[np.float64],
    mount_R: NDArray[np.float64],
    mount_t: NDArray[np.float64],
    carrier: NDArray[np.float64],
    blocked: NDArray[np.bool_],
) -> None:
    """Mark shots that hit the carrier: an upright cylinder in the body.

    Args:
        shot: As in `make_rays`, (N, 7).
        mount_R: ``R_body_sensor``, (3, 3).
        mount_t: Sensor in the body [m], (3,).
        carrier: x, y of the axis, radius, bottom, top [m], (5,).
        blocked: (N,) bool, filled.
    """
    cx, cy = mount_t[0] - carrier[0], mount_t[1] - carrier[1]
    c = cx * cx + cy * cy - carrier[2] * carrier[2]
    for i in range(len(shot)):
        ce = math.cos(shot[i, 1])
        sx, sy, sz = ce * math.cos(shot[i, 0]), -ce * math.sin(shot[i, 0]), math.sin(shot[i, 1])
        dx = mount_R[0, 0] * sx + mount_R[0, 1] * sy + mount_R[0, 2] * sz
        dy = mount_R[1, 0] * sx + mount_R[1, 1] * sy + mount_R[1, 2] * sz
        dz = mount_R[2, 0] * sx + mount_R[2, 1] * sy + mount_R[2, 2] * sz
        a = dx * dx + dy * dy
        half = cx * dx + cy * dy
        root = half * half - a * c
        blocked[i] = False
        if a > 1e-12 and root > 0.0 and half < 0.0:
            near = mount_t[2] + dz * (-half - math.sqrt(root)) / a
            far = mount_t[2] + dz * (-half + math.sqrt(root)) / a
            low, high = min(near, far), max(near, far)
            blocked[i] = high > carrier[3] and low < carrier[4]


@njit(cache=True, nogil=True, error_model="numpy")
def measure(
    range_m: NDArray[np.float32],
    triangle: NDArray[np.uint32],
    normal: NDArray[np.float32],
    rays: NDArray[np.float32],
    reflectivity: NDArray[np.float32],
    blocked: NDArray[np.bool_],
    gain: NDArray[np.float64],
    noise: NDArray[np.float32],
    rules: NDArray[np.float64],
    distance: NDArray[np.uint32],
    intensity: NDArray[np.uint8],
    truth: NDArray[np.uint8],
) -> None:
    """Simulate the measurement of each shot; the model is in ``docs/explanation/simulation.md``.

    Args:
        range_m: Hits of central and second rays, (2 N,).
        triangle: Their triangles, (2 N,).
        normal: Their normals, (2 N, 3).
        rays: Their rays, (2 N, 6).
        reflectivity: Of each triangle, (T,).
        blocked: Shots that hit the carrier, (N,).
        gain: Of the beam of each shot, (N,).
        noise: Standard normal for range and intensity, uniform for mixing and for losses, (N, 4).
        rules: sigma [m], shortest and longest range [m], weakest signal, longest mixed step [m],
            random loss, intensity noise relative and absolute, glass, resolution [m], what is added
            to the range [m], (11,).
        distance: (N,) uint32, filled: in units of the resolution, 0 = no return.
        intensity: (N,) uint8, filled.
        truth: (N,) uint8, filled: hundred times the true reflectivity, 0 = no return.
    """
    n = len(blocked)
    for i in range(n):
        distance[i], intensity[i], truth[i] = 0, 0, 0
        r = range_m[i]
        if blocked[i] or not (r < rules[2]):
            continue
        cosine = abs(
            normal[i, 0] * rays[i, 3] + normal[i, 1] * rays[i, 4] + normal[i, 2] * rays[i, 5]
        )
        rho = reflectivity[triangle[i]]
        if rho < rules[8] and cosine < 0.95:
            continue
        signal = rho * cosine / max(r * r, 0.25)
        # A logistic in the logarithm of the signal: half of the shots return at the weakest signal.
        chance = 1.0 / (1.0 + (rules[3] / max(signal, 1e-12)) ** 3)
        if noise[i, 3] > chance * (1.0 - rules[5]):
            continue
        gap = range_m[n + i] - r
        if abs(gap) < rules[4]:
            r += (0.5 * noise[i, 2]) * gap
        measured = r + rules[0] * noise[i, 0]
        units = round((measured + rules[10]) / rules[9])
        if measured < rules[1] or measured > rules[2] or units <= 0:
            continue
        near = 1.0 - math.exp(-r / 0.8)
        far = math.exp(-r / 60.0)
        expected = 100.0 * rho * gain[i] * near * far * (0.25 + 0.75 * cosine)
        value = expected * (1.0 + rules[6] * noise[i, 1]) + rules[7] * noise[i, 1]
        distance[i] = np.uint32(units)
        intensity[i] = np.uint8(min(max(round(value), 0.0), 255.0))
        truth[i] = np.uint8(min(max(round(100.0 * rho), 1.0), 255.0))
