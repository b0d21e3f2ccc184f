"""Semi-rigid refinement of line scans (L §4.3): every line moves, all of them at once.

The points of all lines make one map of planes. Each point is matched to what was measured at
least a turn of the head earlier or later, and the states of the chain are corrected until the
points lie on the planes and the motion is that of the IMU.
"""

from __future__ import annotations

from collections import deque
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from msgspec import structs
from numpy.typing import NDArray

from recon4.geometry.se3 import ROTATION, TRANSLATION, Array
from recon4.model.events import RoundRefined
from recon4.model.figures import RefineRound
from recon4.model.laser_scans import LaserScans
from recon4.model.laser_upright import turned_round
from recon4.model.support import SurfaceSupport
from recon4.model.trajectory import Times, Trajectory
from recon4.profiler.at_rest import AtRest
from recon4.profiler.imu_chain import (
    POSITION,
    ImuChain,
    Information,
    initial_chain,
    linearize,
    make_drive,
)
from recon4.profiler.mirrored import is_mirrored
from recon4.profiler.planar_hold import PlanarHold, observed_motion
from recon4.profiler.published_refine import PublishedRefiner
from recon4.profiler.samples import joined, laser_points, line_points
from recon4.profiler.stage_odometry import span_of
from recon4.profiler.tuning import LineTuning
from recon4.profiler.tuning_solve import LINE_REFINE_STEPS, SUPPORT
from recon4.progress import Progress
from recon4.registration.degeneracy import observable_pose, of_rigid_pose
from recon4.registration.plane_map import Match, PlaneMap
from recon4.registration.tuning import PLANES, OdometryTuning, PlaneTuning
from recon4.semi_rigid.refine import Refinement, corrected_by_nodes
from recon4.settings.reads import LineRefineReads
from recon4.settings.tuning import tuned
from recon4.store.arrays import load_arrays, load_trajectory
from recon4.store.frames import FrameStore
from recon4.store.line_store import load_laser_scans, load_lines


@dataclass(frozen=True, slots=True)
class LineRound:
    """What one round of matching uses."""

    gate_m: float
    """Points farther from their plane do not match [m]."""
    max_sd_m: float = 0.03
    """Largest standard deviation of the points of a plane across it [m]."""


ROUNDS = (LineRound(0.06), LineRound(0.05))
"""The last one repeats until the steps are small.

The gate is less than half the thickness of a wall: where only the next room was seen at another
time, the other side of the wall is the only plane there. The turns are registered before, so the
first trajectory is near enough.
"""


@dataclass(frozen=True, slots=True, eq=False)
class LineRefiner:
    """Refines the chain of one recording."""

    frames: FrameStore
    scans: LaserScans | None
    settings: LineTuning
    planes: PlaneTuning
    hold: PlanarHold
    rest: AtRest | None
    """Where no 2-D laser observes the motion; None = one does."""
    progress: Progress

    def refine(self, chain: ImuChain) -> tuple[ImuChain, list[RefineRound], Matched | None]:
        """Correct all states in rounds, each with a map of the newest poses.

        Returns:
            The chain, the rounds, and what matched in the last one.
        """
        found: list[RefineRound] = []
        last: Matched | None = None
        for number in range(self.settings.rounds):
            chain, done, matched = self._round(chain, ROUNDS[min(number, len(ROUNDS) - 1)])
            if done is None:
                break
            found.append(done)
            last = matched
            self.progress.event(
                RoundRefined(
                    mean_m=done.mean_m,
                    match_ratio=done.match_ratio,
                    largest_step_m=done.largest_step_m,
                )
            )
            if number >= 3 and done.largest_step_m < self.settings.converged_step_m:
                break
        return chain, found, last

    def _round(
        self, chain: ImuChain, wide: LineRound
    ) -> tuple[ImuChain, RefineRound | None, Matched]:
        linear = linearize(chain)
        dense = linear.trajectory()
        count = len(self.frames)
        self.progress.start("refine lines", count // self.settings.map_stride + count, "multiframe")
        sweep = _LineSweep(self, dense, wide)
        matched = sweep.match(chain)
        if matched.matches == 0:
            return chain, None, matched
        measured = matched.information + self.hold.information(chain)
        if self.rest is not None:
            measured = measured + self.rest.information(chain)
        step = linear.solve(measured, anchor=self._anchor())
        largest_m = float(np.linalg.norm(step[:, POSITION], axis=1).max())
        done = RefineRound(
            mean_m=matched.total_m / matched.matches,
            match_ratio=matched.matches / max(matched.points, 1),
            largest_step_m=largest_m,
        )
        return chain.moved(step), done, matched

    def _anchor(self) -> Array:
        """Weak prior that keeps the map where it is: nothing else says where that is."""
        s = self.settings
        return np.repeat([s.total_sd_rad**-2.0, s.total_sd_m**-2.0], 3) / 100.0


@dataclass(slots=True, eq=False)
class Matched:
    """Normal equations of one round with their counts."""

    information: Information
    counts: NDArray[np.int64]
    """Points and matches of each interval, (K - 1, 2)."""
    total_m: float = 0.0

    @property
    def points(self) -> int:
        """Points that were compared with the map."""
        return int(self.counts[:, 0].sum())

    @property
    def matches(self) -> int:
        """Those that found a plane."""
        return int(self.counts[:, 1].sum())

    def add(self, interval: int, match: Match, scale: float) -> None:
        """Add the matches of some points of an interval."""
        self.information.H[interval] += scale * match.H
        self.information.g[interval] += scale * match.g
        self.counts[interval] += len(match.residual_m), match.matches
        if match.matches:
            self.total_m += match.matches * match.mean_m


class _LineSweep:
    """One pass over the points to build the map, one to match them."""

    def __init__(self, refiner: LineRefiner, dense: Trajectory, wide: LineRound) -> None:
        self._r, self._dense, self._wide = refiner, dense, wide
        settings = structs.replace(refiner.planes, max_sd_m=wide.max_sd_m)
        self._planes = PlaneMap(settings)
        index = refiner.frames.index
        gap_ns = refiner.settings.min_gap_s * 1e9
        duration_ns = max(1, int(index["duration_ns"].min()))
        rows = int(np.ceil(gap_ns / duration_ns))
        # A short walk has no earlier or later visits: everything matches everything.
        self._gap = rows if len(index) >= 3 * rows else 0
        self._present: deque[tuple[int, Array]] = deque()
        self._absent: deque[tuple[int, Array]] = deque()

    def match(self, chain: ImuChain) -> Matched:
        """Match all points; those near in time are not in the map meanwhile."""
        count = len(self._r.frames)
        intervals = len(chain) - 1
        found = Matched(Information.none(intervals), np.zeros((intervals, 2), np.int64))
        stride = self._r.settings.map_stride
        for row in range(0, count, stride):
            placed = self._map_points(row)
            self._planes.add(placed)
            self._r.progress.advance()
        self._planes.fit()
        next_row = 0
        for first in range(0, count, LINE_REFINE_STEPS.block):
            block = range(first, min(first + LINE_REFINE_STEPS.block, count))
            next_row = self._remove_near(block, next_row, count)
            for row in block:
                self._match_frame(row, chain, found)
                self._r.progress.advance()
        return found

    def _map_points(self, row: int) -> Array:
        s = self._r.settings
        points = line_points(self._r.frames, row, every=s.map_every, min_range_m=s.min_range_m)
        return np.ascontiguousarray(points.placed(self._dense))

    def _remove_near(self, block: range, next_row: int, count: int) -> int:
        """Remove what is nearer in time than the gap; add again what no longer is."""
        if not self._gap:
            return next_row
        changed = False
        while self._absent and self._absent[0][0] < block[0] - self._gap:
            self._planes.add(self._absent.popleft()[1])
            changed = True
        stride = self._r.settings.map_stride
        while next_row < min(block[-1] + self._gap + 1, count):
            placed = self._map_points(next_row)
            self._planes.remove(placed)
            self._absent.append((next_row, placed))
            next_row += stride
            changed = True
        if changed:
            self._planes.fit()
        return next_row

    def _match_frame(self, row: int, chain: ImuChain, found: Matched) -> None:
        """Match the points of one multiframe, interval by interval of the chain."""
        r, s = self._r, self._r.settings
        index = r.frames.index[row]
        start_ns = int(index["t_ns"])
        end_ns = start_ns + int(index["duration_ns"])
        parts = [line_points(r.frames, row, every=s.match_every, min_range_m=s.min_range_m)]
        if r.scans is not None and s.laser_every:
            span = (start_ns, end_ns)
            parts.append(laser_points(r.scans, r.frames.rig, span, every=s.laser_every))
        points = joined(parts)
        p_map = points.placed(self._dense)
        knot_ns = chain.drive.knot_ns
        interval = np.clip(
            np.searchsorted(knot_ns, points.t_ns, side="right") - 1, 0, len(knot_ns) - 2
        )
        ends = np.flatnonzero(np.diff(interval)) + 1
        for rows in np.split(np.arange(len(points)), ends):
            if len(rows):
                k = int(interval[rows[0]])
                fraction = (points.t_ns[rows] - knot_ns[k]) / (knot_ns[k + 1] - knot_ns[k])
                match = self._planes.match(
                    np.ascontiguousarray(p_map[rows]),
                    fraction,
                    center=np.ascontiguousarray(chain.vector[k, 0:3]),
                    finest=0,
                    gate_m=self._wide.gate_m,
                )
                found.add(k, match, s.information_scale)


def refine_lines(
    frames: FrameStore,
    odometry: Path,
    nodes: Trajectory,
    *,
    settings: LineRefineReads,
    progress: Progress,
) -> Refinement:
    """Correct the first trajectory by the graph of turns and refine every line scan.

    Args:
        frames: The points, with scans of the 2-D laser beside them.
        odometry: Folder of the stage ``odometry``.
        nodes: ``T_map_body`` of the nodes of the verified graph of turns.
        settings: Uses lines, planes and odometry.
        progress: Counts multiframes.
    """
    start = corrected_by_nodes(load_trajectory(odometry / "trajectory.npz"), nodes)
    if settings.lines.method == "published":
        lines = load_lines(frames.folder)
        published = PublishedRefiner(frames, lines, tuned(LineTuning, settings.lines), progress)
        trajectory, found = published.refine(start)
        return Refinement(trajectory, tuple(found))
    drive = make_drive(
        frames.imu,
        frames.rig,
        span_of(frames),
        knot_s=tuned(LineTuning, settings.lines).knot_s,
        settings=settings.odometry,
    )
    chain = initial_chain(drive).following(start)
    scans = _turned_over(load_laser_scans(frames.folder), frames, start)
    steps = load_arrays(odometry / "steps.npz", ["weak_sd_m", "lost"])
    known = observed_motion(frames.t_mid_ns, drive.knot_ns, **steps)
    hold = PlanarHold.of(start, drive.knot_ns, known)
    rest = None if known.any() else AtRest.of(drive)
    tuning = tuned(LineTuning, settings.lines)
    refiner = LineRefiner(frames, scans, tuning, PLANES, hold, rest, progress)
    chain, rounds, matched = refiner.refine(chain)
    support = None
    if matched is not None:
        support = surface_support(
            frames.t_mid_ns,
            drive.knot_ns,
            H=matched.information.H,
            counts=matched.counts,
            normal_noise_rad=tuned(OdometryTuning, settings.odometry).normal_noise_rad,
        )
    return Refinement(linearize(chain).trajectory(), tuple(rounds), support)


def _turned_over(
    scans: LaserScans | None, frames: FrameStore, trajectory: Trajectory
) -> LaserScans | None:
    """The scans, turned over if the 2-D laser is mounted upside down as odometry found."""
    row = frames.rig.row_of("laser2d")
    if scans is None or row is None or frames.imu is None:
        return scans
    T_map_laser = trajectory.T_a_b @ frames.rig.sensors[row].T_body_sensor
    leveled = Trajectory(trajectory.t_ns, T_map_laser)
    return turned_round(scans) if is_mirrored(scans, leveled) else scans


def surface_support(
    t_mid_ns: Times,
    knot_ns: Times,
    *,
    H: Array,
    counts: NDArray[np.int64],
    normal_noise_rad: float,
) -> SurfaceSupport:
    """Sum the information around each multiframe and find its weakest direction.

    Args:
        t_mid_ns: Middle of each multiframe [ns], (N,).
        knot_ns: Knots of the chain [ns], (K,).
        H: Of the poses at start and end of each interval, as `Information.H`, (K - 1, 12, 12).
        counts: Points and matches of each interval, (K - 1, 2).
        normal_noise_rad: Standard deviation of a plane's normal [rad]: what it alone creates is no
            information.
    """
    summed = np.concatenate([np.zeros((1, 6, 6)), np.cumsum(of_rigid_pose(H), axis=0)])
    counted = np.concatenate([np.zeros((1, 2), np.int64), np.cumsum(counts, axis=0)])
    last = len(knot_ns) - 1
    first, stop = (
        np.clip(np.searchsorted(knot_ns, t_mid_ns + side * SUPPORT.around_ns), 0, last)
        for side in (-1, 1)
    )
    information = summed[stop] - summed[first]
    points, matches = (counted[stop] - counted[first]).T
    weak = [_weakest(one, normal_noise_rad) for one in information]
    return SurfaceSupport(
        t_mid_ns,
        matches / np.maximum(points, 1),
        np.array([sd_m for sd_m, _ in weak]),
        np.stack([direction for _, direction in weak]),
    )


def _weakest(H: Array, normal_noise_rad: float) -> tuple[float, Array]:
    """Standard deviation [m] and direction of the least known position; rotations are free."""
    reduced, _ = observable_pose(H, normal_noise_rad)
    of_turn = reduced[ROTATION, ROTATION] + 1e-6 * np.eye(3)
    coupling = reduced[ROTATION, TRANSLATION]
    position = reduced[TRANSLATION, TRANSLATION] - coupling.T @ np.linalg.solve(of_turn, coupling)
    values, vectors = np.linalg.eigh(0.5 * (position + position.T))
    return max(float(values[0]), SUPPORT.least) ** -0.5, vectors[:, 0]
