"""Work of putting a map on control points, in child processes."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path

import msgspec

from recon4.errors import GeoreferenceError
from recon4.evaluation.site_control import Offset, remarks, said_of_test
from recon4.locales.coded import CodedText
from recon4.model.plain import to_plain
from recon4.slices.control_points import ControlPoint
from recon4.slices.site_control import (
    ControlTrial,
    forbidding,
    require_agreement,
    trial_outcome,
    trial_remarks,
    trial_text,
    try_control,
)
from recon4_app.slices.model import ControlState
from recon4_app.slices.slice_work import Artifacts


@dataclass(frozen=True, slots=True, kw_only=True)
class TriedPoint:
    """A point after the rigid fit."""

    id: str
    role: str
    off_m: Offset
    """Map minus survey: east, north, up [m]; null = not measured."""
    w: float | None
    """Normalized residual; null = a check point."""
    limit: float | None
    """From there on ``w`` is a blunder."""
    said: str
    """What the other points say of it; empty = nothing is wrong."""


@dataclass(frozen=True, slots=True, kw_only=True)
class SiteTrial:
    """What the map would be like on its control points."""

    points: tuple[TriedPoint, ...]
    remarks: tuple[str, ...]
    """What is said of all points: accuracy at check points, residuals beyond chance."""
    text: str
    """Residuals, tests and statements, as ``recon4 control`` prints them."""
    forbidden: tuple[str, ...]
    """Why the map is not put on them; empty = it may be."""
    unseen: tuple[str, ...]
    """Ids of surveyed points that were not measured in this map."""


def try_site(artifacts: Artifacts, state: ControlState, crs: str, *, language: str) -> SiteTrial:
    """Lay the map on its control points by a rigid fit, and test them; nothing is changed.

    Raises:
        GeoreferenceError: If the points place no map.
    """
    trial = _try(artifacts, state, crs)
    outcome = trial_outcome(trial)
    points = tuple(
        TriedPoint(
            id=one.id,
            role=one.role,
            off_m=one.adjusted_m,
            w=one.test.w if one.test else None,
            limit=one.test.limit if one.test else None,
            said=said_of_test(one.test, language),
        )
        for one in outcome.points
    )
    return SiteTrial(
        points=points,
        remarks=(*remarks(outcome, language), *trial_remarks(trial, language)),
        text=trial_text(trial, language),
        forbidden=tuple(one.said(language) for one in forbidding(trial)),
        unseen=trial.unseen,
    )


def site_control_of(artifacts: Artifacts, state: ControlState, crs: str, *, language: str) -> bytes:
    """The control points as an input of a run, a `SiteControl`: JSON, for `decode_record`.

    Raises:
        GeoreferenceError: If the points place no map, or contradict each other.
    """
    trial = _try(artifacts, state, crs)
    require_agreement(trial, language)
    return msgspec.json.encode(to_plain(trial.control))


def _try(artifacts: Artifacts, state: ControlState, crs: str) -> ControlTrial:
    missing = [name for name in ("frames", "odometry", "level") if name not in artifacts]
    if missing:
        raise GeoreferenceError(CodedText("control-needs-stages", stages=", ".join(missing)))
    measured = state.measured_in(Path(artifacts["map"]).name)
    if not measured:
        raise GeoreferenceError(CodedText("control-none-measured"))
    points = [ControlPoint(**point.model_dump()) for point in state.points]
    folders = {name: Path(folder) for name, folder in artifacts.items()}
    return try_control(points, measured, folders, crs=crs)
