"""Fitted surfaces beside raw points, against the truth: the figures of `docs/explanation/map.md`.

    python -m tests.benchmarks.surfaces [SCENE ...] [--seconds S] [--seeds 11 12] [--once]

SCENE is a world of ``recon4 simulate``, or ``exhibition`` (edges, thin things, partitions) or
``double`` (the same with the second half of the walk off by 3, 5 and 8 cm). Points are placed by
the true poses, so the figures are those of the stage `map` alone. Each map is built twice: the
bytes must be the same, and the second time is the one that counts; with ``--once`` only once.
"""

from __future__ import annotations

import argparse
import shutil
import tempfile
import threading
import time
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np

from recon4.evaluation.table import text_table
from recon4.export.laz import export_laz
from recon4.geometry.se3 import SE3
from recon4.mapping.build import MapInputs, build_map
from recon4.mapping.tiles import TileSet
from recon4.model.trajectory import Trajectory
from recon4.recording.formats.poses import read_tum
from recon4.settings import MapSettings
from recon4.simulation.frames import simulate_frames
from recon4.simulation.lidar import LidarModel
from recon4.simulation.setup import Models, prepare
from recon4.slices.doubles import find_double_walls
from recon4.store.frames import FrameStore
from tests.benchmarks.surface_figures import (
    coverage,
    digest,
    edge_figures,
    error_to_truth,
    rod_figures,
    triangles_of,
)
from tests.benchmarks.surface_scene import DIAMETERS_M, Exhibition, build

SCENES = ("office", "staircase", "exhibition", "double", "street", "field")
APART_M = (0.03, 0.05, 0.08)
SURFACES = ("raw", "fitted")


@dataclass(frozen=True, slots=True, eq=False)
class BuiltMap:
    """A map with what it cost."""

    tiles: TileSet
    cpu_s: float
    peak_bytes: int
    """Largest anonymous memory beyond that before the stage."""
    same_bytes: bool
    folder: Path


class PeakMemory:
    """Samples the anonymous memory of this process in a thread of its own."""

    def __init__(self) -> None:
        self._stop = threading.Event()
        self._thread = threading.Thread(target=self._sample, daemon=True)
        self.before = self.peak = anonymous_bytes()

    def __enter__(self) -> PeakMemory:
        self._thread.start()
        return self

    def __exit__(self, *_: object) -> None:
        self._stop.set()
        self._thread.join()

    def _sample(self) -> None:
        while not self._stop.wait(0.01):
            self.peak = max(self.peak, anonymous_bytes())


def anonymous_bytes() -> int:
    """Anonymous memory of this process."""
    status = Path("/proc/self/status").read_text()
    line = next(row for row in status.splitlines() if row.startswith("RssAnon"))
    return 1024 * int(line.split()[1])


def main() -> None:
    """Run the scenes and print their tables."""
    parser = argparse.ArgumentParser()
    parser.add_argument("scenes", nargs="*", default=SCENES)
    parser.add_argument("--seconds", type=float, default=30.0)
    parser.add_argument("--seeds", type=int, nargs="+", default=[11])
    parser.add_argument("--work", type=Path)
    parser.add_argument("--once", action="store_true")
    a = parser.parse_args()
    with tempfile.TemporaryDirectory() as folder:
        work = a.work or Path(folder)
        for scene in a.scenes:
            for seed in a.seeds:
                frames = recorded(scene, a.seconds, seed, work)
                times = 1 if a.once else 2
                if scene == "double":
                    double_walls(frames, work, times=times)
                    continue
                perfect = recorded(scene, a.seconds, seed, work, perfect=True)
                against_truth(frames, perfect, work, times=times)


def recorded(scene: str, seconds: float, seed: int, work: Path, *, perfect: bool = False) -> Path:
    """Multiframes of a walk; kept in the folder for the next run. Perfect = of perfect LiDARs."""
    custom = scene in {"exhibition", "double"}
    name = "exhibition" if custom else scene
    folder = work / f"{name}-{seconds:g}-{seed}{'-perfect' if perfect else ''}"
    if not folder.exists():
        folder.mkdir(parents=True)
        models = Models(lidar=LidarModel.perfect()) if perfect else None
        world = build().world if custom else scene
        setup = prepare(world, seconds=seconds, seed=seed, models=models)
        simulate_frames(setup, folder)
    return folder


def built(
    frames: Path, trajectory: Trajectory, work: Path, *, surface: str, times: int
) -> BuiltMap:
    """Build a map once or twice."""
    settings = replace(MapSettings(), surface=surface)
    store = FrameStore.open(frames)
    digests = []
    for k in range(times):
        out = work / f"map-{surface}-{k}"
        shutil.rmtree(out, ignore_errors=True)
        out.mkdir(parents=True)
        with PeakMemory() as memory:
            begun = time.process_time()
            tiles = build_map(MapInputs(store, trajectory), out, settings=settings)
            cpu_s = time.process_time() - begun
        digests.append(digest(out))
    same = len(digests) > 1 and digests[0] == digests[1]
    return BuiltMap(tiles, cpu_s, memory.peak - memory.before, same, out)


def against_truth(frames: Path, perfect: Path, work: Path, *, times: int) -> None:
    """Print the figures of a scene; a walk with perfect LiDARs says what could be seen."""
    scene = frames.name.partition("-")[0]
    truth = read_tum(frames / "truth.tum")
    world = prepare(build().world if scene == "exhibition" else scene, seconds=5.0, seed=0).world
    mesh = triangles_of(world.mesh)
    maps = {name: built(frames, truth, work, surface=name, times=times) for name in SURFACES}
    (work / "perfect").mkdir(exist_ok=True)
    seen = built(perfect, truth, work / "perfect", surface="raw", times=1).tiles
    covered = coverage([made.tiles for made in maps.values()], seen, mesh)
    rows = []
    for (name, made), share in zip(maps.items(), covered, strict=True):
        error = error_to_truth((tile.xyz_m() for tile in made.tiles), mesh)
        laz = work / "map.laz"
        export_laz(made.folder, laz)
        rows.append(
            (
                name,
                f"{len(made.tiles) / 1e6:.2f} M",
                f"{100 * error.mean_m:.3f}",
                f"{100 * error.median_m:.3f}",
                f"{100 * error.within_2cm:.2f}",
                f"{100 * error.far:.3f}",
                f"{100 * share.measured:.2f}",
                f"{100 * share.seen:.2f}",
                f"{100 * share.met:.2f}",
                f"{100 * made.tiles.strays / max(1, len(made.tiles)):.2f}",
                f"{made.cpu_s / maps['raw'].cpu_s:.2f}",
                f"{made.peak_bytes / maps['raw'].peak_bytes:.2f}",
                f"{laz.stat().st_size / 1e6:.1f}",
                "yes" if made.same_bytes else "NO" if times > 1 else "",
            )
        )
    head = ("", "points", "mean cm", "median", "< 2 cm %", "far %", "covered %", "of seen %",
            "of met %", "strays %", "CPU", "memory", "LAZ MB", "same bytes")  # fmt: skip
    print(f"\n{frames.name}\n{text_table(head, rows)}", flush=True)
    if scene == "exhibition":
        _print_exhibition(build(), maps)


def _print_exhibition(scene: Exhibition, maps: dict[str, BuiltMap]) -> None:
    mesh = triangles_of(scene.world.mesh)
    rows = []
    for kind in ("corner", "reveal", "cabinet", "table"):
        for name, made in maps.items():
            f = edge_figures(made.tiles, scene, mesh, kind=kind)
            rows.append((kind, name, str(f.pieces), *(f"{1000 * value:.1f}" for value in (
                f.median_m, f.p95_m, f.near_mean_m, f.near_p95_m))))  # fmt: skip
    head = ("edges", "", "pieces", "displaced mm: median", "p95", "points near: mean mm", "p95")
    print(f"\n{text_table(head, rows)}")
    rows = []
    for diameter_m in DIAMETERS_M:
        for name, made in maps.items():
            r = rod_figures(made.tiles, scene.rods, diameter_m)
            rows.append((f"{100 * diameter_m:g} cm", name, str(r.measured),
                         f"{100 * r.kept:.2f}", f"{100 * r.points_kept:.1f}"))  # fmt: skip
    head = ("rods", "", "pieces of 3 cm", "kept %", "points kept %")
    print(f"\n{text_table(head, rows)}", flush=True)


def double_walls(frames: Path, work: Path, *, times: int) -> None:
    """The second half of the walk is off; print the double walls found in both maps."""
    truth = read_tum(frames / "truth.tum")
    rows = []
    for apart_m in (0.0, *APART_M):
        late = (truth.t_ns > truth.t_ns[len(truth) // 2])[:, None]
        t = truth.T_a_b.t + late * apart_m * np.array([1.0, 1.0, 0.0])
        moved = Trajectory(truth.t_ns, SE3(truth.T_a_b.R, t))
        for name in SURFACES:
            tiles = built(frames, moved, work, surface=name, times=times).tiles
            report = find_double_walls(tiles)
            between = f"{100 * two_sheets(tiles, apart_m):.1f}"
            counts = str(len(report.walls)), str(report.patches)
            rows.append((f"{100 * apart_m:g} cm", name, *counts, between))
    head = ("apart", "", "double walls", "patches compared", "points between the sheets %")
    print(f"\n{frames.name}, second half moved\n{text_table(head, rows)}", flush=True)


def two_sheets(tiles: TileSet, apart_m: float) -> float:
    """Ratio of the returns at the western wall that lie in the middle third between its sheets."""
    p = np.concatenate([tile.xyz_m() for tile in tiles])
    wall = (p[:, 1] > 1.5) & (p[:, 1] < 6.0) & (p[:, 2] > 0.3) & (p[:, 2] < 2.5)
    x = p[wall & (np.abs(p[:, 0] - 0.5 * apart_m) < 0.5 * apart_m + 0.03), 0]
    return float((np.abs(x - 0.5 * apart_m) < apart_m / 6.0).mean()) if len(x) else float("nan")


if __name__ == "__main__":
    main()
