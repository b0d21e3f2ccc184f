"""Work of putting a map on control points, in child processes."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path

import msgspec
import numpy as np

from recon4.errors import GeoreferenceError
from recon4.evaluation.site_control import ControlOutcome, outcome_text
from recon4.model.plain import to_plain
from recon4.model.site_control import SiteControl
from recon4.slices.control_points import ControlPoint
from recon4.slices.measured_points import MeasuredPosition, orthonormal
from recon4.slices.site_control import forbidding, try_control
from recon4_app.slices.model import ControlState
from recon4_app.slices.slice_work import Artifacts


@dataclass(frozen=True, slots=True, kw_only=True)
class SiteTrial:
    """What the map would be like on its control points."""

    text: str
    """Residuals, tests and statements, as ``recon4 control`` prints them."""
    forbidden: tuple[str, ...]
    """Why the map is not put on them; empty = it may be."""
    unseen: tuple[str, ...]
    """Ids of surveyed points that were not measured in this map."""


def try_site(artifacts: Artifacts, state: ControlState, crs: str) -> SiteTrial:
    """Lay the map on its control points by a rigid fit, and test them; nothing is changed.

    Raises:
        GeoreferenceError: If the points place no map.
    """
    trial = try_control(*_measured(artifacts, state), _paths(artifacts), crs=crs)
    return SiteTrial(
        text=outcome_text(msgspec.convert(to_plain(trial.record), ControlOutcome)),
        forbidden=tuple(one.text for one in forbidding(trial)),
        unseen=trial.unseen,
    )


def site_control_of(artifacts: Artifacts, state: ControlState, crs: str) -> SiteControl:
    """The control points as an input of a run.

    Raises:
        GeoreferenceError: If the points place no map, or contradict each other.
    """
    trial = try_control(*_measured(artifacts, state), _paths(artifacts), crs=crs)
    if found := forbidding(trial):
        texts = " ".join(one.text for one in found)
        raise GeoreferenceError(f"the map is not put on these points: {texts}")
    return trial.control


def _measured(
    artifacts: Artifacts, state: ControlState
) -> tuple[list[ControlPoint], Mapping[str, MeasuredPosition]]:
    here = state.of_map(Path(artifacts["map"]).name)
    if not here:
        raise GeoreferenceError("no control point was measured in this map")
    measured = {
        name: MeasuredPosition(np.array(p_map), orthonormal(state.along[name]))
        for name, p_map in here.items()
    }
    return [ControlPoint(**point.model_dump()) for point in state.points], measured


def _paths(artifacts: Artifacts) -> dict[str, Path]:
    return {name: Path(folder) for name, folder in artifacts.items()}
