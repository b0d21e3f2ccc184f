"""The Wuerzburg backpack on a walk: everything drawn from one seed, and its recording."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field, replace
from pathlib import Path

import numpy as np

from recon4.errors import ConfigError, StoreError
from recon4.geometry.raycast import Scene
from recon4.locales.coded import CodedText
from recon4.model.laser_scans import LaserScans
from recon4.model.rig import Rig, load_rig
from recon4.progress import Progress
from recon4.simulation.backpack_recorder import BackpackRecorder
from recon4.simulation.crowd import Crowd
from recon4.simulation.degradation import NOT_PROFILER, UPSIDE_DOWN, Degradation
from recon4.simulation.figures import along_figure, figure_named
from recon4.simulation.gait import plan_walk
from recon4.simulation.imu import ImuModel
from recon4.simulation.lidar import Surroundings
from recon4.simulation.profiler import (
    Laser2dModel,
    ProfilerModel,
    SimulatedLaser2d,
    SimulatedLines,
    SimulatedProfiler,
)
from recon4.simulation.setup import EPOCH_NS
from recon4.simulation.walk import Walk
from recon4.simulation.world import World
from recon4.simulation.worlds import build_world
from recon4.store.atomic import atomic_folder
from recon4.units import SECOND_NS


@dataclass(frozen=True, slots=True, kw_only=True)
class BackpackModels:
    """Error models of the sensors of the backpack."""

    profiler: ProfilerModel = field(default_factory=ProfilerModel)
    laser2d: Laser2dModel = field(default_factory=Laser2dModel)
    imu: ImuModel = field(default_factory=ImuModel)


@dataclass(frozen=True, slots=True, eq=False)
class BackpackSetup:
    """A person with the backpack in a world."""

    world: World
    walk: Walk
    rig: Rig
    models: BackpackModels
    profiler: SimulatedProfiler
    laser2d: SimulatedLaser2d | None
    surroundings: Surroundings
    seed: int
    epoch_ns: int
    """UTC of the start [ns]."""

    def rng(self, *purpose: int) -> np.random.Generator:
        """A generator of its own for each purpose, so that parts can be left out or reordered."""
        return np.random.default_rng([self.seed, *purpose])


def prepare_backpack(
    world: str,
    *,
    seed: int,
    figure: str = "",
    seconds: float = 0.0,
    rig: Rig | None = None,
    models: BackpackModels | None = None,
    people: int = 0,
) -> BackpackSetup:
    """Build a world, plan the walk and mount the sensors.

    Args:
        world: One of `recon4.simulation.worlds.WORLDS`.
        seed: Draws the walk and all noise.
        figure: One of `recon4.simulation.figures.FIGURES`; empty = the usual route of the world.
        seconds: Length of the walk; 0 = that of the figure, else 60.
        rig: A rig with a profiler; None = ``wuerzburg``.
        models: Errors of the sensors; None = real ones, with the shots a line of the figure.
        people: Number of people who walk along.

    Raises:
        ConfigError: If a name is unknown, the walk too short, or the rig has no profiler.
    """
    rig = rig or load_rig("wuerzburg")
    row = _profiler_row(rig)
    if seed < 0:
        raise ConfigError(CodedText("simulate-seed", seed=seed))
    place, found = build_world(world), models or BackpackModels()
    if figure:
        place = along_figure(place, figure_named(figure))
        found = models or _models_of(figure)
        seconds = seconds or figure_named(figure).seconds
    companions = Crowd(people).drawn(seed)[0]
    seconds = seconds or 60.0
    if not 5.0 <= seconds < 1e6:
        raise ConfigError(CodedText("simulate-seconds", seconds=seconds))
    return BackpackSetup(
        place,
        plan_walk(place, seconds=seconds, rng=np.random.default_rng([seed, 0])),
        rig,
        found,
        SimulatedProfiler.drawn(
            rig.sensors[row], found.profiler, np.random.default_rng([seed, 1, row])
        ),
        _laser2d(rig, found.laser2d, seed),
        Surroundings(place.mesh, Scene(place.mesh), companions),
        seed,
        EPOCH_NS,
    )


def _laser2d(rig: Rig, model: Laser2dModel, seed: int) -> SimulatedLaser2d | None:
    row = rig.row_of("laser2d")
    if row is None:
        return None
    return SimulatedLaser2d.drawn(rig.sensors[row], model, np.random.default_rng([seed, 1, row]))


def _profiler_row(rig: Rig) -> int:
    row = rig.row_of("profiler")
    if row is None or any(sensor.kind == "lidar" for sensor in rig.sensors):
        raise ConfigError(CodedText("simulate-rig", rig=rig.name))
    return row


def _models_of(figure: str) -> BackpackModels:
    """Models with the line rate and the points of a line of L Table 1."""
    row = figure_named(figure)
    profiler = ProfilerModel(lines_hz=row.line_scans / row.seconds, shots=row.shots_per_line)
    return BackpackModels(profiler=profiler)


def simulate_backpack(
    setup: BackpackSetup,
    out: Path,
    *,
    progress: Progress,
    degradations: Mapping[str, float] | None = None,
) -> None:
    """Write a recording and its truth to a new folder (see ``docs/explanation/wuerzburg.md``).

    Args:
        setup: The walk and the sensors; the same setup gives the same bytes.
        out: Folder to make: it must not exist, or be empty.
        progress: Receives every simulated second.
        degradations: Errors that the rig file does not know; None = none.

    Raises:
        ConfigError: If a degradation cannot be simulated on this rig.
        StoreError: If the folder exists with something in it or cannot be written.
    """
    values = degradations or {}
    wrong = sorted(NOT_PROFILER & set(values))
    if wrong:
        raise ConfigError(CodedText("simulate-not-profiler", wrong=wrong[0]))
    degradation = Degradation.drawn(values, lasers=[1] * len(setup.rig.sensors), seed=setup.seed)
    if out.exists() and (not out.is_dir() or any(out.iterdir())):
        raise StoreError(CodedText("simulate-exists", out=str(out)))
    if out.exists():
        out.rmdir()
    if setup.laser2d is not None and UPSIDE_DOWN in values:
        model = replace(setup.laser2d.model, upside_down=True)
        setup = replace(setup, laser2d=replace(setup.laser2d, model=model))
    with (
        atomic_folder(out) as folder,
        BackpackRecorder(folder, setup, degradation) as recorder,
    ):
        progress.start("simulate", int(np.ceil(setup.walk.seconds)), "s")
        for second, (lines, scans) in enumerate(measured_seconds(setup)):
            recorder.write(second, lines, scans)
            progress.advance()


def measured_seconds(
    setup: BackpackSetup,
) -> Iterator[tuple[SimulatedLines, LaserScans | None]]:
    """What profiler and 2-D laser measure in each second of the walk."""
    lines = scans = 0
    for second in range(int(np.ceil(setup.walk.seconds))):
        end_ns = min((second + 1) * SECOND_NS, int(setup.walk.seconds * 1e9))
        first, lines = lines, max(lines, setup.profiler.lines_before(end_ns))
        measured = setup.profiler.measure(
            range(first, lines), setup.walk, setup.surroundings, rng=setup.rng(3, 0, second)
        )
        if setup.laser2d is None:
            yield measured, None
            continue
        first, scans = scans, max(scans, setup.laser2d.scans_before(end_ns))
        yield (
            measured,
            setup.laser2d.measure(
                range(first, scans), setup.walk, setup.surroundings, rng=setup.rng(3, 1, second)
            ),
        )
