"""The stage ``classes``: which measured points are of the carrier, move, or are reflected.

A point is compared with other scans of the walk. Where several see through it, it was on something
that has moved on: what moves with the sensors is the carrier, everything else a person or a
vehicle. `docs/explanation/map.md` explains it.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from recon4.classes.carrier import CarrierCubes, CarrierVolume, is_near
from recon4.classes.tuning import SIGHT, SPREAD, VOLUME
from recon4.classes.views import RegularViews, in_body
from recon4.geometry.se3 import Array
from recon4.kernels.free_space import VERDICT
from recon4.kernels.seen_through import RangeViews, find_seen_through, spread_to_neighbors
from recon4.mapping.build import in_order
from recon4.mapping.mirrors import Mirror, Sight
from recon4.mapping.tuning import MAP_BUILD
from recon4.mapping.undistort import place, place_with_origins
from recon4.model.classes import CLASSES, PointClass
from recon4.model.figures import ClassFigures
from recon4.model.frames import RecordedFrames
from recon4.model.multiframe import Multiframe
from recon4.model.trajectory import Trajectory
from recon4.progress import Progress, Silent, track
from recon4.store.classes import ClassWriter


def write_classes(
    frames: RecordedFrames,
    trajectory: Trajectory,
    out: Path,
    *,
    mirrors: Sequence[Mirror] = (),
    progress: Progress | None = None,
) -> ClassFigures:
    """Classify all points of a walk, and write the classes into a folder.

    Memory does not grow with the walk.

    Args:
        frames: The multiframes.
        trajectory: ``T_map_body``, dense.
        out: The stage's folder.
        mirrors: In the map.
        progress: Receives the progress.

    Raises:
        OutOfRange: If the trajectory does not cover the frames.
        StoreError: If the folder cannot be written (`NoSpace` when the disk is full).
    """
    counts = np.zeros(256, np.int64)
    with ClassWriter(out) as writer:
        for classes in classify(frames, trajectory, mirrors=mirrors, progress=progress):
            writer.append(classes)
            counts += np.bincount(classes, minlength=256)
    found = {facts.title: int(counts[k]) for k, facts in CLASSES.items() if counts[k]}
    return ClassFigures(points=int(counts.sum()), classes=found)


def classify(
    frames: RecordedFrames,
    trajectory: Trajectory,
    *,
    mirrors: Sequence[Mirror] = (),
    progress: Progress | None = None,
) -> Iterator[NDArray[np.uint8]]:
    """Classes of the points of each multiframe, (N,).

    Args:
        frames: The multiframes.
        trajectory: ``T_map_body``, dense.
        mirrors: In the map.
        progress: Receives the progress.
    """
    watch = progress or Silent()
    known = _Compared(frames, trajectory, _learn_carrier(frames, trajectory, watch), mirrors)
    views = RegularViews(frames, trajectory)

    def work(given: tuple[Multiframe, RangeViews | None]) -> NDArray[np.uint8]:
        return _classes(*given, known=known)

    # Images of scans are made here, in order, so that the threads only read them.
    given = ((frame := frames[k], views.near(frame.t_mid_ns)) for k in range(len(frames)))
    with ThreadPoolExecutor(MAP_BUILD.workers) as pool:
        made = in_order(pool, work, given)
        yield from track(made, watch, what="classify points", unit="frames", total=len(frames))


def _learn_carrier(
    frames: RecordedFrames, trajectory: Trajectory, progress: Progress
) -> CarrierCubes:
    views, volume = RegularViews(frames, trajectory), CarrierVolume()
    rows = range(0, len(frames), 1 + len(frames) // VOLUME.scans)
    for k in track(rows, progress, what="find the carrier", unit="frames", total=len(rows)):
        frame = frames[k]
        near = frame.take(np.flatnonzero(is_near(in_body(frame.xyz, frame.sensor, frames.rig))))
        p_map = place(near, trajectory, frames.rig)
        p_body = in_body(near.xyz, near.sensor, frames.rig)
        volume.learn(p_body, _verdicts(near, p_map, views.near(frame.t_mid_ns)))
    return volume.filled()


@dataclass(frozen=True, slots=True, eq=False)
class _Compared:
    """What the points of all multiframes are compared with, beside other scans."""

    frames: RecordedFrames
    trajectory: Trajectory
    carrier: CarrierCubes
    mirrors: Sequence[Mirror]


def _classes(frame: Multiframe, views: RangeViews | None, *, known: _Compared) -> NDArray[np.uint8]:
    rig = known.frames.rig
    placed = place_with_origins(frame, known.trajectory, rig)
    p_body = in_body(frame.xyz, frame.sensor, rig)
    verdict = _verdicts(frame, placed.xyz_m, views)
    moving = np.zeros(len(frame), np.bool_)
    count = np.zeros(SPREAD.shape, np.int16)
    spread_to_neighbors(p_body, verdict, SPREAD.cube_m, SPREAD.few, count, moving)
    classes = np.full(len(frame), PointClass.UNCLASSIFIED, np.uint8)
    classes[moving] = PointClass.MOVING
    for mirror in known.mirrors:
        classes[mirror.reflects(Sight(placed.xyz_m, placed.origin_m))] = PointClass.REFLECTION
    classes[known.carrier.of(p_body, verdict)] = PointClass.CARRIER
    return classes


def _verdicts(frame: Multiframe, p_map: Array, views: RangeViews | None) -> NDArray[np.int8]:
    verdict = np.full(len(frame), VERDICT.unknown, np.int8)
    if views is not None:
        find_seen_through(p_map, frame.ring, frame.sensor, views, SIGHT, verdict)
    return verdict
