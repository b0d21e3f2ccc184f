"""Ground, buildings and vegetation on simulated walks, against what each surface really is.

    python -m tests.benchmarks.structure_classes [WORLD ...] [--seed 11] [--work FOLDER]

Points are placed by the true poses. The truth of a point is the kind of the nearest surface of the
world (`recon4.geometry.mesh.SurfaceKind`); of what is ground, upright sides are things and
undersides are buildings. Points farther than 5 cm from every surface do not count.
"""

from __future__ import annotations

import argparse
import tempfile
import time
from collections.abc import Callable
from contextlib import contextmanager
from dataclasses import replace
from pathlib import Path
from unittest.mock import patch

import numpy as np

from recon4.classes.stage import write_classes
from recon4.evaluation.table import text_table
from recon4.geometry.mesh import SurfaceKind
from recon4.mapping import build
from recon4.mapping import tile as tile_module
from recon4.mapping.build import MapInputs, build_map
from recon4.mapping.cell_runs import CellRuns
from recon4.mapping.tiles import TileSet
from recon4.model.classes import PointClass
from recon4.recording.formats.poses import read_tum
from recon4.settings import MapSettings
from recon4.simulation.frames import simulate_frames
from recon4.simulation.lidar import LidarModel
from recon4.simulation.setup import Models, SimulationSetup, prepare
from recon4.store.classes import StoredClasses
from recon4.store.frames import FrameStore

SECONDS = {"office": 20.0, "staircase": 25.0, "street": 20.0, "field": 20.0, "forest": 16.0}
KIND_OF = {
    PointClass.UNCLASSIFIED: SurfaceKind.THING,
    PointClass.GROUND: SurfaceKind.GROUND,
    PointClass.BUILDING: SurfaceKind.BUILDING,
    PointClass.LOW_VEGETATION: SurfaceKind.VEGETATION,
    PointClass.MEDIUM_VEGETATION: SurfaceKind.VEGETATION,
    PointClass.HIGH_VEGETATION: SurfaceKind.VEGETATION,
}
EVERY = 5
"""One of this many points of a map is measured."""


def main() -> None:
    """Make the maps and print a table for each."""
    parser = argparse.ArgumentParser()
    parser.add_argument("worlds", nargs="*", default=list(SECONDS))
    parser.add_argument("--seed", type=int, default=11)
    parser.add_argument("--work", type=Path)
    a = parser.parse_args()
    for name in a.worlds:
        with tempfile.TemporaryDirectory() as folder:
            work = a.work or Path(folder)
            print(f"\n{name}\n{figures(name, work, Path(folder), seed=a.seed)}", flush=True)


def figures(name: str, work: Path, out: Path, *, seed: int) -> str:
    """Recall and precision of each class; the walk is kept in the work folder."""
    models = Models(lidar=replace(LidarModel(), carrier_returns=True))
    setup = prepare(name, seconds=SECONDS[name], seed=seed, models=models)
    folder = work / f"{name}-{seed}"
    if not folder.exists():
        folder.mkdir(parents=True)
        simulate_frames(setup, folder)
    frames, truth = FrameStore.open(folder), read_tum(folder / "truth.tum")
    for part in ("classes", "map"):
        (out / part).mkdir()
    write_classes(frames, truth, out / "classes")
    inputs = MapInputs(frames, truth, classes=StoredClasses.open(out / "classes"))
    with thread_seconds() as spent:
        tiles = build_map(inputs, out / "map", settings=MapSettings())
    ms = 1e3 * sum(spent) / len(frames)
    return f"{table(by_kind(tiles, setup))}\n{ms:.2f} ms of CPU a multiframe"


@contextmanager
def thread_seconds():
    """CPU seconds of the threads in what finds ground, buildings and vegetation, call by call."""
    spent: list[float] = []

    def timed(work: Callable):
        def call(*given, **named):
            began = time.thread_time()
            try:
                return work(*given, **named)
            finally:
                spent.append(time.thread_time() - began)

        return call

    with (
        patch.object(CellRuns, "add", timed(CellRuns.add)),
        patch.object(build, "find_structure", timed(build.find_structure)),
        patch.object(tile_module, "mark_structure", timed(tile_module.mark_structure)),
    ):
        yield spent


def by_kind(tiles: TileSet, setup: SimulationSetup) -> np.ndarray:
    """How many points of each kind (rows) have a class of each kind (columns), (4, 4)."""
    scene, mesh = setup.surroundings.scene, setup.world.mesh
    counts = np.zeros((len(SurfaceKind), len(SurfaceKind)), np.int64)
    kinds = np.array([KIND_OF.get(code, SurfaceKind.THING) for code in range(256)])
    for tile in tiles:
        columns = tile.read(["xyz", "classification", "normal"])
        p_map = (columns["xyz"].astype(np.float64) + tile.origin_m)[::EVERY]
        kind = mesh.kind[scene.nearest_triangle(p_map)].copy()
        up = columns["normal"][::EVERY, 2]
        bare = kind == SurfaceKind.GROUND
        kind[bare & (np.abs(up) < 0.5)] = SurfaceKind.THING
        kind[bare & (up <= -0.5)] = SurfaceKind.BUILDING
        near = scene.distance(p_map) < 0.05
        np.add.at(counts, (kind[near], kinds[columns["classification"][::EVERY]][near]), 1)
    return counts


def table(counts: np.ndarray) -> str:
    """Points of each kind, and the recall and precision of its classes."""
    rows = []
    for kind in SurfaceKind:
        right, of_kind, given = counts[kind, kind], counts[kind].sum(), counts[:, kind].sum()
        shown = [f"{100 * right / n:.1f}" if n else "" for n in (of_kind, given)]
        rows.append((kind.name.lower(), f"{EVERY * of_kind}", *shown, *map(str, counts[kind])))
    given = tuple(f"as {kind.name.lower()}" for kind in SurfaceKind)
    return text_table(("kind", "points", "recall %", "precision %", *given), rows)


if __name__ == "__main__":
    main()
