"""A walk through a world as a complete recording with its truth: ``recon4 simulate``."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from concurrent.futures import Future, ThreadPoolExecutor
from contextlib import ExitStack
from pathlib import Path

import numpy as np

from recon4.errors import ConfigError, StoreError
from recon4.locales.coded import CodedText
from recon4.progress import Progress
from recon4.simulation.degradation import (
    BEAM_ANGLE,
    ONLY_PROFILER,
    PEOPLE,
    VEHICLES,
    WRONG_MODEL,
    Degradation,
)
from recon4.simulation.families.families import family_of
from recon4.simulation.families.velodyne import VELODYNES
from recon4.simulation.lidar import Firings
from recon4.simulation.recorder import WalkRecorder
from recon4.simulation.setup import SimulationSetup
from recon4.store.atomic import atomic_folder
from recon4.units import SECOND_NS


def simulate(
    setup: SimulationSetup,
    out: Path,
    *,
    progress: Progress,
    bag: bool | None = None,
    degradations: Mapping[str, float] | None = None,
) -> None:
    """Write a recording and its truth to a new folder (see ``docs/explanation/simulation.md``).

    Args:
        setup: The walk and the sensors, see `prepare`; the same setup gives the same bytes.
        out: Folder to make: it must not exist, or be empty.
        progress: Receives every simulated second.
        bag: Also write the rosbag2, which doubles the size; None = if all LiDARs are Velodynes.
        degradations: Errors that the rig file does not know, see
            `recon4.simulation.degradation.KINDS`; None = none.

    Raises:
        ConfigError: If a degradation cannot be written.
        StoreError: If the folder exists with something in it or cannot be written.
    """
    if bag is None:
        bag = all(family_of(sensor.model) is VELODYNES for sensor in setup.rig.sensors)
    record(setup, {out: degradations or {}}, bag=bag, progress=progress)


def record(
    setup: SimulationSetup,
    folders: Mapping[Path, Mapping[str, float]],
    *,
    bag: bool,
    progress: Progress,
) -> None:
    """Write recordings of one walk that differ in their degradations; rays are cast once.

    Args:
        setup: The walk and the rig.
        folders: Degradations by the folder to make, which must not exist, or be empty.
        bag: Also write the rosbag2.
        progress: Receives every simulated second.

    Raises:
        ConfigError: If a degradation cannot be simulated.
        StoreError: If a folder exists with something in it or cannot be written.
    """
    for values in folders.values():
        _check_possible(values, setup)
    lasers = [lidar.pattern.lasers for lidar in setup.lidars]
    degraded = {
        folder: Degradation.drawn(values, lasers=lasers, seed=setup.seed)
        for folder, values in folders.items()
    }
    for folder in folders:
        _check_empty(folder)
    with ExitStack() as opened:
        recorders = [
            opened.enter_context(
                WalkRecorder(
                    opened.enter_context(atomic_folder(folder)), setup, degradation, bag=bag
                )
            )
            for folder, degradation in degraded.items()
        ]
        progress.start("simulate", int(np.ceil(setup.walk.seconds)), "s")
        for second, parts in enumerate(_seconds(setup)):
            for recorder in recorders:
                recorder.write(second, parts)
            progress.advance()


def _seconds(setup: SimulationSetup) -> Iterator[list[Firings]]:
    """What the sensors measure in each second of the walk; the next one is measured meanwhile."""
    fired = [0] * len(setup.lidars)
    measured: list[Future[Firings]] = []
    with ThreadPoolExecutor(len(setup.lidars)) as pool:
        for second in range(int(np.ceil(setup.walk.seconds))):
            end_ns = min((second + 1) * SECOND_NS, int(setup.walk.seconds * 1e9))
            parts, measured = measured, []
            for row, lidar in enumerate(setup.lidars):
                packets = range(fired[row], lidar.packets_before(end_ns))
                fired[row] = packets.stop
                rng = setup.rng(3, row, second)
                measured.append(
                    pool.submit(lidar.fire, packets, setup.walk, setup.surroundings, rng=rng)
                )
            if parts:
                yield [part.result() for part in parts]
        yield [part.result() for part in measured]


def _check_possible(values: Mapping[str, float], setup: SimulationSetup) -> None:
    wrong = sorted(ONLY_PROFILER & set(values))
    if wrong:
        raise ConfigError(CodedText("simulate-only-profiler", wrong=wrong[0]))
    last = setup.rig.sensors[-1].model
    if WRONG_MODEL in values and family_of(last) is not VELODYNES:
        raise ConfigError(CodedText("simulate-velodyne", wrong_model=WRONG_MODEL, last=last))
    cast = {
        PEOPLE: float(len(setup.surroundings.companions or ())),
        VEHICLES: float(len(setup.surroundings.vehicles or ())),
        BEAM_ANGLE: float(np.rad2deg(setup.models.lidar.beam_angle_sd_rad)),
    }
    for name, prepared in cast.items():
        if not np.isclose(values.get(name, 0.0), prepared):
            raise ConfigError(
                f"{name}: the rays were prepared for {prepared:g}, got {values.get(name, 0):g}"
            )


def _check_empty(out: Path) -> None:
    if not out.exists():
        return
    if not out.is_dir() or any(out.iterdir()):
        raise StoreError(CodedText("simulate-exists", out=str(out)))
    out.rmdir()
