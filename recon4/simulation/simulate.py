"""A walk through a world as a complete recording with its truth: ``recon4 simulate``."""

from __future__ import annotations

import json
from collections.abc import Iterator
from contextlib import ExitStack
from dataclasses import asdict, fields
from pathlib import Path
from typing import TypeVar

import numpy as np

from recon4.errors import StoreError
from recon4.geometry.mesh import write_ply
from recon4.model.rig import Rig, format_rig
from recon4.model.samples import GnssSamples, ImuSamples
from recon4.progress import Progress
from recon4.recording.formats.poses import write_tum
from recon4.recording.velodyne.encode import PcapWriter
from recon4.simulation.bag import BagWriter, open_bag
from recon4.simulation.csv_tables import write_gnss, write_imu, write_markers
from recon4.simulation.gnss import simulate_gnss
from recon4.simulation.imu import simulate_imu
from recon4.simulation.lidar import Firings
from recon4.simulation.packets import pack, write_packets, write_positions
from recon4.simulation.reflectivity import ReflectivityWriter
from recon4.simulation.setup import EPOCH_NS, Models, SimulationSetup, prepare
from recon4.simulation.truth import true_trajectory
from recon4.store.atomic import atomic_folder

_SECOND_NS = 1_000_000_000
Samples = TypeVar("Samples", ImuSamples, GnssSamples)


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

    Raises:
        ConfigError: If the world, the duration or the rig cannot be simulated.
        StoreError: If the folder exists with something in it or cannot be written.
    """
    _check_empty(out)
    setup = prepare(world, seconds=seconds, seed=seed, rig=rig, models=models, epoch_ns=epoch_ns)
    with atomic_folder(out) as folder:
        with _Recorder(folder, setup, bag=bag) as recorder:
            progress.start("simulate", int(np.ceil(seconds)), "s")
            for second, parts in enumerate(_seconds(setup)):
                recorder.write(second, parts)
                progress.advance()
        _write_truth(folder, setup)


class _Recorder:
    """Everything a recording computer would have written, second by second."""

    def __init__(self, folder: Path, setup: SimulationSetup, *, bag: bool) -> None:
        self._setup = setup
        self._imu = simulate_imu(
            setup.walk,
            setup.rig,
            setup.models.imu,
            epoch_ns=setup.epoch_ns,
            rng=setup.rng(2),
        )
        self._gnss = _receive(setup)
        write_imu(folder / "imu.csv", self._imu)
        if self._gnss is not None:
            write_gnss(folder / "gnss.csv", self._gnss)
        (folder / "rig.toml").write_text(format_rig(setup.rig), "utf-8")
        self._open = ExitStack()
        self._pcap = self._open.enter_context(PcapWriter(folder / "recording.pcap"))
        self._reflectivity = self._open.enter_context(
            ReflectivityWriter(folder / "reflectivity.npz", len(setup.lidars))
        )
        self._bag: BagWriter | None = None
        if bag:
            self._bag = self._open.enter_context(open_bag(folder / "rosbag2", setup.rig))

    def __enter__(self) -> _Recorder:
        return self

    def __exit__(self, *error: object) -> None:
        self._open.__exit__(*error)  # type: ignore[arg-type]

    def write(self, second: int, parts: list[Firings]) -> None:
        """Append one second of all sensors."""
        setup = self._setup
        packets = [
            pack(firings, row, setup, rng=setup.rng(4, row, second))
            for row, firings in enumerate(parts)
        ]
        write_positions(self._pcap, second, setup)
        write_packets(self._pcap, packets, setup)
        for row, firings in enumerate(parts):
            self._reflectivity.append(row, firings.reflectivity)
        if self._bag is not None:
            for part in packets:
                self._bag.packets(part.row, part.t_arrival_ns, part.payloads)
            start_ns = setup.epoch_ns + second * _SECOND_NS
            self._bag.imu(_during(self._imu, start_ns))
            if self._gnss is not None:
                self._bag.gnss(_during(self._gnss, start_ns))


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


def _receive(setup: SimulationSetup) -> GnssSamples | None:
    if not setup.world.outdoors:
        return None
    return simulate_gnss(
        setup.walk,
        setup.rig,
        setup.models.gnss,
        origin=setup.world.origin,
        epoch_ns=setup.epoch_ns,
        rng=setup.rng(5),
    )


def _during(samples: Samples, start_ns: int) -> Samples:
    """Samples of the second that starts then."""
    first, last = np.searchsorted(samples.t_ns, [start_ns, start_ns + _SECOND_NS])
    columns = [getattr(samples, column.name)[first:last] for column in fields(samples)]
    return type(samples)(*columns)


def _write_truth(folder: Path, setup: SimulationSetup) -> None:
    write_tum(folder / "truth.tum", true_trajectory(setup.walk, epoch_ns=setup.epoch_ns))
    write_ply(folder / "model.ply", setup.world.mesh)
    write_markers(folder / "markers.csv", setup.world)
    text = json.dumps(_parameters(setup), indent=1, allow_nan=False)
    (folder / "world.json").write_text(text + "\n", "utf-8")


def _parameters(setup: SimulationSetup) -> dict[str, object]:
    """All that was chosen or drawn, so that a result can be judged by it."""
    return {
        "world": setup.world.name,
        "outdoors": setup.world.outdoors,
        "origin": asdict(setup.world.origin),
        "seconds": setup.walk.seconds,
        "seed": setup.seed,
        "epoch_ns": setup.epoch_ns,
        "rig": setup.rig.name,
        "models": asdict(setup.models),
        "lidars": [
            {
                "sensor": lidar.sensor.name,
                "first_packet_ns": lidar.first_packet_ns,
                "azimuth_rad": lidar.azimuth_rad,
                "turn_rate_hz": lidar.turn_rate_hz,
                "gain_by_laser": lidar.gain.tolist(),
            }
            for lidar in setup.lidars
        ],
    }


def _check_empty(out: Path) -> None:
    if not out.exists():
        return
    if not out.is_dir() or any(out.iterdir()):
        raise StoreError(f"{out} exists already; give a new folder")
    out.rmdir()
