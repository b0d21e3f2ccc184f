"""Names of a survey that do not belong to their places, by the distances between the points."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from recon4.georeference.control_blunders import Blunder, BlunderKind
from recon4.georeference.control_fit import MeasuredTarget
from recon4.model.targets import TargetKind
from recon4.slices.targets.candidate import TargetCandidate
from recon4.slices.targets.matching import SurveyedPlace, match_targets

_UNEXPLAINED = ({BlunderKind.CONTRADICTION}, {BlunderKind.POINT})


def renamed_points(
    targets: Sequence[MeasuredTarget], blunders: Sequence[Blunder]
) -> tuple[Blunder, ...]:
    """The blunders, or the one that explains them: another order of the names.

    Args:
        targets: Control points, found in the map.
        blunders: What is suspected of them.

    Returns:
        What was suspected, unless exactly one order of all names fits the distances.
    """
    whole = all(len(one.along) == 3 for one in targets)
    if {one.kind for one in blunders} not in _UNEXPLAINED or not whole:
        return tuple(blunders)
    middle = np.mean([one.p_site for one in targets], axis=0)
    survey = [SurveyedPlace(one.id, one.p_site - middle) for one in targets]
    match = match_targets(survey, [_candidate(one) for one in targets])
    if match is None or match.ambiguous or len(match.row_of) < len(targets):
        return tuple(blunders)
    picks = {one.id: targets[match.row_of[one.id]].id for one in targets}
    moved = tuple(name for name, pick in picks.items() if name != pick)
    if not moved:
        return tuple(blunders)
    called = tuple(picks[name] for name in moved)
    return (Blunder(kind=BlunderKind.RENAMED, points=moved, picks=called),)


def _candidate(one: MeasuredTarget) -> TargetCandidate:
    return TargetCandidate(
        kind=TargetKind.BOARD, p_map=one.p_map, cov=one.cov, size_m=0.0, points=0, agreement=1.0
    )
