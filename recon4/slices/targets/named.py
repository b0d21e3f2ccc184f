"""Found targets as plain records, and with the names of a survey."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from recon4.georeference.survey_system import survey_system
from recon4.model.targets import TargetKind
from recon4.slices.control_points import ControlPoint
from recon4.slices.targets.candidate import TargetCandidate
from recon4.slices.targets.matching import SurveyedPlace, match_targets

Xyz = tuple[float, float, float]


@dataclass(frozen=True, slots=True, kw_only=True)
class TargetRow:
    """A target that was found in a map: a proposal, which a person confirms."""

    kind: TargetKind
    p_map: Xyz
    """Its point [m]."""
    cov_m2: tuple[Xyz, Xyz, Xyz]
    """Covariance by the scatter of its points, without errors of the poses [m²]."""
    sd_m: float
    """Standard deviation by it in the worst direction [m]."""
    size_m: float
    """Longer edge of a plate, radius of a sphere, 0 of a board [m]."""
    points: int
    """Points of the map by which it is known."""
    agreement: float
    """How well they agree with such a target, 0 to 1."""
    id: str = ""
    """Surveyed point that it is by the distances between points; empty = none."""
    off_m: float | None = None
    """From the surveyed point after the rigid fit [m]."""
    ambiguous: bool = False
    """Another reading of the names, as good, gives it another one."""


@dataclass(frozen=True, slots=True, kw_only=True)
class TargetList:
    """The targets of a map, those with names first."""

    rows: tuple[TargetRow, ...]
    missing: tuple[str, ...] = ()
    """Surveyed points that no target is."""
    rmse_m: float | None = None
    """Misfit of the named ones after a rigid fit [m]; None = no three agree."""


def listed(found: Sequence[TargetCandidate]) -> TargetList:
    """Candidates as records, without names."""
    rows = []
    for one in found:
        x, y, z = np.round(one.p_map, 5).tolist()
        a, b, c = (tuple(row) for row in one.cov.tolist())
        rows.append(
            TargetRow(
                kind=one.kind,
                p_map=(x, y, z),
                cov_m2=(a, b, c),
                sd_m=round(float(np.sqrt(np.linalg.eigvalsh(one.cov)[-1])), 6),
                size_m=round(one.size_m, 4),
                points=one.points,
                agreement=round(one.agreement, 3),
            )
        )
    return TargetList(rows=tuple(rows))


def named(found: TargetList, points: Sequence[ControlPoint], *, crs: str = "") -> TargetList:
    """Name targets of a leveled map by a survey.

    Args:
        found: What the map has.
        points: The survey.
        crs: EPSG code or codes of the survey; empty = a grid of the site.

    Raises:
        GeoreferenceError: If PROJ does not know the system, or the points are not in it.
    """
    if not points:
        return found
    xyz = np.array([one.xyz_m for one in points])
    middle = xyz.mean(axis=0)
    system = survey_system(crs, middle) if crs else None
    p_site = system.to_map(xyz) if system else xyz - middle
    survey = [SurveyedPlace(one.id, p, one.radius_m) for one, p in zip(points, p_site, strict=True)]
    match = match_targets(survey, [_candidate(row) for row in found.rows])
    names = {} if match is None else {row: name for name, row in match.row_of.items()}
    rows = list(found.rows)
    if match is not None:
        for k, name in names.items():
            rows[k] = replace(
                rows[k],
                id=name,
                off_m=round(match.off_m[name], 5),
                ambiguous=name in match.ambiguous,
            )
    order = {one.id: k for k, one in enumerate(points)}
    rows.sort(key=lambda row: (order.get(row.id, len(order)), row.kind, -row.agreement))
    return TargetList(
        rows=tuple(rows),
        missing=tuple(one.id for one in points if one.id not in names.values()),
        rmse_m=None if match is None else round(match.rmse_m, 5),
    )


def _candidate(row: TargetRow) -> TargetCandidate:
    return TargetCandidate(
        kind=row.kind,
        p_map=np.array(row.p_map),
        cov=np.array(row.cov_m2),
        size_m=row.size_m,
        points=row.points,
        agreement=row.agreement,
    )
