"""What the sensor itself leaves of e_r: the same points placed by the estimate and by the truth."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from dataclasses import dataclass

import numpy as np

from recon4.errors import OutOfRange
from recon4.evaluation.ate import absolute_error, pair_poses
from recon4.evaluation.reference_mesh import TriangleMesh, align_to_mesh, distance_to
from recon4.evaluation.sharpness import thin
from recon4.evaluation.slices import RelativeError, Slice, relative_error, spread_slices
from recon4.evaluation.tuning import SENSOR_FLOOR
from recon4.geometry.se3 import SE3, Array
from recon4.locales.coded import CodedText
from recon4.mapping.undistort import place
from recon4.model.multiframe import Multiframe
from recon4.model.rig import Rig
from recon4.model.trajectory import Trajectory


@dataclass(frozen=True, slots=True, eq=False)
class ErrorFloor:
    """e_r of estimated poses and of true poses, from the same points."""

    estimated: RelativeError
    true: RelativeError
    ratio: float
    """``estimated / true`` of the point-weighted means: 1.10 = the poses add a tenth."""
    frames: int
    """Multiframes used."""
    skipped: int
    """Multiframes outside one of the trajectories."""


@dataclass(frozen=True, slots=True, eq=False)
class _Points:
    """Points of some multiframes placed by a trajectory; computed again in every pass."""

    frames: Iterable[Multiframe]
    trajectory: Trajectory
    rig: Rig

    def __iter__(self) -> Iterator[Array]:
        for frame in self.frames:
            used = np.array([sensor.enabled for sensor in self.rig.sensors])[frame.sensor]
            near = np.linalg.norm(frame.xyz, axis=1) <= SENSOR_FLOOR.max_range_m
            yield place(frame.take(used & near), self.trajectory, self.rig)


def relative_error_floor(
    frames: Iterable[Multiframe],
    rig: Rig,
    mesh: TriangleMesh,
    *,
    estimate: Trajectory,
    truth: Trajectory,
) -> ErrorFloor:
    """Place the same points twice and compare their e_r.

    Both maps are aligned with the model by `map_onto_model`, so the ratio is the effect of the
    poses relative to the noise of the sensor.

    Args:
        frames: Some multiframes; points within `SENSOR_FLOOR.max_range_m` are used, several times.
        rig: Mountings; sensors switched off are left out.
        mesh: The true model, in the frame of ``truth``.
        estimate: ``T_map_body``.
        truth: ``T_model_body``.

    Raises:
        OutOfRange: If no multiframe is covered by both trajectories.
    """
    given = [frame for frame in frames if len(frame)]
    used = [frame for frame in given if _covers(estimate, frame) and _covers(truth, frame)]
    if not used:
        raise OutOfRange(CodedText("floor-none", count=len(given)))
    where = spread_slices(mesh)
    start = absolute_error(pair_poses(estimate, truth)).T_true_map
    errors = [
        _error(_Points(used, trajectory, rig), mesh, where, start=T_model_map)
        for trajectory, T_model_map in ((estimate, start), (truth, SE3.identity()))
    ]
    return ErrorFloor(
        estimated=errors[0],
        true=errors[1],
        ratio=errors[0].point_weighted.mean_m / errors[1].point_weighted.mean_m,
        frames=len(used),
        skipped=len(given) - len(used),
    )


def map_onto_model(
    chunks: Iterable[Array],
    mesh: TriangleMesh,
    *,
    start: SE3,
    rng: np.random.Generator,
    voxel_m: float = 0.2,
) -> SE3:
    """``T_model_map`` by ICP on the map thinned to one point a voxel (V §3.2 aligns by ICP too).

    Args:
        chunks: Points of the map [m], arrays of (N, 3).
        mesh: The model.
        start: Where to start, for example the SVD fit of the trajectories.
        rng: Source of randomness.
        voxel_m: Voxel of the thinning [m].
    """
    few = thin(chunks, voxel_m=voxel_m)
    if len(few) > 100_000:
        few = few[np.sort(rng.choice(len(few), size=100_000, replace=False))]
    return align_to_mesh(few, mesh, T_model_map=start, rng=rng)


def _error(
    points: _Points, mesh: TriangleMesh, slices: tuple[Slice, ...], *, start: SE3
) -> RelativeError:
    T_model_map = map_onto_model(points, mesh, start=start, rng=np.random.default_rng(0))
    return relative_error(
        points, slices, T_model_map=T_model_map, distance=distance_to(mesh), alignment="ICP"
    )


def _covers(trajectory: Trajectory, frame: Multiframe) -> bool:
    return bool(trajectory.t_ns[0] <= frame.t_mid_ns <= trajectory.t_ns[-1])
