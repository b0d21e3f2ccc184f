"""When a place is recognized again: whether the map has to go on from where it was."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from recon4.geometry.se3 import SE3
from recon4.registration.result import Registration


@dataclass(frozen=True, slots=True, kw_only=True)
class LoopRules:
    """What is believed."""

    match_ratio: float = 0.6
    degeneracy: float = 0.02
    """A corridor looks alike all along."""
    drift_m: float = 0.10
    drift_rad: float = 0.03
    """Less than both is no drift the preview would show, but the noise of one registration: the
    odometry is left alone. (On a simulated office walk of 108 m single registrations were off by
    up to 10 mrad, which moves what lies 10 m ahead by 10 cm; the odometry had drifted by 2 cm.)"""
    agree_m: float = 0.05
    agree_rad: float = 0.01
    """Two in a row must find the same drift so well."""


class LoopGate:
    """Judges one recognized place after the other."""

    def __init__(self, rules: LoopRules | None = None) -> None:
        self._rules = rules or LoopRules()
        self._believed: SE3 | None = None
        self.closed = False
        self.drift_m = 0.0
        """Of the last place that was recognized."""

    def judge(self, found: Registration | None, T_map_body: SE3) -> bool:
        """Whether the map has to be moved so that the body is where it was found.

        Args:
            found: The place, or None if nothing old was near or it did not fit.
            T_map_body: Where the body is by odometry.
        """
        r = self._rules
        if found is None or found.match_ratio < r.match_ratio or found.degeneracy < r.degeneracy:
            self._believed = None
            return False
        drift = found.T_target_source @ T_map_body.inverse()
        apart = T_map_body.inverse() @ found.T_target_source
        self.closed, self.drift_m = True, float(np.linalg.norm(apart.t))
        if self.drift_m < r.drift_m and float(apart.angle()) < r.drift_rad:
            self._believed = None
            return False
        before, self._believed = self._believed, drift
        if before is None:
            return False
        # Compared at the body: far from the origin a small turn is a long way.
        between = (before @ T_map_body).inverse() @ found.T_target_source
        agree = float(np.linalg.norm(between.t)) < r.agree_m and between.angle() < r.agree_rad
        if agree:
            self._believed = None
        return bool(agree)
