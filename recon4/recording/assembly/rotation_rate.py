"""Estimates the rotation rate of a LiDAR from its points."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from recon4.geometry.se3 import Array
from recon4.model.trajectory import Times
from recon4.recording.assembly.shots import Shots
from recon4.recording.assembly.tuning import ROTATION


def rotation_rate(t_ns: Times, xyz: NDArray[np.float32]) -> float:
    """Estimate revolutions per second; NaN if the points do not rotate evenly.

    The azimuth of a turning sensor is ``a0 +- 2 pi f t``. The rate is the ``f`` at which the
    phasors ``exp(i (a -+ 2 pi f t))`` agree best: neither holes in the view nor the order matter.

    Args:
        t_ns: Times of the points [ns], (N,); half a second of them is enough, and those that are
            far from most others do not count.
        xyz: Points in the frame of the sensor [m], (N, 3).
    """
    if len(t_ns) < 50:
        return float("nan")
    median_ns = np.partition(t_ns, len(t_ns) // 2)[len(t_ns) // 2]
    together = np.abs(t_ns - median_ns) <= ROTATION.longest_ns
    t_ns, xyz = t_ns[together], xyz[together]
    rows = np.linspace(0, len(t_ns) - 1, min(ROTATION.points, len(t_ns))).astype(np.intp)
    t_s = (t_ns[rows] - t_ns[0]) * 1e-9
    span_s = float(np.ptp(t_s))
    if span_s < 0.03:
        return float("nan")
    azimuth = np.arctan2(xyz[rows, 1], xyz[rows, 0]).astype(np.float64)
    step = min(0.1, 0.2 / span_s)
    rates = np.arange(ROTATION.slowest_hz, ROTATION.fastest_hz, step)
    best, clear = max((_strongest(azimuth * sign, t_s, rates) for sign in (1.0, -1.0)), key=_clear)
    return best if clear > ROTATION.clear else float("nan")


def rotation_of_head(shots: Sequence[Shots], head_ns: int) -> float:
    """`rotation_rate` of the first points of batches that follow each other; copies no points.

    Args:
        shots: Of one sensor.
        head_ns: Points up to this long after the first one count [ns].
    """
    end_ns = next(int(part.t_ns[0]) for part in shots if len(part)) + head_ns
    ends = np.cumsum([np.count_nonzero(part.t_ns <= end_ns) for part in shots])
    places = np.linspace(0, ends[-1] - 1, min(ROTATION.points, int(ends[-1]))).astype(np.intp)
    t_ns, xyz, start = [], [], 0
    for part, end in zip(shots, ends.tolist(), strict=True):
        own = places[(places >= start) & (places < end)] - start
        rows = np.flatnonzero(part.t_ns <= end_ns)[own]
        t_ns.append(part.t_ns[rows])
        xyz.append(part.xyz[rows])
        start = end
    return rotation_rate(np.concatenate(t_ns), np.concatenate(xyz))


def nominal(rate_hz: float) -> float:
    """Round to the configured whole number of revolutions per second if it is within 0.5 %."""
    whole = max(1.0, float(round(rate_hz)))
    return whole if abs(rate_hz / whole - 1.0) < ROTATION.snap else rate_hz


def _clear(found: tuple[float, float]) -> float:
    return found[1]


def _strongest(azimuth: Array, t_s: Array, rates_hz: Array) -> tuple[float, float]:
    """Rate with the longest mean phasor, refined by a parabola, and that length."""
    phasors = np.exp(1j * azimuth)
    length = np.array([abs(np.mean(phasors * np.exp(-2j * np.pi * f * t_s))) for f in rates_hz])
    k = int(np.clip(np.argmax(length), 1, len(length) - 2))
    left, middle, right = length[k - 1 : k + 2]
    bend = left - 2.0 * middle + right
    shift = float(np.clip(0.5 * (left - right) / bend, -1.0, 1.0)) if bend < 0.0 else 0.0
    return float(rates_hz[k] + shift * (rates_hz[1] - rates_hz[0])), float(length[k])
