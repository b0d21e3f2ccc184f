"""How well a hypothesis explains a walk, and the one comparison of two of them."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from recon4.geometry.se3 import Array
from recon4.model.tried_hypotheses import TrialVerdict


@dataclass(frozen=True, slots=True, kw_only=True)
class ScoreTuning:
    """From which differences on a score is another one."""

    typical: float = 0.8
    """Quantile of the residuals that is compared: a single bad multiframe has no influence."""
    clearly: float = 0.75
    """A residual below this fraction of the other is clearly smaller …"""
    clearly_m: float = 0.002
    """… if it is so by at least this [m]: the noise of windows of ten multiframes."""
    as_well: float = 1.02
    """Residuals that are larger by no more than this factor are as good."""
    rejected: float = 0.1
    """A trajectory that contradicts a larger ratio of the fixes may have been pulled along."""
    explained: float = 0.3
    """The gyroscope explains the turns that the LiDARs see without it if this ratio of them is
    left. A clock 20 ms off leaves 0.07, a rotated LiDAR 0.12, a clock 300 ms off 0.7, swapped axes
    2."""
    witness: float = 0.5
    """Who loses a larger ratio of the multiframes sees too little to accuse an IMU."""
    settled_m: float = 0.1
    """A trajectory is settled if what was left out last moved no position by more than this."""
    never_m: float = 1.0
    """Residual of a multiframe without a match [m]."""


TUNING = ScoreTuning()


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class Score:
    """What speaks for and against a hypothesis."""

    multiframes: int
    """How many were registered."""
    lost: int
    """Of these, where tracking was lost."""
    residuals_m: Array
    """Mean distance of the points of each multiframe from the local map [m], NaN = no match."""
    contradicted: float | None = None
    """Ratio of the fixes that the trajectory contradicts; None = there are none."""
    unexplained: float | None = None
    """Part of the turns that the gyroscope does not measure; None = not asked."""
    other_axes: float | None = None
    """What speaks for other axes of the gyroscope (`for_other_axes`); None = not asked."""
    moved_m: float | None = None
    """Largest distance of a position from the walk that suggested it; None = no walk did [m]."""

    @property
    def lost_in_sight(self) -> int:
        """Multiframes that were lost although they saw something of the local map."""
        return max(self.lost - int(np.count_nonzero(np.isnan(self.residuals_m))), 0)

    @property
    def residual_m(self) -> float:
        """Residual that most multiframes stay below [m]."""
        known = np.nan_to_num(self.residuals_m, nan=TUNING.never_m)
        return float(np.quantile(known, TUNING.typical)) if len(known) else 0.0

    @property
    def contradicts_fixes(self) -> bool:
        """Whether the trajectory contradicts more of the fixes than are outliers."""
        return (self.contradicted or 0.0) > TUNING.rejected

    @property
    def is_settled(self) -> bool:
        """Whether the trajectory is that of the walk that suggested it."""
        return self.moved_m is not None and self.moved_m < TUNING.settled_m

    def clearly_better(self, rival: Score) -> TrialVerdict:
        """Verdict on a hypothesis that knows less than its rival."""
        residual_m, of_rival_m = self.residual_m, rival.residual_m
        gain_m = of_rival_m - residual_m
        least_m = max((1.0 - TUNING.clearly) * of_rival_m, TUNING.clearly_m)
        if self.lost > rival.lost:
            return TrialVerdict.LOSES_MORE
        if self.lost > TUNING.witness * self.multiframes:
            return TrialVerdict.SEES_TOO_LITTLE
        if not gain_m > (least_m if self.lost == rival.lost else 0.0):
            return TrialVerdict.NOT_CLEARLY_BETTER
        if self.unexplained is not None and self.unexplained < TUNING.explained:
            return TrialVerdict.TURNS_EXPLAINED
        return TrialVerdict.CLEARLY_BETTER

    def no_worse(self, rival: Score) -> TrialVerdict:
        """Verdict on a hypothesis that corrects its rival; both saw the same points."""
        if self.lost > rival.lost:
            return TrialVerdict.LOSES_MORE
        both = np.isfinite(self.residuals_m) & np.isfinite(rival.residuals_m)
        mine, others = (float(one.residuals_m[both].sum()) for one in (self, rival))
        fits = mine <= TUNING.as_well * others
        return TrialVerdict.NO_WORSE if fits else TrialVerdict.LARGER_RESIDUALS

    def holds(self, rival: Score, *, with_fixes: bool) -> TrialVerdict:
        """Verdict on a hypothesis that saw fewer points than its rival."""
        if self.lost > rival.lost:
            return TrialVerdict.LOSES_MORE
        if with_fixes and self.contradicts_fixes:
            return TrialVerdict.CONTRADICTS_FIXES
        return TrialVerdict.NO_WORSE
