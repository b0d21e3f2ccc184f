"""The head of a profiler: it sweeps back and forth, to skip the person behind it."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from recon4.geometry.se3 import Array


@dataclass(frozen=True, slots=True, kw_only=True)
class HeadModel:
    """How the head turns (requirements A1, L-HW: 6 s a sweep, 90° behind the person skipped)."""

    sweep_rad: float = float(np.deg2rad(270.0))
    """From one reversal to the next [rad]."""
    sweep_s: float = 6.0
    """Duration of a sweep [s]."""
    reversal_s: float = 0.3
    """Duration of braking, and of starting again, at either end [s]."""
    encoder_sd_rad: float = float(np.deg2rad(0.002))
    """Standard deviation of a reported angle [rad]."""

    def angle_rad(self, t_s: Array) -> Array:
        """True angle of the head, from - sweep / 2 to sweep / 2 and back, (N,) -> (N,)."""
        phase = np.mod(t_s, 2.0 * self.sweep_s)
        since = np.where(phase < self.sweep_s, phase, 2.0 * self.sweep_s - phase)
        braking = self.reversal_s
        speed = self.sweep_rad / (self.sweep_s - braking)
        left = self.sweep_s - since
        travelled = speed * (since - 0.5 * braking)
        travelled = np.where(since < braking, speed * since**2 / (2.0 * braking), travelled)
        at_end = self.sweep_rad - speed * left**2 / (2.0 * braking)
        return np.asarray(np.where(left < braking, at_end, travelled) - 0.5 * self.sweep_rad)
