"""Work of the control points in child processes."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np

from recon4.geometry.se3 import Array
from recon4.locales.languages import ENGLISH
from recon4.model.site_control import SITE_GRID
from recon4.recording.tables.coordinates import ColumnChoice
from recon4.review.evidence import Evidence
from recon4.slices.acceptance import AcceptanceText, render_acceptance
from recon4.slices.control_limits import ControlLimits
from recon4.slices.control_points import ControlPoint, ControlPreview, Lies, read_control
from recon4.slices.error_ellipses import place_covariance
from recon4.slices.measured_points import MeasuredPosition
from recon4.slices.pick import absent_picks
from recon4.slices.residual_table import residual_csv
from recon4.slices.residuals import ControlContext, ControlReport, lies_in, residuals
from recon4.slices.sheet import source_text
from recon4.slices.stored_picks import TRAJECTORY
from recon4.workflows.result_files import covariances_of
from recon4_app.slices.model import ControlState, ExportContext
from recon4_app.slices.slice_work import Artifacts, map_frame, map_of, stamp_text, tiles_of


@dataclass(frozen=True, slots=True)
class SurveyFile:
    """A file of surveyed points as a person sent it."""

    data: bytes
    name: str
    crs: str
    """Of the map, into which latitude and longitude are put."""


def preview_control(file: SurveyFile, choice: ColumnChoice, artifacts: Artifacts) -> ControlPreview:
    """Points and open questions of a survey file, and whether they lie in the map."""
    crs = "" if file.crs == SITE_GRID else file.crs
    found = read_control(file.data, name=file.name, choice=choice, crs=crs)
    return replace(found, lies=_lies(found.points, artifacts) if found.points else "")


def _lies(points: Sequence[ControlPoint], artifacts: Artifacts) -> Lies:
    """In which coordinates of the map the points of a survey lie within it."""
    for frame, in_crs in (("crs", True), ("map", False)):
        bounds_m = _bounds(artifacts, in_crs=in_crs) if "map" in artifacts else None
        if bounds_m is not None and lies_in(points, bounds_m):
            return frame
    return ""


def control_report(artifacts: Artifacts, state: ControlState, language: str) -> ControlReport:
    """Residuals of the points found in the map, with the verdict in a language."""
    return _residuals(artifacts, state, language)


def control_file(
    artifacts: Artifacts, state: ControlState, ending: str, *, context: ExportContext
) -> str:
    """The residuals as CSV or as an HTML sheet.

    Raises:
        Altered: If the map or its georeference differs from the approved one.
    """
    evidence = context.evidence
    if evidence:
        map_of(artifacts, evidence)
        evidence.artifact("map", Path(artifacts["map"])).check_all()  # points were found in it
        _check_trajectory(artifacts, evidence)  # or they were carried to it
    found, sources = _residuals(artifacts, state), source_text(Path(artifacts["map"]).name)
    text = AcceptanceText(
        project=context.project,
        frame=map_frame(artifacts).text,
        sources=sources,
        approval=stamp_text(evidence),
    )
    if ending == "html":
        return render_acceptance(found, text)
    line = f"of {text.project}, {text.sources}, {text.frame}. {text.approval}"
    return residual_csv(found, comment=line)


def _check_trajectory(artifacts: Artifacts, evidence: Evidence) -> None:
    if "level" in artifacts:
        level = evidence.artifact("level", Path(artifacts["level"]))
        if TRAJECTORY in level.files:
            level.check(TRAJECTORY)


def _residuals(artifacts: Artifacts, state: ControlState, language: str = ENGLISH) -> ControlReport:
    own = map_frame(artifacts)
    measured = state.measured_in(Path(artifacts["map"]).name)
    covariances = _covariances(artifacts, measured)
    picks = {name: found.xyz_m for name, found in measured.items()}
    radii_m = {one.id: one.radius_m for one in state.points}
    absent = absent_picks(tiles_of(artifacts["map"]), picks, radii_m)
    if state.frame == "crs" and own.to_crs is not None:  # else `residuals` says it
        for name, found in measured.items():
            steps = own.to_crs(found.xyz_m + np.vstack([np.zeros(3), np.eye(3)]))
            R = (steps[1:] - steps[0]).T  # of the axes, within the ppm of the CRS
            measured[name] = found.turned(R, steps[0])
            if name in covariances:
                covariances[name] = R @ covariances[name] @ R.T
    return residuals(
        [ControlPoint(**point.model_dump()) for point in state.points],
        measured,
        ControlContext(
            covariances=covariances,
            outdated=state.picks.keys() - measured.keys(),
            absent=absent,
            map_bounds_m=_bounds(artifacts, in_crs=state.frame == "crs"),
            limits=ControlLimits(**state.limits.model_dump()),
            language=language,
        ),
    )


def _bounds(artifacts: Artifacts, *, in_crs: bool) -> Array | None:
    """Lowest and highest corner of the map, in its CRS if asked for, (2, 3).

    None: it is empty, or has no CRS.
    """
    low, high = np.array(tiles_of(artifacts["map"]).bounds_m)
    to_crs = map_frame(artifacts).to_crs
    if not np.isfinite([low, high]).all() or (in_crs and to_crs is None):
        return None
    corners = np.array(np.meshgrid(*zip(low, high, strict=True))).reshape(3, -1).T
    if in_crs and to_crs is not None:
        corners = to_crs(corners)
    return np.array([corners.min(axis=0), corners.max(axis=0)])


def _covariances(artifacts: Artifacts, measured: dict[str, MeasuredPosition]) -> dict[str, Array]:
    """Covariances of the map at places; none where the map states none."""
    covariances_at = covariances_of(Path(artifacts["level"])) if "level" in artifacts else None
    if covariances_at is None:
        return {}
    tiles = tiles_of(artifacts["map"])
    places = {
        name: place_covariance(tiles, found.xyz_m, covariances_at)
        for name, found in measured.items()
    }
    return {name: cov for name, cov in places.items() if cov is not None}
