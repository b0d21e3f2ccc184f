"""Small maps whose tiles are made by workers."""

from __future__ import annotations

import hashlib
from collections.abc import Callable, Iterator, Sequence
from pathlib import Path
from typing import Any

import numpy as np

from recon4.executors.executor import Executor, InOrder
from recon4.mapping.build import MapInputs, MapMeans, build_map
from recon4.mapping.class_corrections import ClassVolumes
from recon4.mapping.deviation import PoseCovariances
from recon4.model.class_corrections import Reclassified
from recon4.model.classes import PointClass
from recon4.model.intensity_table import IntensityTable
from recon4.model.volumes import Sphere
from recon4.orders.on_worker import PartTask, make_part
from recon4.orders.order import Answer, OrderKind, Workers
from recon4.progress import Progress
from recon4.settings import MapSettings
from recon4.store.package_versions import versions
from tests.room_walks import room_walk
from tests.unit.mapping.test_point_classes import Marked


class DirectWorkers:
    """Workers without a confined process: orders go to the executor as they are."""

    def __init__(self, project: Path, executor: Executor | None = None) -> None:
        self.project = project
        self.executor = executor or InOrder()
        self.versions = tuple(versions().items())

    def make(
        self,
        kind: OrderKind,
        folder: Path,
        items: Sequence[tuple[int, ...]],
        *,
        waiting: Callable[[], None],
    ) -> Iterator[Answer]:
        """As `Workers.make`."""
        below = folder.relative_to(self.project).as_posix()
        tasks = [
            PartTask(item, str(kind), str(self.project), below, numbers, self.versions)
            for item, numbers in enumerate(items)
        ]
        for ended in self.executor.run(make_part, tasks, lambda name, line: None):
            yield Answer(item=ended.task.item, failure=ended.failure or ended.result or "")


class Instead:
    """An executor that runs another function than it is asked to."""

    def __init__(self, executor: Executor, function: Any) -> None:
        self.executor, self.function = executor, function

    def run(self, function: Any, tasks: Any, say: Any) -> Any:
        """As `Executor.run`."""
        return self.executor.run(self.function, tasks, say)


def full_inputs(frames: int = 4) -> MapInputs:
    """A walk with all that a map can be made of."""
    walk = room_walk(frames=frames, points=8000)
    position_m = walk.trajectory.at(np.array([walk[k].t_ns for k in range(frames)])).t
    shape = (2, 16, 5, 8)
    rng = np.random.default_rng(3)
    table = IntensityTable(
        mean=rng.uniform(50, 90, shape).astype(np.float32),
        std=rng.uniform(5, 20, shape).astype(np.float32),
        level=np.zeros(shape, np.uint8),
        target_mean=100.0,
        target_std=100.0 / 3.0,
        upper=255.0,
        incidence_bin_rad=0.4,
        range_bin_m=1.1,
    )
    ball = Reclassified(
        volume=Sphere(center_m=(5.0, 0.0, 0.0), radius_m=2.0), to=int(PointClass.BUILDING)
    )
    return MapInputs(
        walk,
        walk.trajectory,
        table,
        covariances=PoseCovariances(position_m, np.tile(1e-4 * np.eye(6), (frames, 1, 1))),
        classes=Marked(),
        corrections=ClassVolumes.of([ball]),
    )


def make_map(
    project: Path,
    workers: Workers | None,
    *,
    surface: str = "fitted",
    inputs: MapInputs | None = None,
    progress: Progress | None = None,
) -> Path:
    """Make a map as the stage does, in a new artifact of a project; returns its folder."""
    out = project / "artifacts" / f"map{len(list(project.glob('artifacts/*')))}"
    out.mkdir(parents=True)
    build_map(
        inputs or full_inputs(),
        out,
        settings=MapSettings(surface=surface, voxel_m=0.05, tile_m=3.0),
        progress=progress,
        means=MapMeans(workers, burst=10_000),
    )
    return out


def bytes_of(folder: Path) -> dict[str, str]:
    """Hash of each file of an artifact."""
    return {
        path.relative_to(folder).as_posix(): hashlib.sha256(path.read_bytes()).hexdigest()
        for path in sorted(folder.rglob("*"))
        if path.is_file()
    }
