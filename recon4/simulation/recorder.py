"""Everything a recording computer would have written, second by second, and the truth."""

from __future__ import annotations

import json
import shutil
import zipfile
from collections.abc import Sequence
from contextlib import ExitStack
from dataclasses import asdict, fields, replace
from pathlib import Path
from types import TracebackType
from typing import Self, TypeVar

import numpy as np
from numpy.typing import NDArray

from recon4.geometry.mesh import write_ply
from recon4.model.beams import BeamCorrections
from recon4.model.rig import Rig, format_rig
from recon4.model.samples import GnssSamples, ImuSamples
from recon4.recording.formats.poses import write_tum
from recon4.recording.packets.velodyne.encode import PcapWriter
from recon4.simulation.bag import BagWriter, open_bag
from recon4.simulation.csv_tables import write_gnss, write_imu, write_markers
from recon4.simulation.degradation import Degradation
from recon4.simulation.families.families import family_of
from recon4.simulation.imu import simulate_imu
from recon4.simulation.lidar import Firings
from recon4.simulation.packets import (
    Packets,
    pack,
    pack_imu,
    put_imu,
    stamped,
    write_packets,
    write_position_packets,
)
from recon4.simulation.setup import SimulationSetup, gnss_samples
from recon4.simulation.targets import write_targets
from recon4.simulation.truth import true_trajectory
from recon4.units import SECOND_NS

Samples = TypeVar("Samples", ImuSamples, GnssSamples)


class WalkRecorder:
    """Writes one recording; the truth is written when it is closed without an error."""

    def __init__(
        self, folder: Path, setup: SimulationSetup, degradation: Degradation, *, bag: bool
    ) -> None:
        self._folder, self._setup, self._degradation = folder, setup, degradation
        self._imu, self._gnss = _sense(setup, degradation), _receive(setup, degradation)
        if self._imu is not None and setup.imu_row is None:
            write_imu(folder / "imu.csv", self._imu)
        if self._gnss is not None:
            write_gnss(folder / "gnss.csv", self._gnss)
        (folder / "rig.toml").write_text(format_rig(degradation.nominal_rig(setup.rig)), "utf-8")
        for name, content in _companions(setup).items():
            (folder / name).write_bytes(content)
        self._open = ExitStack()
        self._pcap = self._open.enter_context(PcapWriter(folder / "recording.pcap"))
        self._reflectivity = self._open.enter_context(
            ReflectivityWriter(
                folder / "reflectivity.npz", [lidar.pattern.shape for lidar in setup.lidars]
            )
        )
        self._bag: BagWriter | None = None
        if bag:
            self._bag = self._open.enter_context(open_bag(folder / "rosbag2", setup.rig))

    def __enter__(self) -> WalkRecorder:
        return self

    def __exit__(self, kind: type[BaseException] | None, *error: object) -> None:
        self._open.__exit__(kind, *error)  # type: ignore[arg-type]
        if kind is None:
            self._write_truth()

    def write(self, second_index: int, firings_by_lidar: list[Firings]) -> None:
        """Append one second of all sensors; the first one has the index 0."""
        setup, degradation = self._setup, self._degradation
        if degradation.values:
            firings_by_lidar = [
                degradation.degrade_firings(
                    firings, row, second_index, pattern=setup.lidars[row].pattern
                )
                for row, firings in enumerate(firings_by_lidar)
            ]
        packets = [
            pack(firings, row, setup, degradation=degradation, rng=setup.rng(4, row, second_index))
            for row, firings in enumerate(firings_by_lidar)
        ]
        if degradation.recorded(np.array([second_index * SECOND_NS]))[0]:
            write_position_packets(self._pcap, second_index, setup)
        write_packets(self._pcap, [*packets, *self._imu_packets(second_index, packets)], setup)
        for row, firings in enumerate(firings_by_lidar):
            self._reflectivity.append(row, firings.reflectivity)
        if self._bag is not None:
            for part in packets:
                self._bag.packets(part.row, part.t_arrival_ns, part.payloads)
            start_ns = setup.epoch_ns + second_index * SECOND_NS
            if self._imu is not None:
                self._bag.imu(self._as_stamped(_during(self._imu, start_ns)))
            if self._gnss is not None:
                self._bag.gnss(_during(self._gnss, start_ns))

    def _imu_packets(self, second_index: int, packets: list[Packets]) -> list[Packets]:
        """Those of one second of the LiDAR whose IMU is that of the rig; or its data packets, one
        element a LiDAR, are given the samples.
        """
        setup = self._setup
        if self._imu is None or setup.imu_row is None:
            return []
        put_imu(packets[setup.imu_row], self._imu, setup, degradation=self._degradation)
        samples = _during(self._imu, setup.epoch_ns + second_index * SECOND_NS)
        own = pack_imu(samples, setup.imu_row, setup, degradation=self._degradation)
        return [] if own is None else [own]

    def _as_stamped(self, samples: ImuSamples) -> ImuSamples:
        """Samples as their driver stamps them: those of the IMU in a LiDAR are on its clock."""
        row = self._setup.imu_row
        if row is None:
            return samples
        return stamped(samples, row, self._setup, degradation=self._degradation)

    def _write_truth(self) -> None:
        folder, setup = self._folder, self._setup
        write_tum(folder / "truth.tum", true_trajectory(setup.walk, epoch_ns=setup.epoch_ns))
        write_ply(folder / "model.ply", setup.world.mesh)
        write_markers(folder / "markers.csv", setup.world)
        write_targets(folder, setup.world.targets, setup.seed)
        if self._degradation.values:
            true = true_rig(setup, self._degradation)
            (folder / "rig_true.toml").write_text(format_rig(true), "utf-8")
        parameters = _parameters(setup) | {"degradations": self._degradation.to_json()}
        text = json.dumps(parameters, indent=1, allow_nan=False)
        (folder / "world.json").write_text(text + "\n", "utf-8")


def true_rig(setup: SimulationSetup, degradation: Degradation) -> Rig:
    """The rig that was simulated, with the errors of its beams as corrections."""
    sensors = []
    for lidar, range_bias_m in zip(setup.lidars, degradation.range_bias_m, strict=True):
        ring = lidar.pattern.ring
        rows = np.zeros((3, len(ring)))
        elevation_rad, clockwise_rad = lidar.beam_angle_error_rad
        rows[:, ring] = [-range_bias_m, elevation_rad, -clockwise_rad]
        beams = BeamCorrections.of(rows) if rows.any() else None
        sensors.append(replace(lidar.sensor, beams=beams))
    return replace(setup.rig, sensors=tuple(sensors))


def _companions(setup: SimulationSetup) -> dict[str, bytes]:
    """What the makers deliver with the sensors, named by the sensor."""
    return {
        f"{lidar.sensor.name}_{name}": content
        for lidar in setup.lidars
        for name, content in family_of(lidar.sensor.model).companions(lidar).items()
    }


def _sense(setup: SimulationSetup, degradation: Degradation) -> ImuSamples | None:
    if "no-imu" in degradation.values:
        return None
    model = degradation.imu_model(setup.models.imu)
    rng = setup.rng(2)
    samples = simulate_imu(setup.walk, setup.rig, model, epoch_ns=setup.epoch_ns, rng=rng)
    return degradation.imu(samples)


def _receive(setup: SimulationSetup, degradation: Degradation) -> GnssSamples | None:
    samples = None if "no-gnss" in degradation.values else gnss_samples(setup)
    return None if samples is None else degradation.gnss(samples)


def _during(samples: Samples, start_ns: int) -> Samples:
    """Samples of the second that starts then."""
    first, last = np.searchsorted(samples.t_ns, [start_ns, start_ns + SECOND_NS])
    columns = [getattr(samples, column.name)[first:last] for column in fields(samples)]
    return type(samples)(*columns)


def _parameters(setup: SimulationSetup) -> dict[str, object]:
    """All that was chosen or drawn, so that a result can be judged by it."""
    return {
        "world": setup.world.name,
        "outdoors": setup.world.outdoors,
        "origin": asdict(setup.world.origin),
        "people": len(setup.surroundings.companions or ()),
        "vehicles": len(setup.surroundings.vehicles or ()),
        "seconds": setup.walk.seconds,
        "seed": setup.seed,
        "epoch_ns": setup.epoch_ns,
        "rig": setup.rig.name,
        "models": asdict(setup.models),
        "lidars": [
            {
                "sensor": lidar.sensor.name,
                "model": lidar.pattern.model,
                "first_packet_ns": lidar.first_packet_ns,
                "azimuth_rad": lidar.azimuth_rad,
                "turn_rate_hz": lidar.turn_rate_hz,
                "gain_by_laser": lidar.gain.tolist(),
                "turned_rad_by_laser": lidar.beam_angle_error_rad.tolist(),
            }
            for lidar in setup.lidars
        ],
    }


class ReflectivityWriter:
    """Writes an ``.npz`` with an array ``sensor0``, ``sensor1``, … a sensor, without holding it.

    Each is (packets, sequences, lasers) uint8: hundred times the reflectivity of what the shot
    hit, at most 255, and 0 where nothing came back.
    """

    def __init__(self, path: Path, shapes: Sequence[tuple[int, int]]) -> None:
        """Begin.

        Args:
            path: File to write.
            shapes: Sequences and lasers of a packet of each sensor.
        """
        self._path, self._shapes, sensors = path, shapes, len(shapes)
        self._parts = [path.with_name(f"{path.stem}{row}.tmp") for row in range(sensors)]
        self._files = [part.open("wb") for part in self._parts]
        self._packets = [0] * sensors

    def __enter__(self) -> Self:
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, _: TracebackType | None
    ) -> None:
        for file in self._files:
            file.close()
        if kind is None:
            self._collect()
        for part in self._parts:
            part.unlink()

    def append(self, row: int, reflectivity: NDArray[np.uint8]) -> None:
        """Append packets of a sensor, (P, S, L)."""
        self._files[row].write(reflectivity.tobytes())
        self._packets[row] += len(reflectivity)

    def _collect(self) -> None:
        with zipfile.ZipFile(self._path, "w") as archive:
            for row, (part, packets) in enumerate(zip(self._parts, self._packets, strict=True)):
                name = zipfile.ZipInfo(f"sensor{row}.npy")  # of no date
                with archive.open(name, "w", force_zip64=True) as target, part.open("rb") as source:
                    header = {
                        "descr": "|u1",
                        "fortran_order": False,
                        "shape": (packets, *self._shapes[row]),
                    }
                    np.lib.format.write_array_header_1_0(target, header)
                    shutil.copyfileobj(source, target, 1 << 20)
