"""The stage ``intensity``: learn the table from samples of the walk, with diagnostics."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from recon4.geometry.se3 import Array
from recon4.intensity.diagnostics import Diagnostics, diagnose
from recon4.intensity.surfaces import Observations, cells_of, learn_surfaces
from recon4.intensity.table import table_of_sums, table_of_surfaces
from recon4.intensity.tuning import SAMPLING, IntensityTuning
from recon4.kernels.intensity import accumulate, bins_of
from recon4.kernels.voxels import face_sensor
from recon4.mapping.normals import local_normals
from recon4.mapping.undistort import place_with_origins
from recon4.model.frames import Frames
from recon4.model.intensity_table import IntensityTable
from recon4.model.trajectory import Trajectory
from recon4.progress import Progress, Silent, track
from recon4.store.arrays import save_intensity_table


@dataclass(frozen=True, slots=True, eq=False)
class IntensitySample:
    """Points with the quantities that their intensity depends on."""

    intensity: NDArray[np.uint16]
    sensor: NDArray[np.uint8]
    ring: NDArray[np.uint8]
    incidence_rad: NDArray[np.float32]
    """NaN without a normal, (N,)."""
    range_m: NDArray[np.float32]
    cell: NDArray[np.int64]
    """Cube of the map, `recon4.intensity.surfaces.cells_of`, (N,)."""


def learn_intensity(
    frames: Frames,
    trajectory: Trajectory,
    *,
    settings: IntensityTuning,
    progress: Progress | None = None,
) -> tuple[IntensityTable, Diagnostics]:
    """Learn the table of a walk and compute its diagnostics.

    Some windows of ten seconds are sampled, ten multiframes each; normals are computed from all
    points of a window. Memory depends on the window and ``settings.surface_points``.

    Args:
        frames: The points in the frames of their sensors.
        trajectory: ``T_map_body``, dense.
        settings: Bins and number of samples.
        progress: Receives the progress.

    Raises:
        ConfigError: If there are no points to learn from.
        OutOfRange: If the trajectory does not cover the frames.
    """
    progress = progress or Silent()
    windows = sample_windows(len(frames), settings.windows)
    shape = _shape(frames, windows, settings)
    few = settings.surface_points / max(1, sum(map(len, windows)))
    learned, held_out = (_SampleAccumulator(shape, few, settings) for _ in range(2))
    for window in track(windows, progress, what="learn intensities", unit="windows"):
        samples = _sample(frames, trajectory, window, settings=settings)
        for k, sample in enumerate(samples):
            (held_out if k % SAMPLING.held_out == SAMPLING.held_out - 1 else learned).add(sample)
    seen = learned.observations()
    surfaces = learn_surfaces(seen, shape, settings=settings)
    largest = max(learned.largest, held_out.largest)
    if settings.method == "surfaces":
        total = learned.sums.sum(axis=(0, 1, 2, 3))
        table = table_of_surfaces(surfaces, total, settings=settings, largest=largest)
    else:
        table = table_of_sums(learned.sums, settings=settings, largest=largest)
    shown = held_out if held_out.sums[..., 0].any() else learned
    return table, diagnose(table, shown.sums, surfaces, seen=shown.observations())


def write_intensity(
    frames: Frames,
    trajectory: Trajectory,
    out: Path,
    *,
    settings: IntensityTuning,
    progress: Progress | None = None,
) -> None:
    """Run the stage ``intensity``: write ``table.npz`` and ``diagnostics.npz``."""
    table, diagnostics = learn_intensity(frames, trajectory, settings=settings, progress=progress)
    save_intensity_table(out / "table.npz", table)
    diagnostics.save(out / "diagnostics.npz")


def add_sample(sums: Array, sample: IntensitySample, settings: IntensityTuning) -> None:
    """Add points to the sums of their bins, ``(S, B, I, R, 3)``, in place."""
    channel = sample.sensor.astype(np.int64) * sums.shape[1] + sample.ring
    accumulate(
        sample.intensity,
        channel,
        sample.incidence_rad,
        sample.range_m,
        float(np.deg2rad(settings.incidence_bin_deg)),
        settings.range_bin_m,
        sums.reshape(-1, *sums.shape[2:]),
    )


def sample_windows(frames: int, windows: int) -> list[list[int]]:
    """Rows of the sampled multiframes, window by window, spread evenly over the walk."""
    stride = max(1, min(SAMPLING.stride, frames // SAMPLING.samples))
    length = stride * SAMPLING.samples
    count = min(windows, -(-frames // length))
    starts = np.linspace(0, max(0, frames - length), count).astype(int)
    return [list(range(start, min(start + length, frames), stride)) for start in starts]


def _shape(
    frames: Frames, windows: list[list[int]], settings: IntensityTuning
) -> tuple[int, int, int, int]:
    """Sensors, beams, bins of incidence (last: no normal), bins of range."""
    beams = (int(frames[k].ring.max(initial=0)) for window in windows for k in window)
    incidences = int(np.ceil(90.0 / settings.incidence_bin_deg)) + 1
    ranges = int(np.ceil(settings.max_range_m / settings.range_bin_m))
    return len(frames.rig.sensors), 1 + max(beams, default=0), incidences, ranges


class _SampleAccumulator:
    """Sums over samples, and about ``few`` points of each sample."""

    def __init__(
        self, shape: tuple[int, int, int, int], few: float, settings: IntensityTuning
    ) -> None:
        self._few, self._settings = few, settings
        self._rng = np.random.default_rng(0)
        self._seen: list[Observations] = []
        self.sums = np.zeros((*shape, 3))
        self.largest = 0.0

    def add(self, sample: IntensitySample) -> None:
        """Add the points of a multiframe."""
        add_sample(self.sums, sample, self._settings)
        self.largest = max(self.largest, float(sample.intensity.max(initial=0)))
        rows = np.flatnonzero(self._rng.random(len(sample.cell)) * len(sample.cell) < self._few)
        self._seen.append(self._observations(sample, rows))

    def _observations(self, sample: IntensitySample, rows: NDArray[np.intp]) -> Observations:
        """Some points, sorted into bins."""
        sensors, rings, incidences, ranges, _ = self.sums.shape
        bins = np.empty((len(rows), 3), np.int32)
        bins_of(
            sample.sensor[rows].astype(np.int64) * rings + sample.ring[rows],
            sample.incidence_rad[rows],
            sample.range_m[rows],
            float(np.deg2rad(self._settings.incidence_bin_deg)),
            self._settings.range_bin_m,
            (sensors * rings, incidences, ranges),
            bins,
        )
        return Observations(sample.cell[rows], bins, sample.intensity[rows].astype(np.float32))

    def observations(self) -> Observations:
        """Some points of all multiframes; the same ones in every run."""
        return Observations.joined(self._seen)


def _sample(
    frames: Frames, trajectory: Trajectory, rows: list[int], *, settings: IntensityTuning
) -> Iterator[IntensitySample]:
    """The samples of one window, with normals from all of its points."""
    enabled = np.array([sensor.enabled for sensor in frames.rig.sensors])
    kept = [f.take(np.flatnonzero(enabled[f.sensor])) for f in map(frames.__getitem__, rows)]
    placed = [place_with_origins(frame, trajectory, frames.rig) for frame in kept]
    if not any(map(len, kept)):
        return
    xyz = np.concatenate([p.xyz_m for p in placed])
    normals = local_normals((xyz - xyz[0]).astype(np.float32), settings.normal_cell_m).normal
    ends = np.cumsum([len(frame) for frame in kept])
    for frame, place, normal in zip(kept, placed, np.split(normals, ends[:-1]), strict=True):
        range_m, incidence = np.empty((2, len(frame)), np.float32)
        to_sensor = (place.origin_m - place.xyz_m).astype(np.float32)
        face_sensor(np.ascontiguousarray(normal), to_sensor, range_m, incidence)
        cell = cells_of(place.xyz_m, settings.surface_cell_m)
        yield IntensitySample(frame.intensity, frame.sensor, frame.ring, incidence, range_m, cell)
