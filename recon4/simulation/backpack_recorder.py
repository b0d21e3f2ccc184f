"""Writes what the computer of the Wuerzburg backpack would have recorded, and the truth."""

from __future__ import annotations

import json
from contextlib import ExitStack
from dataclasses import asdict, dataclass, replace
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from recon4.geometry.mesh import write_ply
from recon4.geometry.se3 import SE3, Array
from recon4.model.laser_scans import LaserScans
from recon4.model.rig import format_rig
from recon4.model.samples import ImuSamples
from recon4.model.trajectory import Times, Trajectory
from recon4.recording.formats.poses import write_tum
from recon4.simulation.csv_tables import write_imu
from recon4.simulation.degradation import COURSE, Degradation
from recon4.simulation.imu import simulate_imu
from recon4.simulation.line_bag import LineBag, open_line_bag
from recon4.simulation.profiler import SimulatedLines
from recon4.simulation.truth import true_trajectory
from recon4.units import SECOND_NS

if TYPE_CHECKING:
    from recon4.simulation.backpack import BackpackSetup


@dataclass(frozen=True, slots=True, kw_only=True)
class IspaceModel:
    """The measuring system of the hall (L §4.4)."""

    rate_hz: int = 40
    error_m: float = 0.00025
    """Largest error of a position."""
    sd_rad: float = 2e-4
    """Standard deviation of an orientation about each axis."""


ISPACE = IspaceModel()


class BackpackRecorder:
    """Writes one recording; the truth is written when it is closed without an error."""

    def __init__(self, folder: Path, setup: BackpackSetup, degradation: Degradation) -> None:
        self._folder, self._setup, self._degradation = folder, setup, degradation
        self._counts = {"line_scans": 0, "points": 0, "laser2d_scans": 0}
        self._imu = self._imu_samples()
        if self._imu is not None:
            write_imu(folder / "imu.csv", self._imu)
        (folder / "rig.toml").write_text(format_rig(degradation.nominal_rig(setup.rig)), "utf-8")
        self._open = ExitStack()
        self._bag: LineBag = self._open.enter_context(open_line_bag(folder / "rosbag2"))
        self._stuck_rad: float | None = None

    def __enter__(self) -> BackpackRecorder:
        return self

    def __exit__(self, kind: type[BaseException] | None, *error: object) -> None:
        self._open.__exit__(kind, *error)  # type: ignore[arg-type]
        if kind is None:
            self._write_truth()

    def write(self, second: int, lines: SimulatedLines, scans: LaserScans | None) -> None:
        """Append one second of all sensors."""
        if scans is not None and "no-laser2d" not in self._degradation.values:
            self._write_scans(scans)
        self._write_lines(second, lines)
        if self._imu is not None:
            start_ns = self._setup.epoch_ns + second * SECOND_NS
            first, last = np.searchsorted(self._imu.t_ns, [start_ns, start_ns + SECOND_NS])
            rows = slice(int(first), int(last))
            self._bag.imu(
                ImuSamples(
                    self._imu.t_ns[rows], self._imu.gyro_rad_s[rows], self._imu.accel_m_s2[rows]
                )
            )

    def _write_lines(self, second: int, lines: SimulatedLines) -> None:
        setup, values = self._setup, self._degradation.values
        row = setup.rig.row_of("profiler") or 0
        sensor, sensors = setup.rig.sensors[row], len(setup.rig.sensors)
        model = setup.profiler.model
        offset_ns = setup.epoch_ns - round(1e9 * sensor.time_offset_s)
        t_ns = offset_ns + self._degradation.stamps(row, lines.t_ns, sensors=sensors)
        kept = np.flatnonzero(self._degradation.kept(len(t_ns), row, second))
        head, unit = lines.head_rad, 100.0 if "lines-cm" in values else 1.0
        if "head-stuck" in values:
            self._stuck_rad = float(head[0]) if self._stuck_rad is None else self._stuck_rad
            head = np.full(len(head), self._stuck_rad)
        if "head-pause" in values:
            head = self._with_pause(lines.t_ns, head)
        if "no-head" not in values:
            self._bag.head(sensor.head_topic or "/profiler/head", t_ns, head)
        self._bag.scans(
            sensor.topic,
            LaserScans.of_rows(
                t_ns[kept],
                lines.range_m[kept] * np.float32(unit),
                angles=(
                    model.lowest_rad,
                    (model.highest_rad - model.lowest_rad) / (model.shots - 1),
                ),
                range_max_m=model.errors.max_range_m * unit,
                time_step_s=setup.profiler.shot_s,
            ),
            lines.intensity[kept],
        )
        self._counts["line_scans"] += len(kept)
        self._counts["points"] += int(np.isfinite(lines.range_m[kept]).sum())

    def _with_pause(self, t_ns: Times, head: Array) -> Array:
        """Angles with that of `COURSE.silent_from_s` for as long as the encoder is stuck."""
        t_s = 1e-9 * t_ns
        stuck = t_s >= COURSE.silent_from_s
        stuck &= t_s < COURSE.silent_from_s + self._degradation.values["head-pause"]
        if stuck.any() and self._stuck_rad is None:
            self._stuck_rad = float(head[np.argmax(stuck)])
        return np.where(stuck, self._stuck_rad or 0.0, head)

    def _write_scans(self, scans: LaserScans) -> None:
        setup, values = self._setup, self._degradation.values
        row = setup.rig.row_of("laser2d") or 0
        sensor = setup.rig.sensors[row]
        silent_s = values.get("laser2d-silent", 0.0)
        t_s = 1e-9 * scans.t_ns
        kept = ~((t_s >= COURSE.silent_from_s) & (t_s < COURSE.silent_from_s + silent_s))
        scans = scans[kept]
        scans = replace(scans, t_ns=scans.t_ns + setup.epoch_ns - round(1e9 * sensor.time_offset_s))
        ahead_ns = round(1e9 * values.get("laser2d-clock", 0.0))
        unit = 100.0 if "laser2d-cm" in values else 1.0
        scans = replace(
            scans,
            t_ns=scans.t_ns + ahead_ns,
            range_m=scans.range_m * np.float32(unit),
            range_max_m=scans.range_max_m * unit,
        )
        self._bag.scans(sensor.topic, scans)
        self._counts["laser2d_scans"] += len(scans)

    def _imu_samples(self) -> ImuSamples | None:
        setup, degradation = self._setup, self._degradation
        if "no-imu" in degradation.values:
            return None
        model = degradation.imu_model(setup.models.imu)
        samples = simulate_imu(
            setup.walk, setup.rig, model, epoch_ns=setup.epoch_ns, rng=setup.rng(2)
        )
        return degradation.imu(samples)

    def _write_truth(self) -> None:
        folder, setup = self._folder, self._setup
        write_tum(folder / "truth.tum", true_trajectory(setup.walk, epoch_ns=setup.epoch_ns))
        write_tum(folder / "ispace.tum", ispace_trajectory(setup))
        write_ply(folder / "model.ply", setup.world.mesh)
        if self._degradation.values:
            (folder / "rig_true.toml").write_text(format_rig(setup.rig), "utf-8")
        about = {
            "world": setup.world.name,
            "seconds": setup.walk.seconds,
            "seed": setup.seed,
            "epoch_ns": setup.epoch_ns,
            "rig": setup.rig.name,
            "counts": self._counts,
            "models": asdict(setup.models),
            "degradations": self._degradation.to_json(),
        }
        text = json.dumps(about, indent=1, allow_nan=False)
        (folder / "world.json").write_text(text + "\n", "utf-8")


def ispace_trajectory(setup: BackpackSetup) -> Trajectory:
    """``T_map_body`` as iSpace measures it: 40 Hz, within 0.25 mm (L §4.4)."""
    period_ns = SECOND_NS // ISPACE.rate_hz
    t_ns = np.arange(int(setup.walk.seconds * ISPACE.rate_hz) + 1, dtype=np.int64) * period_ns
    rng = setup.rng(9)
    T = setup.walk.poses(1e-9 * t_ns)
    direction = rng.standard_normal((len(t_ns), 3))
    direction /= np.linalg.norm(direction, axis=1, keepdims=True)
    error_m = ISPACE.error_m * rng.uniform(0.0, 1.0, (len(t_ns), 1)) * direction
    turn = np.zeros((len(t_ns), 6))
    turn[:, :3] = ISPACE.sd_rad * rng.standard_normal((len(t_ns), 3))
    R = T.R @ SE3.exp(turn).R
    return Trajectory(setup.epoch_ns + t_ns, SE3(R, T.t + error_m))
