"""How an odometry knows the motion before it looks at its map: by an IMU, by scans, by fixes.

The odometry asks these questions, and never which strategy it has.
"""

from __future__ import annotations

from typing import Protocol

import numpy as np

from recon4.geometry.se3 import Array
from recon4.model.multiframe import Multiframe
from recon4.model.samples import ImuSamples
from recon4.registration.frame_fit import FrameFit, FrameFitter
from recon4.registration.frame_view import FrameView
from recon4.registration.lost import LostLimits
from recon4.registration.motion import MotionState, Prediction, Rest
from recon4.registration.step import OdometryStep
from recon4.registration.tracking import Seen, TrackingState


class MotionStrategy(Protocol):
    """What an odometry asks about the motion."""

    fitter: FrameFitter
    """Bounds of the iterations, as large as the errors of the predictions."""
    longest_map: int
    """Keyframes in the local map."""

    def remember(self, known: MotionState) -> None:
        """Begin later maps with the gain and the clock of the IMU that a state knows."""

    def extend(self, imu: ImuSamples) -> None:
        """Append newer samples of a live capture."""

    def moving_start(self, frame: Multiframe) -> tuple[Multiframe, MotionState] | None:
        """At the second frame: the first one and the state at its start, if the body moved."""

    def covers(self, start_ns: int, end_ns: int) -> bool:
        """Whether the motion over a long time without frames is known."""

    def bridge(self, view: FrameView, last_ns: int) -> Prediction | None:
        """Motion over a frame that only the scans before a gap know; None = they do not.

        Args:
            view: The frame after the gap.
            last_ns: When the last one before it ended [ns].
        """

    def predict(
        self, state: MotionState | None, view: FrameView, tracking: TrackingState
    ) -> Prediction:
        """Motion over a frame from the state before; None = from the start of the walk."""

    def rest(self, end: MotionState, *, weak: bool) -> Rest:
        """Whether the body stands at the end of a frame; ``weak``: the LiDARs hardly know it."""

    def is_lost(self, fit: FrameFit, prediction: Prediction, limits: LostLimits) -> bool:
        """Whether a frame lies neither on the local map nor where it was expected."""

    def by_fixes(self, view: FrameView, prediction: Prediction) -> Prediction | None:
        """The motion over a frame of which the map says too little; None = no fixes say it."""

    def refined(self, fit: FrameFit, prediction: Prediction) -> FrameFit:
        """A fit with what the motion itself says of it."""

    def unknown_cov(self, frame: Multiframe, fit: FrameFit) -> Array:
        """Covariance of the motion that neither LiDAR nor fixes nor standing still excludes."""

    def keep(self, step: OdometryStep) -> None:
        """Learn from a frame that was tracked."""

    def after_loss(self, view: FrameView, tracking: TrackingState) -> Seen | None:
        """What else a lost frame shows; None = nothing."""

    def at_rest(self, state: MotionState, t_ns: int) -> MotionState:
        """The state with which another map begins, because the motion since is not known."""

    def imu_state(self, good: MotionState | None) -> MotionState | None:
        """The last tracked state that knows the IMU; None without one."""


def is_numeric(fit: FrameFit) -> bool:
    """Whether the solution of a fit has numbers only."""
    return bool(np.isfinite(fit.delta).all())
