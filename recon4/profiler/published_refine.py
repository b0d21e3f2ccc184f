"""Semi-rigid SLAM as published (L §4.3): point pairs, corrections between groups of lines.

Every 100 lines have a correction; between two of them that of a line is interpolated. Points match
the closest point of another sweep, so at least a sweep away in time, within 25 cm. There is no
model of the motion besides a weak bond between consecutive corrections.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from scipy.spatial import cKDTree

from recon4.geometry.se3 import TRANSLATION, Array
from recon4.kernels.pairs import accumulate_pairs
from recon4.model.events import RoundRefined
from recon4.model.figures import RefineRound
from recon4.model.line_scans import LineScans
from recon4.model.trajectory import Times, Trajectory
from recon4.profiler.samples import TimedPoints, joined, line_points
from recon4.profiler.tuning import LineTuning
from recon4.profiler.tuning_solve import PUBLISHED_REFINE
from recon4.progress import Progress
from recon4.registration.scan_registration import thinned
from recon4.semi_rigid.knots import IntervalEquations, apply_knots, solve_knots
from recon4.store.frames import FrameStore


@dataclass(frozen=True, slots=True, eq=False)
class PublishedRefiner:
    """Refines the trajectory of one recording."""

    frames: FrameStore
    lines: LineScans
    settings: LineTuning
    progress: Progress

    def refine(self, start: Trajectory) -> tuple[Trajectory, list[RefineRound]]:
        """Search pairs and correct all groups of lines, until the steps are small."""
        knot_ns = self._knots()
        applied = np.zeros((len(knot_ns), 6))
        trajectory, rounds = start, []
        for _ in range(self.settings.outer_rounds):
            system, mean_m, ratio = self._match(trajectory, knot_ns)
            if ratio == 0.0:
                break
            step = solve_knots(
                system,
                applied,
                neighbor_sd=np.repeat(PUBLISHED_REFINE.neighbor_sd, 3),
                total_sd=np.repeat(PUBLISHED_REFINE.total_sd, 3),
            )
            applied = applied + step
            trajectory = apply_knots(trajectory, knot_ns, step)
            largest_m = float(np.linalg.norm(step[:, TRANSLATION], axis=1).max())
            figures = RefineRound(mean_m=mean_m, match_ratio=ratio, largest_step_m=largest_m)
            rounds.append(figures)
            self.progress.event(
                RoundRefined(mean_m=mean_m, match_ratio=ratio, largest_step_m=largest_m)
            )
            if largest_m < self.settings.converged_step_m:
                break
        return trajectory, rounds

    def _knots(self) -> Times:
        """Times of every n-th line and of the end [ns]."""
        rows = np.arange(0, len(self.lines), self.settings.group_lines)
        return np.append(self.lines.t_ns[rows], self.lines.t_ns[-1] + 20_000_000)

    def _match(
        self, trajectory: Trajectory, knot_ns: Times
    ) -> tuple[IntervalEquations, float, float]:
        """Normal equations of all pairs, their mean distance [m] and the part of matched points."""
        sweeps = self._sweeps(trajectory)
        clouds = [
            thinned(points.placed(trajectory), self.settings.pair_voxel_m) for points in sweeps
        ]
        count = len(knot_ns) - 1
        H, g = np.zeros((count, 12, 12)), np.zeros((count, 12))
        center = trajectory.at(np.clip(knot_ns[:-1], trajectory.t_ns[0], trajectory.t_ns[-1])).t
        total, matches, tried = 0.0, 0, 0
        for k, points in enumerate(sweeps):
            others = [cloud for j, cloud in enumerate(clouds) if abs(j - k) >= 2 and len(cloud)]
            if not others:
                continue
            some = _every(points, self.settings.pair_every)
            p, q, distance, rows = _closest(
                some.placed(trajectory), np.concatenate(others), self.settings.link_distance_m
            )
            t_ns = some.t_ns[rows]
            interval = np.clip(np.searchsorted(knot_ns, t_ns, side="right") - 1, 0, count - 1)
            span = knot_ns[interval + 1] - knot_ns[interval]
            fraction = np.clip((t_ns - knot_ns[interval]) / span, 0.0, 1.0)
            accumulate_pairs(p, q, interval.astype(np.int64), fraction, center, H, g)
            total += float(distance.sum())
            matches, tried = matches + len(p), tried + len(some)
        scale = PUBLISHED_REFINE.independent / PUBLISHED_REFINE.pair_sd_m**2
        system = IntervalEquations(scale * H, scale * g)
        return system, total / max(matches, 1), matches / max(tried, 1)

    def _sweeps(self, trajectory: Trajectory) -> list[TimedPoints]:
        """Points of each sweep of the head."""
        ends = self.lines.sweeps()
        start_ns = self.lines.t_ns[ends[:-1]]
        parts: list[list[TimedPoints]] = [[] for _ in start_ns]
        self.progress.start("pair lines", len(self.frames), "multiframe")
        for row in range(len(self.frames)):
            points = line_points(
                self.frames,
                row,
                every=self.settings.match_every,
                min_range_m=self.settings.min_range_m,
            )
            sweep = np.clip(np.searchsorted(start_ns, points.t_ns, side="right") - 1, 0, None)
            for k in np.unique(sweep):
                rows = sweep == k
                parts[k].append(TimedPoints(points.t_ns[rows], points.p_body[rows]))
            self.progress.advance()
        nothing = TimedPoints(np.zeros(0, np.int64), np.empty((0, 3)))
        return [joined(part) if part else nothing for part in parts]


def _every(points: TimedPoints, every: int) -> TimedPoints:
    return TimedPoints(points.t_ns[::every], np.ascontiguousarray(points.p_body[::every]))


def _closest(
    p: Array, cloud: Array, reach_m: float
) -> tuple[Array, Array, Array, np.ndarray[tuple[int], np.dtype[np.bool_]]]:
    """Points with a closest point within reach, that point, their distance, and which they are."""
    tree = cKDTree(cloud, balanced_tree=False, compact_nodes=False)
    distance, nearest = tree.query(p, distance_upper_bound=reach_m)
    rows = np.isfinite(distance)
    return p[rows], cloud[nearest[rows]], distance[rows], rows
