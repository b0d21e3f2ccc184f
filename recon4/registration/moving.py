"""Moving objects: people and vehicles that stand where other scans of the walk see through.

Who walks with the carrier seems to stand in the body while the world moves past. A registration
that matches such points estimates less motion than there was, sure of itself. What gives them away
is free space: some seconds before or after, a scan from another place sees through where they were.
A surface that stands is met there by all scans that look at it.

Scans of the walk at regular times become images of ranges. A point is moving if several of them see
through it, and more than meet a surface there. Grass, leaves and the edges of surfaces are safe: a
scan sees through a point only if it does so in all directions around it, too.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from recon4.geometry.cubes import cubes_of
from recon4.geometry.se3 import SE3, Array
from recon4.kernels.free_space import NO_SURFACE, find_moving_points, nearest_ranges
from recon4.kernels.imu import place_points
from recon4.kernels.points import points_in_body
from recon4.model.frames import RecordedFrames
from recon4.model.hidden_points import HiddenPoints
from recon4.model.lidars import lidar_model
from recon4.model.multiframe import Multiframe
from recon4.model.odometry_figures import MovingFigures
from recon4.model.rig import Rig
from recon4.model.samples import ImuSamples
from recon4.model.trajectory import Times, Trajectory
from recon4.registration.tuning_matching import MOVING

_RULES: Array = np.array(
    [
        MOVING.margin_m,
        MOVING.margin_per_m,
        MOVING.nearest_m,
        MOVING.farthest_m,
        MOVING.min_passes,
        MOVING.agreed,
    ],
    np.float64,
)


@dataclass(frozen=True, slots=True, eq=False)
class _View:
    """One scan as images of ranges, an image a sensor."""

    t_ns: int
    piece: int
    T_odom_sensor: SE3
    """Of each sensor, (S,)."""
    images: NDArray[np.float32]
    """Ranges [m], (S, rows, columns)."""


class FreeSpace:
    """Scans of a walk at regular times, which tell whether points of others stand still.

    A scan is read when it is needed and forgotten when it is too far away in time: some twenty
    images are in memory.
    """

    def __init__(self, frames: RecordedFrames, trajectory: Trajectory, piece: Times) -> None:
        """Nothing is read yet.

        Args:
            frames: The multiframes.
            trajectory: ``T_odom_body``, dense.
            piece: Number of the piece of each multiframe, -1 = tracking was lost, (N,).
        """
        self._frames, self._trajectory, self._piece = frames, trajectory, piece
        self.rows = _regular(frames.t_mid_ns, piece >= 0)
        self._t_ns: Times = frames.t_mid_ns[self.rows]
        self._shape = image_shape(frames.rig)
        self._views: dict[int, _View] = {}

    def moving(self, frame: Multiframe, rows: NDArray[np.intp]) -> NDArray[np.bool_]:
        """Which of some points of a multiframe move, (M,).

        Args:
            frame: The multiframe.
            rows: Numbers of its points, (M,).
        """
        p_odom = _placed(frame.take(rows), self._trajectory, self._frames.rig)
        moving = np.zeros(len(rows), np.bool_)
        if views := self._near(frame):
            find_moving_points(
                p_odom,
                np.stack([view.T_odom_sensor.R for view in views]),
                np.stack([view.T_odom_sensor.t for view in views]),
                np.stack([view.images for view in views]),
                _RULES,
                moving,
            )
        return moving

    def _near(self, frame: Multiframe) -> list[_View]:
        """The scans with which points of a multiframe are compared, nearest in time first."""
        away_ns = np.abs(self._t_ns - frame.t_mid_ns)
        near = np.flatnonzero((away_ns >= MOVING.apart_ns) & (away_ns <= MOVING.reach_ns))
        near = near[np.argsort(away_ns[near], kind="stable")]
        for old in [k for k in self._views if away_ns[k] > MOVING.reach_ns + MOVING.view_ns]:
            del self._views[old]
        for k in near.tolist():
            if k not in self._views:
                self._views[k] = self._view(int(self.rows[k]))
        piece = self._piece[frame.frame_id]
        return [view for k in near.tolist() if (view := self._views[k]).piece == piece]

    def _view(self, row: int) -> _View:
        frame, rig = self._frames[row], self._frames.rig
        T_odom_body = self._trajectory.at(np.array([frame.t_mid_ns]))
        T_odom_sensor = T_odom_body @ rig.T_body_sensor
        images = np.full((len(rig.sensors), *self._shape), NO_SURFACE, np.float32)
        p_odom = _placed(frame, self._trajectory, rig)
        for sensor, image in enumerate(images):
            T = T_odom_sensor[sensor]
            nearest_ranges(p_odom[frame.sensor == sensor], T.R, T.t, image)
        return _View(frame.t_mid_ns, int(self._piece[row]), T_odom_sensor, images)


def image_shape(rig: Rig) -> tuple[int, int]:
    """Rows (elevation) and columns (azimuth) of the images of ranges of a rig's sensors."""
    steps_deg = [lidar_model(sensor.model).ring_step_deg for sensor in rig.sensors]
    cell_deg = max(MOVING.least_cell_deg, *steps_deg)
    return round(180.0 / cell_deg), round(360.0 / cell_deg)


def find_moving(frames: RecordedFrames, trajectory: Trajectory, piece: Times) -> MovingFigures:
    """How much of the view moving objects fill in the course of a walk.

    Args:
        frames: The multiframes.
        trajectory: ``T_odom_body``, dense.
        piece: Number of the piece of each multiframe, -1 = tracking was lost, (N,).
    """
    if len(frames) < 2:
        return MovingFigures(t_s=(), ratio=())
    space = FreeSpace(frames, trajectory, piece)
    ratios = []
    for row in space.rows:
        frame = frames[int(row)]
        rows = np.arange(0, len(frame), 1 + len(frame) // MOVING.sampled)
        ratios.append(float(space.moving(frame, rows).mean()) if len(rows) else 0.0)
    since_s = (frames.t_mid_ns[space.rows] - frames.t_mid_ns[0]) / 1e9
    return MovingFigures(
        t_s=tuple(np.round(since_s, 2).tolist()), ratio=tuple(np.round(ratios, 4).tolist())
    )


def hide_moving(
    frames: RecordedFrames, trajectory: Trajectory, piece: Times, *, found: MovingFigures
) -> HiddenPoints:
    """The moving points of all multiframes near scans that have some.

    Args:
        frames: The multiframes.
        trajectory: ``T_odom_body``, dense.
        piece: Number of the piece of each multiframe, -1 = tracking was lost, (N,).
        found: Of `find_moving`.
    """
    space = FreeSpace(frames, trajectory, piece)
    crowded = is_crowded_at(frames.t_mid_ns, found) & (piece >= 0)
    masks: list[NDArray[np.bool_] | None] = []
    for row in range(len(frames)):
        if crowded[row]:
            frame = frames[row]
            moving = space.moving(frame, np.arange(len(frame)))
            masks.append(with_points_around(frame, moving, frames.rig))
        else:
            masks.append(None)
    return HiddenPoints.of(masks)


def with_points_around(frame: Multiframe, moving: NDArray[np.bool_], rig: Rig) -> NDArray[np.bool_]:
    """Moving points of a multiframe and the points around them: feet on the ground, (N,)."""
    cell = cubes_of(_in_body(frame, rig), MOVING.around_m)
    crowded, count = np.unique(_keys(cell[moving]), return_counts=True)
    around = (crowded[:, None] + _keys(_NEIGHBORS)).ravel()
    cells, of = np.unique(around, return_inverse=True)
    near = np.bincount(of, np.repeat(count, len(_NEIGHBORS)), len(cells)) >= MOVING.around_points
    return np.asarray(moving | np.isin(_keys(cell), cells[near]))


_NEIGHBORS = np.stack(np.meshgrid(*3 * [np.arange(-1, 2)], indexing="ij"), axis=-1).reshape(-1, 3)


def _keys(cell: NDArray[np.int64]) -> NDArray[np.int64]:
    """A number for each cell of a grid, (N, 3) -> (N,); those of neighbors add up."""
    return np.asarray(cell @ np.array([1, 1 << 20, 1 << 40], np.int64))


def is_crowded_at(
    t_ns: Times, found: MovingFigures, *, within_ns: int = MOVING.cleared_ns
) -> NDArray[np.bool_]:
    """Near which multiframes moving objects were found.

    Args:
        t_ns: Times of all multiframes [ns], (N,).
        found: Of `find_moving`.
        within_ns: How near in time [ns].
    """
    since_s = np.array(found.t_s)[np.array(found.ratio) >= MOVING.cleared]
    crowded_ns = t_ns[0] + np.round(1e9 * since_s).astype(np.int64)
    return np.asarray((np.abs(crowded_ns - t_ns[:, None]) <= within_ns).any(axis=1))


def _regular(t_ns: Times, usable: NDArray[np.bool_]) -> NDArray[np.intp]:
    """Numbers of usable multiframes, the first of each `MOVING.view_ns`."""
    rows = np.flatnonzero(usable)
    slots = (t_ns[rows] - t_ns[0]) // MOVING.view_ns
    return np.asarray(rows[np.unique(slots, return_index=True)[1]], np.intp)


def _placed(frame: Multiframe, trajectory: Trajectory, rig: Rig) -> Array:
    """Points of a multiframe, each by the pose at its time [m], (N, 3)."""
    first, last = np.searchsorted(trajectory.t_ns, [frame.t_ns, frame.t_ns + frame.duration_ns])
    first = min(max(int(first) - 1, 0), len(trajectory) - 2)
    part = trajectory[slice(first, max(int(last) + 1, first + 2))]
    body = _in_body(frame, rig)
    t_s = (part.t_ns - frame.t_ns).astype(np.float64) * 1e-9
    s = frame.dt_ns.astype(np.float64) * 1e-9
    return np.asarray(place_points(t_s, part.T_a_b.R, part.T_a_b.t, s, body))


def _in_body(frame: Multiframe, rig: Rig) -> Array:
    """Points of a multiframe in the body, each at its time [m], (N, 3)."""
    body = np.empty((len(frame), 3))
    T = SE3.stack(sensor.T_body_sensor for sensor in rig.sensors)
    points_in_body(T.R, T.t, frame.sensor, frame.xyz, body)
    return body


@dataclass(frozen=True, slots=True, eq=False)
class StandingFrames:
    """Multiframes of a recording without their moving points."""

    frames: RecordedFrames
    hidden: HiddenPoints

    @property
    def rig(self) -> Rig:
        """The sensors and their poses."""
        return self.frames.rig

    @property
    def imu(self) -> ImuSamples | None:
        """IMU samples, if there are any."""
        return self.frames.imu

    def with_imu(self, imu: ImuSamples) -> StandingFrames:
        """The same multiframes with repaired samples."""
        return replace(self, frames=self.frames.with_imu(imu))

    @property
    def t_mid_ns(self) -> Times:
        """Middle of each multiframe [ns], (N,)."""
        return self.frames.t_mid_ns

    def __len__(self) -> int:
        return len(self.frames)

    def __getitem__(self, k: int) -> Multiframe:
        return self.hidden.seen(self.frames[k])

    def __iter__(self) -> Iterator[Multiframe]:
        return (self[k] for k in range(len(self)))
