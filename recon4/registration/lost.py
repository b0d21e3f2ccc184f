"""When tracking is lost, and when it is sure of itself again."""

from __future__ import annotations

from collections import deque
from statistics import median

import numpy as np

from recon4.geometry.se3 import SE3
from recon4.registration.frame_view import FrameView
from recon4.registration.plane_map import Match
from recon4.registration.scan_chain import ScanChain
from recon4.registration.tuning import SCANS, OdometryTuning, ScanTuning
from recon4.registration.tuning_motion import LOST
from recon4.settings import OdometrySettings
from recon4.settings.tuning import tuned


class LostLimits:
    """Compares a frame's match ratio with what is usual for the sensor.

    A dense LiDAR indoors matches nine tenths of its segments, a thinned one without rings a
    quarter. A fixed limit calls the latter lost at once.
    """

    def __init__(self, settings: OdometrySettings) -> None:
        self._settings = tuned(OdometryTuning, settings)
        self._ratios: deque[float] = deque(maxlen=LOST.usual_frames)

    def learn(self, match_ratio: float) -> None:
        """Count a frame that was tracked."""
        self._ratios.append(match_ratio)

    @property
    def is_usual_known(self) -> bool:
        """Whether enough frames were tracked to know what usually matches."""
        return len(self._ratios) >= self._settings.lost_after_frames

    @property
    def match_ratio(self) -> float:
        """With a smaller match ratio tracking is lost."""
        s = self._settings
        if not self.is_usual_known:
            return s.lost_match_ratio
        usual = s.lost_usual_ratio * median(self._ratios)
        return float(np.clip(usual, s.lost_least_ratio, s.lost_match_ratio))

    def is_usual(self, match: Match) -> bool:
        """Whether as much of a frame matches as of those before it."""
        if not self.is_usual_known:
            return False
        usual = LOST.usual_part * median(self._ratios)
        return match.match_ratio >= usual and match.mean_m < self._settings.lost_error_m

    def is_lost(self, match: Match, *, sure: bool) -> bool:
        """Whether a frame is lost.

        Args:
            match: Of the last round.
            sure: The scan was also located surely in the scan before it, or at the start of a walk
                lies where the IMU predicts it, so that only the least match ratio is demanded.
        """
        least = min(self._settings.lost_least_ratio, self.match_ratio) if sure else self.match_ratio
        return match.match_ratio < least or not match.mean_m < self._settings.lost_error_m


class FreshChain:
    """Follows the scans after tracking was lost, until enough in a row fit each other."""

    def __init__(self, settings: ScanTuning = SCANS) -> None:
        self._settings = settings
        self._chain = ScanChain(settings)
        self._T_begin_now = SE3.identity()

    def push(self, view: FrameView) -> bool:
        """Add a lost scan; whether the scans are sure of their motion now."""
        found = view.locate_in(self._chain)
        if found is not None and self._chain.is_sure:
            self._T_begin_now = self._T_begin_now @ found
        self._chain.keep(self._T_begin_now, view.frame.t_mid_ns)
        return self._chain.sure_scans >= self._settings.sure_scans
