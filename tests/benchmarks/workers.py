"""The stage ``map`` by threads and by workers of Dask: processor time, bytes and overhead.

    python -m tests.benchmarks.workers PROJECT OUT [FRAMES [WORKERS…]]

Processor times of this process, its workers and their makers; they hold on a busy computer, too.
"""

from __future__ import annotations

import json
import os
import resource
import shutil
import sys
import time
from contextlib import nullcontext
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import psutil

from recon4.executors.cluster import Cluster, workers_here
from recon4.executors.executor import Say
from recon4.mapping.build import MapInputs, MapMeans, build_map
from recon4.model.rig import Rig
from recon4.orders.on_worker import PartTask, make_part
from recon4.settings import MapSettings
from recon4.store.arrays import load_intensity_table, load_trajectory
from recon4.store.classes import StoredClasses
from recon4.store.frames import open_frames
from recon4.store.project import read_artifacts
from tests.ordered_maps import DirectWorkers, bytes_of


@dataclass(frozen=True)
class First:
    """The first multiframes of a store."""

    store: Any
    count: int

    def __len__(self) -> int:
        return min(self.count, len(self.store))

    def __getitem__(self, k: int) -> Any:
        return self.store[k]

    @property
    def rig(self) -> Rig:
        """Of the store."""
        return self.store.rig


def cpu_s() -> tuple[float, float]:
    """Processor time of this process, and of all that it has waited for [s]."""
    own, others = (
        resource.getrusage(who) for who in (resource.RUSAGE_SELF, resource.RUSAGE_CHILDREN)
    )
    return own.ru_utime + own.ru_stime, others.ru_utime + others.ru_stime


@dataclass(frozen=True)
class Timed:
    """An executor that notes the processor time of makers."""

    cluster: Cluster

    def run(self, function: Any, tasks: Any, say: Any) -> Any:
        """As `Executor.run`."""
        return self.cluster.run(timed_part, tasks, say)


def timed_part(task: PartTask, say: Say) -> str:
    """Make a part; the time of the makers of this worker so far is in a file."""
    failure = make_part(task, say)
    times = [child.cpu_times() for child in psutil.Process().children()]
    path = Path(task.project) / f"cpu-{os.getpid()}"
    path.write_text(str(sum(one.user + one.system for one in times)), "ascii")
    return failure


def inputs_of(project: Path, frames: int) -> MapInputs:
    """What the stage is given, of the first multiframes."""
    at = read_artifacts(project)
    return MapInputs(
        First(open_frames(at["frames"], None, at["odometry"]), frames),
        load_trajectory(at["level"] / "trajectory.npz"),
        load_intensity_table(at["intensity"] / "table.npz"),
        classes=StoredClasses.open(at["classes"]),
    )


def measure(inputs: MapInputs, out: Path, workers: int) -> tuple[dict[str, float], dict[str, str]]:
    """Make the map once; figures and hashes."""
    folder = out / "artifacts" / f"map{workers}"
    shutil.rmtree(folder, ignore_errors=True)
    folder.mkdir(parents=True)
    began, began_s = cpu_s(), time.monotonic()
    with workers_here(workers) if workers else nullcontext() as cluster:
        means = MapMeans(DirectWorkers(out, Timed(cluster)) if cluster else None)
        build_map(inputs, folder, settings=MapSettings(), means=means)
    own_s, others_s = (b - a for a, b in zip(began, cpu_s(), strict=True))
    tiles = json.loads((folder / "tiles.json").read_text("utf-8"))
    makers_s = sum(float(file.read_text("ascii")) for file in out.glob("cpu-*"))
    for file in out.glob("cpu-*"):
        file.unlink()
    figures = {
        "workers": workers,
        "tiles": len(tiles["tiles"]),
        "points": tiles["points"],
        "cpu here [s]": round(own_s, 2),
        "cpu of workers [s]": round(others_s, 2),
        "cpu of makers [s]": round(makers_s, 2),
        "wall [s]": round(time.monotonic() - began_s, 1),
    }
    return figures, bytes_of(folder)


def main() -> None:
    """Measure and compare."""
    project, out = Path(sys.argv[1]), Path(sys.argv[2]).absolute()
    frames = int(sys.argv[3]) if sys.argv[3:] else 1 << 30
    inputs = inputs_of(project, frames)
    expected = None
    for workers in map(int, sys.argv[4:] or ("0", "1", "2")):
        figures, made = measure(inputs, out, workers)
        expected = expected or made
        print(json.dumps(figures | {"same bytes": made == expected}), flush=True)


if __name__ == "__main__":
    main()
