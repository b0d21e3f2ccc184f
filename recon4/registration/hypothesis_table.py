"""A hypothesis that was tried, as a row of the table that is stored."""

from __future__ import annotations

import numpy as np

from recon4.model.tried_hypotheses import TriedHypothesis
from recon4.registration.choose import TrialRow


def row_of(trial: TrialRow, *, whole: bool, chosen: bool) -> TriedHypothesis:
    """A hypothesis as a row of the table.

    Args:
        trial: What was tried.
        whole: Whether the whole recording was tracked.
        chosen: Whether the odometry is made of it.
    """
    hypothesis, score = trial.hypothesis, trial.score
    imu, hidden = hypothesis.imu, hypothesis.hidden
    recorded = imu.samples is not None or imu.choice.outcome == "not used"
    return TriedHypothesis(
        because=hypothesis.because,
        imu=imu.choice.outcome if recorded else None,
        corrected=imu.known is not None,
        hidden_points=hidden.count if hidden is not None else 0,
        fixes=hypothesis.aiding is not None,
        whole=whole,
        multiframes=score.multiframes,
        lost=score.lost,
        residual_m=_rounded(score.residual_m),
        contradicted=_rounded(score.contradicted),
        unexplained=_rounded(score.unexplained),
        other_axes=_rounded(score.other_axes),
        moved_m=_rounded(score.moved_m),
        verdict=trial.verdict,
        chosen=chosen,
    )


def _rounded(value: float | None) -> float | None:
    return None if value is None or not np.isfinite(value) else round(value, 5)
