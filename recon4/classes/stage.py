"""The stage ``classes``: which measured points are of the carrier, move, or are reflected.

A point is compared with other scans of the walk. Where several see through it, it was on something
that has moved on: what moves with the sensors is the carrier, everything else a person or a
vehicle. `docs/explanation/map.md` explains it.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass
from functools import partial
from itertools import chain, pairwise
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from recon4.classes.carrier import CarrierCubes, CarrierVolume, near_points
from recon4.classes.class_parts import ClassedWalk, Classes, OrderedClasses, save_classes
from recon4.classes.tuning import (
    KNOWN_PLACES,
    PARTED,
    SIGHT,
    SPREAD,
    THINGS,
    TOUCHING,
    VIEWS,
    VOLUME,
)
from recon4.classes.views import RegularViews
from recon4.errors import StoreError
from recon4.geometry.se3 import Array
from recon4.kernels.free_space import VERDICT
from recon4.kernels.seen_through import EVIDENCE, RangeViews, find_seen_through
from recon4.kernels.things import Cubes, JudgedPoints, move_as_things, spread_to_neighbors
from recon4.mapping.mirrors import Mirror, Sight, load_mirrors, reflections
from recon4.mapping.threads import in_order
from recon4.mapping.tuning import MAP_BUILD
from recon4.mapping.undistort import place, place_with_origins
from recon4.model.classes import CLASSES, PointClass
from recon4.model.figures import ClassFigures
from recon4.model.frames import RecordedFrames
from recon4.model.multiframe import Multiframe
from recon4.model.trajectory import Times, Trajectory
from recon4.progress import Progress, Silent, track
from recon4.store.arrays import load_trajectory
from recon4.store.classes import ClassWriter


def write_classes(found: Iterable[NDArray[np.uint8]], out: Path) -> ClassFigures:
    """Write the classes of a walk into a folder.

    Memory does not grow with the walk.

    Args:
        found: Of each multiframe, as `classify` finds them.
        out: The stage's folder.

    Raises:
        StoreError: If the folder cannot be written (`NoSpace` when the disk is full).
    """
    counts = np.zeros(256, np.int64)
    with ClassWriter(out) as writer:
        for classes in found:
            writer.append(classes)
            counts += np.bincount(classes, minlength=256)
    shares = {facts.title: int(counts[k]) for k, facts in CLASSES.items() if counts[k]}
    return ClassFigures(points=int(counts.sum()), classes=shares)


def classify(
    frames: RecordedFrames,
    trajectory: Trajectory,
    *,
    mirrors: Sequence[Mirror] = (),
    progress: Progress | None = None,
    ordered: OrderedClasses | None = None,
) -> Iterator[NDArray[np.uint8]]:
    """Classes of the points of each multiframe, (N,).

    Args:
        frames: The multiframes.
        trajectory: ``T_map_body``, dense.
        mirrors: In the map.
        progress: Receives the progress.
        ordered: Workers that classify; None = threads of this process.

    Raises:
        OutOfRange: If the trajectory does not cover the frames.
    """
    watch = progress or Silent()
    carrier = _learn_carrier(frames, trajectory, mirrors, progress=watch)
    known = _Compared(frames, trajectory, carrier, mirrors)
    if ordered is None:
        found = _by_threads(known)
    else:
        here = partial(
            _of_part, known=known, views=RegularViews(frames, trajectory, mirrors=mirrors)
        )
        found = ordered.found(_parts(frames), carrier, here=here, progress=watch)
    made = chain.from_iterable(found)
    yield from track(made, watch, what="classify points", unit="frames", total=len(frames))


def _by_threads(known: _Compared) -> Iterator[Classes]:
    """Classes of the multiframes of each span."""
    frames = known.frames
    views = RegularViews(frames, known.trajectory, mirrors=known.mirrors)
    # Images of scans are made here, in order, so that the threads only read them.
    with ThreadPoolExecutor(MAP_BUILD.workers) as pool:
        yield from in_order(pool, known.classes, _compared_spans(frames, views))


def _parts(frames: RecordedFrames) -> list[range]:
    """Multiframes of whole spans that a worker classifies at once."""
    starts = [int(rows[0]) for rows in _spans(frames)[:: VIEWS.part_ns // VIEWS.span_ns]]
    return [range(*ends) for ends in pairwise([*starts, len(frames)])]


@dataclass(frozen=True, slots=True, eq=False)
class ClassMaker:
    """Classifies parts of a walk on a worker."""

    known: _Compared
    views: RegularViews
    folder: Path
    """Receives the classes."""

    @staticmethod
    def open(folder: Path) -> ClassMaker:
        """Read what all parts have in common.

        Raises:
            StoreError: If a file is missing or damaged.
        """
        walk, carrier = ClassedWalk.load(folder)
        level = Path(walk.level)
        trajectory = load_trajectory(level / "trajectory.npz")
        mirrors = load_mirrors(level / "mirrors.npz")
        frames = walk.folders.open()
        known = _Compared(frames, trajectory, carrier, mirrors)
        return ClassMaker(known, RegularViews(frames, trajectory, mirrors=mirrors), folder)

    def make(self, numbers: tuple[int, ...]) -> None:
        """Classify a part and leave its classes in the folder, whole or not at all.

        Args:
            numbers: The first multiframe and the one after the last.

        Raises:
            StoreError: If there are none such, or they cannot be written.
        """
        rows = range(*numbers)
        if not (rows and rows[0] >= 0 and rows[-1] < len(self.known.frames)):
            raise StoreError(f"expected rows of {len(self.known.frames)} multiframes, got {rows}")
        save_classes(self.folder, rows, _of_part(rows, self.known, self.views))


def _of_part(rows: range, known: _Compared, views: RegularViews) -> Classes:
    """Classes of consecutive multiframes of whole spans."""
    t_ns = known.frames.t_mid_ns
    spans = [span for span in _spans(known.frames) if rows.start <= span[0] < rows.stop]
    near = ((span, views.near(_middle_ns(t_ns[span]))) for span in spans)
    return [one for given in near for one in known.classes(given)]


def _compared_spans(
    frames: RecordedFrames, views: RegularViews
) -> Iterator[tuple[NDArray[np.intp], RangeViews | None]]:
    """Rows of each span with the scans that they are compared with, which stay as they are until
    the spans of all threads are done.
    """
    before_ns: int | None = None
    for rows in _spans(frames):
        t_ns = _middle_ns(frames.t_mid_ns[rows])
        # Each thread has a span in work; of steps this short all fit into what is kept.
        if before_ns is not None and t_ns - before_ns > VIEWS.kept_ns // MAP_BUILD.workers:
            views.renew()
        yield rows, views.near(t_ns)
        before_ns = t_ns


def _spans(frames: RecordedFrames) -> list[NDArray[np.intp]]:
    """Rows of the multiframes that are compared with the same scans: what these say of a place."""
    span = (frames.t_mid_ns - frames.t_mid_ns[:1]) // VIEWS.span_ns
    return np.split(np.arange(len(span)), np.flatnonzero(np.diff(span)) + 1) if len(span) else []


def _middle_ns(t_ns: Times) -> int:
    return int(t_ns[0] + t_ns[-1]) // 2


def _learn_carrier(
    frames: RecordedFrames,
    trajectory: Trajectory,
    mirrors: Sequence[Mirror],
    *,
    progress: Progress,
) -> CarrierCubes:
    every_ns = VOLUME.views_every_ns
    views = RegularViews(frames, trajectory, mirrors=mirrors, every_ns=every_ns)
    volume, rig = CarrierVolume(), frames.rig
    scans = range(0, len(frames), 1 + len(frames) // VOLUME.scans)
    for k in track(scans, progress, what="find the carrier", unit="frames", total=len(scans)):
        frame = frames[k]
        rows, p_body = near_points(frame, rig)
        near = frame.take(rows)
        p_map = place(near, trajectory, rig)
        others = views.near(frame.t_mid_ns)
        verdict = _verdicts(near, p_map, KnownPlaces(others), of=trajectory)
        volume.learn(p_body, verdict)
    return volume.filled()


@dataclass(frozen=True, slots=True, eq=False)
class _Compared:
    """What the points of all multiframes are compared with, beside other scans."""

    frames: RecordedFrames
    trajectory: Trajectory
    carrier: CarrierCubes
    mirrors: Sequence[Mirror]

    def classes(self, given: tuple[NDArray[np.intp], RangeViews | None]) -> Classes:
        """Classes of the multiframes of a span, compared with some scans."""
        rows, others = given
        places = KnownPlaces(others)
        return [_classes(self.frames[k], places, known=self) for k in rows.tolist()]


class KnownPlaces:
    """What scans say of places, as it is found out."""

    def __init__(self, views: RangeViews | None = None) -> None:
        self.views = views
        self.held = np.zeros(1 << KNOWN_PLACES.bits, np.int64)
        moving, met = np.empty((2, *KNOWN_PLACES.cubes), np.int32)
        low_m, floor_m = np.empty((2, *KNOWN_PLACES.cubes[:2]), np.float32)
        self.cubes = Cubes(moving, met, low_m, floor_m, np.empty(low_m.shape, np.bool_))


def _classes(frame: Multiframe, places: KnownPlaces, *, known: _Compared) -> NDArray[np.uint8]:
    rig, trajectory = known.frames.rig, known.trajectory
    placed = place_with_origins(frame, trajectory, rig)
    classes = np.full(len(frame), PointClass.UNCLASSIFIED, np.uint8)
    reflected = reflections(known.mirrors, Sight(placed.xyz_m, placed.origin_m))
    classes[reflected] = PointClass.REFLECTION
    near, p_body = near_points(frame, rig)
    classes[near[known.carrier.surely(p_body)]] = PointClass.CARRIER
    others = classes == PointClass.UNCLASSIFIED
    verdict = _verdicts(frame, placed.xyz_m, places, of=trajectory, things=others)
    classes[others & (verdict == VERDICT.seen_through)] = PointClass.MOVING
    classes[near[known.carrier.of(p_body, verdict[near])]] = PointClass.CARRIER
    return classes


def _verdicts(
    frame: Multiframe,
    p_map: Array,
    places: KnownPlaces,
    *,
    of: Trajectory,
    things: NDArray[np.bool_] | None = None,
) -> NDArray[np.int8]:
    """What other scans say of points; ``things``: which points may be of a thing that moves."""
    verdict = np.full(len(frame), VERDICT.unknown, np.int8)
    if places.views is None:
        return verdict
    evidence, cubes = np.empty(len(frame), np.int8), places.cubes
    find_seen_through(p_map, frame.sensor, places.views, SIGHT, places.held, evidence)
    body_m = of.at(np.array([frame.t_mid_ns]), slack_ns=frame.duration_ns).t[0]
    points = JudgedPoints(p_map, evidence, verdict)
    spread_to_neighbors(points, body_m, SPREAD, cubes)
    if things is not None:
        move_as_things(points, things, body_m, THINGS, cubes)
        # A bus that stands close to a front is one thing with the house, but for what is met there.
        seen_through = (evidence >= EVIDENCE.doubted) & (evidence != EVIDENCE.unknown)
        move_as_things(points, things & seen_through, body_m, PARTED, cubes)
        unmet = things & (evidence > EVIDENCE.doubted)
        move_as_things(points, unmet, body_m, TOUCHING, cubes)
    return verdict
