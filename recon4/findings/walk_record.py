"""What witnesses and report read of a run: its artifacts in memory, without points.

Missing artifacts are left out.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import msgspec
import numpy as np
from numpy.typing import NDArray

from recon4.errors import StoreError
from recon4.findings.placement import Placement, placement_in
from recon4.findings.tuning import AUDIT_LIST
from recon4.geometry.se3 import Array
from recon4.locales.coded import unreadable
from recon4.model.calibration_figures import CalibrationFigures
from recon4.model.figures import FrameFigures, LevelFigures, MapFigures, ReviewFigures
from recon4.model.odometry_figures import OdometryFigures
from recon4.model.pose_graph import PoseGraph
from recon4.model.rig import Rig
from recon4.model.samples import ImuSamples
from recon4.model.support import SurfaceSupport
from recon4.model.trajectory import Trajectory
from recon4.pose_graph.files import load_graph
from recon4.pose_graph.uncertainty import PoseUncertainty
from recon4.pose_graph.uncertainty_files import load_uncertainty
from recon4.settings.reads import AuditReads
from recon4.store.arrays import load_arrays, load_record, load_trajectory
from recon4.store.earlier_names import STEPS, current_names
from recon4.store.frames import FrameStore, open_frames
from recon4.store.json_files import read_object
from recon4.store.stage import OfStage, read_figures, read_manifest
from recon4.untrusted.typed import as_type


@dataclass(frozen=True, slots=True, eq=False)
class WalkRecord:
    """The artifacts of a run in memory, without points. None or empty = missing."""

    settings: AuditReads = field(default_factory=AuditReads)
    imported: dict[str, object] = field(default_factory=dict)
    """``report.json`` of the frames."""
    odometry: Trajectory | None = None
    steps: dict[str, NDArray[Any]] = field(default_factory=dict)
    """Columns of ``steps.npz``."""
    calibration: CalibrationFigures | None = None
    """Audit of the rig."""
    graph: PoseGraph | None = None
    """The latest graph: leveled, else reviewed, else verified, else as searched."""
    verification: dict[str, object] = field(default_factory=dict)
    final: Trajectory | None = None
    """The latest trajectory after the odometry."""
    refine: dict[str, object] = field(default_factory=dict)
    support: SurfaceSupport | None = None
    """What holds each multiframe of line scans; None = not worked out."""
    georeference: dict[str, object] = field(default_factory=dict)
    uncertainty: PoseUncertainty | None = None
    """Covariances of the final poses; None = not stated."""
    intensity: dict[str, NDArray[Any]] = field(default_factory=dict)
    """Columns of ``diagnostics.npz``."""
    map: MapFigures | None = None
    """Figures of the stage ``map``, with the thickness of its planar surfaces."""
    frames: FrameFigures | None = None
    odometry_figures: OdometryFigures | None = None
    review: ReviewFigures | None = None
    """None = there are no decisions."""
    level: LevelFigures | None = None
    imu: ImuSamples | None = None
    """As the odometry used it, with the clock of the rig that was used."""
    rig: Rig | None = None
    """The rig that the map was made with."""
    recorded_ns: int = 0
    """Start of the recording; 0 = unknown."""
    earlier_warnings: tuple[tuple[str, bool], ...] = ()
    """Sentences in the manifests of earlier versions, and whether each forbids the use of the map.
    """

    @property
    def placement(self) -> Placement:
        """How the map was leveled and georeferenced.

        Raises:
            StoreError: If ``georeference.json`` is not as written.
        """
        return placement_in(self.georeference)


def read_walk(artifacts: Mapping[str, Path], settings: AuditReads) -> WalkRecord:
    """Read the existing artifacts.

    Raises:
        StoreError: If a file is damaged.
    """
    store = _frame_store(artifacts)
    return WalkRecord(
        settings=settings,
        imported=_json(artifacts, "frames", "report.json"),
        odometry=_latest_trajectory(artifacts, ("odometry",)),
        steps=current_names(_arrays(artifacts, "odometry", "steps.npz"), STEPS),
        calibration=_calibration(artifacts),
        graph=_latest_graph(artifacts, ("level", "review", "verification", "graph")),
        verification=_json(artifacts, "verification", "verification.json"),
        final=final_trajectory(artifacts),
        refine=_json(artifacts, "refine", "refine.json"),
        support=_support(artifacts),
        georeference=_json(artifacts, "level", "georeference.json"),
        uncertainty=load_uncertainty(artifacts["level"]) if "level" in artifacts else None,
        intensity=_arrays(artifacts, "intensity", "diagnostics.npz"),
        map=_figures(artifacts, "map", MapFigures),
        frames=_figures(artifacts, "frames", FrameFigures),
        odometry_figures=_figures(artifacts, "odometry", OdometryFigures),
        review=_figures(artifacts, "review", ReviewFigures),
        level=_figures(artifacts, "level", LevelFigures),
        imu=store.imu if store else None,
        rig=store.rig if store else None,
        recorded_ns=int(store.index["t_ns"][0]) if store and len(store) else 0,
        earlier_warnings=_earlier_warnings(artifacts),
    )


def final_trajectory(artifacts: Mapping[str, Path]) -> Trajectory | None:
    """The trajectory that the map was made with; None if there is none.

    Raises:
        StoreError: If the file is damaged.
    """
    return _latest_trajectory(artifacts, ("level", "refine"))


def positions_along(walk: Trajectory, span_s: tuple[float, float], *, most: int) -> Array:
    """Positions of a stretch of a walk [m], (N, 3); none if the walk ends before it.

    Args:
        walk: Its poses.
        span_s: First and last time of the stretch, after the first pose [s].
        most: Between the ends every n-th pose, so that about as many remain.
    """
    offsets_s = np.clip(span_s, 0.0, AUDIT_LIST.longest_s)
    ends_ns = walk.t_ns[0] + np.rint(1e9 * offsets_s).astype(np.int64)
    if ends_ns[0] > walk.t_ns[-1]:
        return np.empty((0, 3))
    ends_ns = np.minimum(ends_ns, walk.t_ns[-1])
    between = walk.T_a_b.t[(walk.t_ns > ends_ns[0]) & (walk.t_ns < ends_ns[1])]
    first, last = walk.at(ends_ns).t
    return np.concatenate([[first], between[:: max(1, -(-len(between) // most))], [last]])


def path_length_m(trajectory: Trajectory) -> Array:
    """Path length before each pose [m], (N,), from positions at least 0.5 s apart.

    Shorter steps would add the sway of the body and the noise of the poses.
    """
    t_s = (trajectory.t_ns - trajectory.t_ns[0]) / 1e9
    knots = np.unique(np.append(np.arange(0.0, t_s[-1], 0.5), t_s[-1]))
    places = np.stack([np.interp(knots, t_s, trajectory.T_a_b.t[:, k]) for k in range(3)], axis=1)
    covered = np.concatenate([[0.0], np.cumsum(np.linalg.norm(np.diff(places, axis=0), axis=1))])
    return np.interp(t_s, knots, covered)


def _file(artifacts: Mapping[str, Path], stage: str, name: str) -> Path | None:
    path = artifacts[stage] / name if stage in artifacts else None
    return path if path is not None and path.is_file() else None


def _json(artifacts: Mapping[str, Path], stage: str, name: str) -> dict[str, object]:
    path = _file(artifacts, stage, name)
    if path is None:
        return {}
    try:
        return read_object(path)
    except StoreError as error:
        raise StoreError(unreadable(f"{stage}/{name}", error)) from error


def _arrays(artifacts: Mapping[str, Path], stage: str, name: str) -> dict[str, NDArray[Any]]:
    path = _file(artifacts, stage, name)
    if path is None:
        return {}
    try:
        return load_arrays(path)
    except StoreError as error:
        raise StoreError(unreadable(f"{stage}/{name}", error)) from error


def _calibration(artifacts: Mapping[str, Path]) -> CalibrationFigures | None:
    """Figures in ``calibration.json``; its standard deviations may be null: not observable."""
    record = _json(artifacts, "calibration", "calibration.json").get("figures")
    if record is None:
        return None
    try:
        return as_type(record, CalibrationFigures)
    except msgspec.ValidationError as error:
        raise StoreError(unreadable("calibration/calibration.json", error)) from error


def _support(artifacts: Mapping[str, Path]) -> SurfaceSupport | None:
    path = _file(artifacts, "refine", "support.npz")
    return None if path is None else load_record(path, SurfaceSupport)


def _figures(artifacts: Mapping[str, Path], stage: str, kind: type[OfStage]) -> OfStage | None:
    if _file(artifacts, stage, "manifest.json") is None:
        return None
    return read_figures(artifacts[stage], kind)


def _frame_store(artifacts: Mapping[str, Path]) -> FrameStore | None:
    """The multiframes with the rig that the map was made with."""
    if _file(artifacts, "frames", "rig.toml") is None:
        return None
    calibration = _figures(artifacts, "calibration", CalibrationFigures)
    used = artifacts["calibration"] if calibration and calibration.applied else None
    return open_frames(artifacts["frames"], used, artifacts.get("odometry"))


class _Sentences(msgspec.Struct, frozen=True):
    """What the stages that are kept said before findings were records."""

    warnings: tuple[str, ...] = ()
    severe: tuple[str, ...] = ()
    uncorrected: tuple[str, ...] = ()


def _earlier_warnings(artifacts: Mapping[str, Path]) -> tuple[tuple[str, bool], ...]:
    """Sentences of odometry and calibration of earlier versions."""
    odometry, calibration = (_sentences(artifacts, name) for name in ("odometry", "calibration"))
    said = [(text, text in odometry.severe) for text in odometry.warnings]
    return (*said, *((text, False) for text in calibration.uncorrected))


def _sentences(artifacts: Mapping[str, Path], stage: str) -> _Sentences:
    if _file(artifacts, stage, "manifest.json") is None:
        return _Sentences()
    return as_type(read_manifest(artifacts[stage])["figures"], _Sentences)


def _latest_trajectory(artifacts: Mapping[str, Path], stages: tuple[str, ...]) -> Trajectory | None:
    for stage in stages:
        path = _file(artifacts, stage, "trajectory.npz")
        if path is not None:
            return load_trajectory(path)
    return None


def _latest_graph(artifacts: Mapping[str, Path], stages: tuple[str, ...]) -> PoseGraph | None:
    for stage in stages:
        if _file(artifacts, stage, "graph.npz") is not None:
            return load_graph(artifacts[stage])
    return None
