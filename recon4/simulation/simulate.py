"""A walk through a world as a complete recording with its truth: ``recon4 simulate``."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from contextlib import ExitStack
from pathlib import Path

import numpy as np

from recon4.errors import StoreError
from recon4.model.rig import Rig
from recon4.progress import Progress
from recon4.simulation.degradation import Degradation
from recon4.simulation.lidar import Firings
from recon4.simulation.recorder import Recorder
from recon4.simulation.setup import EPOCH_NS, Models, SimulationSetup, prepare
from recon4.store.atomic import atomic_folder

_SECOND_NS = 1_000_000_000


def simulate(  # noqa: PLR0913 - every part of a recording can be chosen
    world: str,
    out: Path,
    *,
    seconds: float,
    seed: int,
    progress: Progress,
    rig: Rig | None = None,
    models: Models | None = None,
    bag: bool = True,
    epoch_ns: int = EPOCH_NS,
    degradations: Mapping[str, float] | None = None,
) -> None:
    """Write a recording and its truth to a new folder (see ``docs/simulation.md``).

    Args:
        world: One of `recon4.simulation.worlds.WORLDS`.
        out: Folder to make: it must not exist, or be empty.
        seconds: Length of the walk.
        seed: Draws the walk and all noise; the same seed gives the same bytes.
        progress: Receives every simulated second.
        rig: VLP-16s and their mounting; None = 4RECON.
        models: Errors of the sensors; None = those of the real ones.
        bag: Also write the rosbag2, which doubles the size.
        epoch_ns: UTC of the start [ns].
        degradations: Errors that the rig file does not know, see
            `recon4.simulation.degradation.KINDS`; None = none.

    Raises:
        ConfigError: If the world, the duration, the rig or a degradation cannot be simulated.
        StoreError: If the folder exists with something in it or cannot be written.
    """
    setup = prepare(world, seconds=seconds, seed=seed, rig=rig, models=models, epoch_ns=epoch_ns)
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
    degraded = {
        folder: Degradation.drawn(values, sensors=len(setup.lidars), seed=setup.seed)
        for folder, values in folders.items()
    }
    for folder in folders:
        _check_empty(folder)
    with ExitStack() as opened:
        recorders = [
            opened.enter_context(
                Recorder(opened.enter_context(atomic_folder(folder)), setup, degradation, bag=bag)
            )
            for folder, degradation in degraded.items()
        ]
        progress.start("simulate", int(np.ceil(setup.walk.seconds)), "s")
        for second, parts in enumerate(_seconds(setup)):
            for recorder in recorders:
                recorder.write(second, parts)
            progress.advance()


def _seconds(setup: SimulationSetup) -> Iterator[list[Firings]]:
    """What the sensors measure in each second of the walk."""
    fired = [0] * len(setup.lidars)
    for second in range(int(np.ceil(setup.walk.seconds))):
        end_ns = min((second + 1) * _SECOND_NS, int(setup.walk.seconds * 1e9))
        parts = []
        for row, lidar in enumerate(setup.lidars):
            packets = range(fired[row], lidar.packets_before(end_ns))
            fired[row] = packets.stop
            rng = setup.rng(3, row, second)
            parts.append(lidar.fire(packets, setup.walk, setup.surroundings, rng))
        yield parts


def _check_empty(out: Path) -> None:
    if not out.exists():
        return
    if not out.is_dir() or any(out.iterdir()):
        raise StoreError(f"{out} exists already; give a new folder")
    out.rmdir()
