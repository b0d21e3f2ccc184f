"""Decides whether a recognized place corrects the drift of the live map."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from recon4.geometry.se3 import SE3
from recon4.registration.result import Registration


@dataclass(frozen=True, slots=True, kw_only=True)
class LoopRules:
    """Acceptance limits of a live loop closure."""

    match_ratio: float = 0.6
    degeneracy: float = 0.02
    """Excludes corridors, where one direction is unobservable."""
    drift_m: float = 0.10
    drift_rad: float = 0.03
    """Drift below both limits is within the noise of one registration and is not corrected. (On a
    simulated office walk of 108 m single registrations had errors up to 10 mrad, which is 10 cm at
    a distance of 10 m; the odometry had drifted by 2 cm.)"""
    agree_m: float = 0.05
    agree_rad: float = 0.01
    """Largest difference between the drifts of two consecutive registrations."""


class LoopGate:
    """Checks consecutive recognized places for a consistent drift."""

    def __init__(self, rules: LoopRules | None = None) -> None:
        self._rules = rules or LoopRules()
        self._pending: SE3 | None = None
        self.closed = False
        self.drift_m = 0.0
        """Drift at the last recognized place."""

    def judge(self, found: Registration | None, T_map_body: SE3) -> bool:
        """Whether to move the map so that the body gets the registered pose.

        Args:
            found: Registration to an earlier place; None if there was none or it was rejected.
            T_map_body: Pose of the body by odometry.
        """
        r = self._rules
        if found is None or found.match_ratio < r.match_ratio or found.degeneracy < r.degeneracy:
            return self.judge_pose(None, T_map_body)
        return self.judge_pose(found.T_target_source, T_map_body)

    def judge_pose(self, T_map_found: SE3 | None, T_map_body: SE3) -> bool:
        """The same for the pose by a registration that is accepted; None = there is none."""
        r = self._rules
        if T_map_found is None:
            self._pending = None
            return False
        drift = T_map_found @ T_map_body.inverse()
        apart = T_map_body.inverse() @ T_map_found
        self.closed, self.drift_m = True, float(np.linalg.norm(apart.t))
        if self.drift_m < r.drift_m and float(apart.angle()) < r.drift_rad:
            self._pending = None
            return False
        before, self._pending = self._pending, drift
        if before is None:
            return False
        # Compared at the body: far from the origin a small rotation is a large offset.
        between = (before @ T_map_body).inverse() @ T_map_found
        agree = float(np.linalg.norm(between.t)) < r.agree_m and between.angle() < r.agree_rad
        if agree:
            self._pending = None
        return bool(agree)
