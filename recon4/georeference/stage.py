"""The stage ``level``: level the map and, with GNSS, georeference it."""

from __future__ import annotations

from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np

from recon4.geometry.se3 import Array
from recon4.georeference.antenna_audit import (
    antenna_doubts,
    audit_antenna,
    turn_by_antenna,
)
from recon4.georeference.control_adjustment import ToAdjust
from recon4.georeference.control_stage import ControlRecord, OnControl, put_on_control
from recon4.georeference.crs import CrsTransform, GeodeticOrigin, to_geodetic
from recon4.georeference.floor import level_by_floor
from recon4.georeference.gnss import GeoreferenceResult, georeference
from recon4.georeference.level import NOT_LEVELED, Leveling, level
from recon4.georeference.site_grid import SiteGrid
from recon4.georeference.tuning import LEVEL_STAGE, GnssTuning
from recon4.mapping.mirrors import Mirror, Sight, find_mirrors, save_mirrors
from recon4.mapping.small_mirrors import find_small_mirrors
from recon4.mapping.undistort import place_with_origins
from recon4.model.corrections import apply_corrections
from recon4.model.figures import AntennaFigures, LevelFigures
from recon4.model.plain import to_plain
from recon4.model.pose_graph import PoseGraph
from recon4.model.rejected_fixes import disputed_m, rejected_runs
from recon4.model.rig import Rig
from recon4.model.samples import GnssSamples
from recon4.model.site_control import SiteControl
from recon4.model.trajectory import Trajectory
from recon4.pose_graph.error_model import CALIBRATED
from recon4.pose_graph.files import save_graph
from recon4.pose_graph.known_errors import NOTHING_KNOWN, KnownErrors
from recon4.pose_graph.relations import with_residuals
from recon4.pose_graph.uncertainty import PoseUncertainty, pose_uncertainty
from recon4.pose_graph.uncertainty_files import save_uncertainty, uncertainty_figures
from recon4.pose_graph.verification import confirmed_again
from recon4.progress import Progress
from recon4.settings import GnssSettings
from recon4.settings.reads import LevelReads
from recon4.settings.tuning import tuned
from recon4.store.arrays import save_trajectory
from recon4.store.atomic import write_json
from recon4.store.frames import FrameStore


@dataclass(frozen=True, slots=True, kw_only=True)
class CrsRecord:
    """The CRS in ``georeference.json``; the fields are its keys."""

    name: str
    """EPSG code or codes."""
    wkt: str
    operation: str
    """Description of the transformation by PROJ."""
    accuracy_m: float
    """Stated accuracy of the transformation [m]; NaN if unknown."""
    origin_m: list[float]
    """Coordinates of the map's origin in the CRS [m], (3,)."""


@dataclass(frozen=True, slots=True, eq=False)
class LeveledMap:
    """Result of the stage ``level``."""

    trajectory: Trajectory
    """``T_map_body``, dense."""
    graph: PoseGraph
    """Its residuals are those of the final poses."""
    leveling: Leveling
    georeference: GeoreferenceResult
    crs: CrsRecord | None
    """None: the map is not georeferenced."""
    antenna: AntennaFigures | None
    """Audit of the antenna; None = too few fixes."""
    uncertainty: PoseUncertainty | None
    """Covariances of the poses of the nodes; None = not stated."""
    mirrors: tuple[Mirror, ...] = ()
    """Walls that show the room before them."""
    control: ControlRecord | None = None
    """What the control points say; None = none were given."""

    def save(self, out: Path) -> LevelFigures:
        """Write ``trajectory.npz``, the files of the graph, ``georeference.json``,
        ``mirrors.npz`` and, where covariances are stated, ``uncertainty.npz``.
        """
        if self.uncertainty is not None:
            save_uncertainty(out, self.uncertainty)
        save_trajectory(out / "trajectory.npz", self.trajectory)
        save_graph(out, self.graph)
        save_mirrors(out / "mirrors.npz", self.mirrors)
        record: dict[str, object] = {
            "levelling": self.leveling.record(),
            "georeference": self.georeference.record(),
            "crs": self.crs or {},
        }
        if self.control is not None:
            record["control"] = self.control
        write_json(out / "georeference.json", to_plain(record))
        return LevelFigures(
            leveled_by=self.leveling.source,
            tilt_deg=round(float(np.rad2deg(self.leveling.tilt_rad)), 4),
            crs=self.crs.name if self.crs else "",
            local=self.georeference.local.reason if self.georeference.local else "",
            edges_rejected=len(self.georeference.rejected),
            antenna=self.antenna,
            uncertainty=(
                uncertainty_figures(self.uncertainty, self.trajectory) if self.uncertainty else None
            ),
            mirrors=tuple(mirror.figures for mirror in self.mirrors),
        )


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class RefinedWalk:
    """What the stages before have made of a walk."""

    trajectory: Trajectory
    """The refined one, dense."""
    graph: PoseGraph
    """The verified one."""
    known: KnownErrors = NOTHING_KNOWN
    """What they found to be wrong."""
    control: SiteControl | None = None
    """Control points; None = none were given."""


def level_and_georeference(
    frames: FrameStore, walk: RefinedWalk, *, settings: LevelReads, progress: Progress
) -> LeveledMap:
    """Level a finished trajectory; GNSS positions or control points give it its place.

    Args:
        frames: The multiframes with IMU and GNSS.
        walk: The refined trajectory with its graph.
        settings: Uses level, gnss and verification.
        progress: Counts the steps.
    """
    progress.start("level", 2, "steps")
    trajectory, graph = walk.trajectory, walk.graph
    nodes = graph.with_poses(trajectory.at(graph.t_ns))
    leveling = find_level(frames, trajectory, source=settings.level.source)
    dense = Trajectory(trajectory.t_ns, leveling.T_level_odom @ trajectory.T_a_b)
    nodes = nodes.with_poses(leveling.T_level_odom @ nodes.T_map_body)
    progress.advance()
    fixes = _above_ellipsoid(frames.gnss, settings.gnss)
    placed = georeference(
        nodes, dense, fixes, rig=frames.rig, settings=tuned(GnssTuning, settings.gnss)
    )
    antenna = _audit_antenna(fixes, dense, placed, rig=frames.rig)
    control = None
    if walk.control is None:
        dense = apply_corrections(
            dense, nodes.t_ns, T_before=nodes.T_map_body, T_after=placed.graph.T_map_body
        )
        crs = _describe_crs(placed.origin, settings.gnss.crs) if placed.origin else None
    else:
        before = _uncertainty(frames, placed.graph, placed, antenna=antenna, known=walk.known)
        leveled = _Leveled(dense, placed, leveling, before)
        on = _on_control(leveled, walk.control, settings=settings)
        dense, placed, control = on.trajectory, _placed_by(on, placed), on.record
        crs = _record_of(on.system)
    judged = _judged_again(placed, settings)
    progress.advance()
    uncertainty = _uncertainty(frames, judged, placed, antenna=antenna, known=walk.known)
    return LeveledMap(
        dense,
        with_residuals(judged),
        leveling,
        placed,
        crs,
        antenna,
        uncertainty,
        mirrors=_mirrors(frames, dense),
        control=control,
    )


def _judged_again(placed: GeoreferenceResult, settings: LevelReads) -> PoseGraph:
    """Edges that were confirmed only by rejected ones become unverified."""
    if not placed.rejected:
        return placed.graph
    return confirmed_again(placed.graph, settings=settings.verification)


@dataclass(frozen=True, slots=True, eq=False)
class _Leveled:
    """A map before it is put on control points."""

    dense: Trajectory
    """Leveled, without GNSS."""
    placed: GeoreferenceResult
    leveling: Leveling
    uncertainty: PoseUncertainty | None


def _on_control(given: _Leveled, control: SiteControl, *, settings: LevelReads) -> OnControl:
    placed = given.placed
    on_earth = placed.origin is not None
    to_adjust = ToAdjust(
        trajectory=given.dense,
        graph=placed.graph,
        leveled=given.leveling.source != "none",
        tilt_sd_rad=tuned(GnssTuning, settings.gnss).tilt_sd_rad,
        positions=placed.positions,
        on_earth=on_earth and bool(control.crs),
        start=placed.graph.T_map_body if on_earth else None,
        keep_edges=bool(placed.rejected),
        uncertainty=given.uncertainty,
    )
    return put_on_control(to_adjust, control, origin=placed.origin)


def _placed_by(on: OnControl, placed: GeoreferenceResult) -> GeoreferenceResult:
    """The georeference after the control points have moved the map."""
    found = replace(placed, graph=on.adjusted.graph, positions=on.adjusted.positions)
    if isinstance(on.system, CrsTransform):
        return replace(found, origin=on.system.origin, local=None)
    if placed.origin is None:
        return found
    p_enu = on.adjusted.T_site_map.inverse() @ np.zeros((1, 3))
    lat, lon, height = (float(v[0]) for v in to_geodetic(placed.origin, p_enu))
    frame = "x, y of the site grid, z up; its origin on WGS 84 by GNSS"
    return replace(found, origin=GeodeticOrigin(lat, lon, height), frame=frame)


def _mirrors(frames: FrameStore, trajectory: Trajectory) -> tuple[Mirror, ...]:
    """Mirrors in a map of LiDARs; a profiler sees too little of a wall at once."""
    if frames.rig.row_of("profiler") is not None or not len(frames):
        return ()
    sight = Sight(*_sample_points(frames, trajectory))
    large = find_mirrors(sight)
    return (*large, *find_small_mirrors(sight, large))


def _uncertainty(
    frames: FrameStore,
    graph: PoseGraph,
    placed: GeoreferenceResult,
    *,
    antenna: AntennaFigures | None,
    known: KnownErrors,
) -> PoseUncertainty | None:
    """Covariances of the final poses, with the errors that were found."""
    if frames.rig.row_of("profiler") is not None:
        return None  # line scans have errors of their own kind, which the model does not know
    runs = rejected_runs(placed.t_ns, placed.used, placed.residual_m)
    disputed = disputed_m(runs, fixes=len(placed.t_ns))
    model = replace(CALIBRATED, gnss_m=float(np.hypot(CALIBRATED.gnss_m, disputed)))
    if not len(placed.t_ns):
        model = replace(model, gnss_m=0.0)  # control points alone place the map
    if antenna is not None and antenna_doubts(antenna):
        known_m = float(np.linalg.norm(antenna.arm_m)) + LEVEL_STAGE.walk_m_s * abs(antenna.clock_s)
        nodes = Trajectory(graph.t_ns, graph.T_map_body)
        model = replace(
            model,
            gnss_m=float(np.hypot(model.gnss_m, known_m)),
            gnss_turn_rad=abs(turn_by_antenna(nodes, antenna)) if len(nodes) > 1 else 0.0,
        )
    known = replace(known, rig=known.rig.seen_at(frames.rig.sensors[0].T_body_sensor.t))
    return pose_uncertainty(graph, positions=placed.positions, model=model, known=known)


def _above_ellipsoid(fixes: GnssSamples | None, settings: GnssSettings) -> GnssSamples | None:
    """The fixes with the geoid separation that the settings add to their heights."""
    if fixes is None or not settings.geoid_separation_m:
        return fixes
    return replace(fixes, height_m=fixes.height_m + settings.geoid_separation_m)


def _audit_antenna(
    fixes: GnssSamples | None, leveled: Trajectory, placed: GeoreferenceResult, *, rig: Rig
) -> AntennaFigures | None:
    """Compare the fixes with the trajectory before they bend it."""
    if placed.origin is None or fixes is None:
        return None
    T_enu_body = Trajectory(leveled.t_ns, placed.T_enu_map @ leveled.T_a_b)
    return audit_antenna(T_enu_body, fixes, rig, origin=placed.origin)


def find_level(frames: FrameStore, trajectory: Trajectory, *, source: str) -> Leveling:
    """Leveling by the source that the settings select; ``auto`` uses the floor last.

    Args:
        frames: The multiframes with IMU and GNSS.
        trajectory: ``T_odom_body``, dense.
        source: ``auto``, ``imu``, ``floor`` or ``none``.
    """
    found = NOT_LEVELED
    if source in {"auto", "imu"}:
        gnss = frames.gnss if source == "auto" else None
        found = level(trajectory, frames.imu, frames.rig, gnss=gnss)
    if source == "floor" or (source == "auto" and found.source == "none"):
        found = level_by_floor(*_sample_points(frames, trajectory))
    return found


def _describe_crs(origin: GeodeticOrigin, name: str) -> CrsRecord:
    return _record_of(CrsTransform(origin, name))


def _record_of(crs: CrsTransform | SiteGrid) -> CrsRecord:
    return CrsRecord(
        name=crs.crs,
        wkt=crs.wkt,
        operation=crs.operation,
        accuracy_m=crs.accuracy_m,
        origin_m=crs.to_crs(np.zeros((1, 3)))[0].tolist(),
    )


def _sample_points(frames: FrameStore, trajectory: Trajectory) -> tuple[Array, Array]:
    """A sample of the map's points and the sensor positions [m], (N, 3) each."""
    rows = np.unique(np.linspace(0, len(frames) - 1, LEVEL_STAGE.sample_frames).astype(int))
    points, origins = [], []
    for k in rows.tolist():
        frame = frames[k]
        few = frame.take(slice(None, None, 1 + len(frame) // LEVEL_STAGE.sample_points))
        placed = place_with_origins(few, trajectory, frames.rig)
        points.append(placed.xyz_m)
        origins.append(placed.origin_m)
    return np.concatenate(points), np.concatenate(origins)
