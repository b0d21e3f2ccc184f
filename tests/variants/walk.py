"""The walk that all variants record in their own manner: clouds, packets, samples and truth."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from recon4.geometry.se3 import Array
from recon4.model.rig import load_rig
from recon4.model.samples import ImuSamples
from recon4.model.trajectory import Times, Trajectory
from recon4.progress import Silent
from recon4.recording.formats.pcap import read_pcap
from recon4.recording.formats.poses import read_tum
from recon4.recording.ingest import ingest
from recon4.recording.report import ImportReport
from recon4.recording.sources import Sources
from recon4.settings import IngestSettings
from recon4.simulation.setup import SimulationSetup, prepare
from recon4.simulation.simulate import simulate
from recon4.store.frames import FrameStore

TURN_NS = 100_000_000


@dataclass(frozen=True, slots=True, eq=False)
class Cloud:
    """One revolution, as measured by a VLP-16."""

    t_ns: int
    """Start [ns UTC]."""
    dt_ns: NDArray[np.int64]
    """Time of each point since the start [ns], (N,)."""
    xyz: NDArray[np.float32]
    """Frame of the sensor [m], (N, 3)."""
    intensity: NDArray[np.uint16]
    ring: NDArray[np.uint8]


@dataclass(frozen=True, slots=True, eq=False)
class RecordedWalk:
    """A walk with one LiDAR and an IMU at its place."""

    clouds: list[Cloud]
    imu: ImuSamples
    truth: Trajectory
    """Of the LiDAR, in the world."""
    packet_ns: Times
    """Times of arrival of data packets [ns], (P,)."""
    packets: NDArray[np.uint8]
    """(P, 1206)."""
    setup: SimulationSetup
    """What was simulated, to measure the walk with other sensors."""

    def error_m(self, found: Trajectory, offset_ns: int) -> float:
        """Largest horizontal distance from the truth [m], aligned at the first pose.

        Args:
            found: A trajectory whose frame is that of the LiDAR.
            offset_ns: Its times minus UTC [ns].
        """
        t_ns = found.t_ns - offset_ns
        rows = (t_ns >= self.truth.t_ns[0]) & (t_ns <= self.truth.t_ns[-1])
        true, made = self.truth.at(t_ns[rows]), found.T_a_b[rows]
        off = (true[0].inverse() @ true).t - (made[0].inverse() @ made).t
        return float(np.hypot(off[:, 0], off[:, 1]).max())


def record_walk(folder: Path, *, seconds: float = 5.0) -> RecordedWalk:
    """Simulate the walk; its files stay in the folder.

    Args:
        folder: A new folder.
        seconds: Length of what is kept [s].
    """
    setup = prepare("office", seconds=max(5.0, seconds), seed=3, rig=load_rig("single-vlp16"))
    simulate(setup, folder, bag=False, progress=Silent())
    capture = folder / "recording.pcap"
    sources = Sources((capture,), setup.rig, folder / "imu.csv", None)
    ingest(sources, folder / "frames", settings=IngestSettings(), progress=Silent())
    store = FrameStore.open(folder / "frames")
    clouds = [
        Cloud(f.t_ns, f.dt_ns.astype(np.int64), np.array(f.xyz), np.array(f.intensity), f.ring)
        for f in (store[k] for k in range(min(len(store), round(10 * seconds))))
    ]
    assert store.imu is not None
    end_ns = clouds[-1].t_ns + TURN_NS
    packet_ns, packets = _packets(capture)
    imu, early = store.imu, packet_ns < end_ns
    kept = imu.t_ns < end_ns
    return RecordedWalk(
        clouds,
        ImuSamples(imu.t_ns[kept], imu.gyro_rad_s[kept], imu.accel_m_s2[kept]),
        read_tum(folder / "truth.tum"),
        packet_ns[early],
        packets[early],
        setup,
    )


def _packets(capture: Path) -> tuple[Times, NDArray[np.uint8]]:
    times, payloads = [], []
    for part in read_pcap(capture, ImportReport()):
        rows = np.flatnonzero(part.length == 1206)
        times.append(part.t_ns[rows])
        payloads.append(part.buffer[part.start[rows, None] + np.arange(1206)])
    return np.concatenate(times), np.concatenate(payloads)


def turned(values: Array, R: Array) -> Array:
    """Vectors of one frame in another, (N, 3)."""
    return np.asarray(values @ R.T)
