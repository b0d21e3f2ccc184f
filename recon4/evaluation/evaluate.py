"""Evaluation of a result against ground truth: ``recon4 evaluate``."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from dataclasses import dataclass, fields, is_dataclass
from pathlib import Path

import numpy as np

from recon4.evaluation.ate import AbsoluteError, PosePairs, absolute_error, pair_poses
from recon4.evaluation.density import SurfaceDensity, surface_density
from recon4.evaluation.floor import ErrorFloor, map_onto_model, relative_error_floor
from recon4.evaluation.kitti import OFFICIAL_M, WALK_M, Drift, official_drift, thesis_drift
from recon4.evaluation.reference_mesh import TriangleMesh, distance_to
from recon4.evaluation.sharpness import Sharpness, around, draw_places, sharpness, thin
from recon4.evaluation.slices import RelativeError, relative_error, spread_slices
from recon4.evaluation.text import evaluation_text
from recon4.evaluation.trajectories import trajectory_with_hints
from recon4.evaluation.tuning import EVALUATION, SEGMENT_DRIFT
from recon4.geometry.se3 import SE3, Array
from recon4.locales.languages import ENGLISH
from recon4.model.frames import Frames
from recon4.model.plain import finite_or_none
from recon4.model.trajectory import Trajectory

Chunks = Callable[[], Iterable[Array]]
"""Makes a fresh pass over the points of the map [m], arrays of (N, 3)."""


@dataclass(frozen=True, slots=True, eq=False)
class MapChunks:
    """The points of a map, a new pass at each call."""

    delivered: Chunks
    """For example ``lambda: (tile.xyz_m() for tile in TileSet.open(folder))``."""
    measured: Chunks | None = None
    """The same points where they were measured; None = the map has no fitted surfaces."""


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class MapQuality:
    """Quality of the map that needs no ground truth."""

    density: SurfaceDensity
    sharpness: Sharpness


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class Evaluation:
    """All figures of a result."""

    estimate: str
    """Name of the evaluated trajectory or project."""
    truth: str
    """Name of the ground truth."""
    poses: int
    coverage_ratio: float
    """Ratio of the estimated poses covered by the ground truth, 0..1."""
    path_length_m: float
    """Path length of the ground truth [m]."""
    duration_s: float
    aligned: AbsoluteError
    """After the SVD fit of all positions."""
    first_pose: AbsoluteError
    """Aligned at the first pose (L Eq. 9)."""
    unaligned: AbsoluteError
    """Not aligned: meaningful if estimate and truth are in one frame."""
    drift: tuple[Drift, ...]
    relative: RelativeError | None = None
    """Of the map as delivered."""
    measured: RelativeError | None = None
    """The same points where they were measured; None = the map has no fitted surfaces."""
    floor: ErrorFloor | None = None
    quality: MapQuality | None = None

    def table(self, language: str = ENGLISH) -> str:
        """The figures as text tables for a terminal."""
        return evaluation_text(self, language)

    def to_json(self) -> dict[str, object]:
        """Plain JSON values; NaN becomes null, arrays with one row per pose are left out."""
        plain = _plain(self)
        assert isinstance(plain, dict)
        return plain

    hints: tuple[str, ...] = ()
    """What is strange about the files."""


def evaluate(
    project_or_trajectory: Path,
    *,
    truth: Path,
    model: TriangleMesh | None = None,
    chunks: MapChunks | None = None,
    frames: Frames | None = None,
) -> Evaluation:
    """Evaluate a result against ground truth.

    Args:
        project_or_trajectory: ``.tum`` or ``.npz`` file, or a project with ``trajectory.tum``.
        truth: Ground truth trajectory in the same formats, at any rate, in any frame.
        model: True model as a triangle mesh in the frame of ``truth``; needed for e_r.
        chunks: Points of the map; needed for e_r and the map's quality.
        frames: Multiframes; with ``model``, every tenth gives e_r of the true poses from the same
            points.

    Raises:
        OutOfRange: If the truth covers fewer than two poses.
        Recon4Error: If a file cannot be read.
    """
    (estimate, hints), (true, more) = map(trajectory_with_hints, (project_or_trajectory, truth))
    pairs = pair_poses(at_frames(estimate), true)
    aligned = absolute_error(pairs)
    floor = relative = as_measured = None
    if model is not None and frames is not None:
        tenth = [frames[row] for row in range(0, len(frames), EVALUATION.every)]
        floor = relative_error_floor(tenth, frames.rig, model, estimate=estimate, truth=true)
    if model is not None and chunks is not None:
        relative = _relative(chunks.delivered, model, start=aligned.T_true_map)
        if chunks.measured is not None:
            as_measured = _relative(chunks.measured, model, start=aligned.T_true_map)
    return Evaluation(
        estimate=project_or_trajectory.name,
        truth=truth.name,
        poses=len(pairs),
        coverage_ratio=pairs.coverage_ratio,
        path_length_m=_path_length_m(pairs),
        duration_s=float(pairs.t_ns[-1] - pairs.t_ns[0]) / 1e9,
        aligned=aligned,
        first_pose=absolute_error(pairs, alignment="first"),
        unaligned=absolute_error(pairs, alignment="none"),
        drift=drifts(pairs),
        relative=relative,
        measured=as_measured,
        floor=floor,
        quality=map_quality(chunks.delivered) if chunks is not None else None,
        hints=hints + more,
    )


def at_frames(trajectory: Trajectory, *, period_ns: int = EVALUATION.frame_ns) -> Trajectory:
    """A denser trajectory at one pose a frame; a sparser one as it is."""
    if len(trajectory) < 2 or np.median(np.diff(trajectory.t_ns)) > 0.75 * period_ns:
        return trajectory
    t_ns = np.arange(trajectory.t_ns[0], trajectory.t_ns[-1] + 1, period_ns, dtype=np.int64)
    return Trajectory(t_ns, trajectory.at(t_ns))


def drifts(pairs: PosePairs) -> tuple[Drift, ...]:
    """V's metric, the official KITTI metric, and the latter with lengths for short walks."""
    return (
        thesis_drift(pairs, lengths=SEGMENT_DRIFT.thesis_frames),
        official_drift(pairs, lengths_m=OFFICIAL_M),
        official_drift(pairs, lengths_m=WALK_M),
    )


def map_quality(chunks: Chunks, *, places: int = 2000, seed: int = 0) -> MapQuality | None:
    """Density and sharpness of a map at places drawn at random.

    Args:
        chunks: Makes a pass over the map's points.
        places: Number of places.
        seed: Random seed.

    Returns:
        None for a map without points.
    """
    where = draw_places(chunks(), rng=np.random.default_rng(seed), count=places)
    if not len(where):
        return None
    near = list(around(where, chunks(), radius_m=0.3))
    return MapQuality(
        density=surface_density(near, where),
        sharpness=sharpness(thin(near, voxel_m=0.02), places=where, radius_m=0.3),
    )


def _relative(chunks: Chunks, mesh: TriangleMesh, *, start: SE3) -> RelativeError:
    """e_r of the map, aligned with the model by ICP (V §3.2) from the fit of the trajectory on."""
    rng = np.random.default_rng(0)
    T_model_map = map_onto_model(chunks(), mesh, start=start, rng=rng)
    return relative_error(
        chunks(),
        spread_slices(mesh),
        T_model_map=T_model_map,
        distance=distance_to(mesh),
        alignment="ICP",
    )


def _path_length_m(pairs: PosePairs) -> float:
    return float(np.linalg.norm(np.diff(pairs.T_true_body.t, axis=0), axis=1).sum())


_PER_POSE = {"position_errors_m", "rotation_errors_rad"}


def _plain(value: object) -> object:
    if isinstance(value, SE3):
        return {"quat_xyzw": _plain(value.quat_xyzw()), "t_m": _plain(value.t)}
    if is_dataclass(value) and not isinstance(value, type):
        names = [f.name for f in fields(value) if f.name not in _PER_POSE]
        return {name: _plain(getattr(value, name)) for name in names}
    if isinstance(value, np.ndarray):
        return _plain(value.tolist())
    if isinstance(value, (list, tuple)):
        return [_plain(item) for item in value]
    return finite_or_none(value) if isinstance(value, float) else value
