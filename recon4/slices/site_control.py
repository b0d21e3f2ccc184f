"""Control points of a survey that were measured in a map, as an input of a run."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from recon4.errors import ConfigError, GeoreferenceError
from recon4.evaluation.site_control import ControlOutcome, outcome_text
from recon4.geometry.se3 import Array
from recon4.georeference.control_adjustment import measured_targets
from recon4.georeference.control_blunders import (
    Blunder,
    BlunderKind,
    named_blunders,
    with_exchanged_names,
)
from recon4.georeference.control_names import unseen_exchanges
from recon4.georeference.control_sightings import PickedTarget, Sighting, sightings
from recon4.georeference.control_stage import (
    ControlRecord,
    control_record,
    offsets,
    suspected_checks,
    system_of,
)
from recon4.georeference.crs import CrsTransform
from recon4.georeference.crs_file import read_crs
from recon4.georeference.site_grid import SiteGrid
from recon4.locales.coded import CodedText
from recon4.locales.languages import ENGLISH
from recon4.locales.texts import texts
from recon4.model.plain import to_plain
from recon4.model.site_control import SeenPlace, SeenTarget, SiteControl
from recon4.model.trajectory import Trajectory
from recon4.pose_graph.files import load_graph
from recon4.pose_graph.uncertainty_files import load_uncertainty
from recon4.slices.control_points import ControlPoint
from recon4.slices.measured_points import MeasuredPosition
from recon4.slices.renamed_points import renamed_points
from recon4.store.arrays import load_trajectory
from recon4.store.frames import open_frames
from recon4.store.json_files import read_object
from recon4.untrusted.limits import LIMITS
from recon4.untrusted.typed import as_type


@dataclass(frozen=True, slots=True, kw_only=True)
class ControlAccuracy:
    """How exact points are, survey and pick together."""

    horizontal_m: float = 0.01
    """Standard deviation of easting and of northing [m]."""
    height_m: float = 0.01
    """Of the height [m]."""

    def __post_init__(self) -> None:
        for name in self.__dataclass_fields__:
            if not 0.0 < getattr(self, name) <= 10.0:
                raise ConfigError(CodedText("site-range", name=name))


@dataclass(frozen=True, slots=True)
class RoughPlace:
    """That a map in a system is only roughly on WGS 84, as grids of the datum are not installed."""

    crs: str
    grids: tuple[str, ...]
    accuracy_m: float
    """Of latitude and longitude; NaN = not known."""

    def said(self, language: str) -> str:
        """It in a language."""
        grids = ", ".join(self.grids)
        text = CodedText("crs-rough", crs=self.crs, grids=grids, accuracy_m=self.accuracy_m)
        return text.said(language)


@dataclass(frozen=True, slots=True)
class ControlTrial:
    """What control points would do to a map."""

    control: SiteControl
    record: ControlRecord
    """After the rigid fit; its adjusted residuals are the same."""
    blunders: tuple[Blunder, ...]
    """Suspected blunders; those of control points forbid to place the map."""
    unseen: tuple[str, ...]
    """Surveyed points that were not measured in the map."""
    unseen_exchanges: tuple[tuple[str, str], ...] = ()
    """Pairs of control points whose names could be exchanged without a test that fails."""
    rough: RoughPlace | None = None
    """Where on earth the map would be; None = as exactly as the system says."""


def site_control(
    points: Sequence[ControlPoint],
    measured: Mapping[str, MeasuredPosition],
    artifacts: Mapping[str, Path],
    *,
    crs: str = "",
    accuracy: ControlAccuracy = ControlAccuracy(),
) -> SiteControl:
    """Find who saw the points that were measured in a map.

    Args:
        points: The survey.
        measured: Id -> place in the map frame.
        artifacts: Of the run that made the map.
        crs: EPSG code or codes of the survey; empty = a grid of the site.
        accuracy: Of all points.

    Raises:
        GeoreferenceError: If no point was measured, or a measured one is not in the map: no node
            has points near it.
        StoreError: If an artifact cannot be read.
    """
    known = [one for one in points if one.id in measured]
    if not known:
        raise _no_name_in_common(points, measured)
    picked = {
        one.id: PickedTarget(measured[one.id].xyz_m, measured[one.id].along, one.radius_m)
        for one in known
    }
    trajectory = load_trajectory(artifacts["level"] / "trajectory.npz")
    store = open_frames(artifacts["frames"], artifacts.get("calibration"), artifacts["odometry"])
    found = sightings(picked, store, load_graph(artifacts["level"]), trajectory=trajectory)
    absent = [name for name, one in found.items() if not len(one.t_ns)]
    if absent:
        raise GeoreferenceError(
            CodedText("control-absent", names=", ".join(absent[:10]), count=len(absent))
        )
    targets = tuple(_seen(one, found[one.id], accuracy) for one in known)
    return SiteControl(targets=targets, crs=crs)


def try_control(
    points: Sequence[ControlPoint],
    measured: Mapping[str, MeasuredPosition],
    artifacts: Mapping[str, Path],
    *,
    crs: str = "",
    accuracy: ControlAccuracy = ControlAccuracy(),
) -> ControlTrial:
    """Lay the map on control points by a rigid fit, and test them; nothing is changed.

    Args:
        points: The survey.
        measured: Id -> place in the map frame.
        artifacts: Of the run that made the map.
        crs: As in `site_control`.
        accuracy: Of all points.

    Raises:
        GeoreferenceError: If the points place no map.
        StoreError: If an artifact cannot be read.
    """
    control = site_control(points, measured, artifacts, crs=crs, accuracy=accuracy)
    level = artifacts["level"]
    trajectory, uncertainty = load_trajectory(level / "trajectory.npz"), load_uncertainty(level)
    own = read_crs(level)
    on_earth = own if isinstance(own, CrsTransform) and not own.missing_grids else None
    system = system_of(control, on_earth.origin if crs and on_earth else None)
    p_site = system.to_map(np.array([one.xyz_m for one in control.targets]).reshape(-1, 3))
    ours = np.array([one.role == "control" for one in control.targets], dtype=np.bool_)
    placing = [one for one in control.targets if one.role == "control"]
    found = measured_targets(placing, p_site[ours], trajectory, uncertainty=uncertainty)
    fit, blunders = named_blunders(found, leveled=_is_leveled(level))
    laid = Trajectory(trajectory.t_ns, fit.T_map_site.inverse() @ trajectory.T_a_b)
    off = offsets(control.targets, p_site, laid)
    blunders = renamed_points(found, blunders)
    if all(one.kind in (BlunderKind.POINT, BlunderKind.NAMES) for one in blunders):
        checks = suspected_checks(control.targets, off)
        names = [one.id for one in control.targets]
        blunders = with_exchanged_names((*blunders, *checks), names, p_site, off_m=off)
    alike = [] if blunders else unseen_exchanges(found, fit, leveled=_is_leveled(level))
    record = control_record(
        control.targets,
        fit,
        (off, off),
        crs=system.crs,
        blunders=[one.text for one in blunders],
    )
    unseen = tuple(one.id for one in points if one.id not in measured)
    pairs = tuple((found[i].id, found[j].id) for i, j in alike)
    return ControlTrial(control, record, blunders, unseen, pairs, _rough(system))


def _rough(system: CrsTransform | SiteGrid) -> RoughPlace | None:
    if isinstance(system, SiteGrid) or not system.missing_grids:
        return None
    return RoughPlace(system.crs, system.missing_grids, system.accuracy_m)


def forbidding(trial: ControlTrial) -> tuple[Blunder, ...]:
    """Blunders of control points: a map is not put on points that contradict each other."""
    control = {one.id for one in trial.control.targets if one.role == "control"}
    return tuple(one for one in trial.blunders if not one.points or control & {*one.points})


def require_agreement(trial: ControlTrial, language: str = ENGLISH) -> None:
    """Check that the control points may place the map.

    Raises:
        GeoreferenceError: If they contradict each other, with what is suspected.
    """
    if found := forbidding(trial):
        said = " ".join(one.said(language) for one in found)
        raise GeoreferenceError(CodedText("site-not-put", texts=said))


def trial_text(trial: ControlTrial, language: str = ENGLISH) -> str:
    """Residuals, tests and statements of a trial in lines."""
    said = [one.said(language) for one in trial.blunders]
    text = outcome_text(trial_outcome(trial), language, said)
    return "\n".join([text, *trial_remarks(trial, language)])


def trial_outcome(trial: ControlTrial) -> ControlOutcome:
    """The same record as a finished map has."""
    return as_type(to_plain(trial.record), ControlOutcome)


def trial_remarks(trial: ControlTrial, language: str = ENGLISH) -> tuple[str, ...]:
    """How roughly the map would be on earth, and which names could be exchanged without a test
    that fails, as lines.
    """
    rough = (trial.rough.said(language),) if trial.rough else ()
    if not trial.unseen_exchanges:
        return rough
    say = texts(language, "report")
    pairs = [
        say.part("control-table", "pair", {"one": one, "other": other})
        for one, other in trial.unseen_exchanges
    ]
    return (*rough, say.part("control-table", "unseen-exchange", {"pairs": ", ".join(pairs)}))


def seen_place(found: Sighting) -> SeenPlace:
    """Who saw a place, as it is stored."""
    return SeenPlace(
        t_ns=tuple(found.t_ns.tolist()),
        p_body_m=_tuples(found.p_body),
        directions_body=tuple(map(_tuples, found.directions_body)),
    )


def _seen(point: ControlPoint, found: Sighting, accuracy: ControlAccuracy) -> SeenTarget:
    place = seen_place(found)
    return SeenTarget(
        id=point.id,
        xyz_m=point.xyz_m,
        role=point.role,
        sd_m=_deviations(point, accuracy),
        covariance_m2=point.covariance_m2,
        t_ns=place.t_ns,
        p_body_m=place.p_body_m,
        directions_body=place.directions_body,
    )


def _deviations(point: ControlPoint, accuracy: ControlAccuracy) -> tuple[float, float]:
    """Standard deviation, horizontal (each axis) and height [m]: its own, else that of all."""
    if point.covariance_m2 is None:
        return accuracy.horizontal_m, accuracy.height_m
    e, _, _, n, _, h = point.covariance_m2
    return math.sqrt((e + n) / 2.0), math.sqrt(h)


def _no_name_in_common(
    points: Sequence[ControlPoint], measured: Mapping[str, MeasuredPosition]
) -> GeoreferenceError:
    def some(names: Sequence[str]) -> str:
        return ", ".join(names[:5]) + (" …" if len(names) > 5 else "") if names else "–"

    surveyed = some([point.id for point in points])
    return GeoreferenceError(
        CodedText("control-names", surveyed=surveyed, measured=some([*measured]))
    )


def _is_leveled(level: Path) -> bool:
    record = read_object(level / "georeference.json", max_bytes=LIMITS.findings_bytes)
    stated = record.get("levelling")
    return isinstance(stated, dict) and stated.get("source") != "none"


def _tuples(rows: Array) -> tuple[tuple[float, float, float], ...]:
    return tuple((x, y, z) for x, y, z in rows.tolist())
