"""A leveled map on control points: their system, the adjustment, and what it says of itself."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from recon4.geometry.se3 import Array
from recon4.georeference.control_adjustment import (
    Adjusted,
    ToAdjust,
    adjust,
)
from recon4.georeference.control_blunders import (
    Blunder,
    check_outliers,
    common_offset,
    named_blunders,
    with_exchanged_names,
)
from recon4.georeference.control_fit import ControlFit, TargetTest
from recon4.georeference.crs import CrsTransform, GeodeticOrigin
from recon4.georeference.site_grid import SiteGrid
from recon4.georeference.survey_system import survey_system
from recon4.georeference.tuning_control import CONTROL_FIT
from recon4.model.corrections import apply_corrections
from recon4.model.site_control import SeenTarget, SiteControl
from recon4.model.trajectory import Trajectory

Offset = tuple[float | None, float | None, float | None]


@dataclass(frozen=True, slots=True, kw_only=True)
class PointRecord:
    """A control or check point in ``georeference.json``; the fields are its keys."""

    id: str
    role: str
    xyz_m: tuple[float, float, float]
    """Easting, northing, height of the survey [m]."""
    sd_m: tuple[float, float]
    """Standard deviation of survey and pick, horizontal and height [m]."""
    rigid_m: Offset
    """Map minus survey after the rigid fit: east, north, up [m]; None = not measured."""
    adjusted_m: Offset
    """The same after the adjustment."""
    test: TargetTest | None
    """What the other control points say of it; None = a check point."""


@dataclass(frozen=True, slots=True, kw_only=True)
class ControlRecord:
    """``control`` in ``georeference.json``; the fields are its keys."""

    crs: str
    """Code, or `SITE_GRID`."""
    freedom: int
    """Of the rigid fit: 6, or 4 on a leveled map."""
    scale: float
    """Length in the survey over length in the map; not applied."""
    scale_sd: float
    sd0: float
    """Root of the variance factor of the rigid fit."""
    blunders: tuple[str, ...]
    """Suspected blunders, a sentence each."""
    points: tuple[PointRecord, ...]


@dataclass(frozen=True, slots=True, eq=False)
class OnControl:
    """A map in the coordinates of its control points."""

    trajectory: Trajectory
    """``T_site_body``, dense."""
    adjusted: Adjusted
    system: CrsTransform | SiteGrid
    record: ControlRecord


def system_of(control: SiteControl, origin: GeodeticOrigin | None) -> CrsTransform | SiteGrid:
    """The coordinate system of control points, with an origin for the map.

    Args:
        control: The points and the name of their system.
        origin: That of the map on earth; None = it has none.

    Raises:
        GeoreferenceError: If PROJ does not know the system, or the points are not in it.
    """
    placing = [one.xyz_m for one in control.targets if one.role == "control"]
    grid = SiteGrid.around(placing or [one.xyz_m for one in control.targets])
    if not control.crs:
        return grid
    middle = np.mean([one.xyz_m for one in control.targets], axis=0)
    return survey_system(control.crs, middle, origin=origin)


def put_on_control(
    given: ToAdjust, control: SiteControl, *, origin: GeodeticOrigin | None
) -> OnControl:
    """Put a leveled map on its control points.

    Args:
        given: The map.
        control: Its points; check points judge only.
        origin: That of the map on earth; None = it has none.

    Raises:
        GeoreferenceError: If the points place no map, or are not in their system.
        GraphError: If the graph cannot be solved.
    """
    system = system_of(control, origin)
    p_site = system.to_map(np.array([one.xyz_m for one in control.targets]))
    placing = np.array([one.role == "control" for one in control.targets], dtype=np.bool_)
    ours = [one for one in control.targets if one.role == "control"]
    adjusted = adjust(given, ours, p_site[placing])
    nodes = given.graph.t_ns
    dense = apply_corrections(
        given.trajectory,
        nodes,
        T_before=given.trajectory.at(nodes),
        T_after=adjusted.graph.T_map_body,
    )
    rigid = _rigid(given, adjusted)
    after = offsets(control.targets, p_site, dense)
    blunders = named_blunders(adjusted.measured, leveled=given.leveled)[1]
    if not blunders:
        names = [one.id for one in control.targets]
        checks = suspected_checks(control.targets, after)
        blunders = with_exchanged_names(checks, names, p_site, off_m=after)
    texts = [one.text for one in blunders]
    if adjusted.datum_shift_m is not None:
        texts.append(_datum_text(adjusted.datum_shift_m))
    record = control_record(
        control.targets,
        adjusted.fit,
        (offsets(control.targets, p_site, rigid), after),
        crs=system.crs,
        blunders=texts,
    )
    return OnControl(dense, adjusted, system, record)


def _rigid(given: ToAdjust, adjusted: Adjusted) -> Trajectory:
    """The map after the rigid fit alone."""
    dense, nodes = given.trajectory, given.graph.t_ns
    if given.start is not None:
        dense = apply_corrections(dense, nodes, T_before=dense.at(nodes), T_after=given.start)
    return Trajectory(dense.t_ns, adjusted.T_site_map @ dense.T_a_b)


def offsets(targets: Sequence[SeenTarget], p_site: Array, trajectory: Trajectory) -> Array:
    """Map minus survey in the measured directions [m], (N, 3); NaN = an axis not measured.

    Args:
        targets: What was seen.
        p_site: Surveyed places in the frame of the trajectory [m], (N, 3).
        trajectory: ``T_site_body``.
    """
    rows = []
    for target, p in zip(targets, p_site, strict=True):
        along = target.directions_in(trajectory)
        off = (target.place_in(trajectory) - p) @ along.T @ along
        rows.append(np.where(np.linalg.norm(along, axis=0) > CONTROL_FIT.in_span, off, np.nan))
    return np.array(rows).reshape(-1, 3)


def suspected_checks(targets: Sequence[SeenTarget], off_m: Array) -> tuple[Blunder, ...]:
    """What is wrong with check points; ``off_m`` map minus survey [m], (N, 3)."""
    checks = [k for k, one in enumerate(targets) if one.role == "check"]
    sd_m = max((max(targets[k].sd_m) for k in checks), default=0.0)
    names = [targets[k].id for k in checks]
    shared = common_offset(names, -off_m[checks], sd_m=sd_m)
    return (shared,) if shared is not None else check_outliers(names, -off_m[checks])


def control_record(
    targets: Sequence[SeenTarget],
    fit: ControlFit,
    off_m: tuple[Array, Array],
    *,
    crs: str,
    blunders: Sequence[str],
) -> ControlRecord:
    """What ``georeference.json`` has of the points.

    Args:
        targets: All points.
        fit: Of the control points.
        off_m: Map minus survey after the rigid fit and after the adjustment [m], (N, 3) each.
        crs: Code, or `SITE_GRID`.
        blunders: Sentences.
    """
    tests = {test.id: test for test in fit.tests}
    rigid, adjusted = off_m
    return ControlRecord(
        crs=crs,
        freedom=fit.freedom,
        scale=fit.scale,
        scale_sd=fit.scale_sd,
        sd0=fit.sd0,
        blunders=tuple(blunders),
        points=tuple(
            PointRecord(
                id=one.id,
                role=one.role,
                xyz_m=one.xyz_m,
                sd_m=one.sd_m,
                rigid_m=_cells(rigid[k]),
                adjusted_m=_cells(adjusted[k]),
                test=tests.get(one.id),
            )
            for k, one in enumerate(targets)
        ),
    )


def _cells(off_m: Array) -> Offset:
    east, north, up = (None if np.isnan(d) else round(float(d), 5) for d in off_m)
    return east, north, up


def _datum_text(shift_m: Array) -> str:
    east, north, up = shift_m
    return (
        f"GNSS positions and control points differ by {np.linalg.norm(shift_m):.3f} m "
        f"({east:+z.3f} E, {north:+z.3f} N, {up:+z.3f} up): another datum, geoid "
        "or height of the antenna. The control points decide."
    )
