"""Semi-rigid refinement: correct every multiframe over time, so that it fits the common map.

The pose graph corrects nodes; between them odometry alone determines the motion. Here all segments
of the walk make one plane map, each multiframe is matched to it, and one banded system corrects
all of them together (requirements A12 L-4: global matching in sections, continuous in time).

A round is summed up in one order, so the plane map of a round that was begun is built once more;
what has been matched to it is not matched again.
"""

from __future__ import annotations

import json
from collections.abc import Callable, Iterator
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass
from functools import partial
from pathlib import Path
from typing import NamedTuple, TypeVar

import numpy as np
from numpy.typing import NDArray

from recon4.geometry.se3 import TRANSLATION, Array
from recon4.model.corrections import apply_corrections
from recon4.model.events import RoundRefined
from recon4.model.figures import CarriedFigures, RefineFigures, RefineRound
from recon4.model.multiframe import Multiframe
from recon4.model.plain import to_plain
from recon4.model.support import SurfaceSupport
from recon4.model.trajectory import Times, Trajectory
from recon4.progress import Progress
from recon4.registration.plane_map import PlaneMap
from recon4.registration.segments import sample_segments
from recon4.registration.submap import place_segments
from recon4.registration.tuning import OdometryTuning
from recon4.semi_rigid.knots import IntervalEquations, apply_knots, solve_knots
from recon4.semi_rigid.tuning import REFINE_RUN, RefineTuning
from recon4.settings.reads import RefineReads
from recon4.settings.tuning import tuned
from recon4.store.arrays import load_arrays, load_trajectory, save_record, save_trajectory
from recon4.store.frames import FrameStore
from recon4.store.unfinished import RecordLog, unfinished_file

Result = TypeVar("Result")


@dataclass(frozen=True, slots=True, eq=False)
class Refinement:
    """Result of the stage ``refine``."""

    trajectory: Trajectory
    """``T_map_body``, dense."""
    rounds: tuple[RefineRound, ...]
    support: SurfaceSupport | None = None
    """Of line scans; None = not worked out."""
    carried: CarriedFigures | None = None
    """How far the nodes moved that it was carried along with; None = it was refined by itself."""

    def save(self, out: Path) -> RefineFigures:
        """Write ``trajectory.npz``, ``refine.json`` (the figures) and ``support.npz``."""
        save_trajectory(out / "trajectory.npz", self.trajectory)
        if self.support is not None:
            save_record(out / "support.npz", self.support)
        figures = RefineFigures(rounds=self.rounds, carried=self.carried)
        (out / "refine.json").write_text(json.dumps(to_plain(figures), indent=1))
        return figures


def refine(
    frames: FrameStore,
    odometry: Path,
    nodes: Trajectory,
    *,
    settings: RefineReads,
    progress: Progress,
) -> Refinement:
    """Correct the odometry by the graph and, in mode ``beyond``, refine every multiframe.

    Args:
        frames: The multiframes.
        odometry: Folder of the stage ``odometry``.
        nodes: ``T_map_body`` of the nodes of the verified graph.
        settings: Uses segments, planes and refine; only mode ``beyond`` refines.
        progress: Counts multiframes.
    """
    start = corrected_by_nodes(load_trajectory(odometry / "trajectory.npz"), nodes)
    if settings.graph.mode != "beyond":
        return Refinement(start, ())
    lost = load_arrays(odometry / "steps.npz", ["lost"])["lost"]
    refined, rounds = refine_trajectory(frames, start, lost, settings=settings, progress=progress)
    return Refinement(refined, tuple(rounds))


def corrected_by_nodes(odometry: Trajectory, nodes: Trajectory) -> Trajectory:
    """Dense odometry corrected by the nodes of the graph: ``T_map_body``."""
    before = odometry.at(nodes.t_ns)
    return apply_corrections(odometry, nodes.t_ns, T_before=before, T_after=nodes.T_a_b)


def refine_trajectory(
    frames: FrameStore,
    start: Trajectory,
    lost: NDArray[np.bool_],
    *,
    settings: RefineReads,
    progress: Progress,
) -> tuple[Trajectory, list[RefineRound]]:
    """Build the plane map and correct all multiframes to fit it, in several rounds.

    Args:
        frames: The multiframes.
        start: ``T_map_body``, dense.
        lost: Multiframes that are excluded, (number of multiframes,).
        settings: Uses segments, planes and refine.
        progress: Counts multiframes, twice a round.
    """
    r = tuned(RefineTuning, settings.refine)
    knot_ns = _knots(frames)
    correction = np.zeros((len(knot_ns), 6))
    trajectory, rounds, finished = start, list[RefineRound](), RefinedRounds()
    neighbor_sd = np.repeat([r.step_sd_rad, r.step_sd_m], 3)
    total_sd = np.repeat([r.total_sd_rad, r.total_sd_m], 3)
    for number in range(r.rounds):
        earlier = finished.get(number)
        if earlier is not None:
            step, figures = earlier
        else:
            progress.start("refine", len(frames) // r.map_stride + len(frames), "multiframe")
            sweep = _Sweep(frames, trajectory, lost, settings=settings, progress=progress)
            system, mean_m, match_ratio = sweep.match(sweep.build(), MatchedFrames(number))
            if match_ratio == 0.0:
                break
            step = solve_knots(system, correction, neighbor_sd=neighbor_sd, total_sd=total_sd)
            figures = finished.add(step, mean_m=mean_m, match_ratio=match_ratio)
        correction = correction + step
        trajectory = apply_knots(trajectory, knot_ns, step)
        rounds.append(figures)
        progress.event(
            RoundRefined(
                mean_m=figures.mean_m,
                match_ratio=figures.match_ratio,
                largest_step_m=figures.largest_step_m,
            )
        )
        if figures.largest_step_m < r.converged_step_m:
            break
    return trajectory, rounds


class MatchedFrame(NamedTuple):
    """Normal equations of a multiframe, mean distance [m] and match ratio."""

    H: Array
    """(12, 12)."""
    g: Array
    """(12,)."""
    mean_m: float
    match_ratio: float


class MatchedFrames:
    """Multiframes that were matched in one round."""

    def __init__(self, number: int) -> None:
        """Take up what an earlier process has matched in the round of this number."""
        self._log = RecordLog(unfinished_file(f"round-{number}"))
        found = (np.frombuffer(record, np.float64) for record in self._log)
        self._known = {int(values[0]): _matched(values[1:]) for values in found}

    def get(self, row: int) -> MatchedFrame | None:
        """What an earlier process found; None = nothing."""
        return self._known.get(row)

    def add(self, row: int, found: MatchedFrame) -> None:
        """Note what was found, in the order in which it is used."""
        if row not in self._known:
            figures = (found.mean_m, found.match_ratio)
            values = np.concatenate([[float(row)], found.H.ravel(), found.g, figures])
            self._log.append(values.tobytes())


class RefinedRounds:
    """Rounds that are finished."""

    def __init__(self) -> None:
        """Take up those of an earlier process."""
        self._log = RecordLog(unfinished_file("rounds"))

    def get(self, number: int) -> tuple[Array, RefineRound] | None:
        """Corrections of the knots (K, 6) and figures of a round; None = it was not finished."""
        if number >= len(self._log):
            return None
        values = np.frombuffer(self._log[number], np.float64)
        step = values[2:].reshape(-1, 6)
        return step, _figures(step, mean_m=float(values[0]), match_ratio=float(values[1]))

    def add(self, step: Array, *, mean_m: float, match_ratio: float) -> RefineRound:
        """Note a finished round; returns its figures."""
        self._log.append(np.concatenate([[mean_m, match_ratio], step.ravel()]).tobytes())
        return _figures(step, mean_m=mean_m, match_ratio=match_ratio)


def _matched(values: Array) -> MatchedFrame:
    H, g, figures = np.split(values, [144, 156])
    return MatchedFrame(H.reshape(12, 12), g, float(figures[0]), float(figures[1]))


def _figures(step: Array, *, mean_m: float, match_ratio: float) -> RefineRound:
    largest_m = float(np.linalg.norm(step[:, TRANSLATION], axis=1).max())
    return RefineRound(mean_m=mean_m, match_ratio=match_ratio, largest_step_m=largest_m)


class _PlacedEnds(NamedTuple):
    """The segments of a multiframe, placed by the trajectory."""

    ends: Array
    """Both ends of each [m], (N, 3)."""
    seen_from: Array
    """Place of the body in the middle of the multiframe [m], (3,)."""
    fraction: Array
    """Time of each end within the multiframe, 0..1, (N,)."""


class _Sweep:
    """One pass over all multiframes to build the map, one to match them."""

    def __init__(
        self,
        frames: FrameStore,
        trajectory: Trajectory,
        lost: NDArray[np.bool_],
        *,
        settings: RefineReads,
        progress: Progress,
    ) -> None:
        self._frames, self._trajectory, self._lost = frames, trajectory, lost
        self._settings, self._progress = settings, progress
        self._tuning = tuned(RefineTuning, settings.refine)

    def build(self) -> PlaneMap:
        """Plane map of all segments of the walk; added in order, so that it is reproducible."""
        planes = PlaneMap()
        for placed in self._in_order(self._placed, self._tuning.map_stride):
            if placed is not None:
                planes.add(placed.ends, placed.seen_from)
        planes.fit()
        return planes

    def match(
        self, planes: PlaneMap, matched: MatchedFrames
    ) -> tuple[IntervalEquations, float, float]:
        """Normal equations of every multiframe, mean distance [m] and match ratio.

        With a ``min_gap_s`` multiframes nearer in time than that to those being matched are
        removed from the map meanwhile. The match ratio is 0 if nothing matches. What an earlier
        process has ``matched`` is taken from it.
        """
        count = len(self._frames)
        H, g = np.zeros((count, 12, 12)), np.zeros((count, 12))
        distances: list[float] = []
        ratios: list[float] = []
        absent = _Absent(planes, self._gap_rows(), self._tuning.map_stride)

        def forget(chunk: range, pool: ThreadPoolExecutor) -> None:
            absent.move_to(chunk, partial(pool.map, self._placed), count)

        def match(row: int) -> MatchedFrame | None:
            return matched.get(row) or self._match_one(planes, absent.get(row) or self._placed(row))

        for row, found in enumerate(self._in_order(match, 1, before=forget)):
            if found is not None:
                matched.add(row, found)
                H[row], g[row] = found.H, found.g
                distances.append(found.mean_m)
                ratios.append(found.match_ratio)
        if not ratios:
            return IntervalEquations(H, g), float("nan"), 0.0
        return IntervalEquations(H, g), float(np.mean(distances)), float(np.mean(ratios))

    def _placed(self, row: int) -> _PlacedEnds | None:
        """The segments of a multiframe; None if it is lost."""
        if self._lost[row]:
            return None
        frame = self._frames[row]
        segments = sample_segments(frame, self._frames.rig)
        ends = place_segments(segments, frame.t_ns, frame.duration_ns, trajectory=self._trajectory)
        times_s = np.stack([segments.a_s, segments.b_s], axis=1)
        return _PlacedEnds(
            np.ascontiguousarray(ends.reshape(-1, 3)),
            self._place(frame),
            times_s.reshape(-1) / (frame.duration_ns * 1e-9),
        )

    def _place(self, frame: Multiframe) -> Array:
        """Place of the body in the middle of a multiframe [m], (3,)."""
        return self._trajectory.at(np.array([frame.t_mid_ns])).t[0]

    def _match_one(self, planes: PlaneMap, placed: _PlacedEnds | None) -> MatchedFrame | None:
        if placed is None:
            return None
        found = planes.match(
            placed.ends,
            placed.fraction,
            center=placed.seen_from,
            finest=0,
            gate_m=self._tuning.gate_m,
        )
        if found.matches == 0:
            return None
        scale = tuned(OdometryTuning, self._settings.odometry).information_scale
        return MatchedFrame(scale * found.H, scale * found.g, found.mean_m, found.match_ratio)

    def _gap_rows(self) -> int:
        """Number of multiframes within the gap; 0 = a multiframe may match its own points."""
        durations = self._frames.index["duration_ns"]
        rows = int(np.ceil(self._tuning.min_gap_s * 1e9 / max(1, int(durations.min()))))
        return rows if len(self._frames) >= REFINE_RUN.short * rows else 0

    def _in_order(
        self,
        work: Callable[[int], Result],
        stride: int,
        *,
        before: Callable[[range, ThreadPoolExecutor], None] = lambda *_: None,
    ) -> Iterator[Result]:
        """Results of ``work`` for the multiframes in order, a chunk at a time on several threads.

        ``before`` is called with the rows of a chunk and the threads, while none is working.
        """
        rows = range(0, len(self._frames), stride)
        with ThreadPoolExecutor(self._settings.graph.workers) as pool:
            for first in range(0, len(rows), REFINE_RUN.chunk):
                chunk = rows[first : first + REFINE_RUN.chunk]
                before(chunk, pool)
                yield from pool.map(work, chunk)
                self._progress.advance(len(chunk))


class _Absent:
    """Multiframes removed from the map for a while, with their points to add again."""

    def __init__(self, planes: PlaneMap, gap_rows: int, stride: int) -> None:
        self._planes, self._gap_rows, self._stride = planes, gap_rows, stride
        self._placed: dict[int, _PlacedEnds] = {}
        self._next = 0

    def get(self, row: int) -> _PlacedEnds | None:
        """The segments of a multiframe that is removed; None = it is not."""
        return self._placed.get(row)

    def move_to(
        self,
        rows: range,
        placed: Callable[[range], Iterator[_PlacedEnds | None]],
        count: int,
    ) -> None:
        """Remove what is near in time to ``rows`` and add the rest again; rows only increase."""
        if self._gap_rows == 0:
            return
        first, last = rows[0] - self._gap_rows, rows[-1] + self._gap_rows
        for row in [row for row in self._placed if row < first]:
            again = self._placed.pop(row)
            self._planes.add(again.ends, again.seen_from)
        newer = range(self._next, min(last + 1, count), self._stride)
        for row, found in zip(newer, placed(newer), strict=True):
            self._next = row + self._stride
            if found is not None:
                self._planes.remove(found.ends, found.seen_from)
                self._placed[row] = found
        self._planes.fit()


def _knots(frames: FrameStore) -> Times:
    """Starts of all multiframes and the end of the last one [ns], (N + 1,)."""
    index = frames.index
    return np.append(index["t_ns"], index["t_ns"][-1] + index["duration_ns"][-1]).astype(np.int64)
