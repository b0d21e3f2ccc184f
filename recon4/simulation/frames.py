"""A simulated walk written straight into a frame store, without packets: for tests and studies."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from recon4.model.multiframe import COLUMNS, Multiframe
from recon4.model.rig import Rig
from recon4.model.samples import GnssSamples, ImuSamples
from recon4.progress import Progress, Silent
from recon4.recording.formats.poses import write_tum
from recon4.simulation.lidar import Firings, Lidar
from recon4.simulation.setup import SimulationSetup, gnss_samples, imu_samples
from recon4.simulation.truth import true_trajectory
from recon4.store.frames import FrameWriter
from recon4.units import SECOND_NS

FRAME_NS = SECOND_NS // 10
_CHUNK_FRAMES = SECOND_NS // FRAME_NS
Columns = dict[str, NDArray[Any]]


def simulate_frames(
    setup: SimulationSetup, folder: Path, *, progress: Progress | None = None
) -> None:
    """Write a frame store with ``imu.npz``, and ``truth.tum`` beside its columns.

    The points are what an ideal decoder makes of the packets: azimuths are not rounded.

    Raises:
        StoreError: If the folder cannot be written.
    """
    watch = progress or Silent()
    imu, gnss = imu_samples(setup), gnss_samples(setup)
    with FrameWriter(folder, setup.rig) as writer:
        watch.start("simulate", int(setup.walk.seconds), "s")
        for chunk in _chunks(setup):
            for frame in chunk:
                writer.append(frame)
            watch.advance()
        imu, gnss = _on_rig_clock(imu, gnss, setup.rig)
        writer.add(imu=imu, gnss=gnss, report={"derived": [], "counts": {"points": writer.points}})
    write_tum(folder / "truth.tum", true_trajectory(setup.walk, epoch_ns=setup.epoch_ns))


def _on_rig_clock(
    imu: ImuSamples, gnss: GnssSamples | None, rig: Rig
) -> tuple[ImuSamples, GnssSamples | None]:
    """Samples of a frame store are on the rig's clock, as ingest writes them."""
    imu = replace(imu, t_ns=imu.t_ns + round(1e9 * rig.imu_time_offset_s))
    if gnss is not None:
        gnss = replace(gnss, t_ns=gnss.t_ns + round(1e9 * rig.gnss_time_offset_s))
    return imu, gnss


def _chunks(setup: SimulationSetup) -> Iterator[list[Multiframe]]:
    """Multiframes of one second each; the last incomplete frame is left out."""
    frames = int(setup.walk.seconds * 1e9) // FRAME_NS
    fired = [0] * len(setup.lidars)
    waiting: list[Columns] = [{} for _ in setup.lidars]
    for first in range(0, frames, _CHUNK_FRAMES):
        last = min(first + _CHUNK_FRAMES, frames)
        for row, lidar in enumerate(setup.lidars):
            until = lidar.packets_before(last * FRAME_NS) + 1
            rng = setup.rng(3, row, first)
            shots = lidar.fire(range(fired[row], until), setup.walk, setup.surroundings, rng=rng)
            fired[row] = until
            waiting[row] = _joined(waiting[row], _points(lidar, shots, row))
        yield [_frame(k, waiting, setup.epoch_ns) for k in range(first, last)]
        for row, columns in enumerate(waiting):
            late = columns["t_ns"] >= last * FRAME_NS
            waiting[row] = {name: column[late] for name, column in columns.items()}


def _points(lidar: Lidar, shots: Firings, row: int) -> Columns:
    """Returns of one sensor in its own frame, in firing order."""
    hit = shots.distance > 0
    xyz = lidar.points(shots)[hit]
    return {
        "t_ns": shots.t_ns[hit],
        "xyz": xyz.astype(np.float32),
        "intensity": shots.intensity[hit].astype(np.uint16),
        "ring": np.broadcast_to(lidar.pattern.ring, hit.shape)[hit],
        "sensor": np.full(len(xyz), row, dtype=np.uint8),
        "echo": np.zeros(len(xyz), dtype=np.uint8),
    }


def _joined(a: Columns, b: Columns) -> Columns:
    return {name: np.concatenate([a[name], b[name]]) for name in b} if a else b


def _frame(k: int, waiting: list[Columns], epoch_ns: int) -> Multiframe:
    parts: list[Columns] = []
    for columns in waiting:
        start, stop = np.searchsorted(columns["t_ns"], [k * FRAME_NS, (k + 1) * FRAME_NS])
        part = {name: column[start:stop] for name, column in columns.items()}
        part["dt_ns"] = (part["t_ns"] - k * FRAME_NS).astype(np.int32)
        parts.append(part)
    merged = {name: np.concatenate([part[name] for part in parts]) for name in COLUMNS}
    return Multiframe(k, epoch_ns + k * FRAME_NS, FRAME_NS, **merged)
