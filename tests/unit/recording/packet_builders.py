"""Packets of a sensor that spins in front of a smooth wall. Deterministic."""

from __future__ import annotations

import numpy as np

from recon4.geometry.se3 import SE3
from recon4.model.rig import Rig, Sensor
from recon4.recording.packets.decoder import open_decoder
from recon4.recording.packets.family import PacketSensor
from recon4.recording.packets.velodyne.encode import PacketBlocks, encode_packets
from recon4.recording.packets.velodyne.models import DUAL, MODELS, STRONGEST
from recon4.recording.report import ImportReport
from recon4.settings import IngestSettings

T0_NS = 1_700_000_000_000_000_000
"""A time 13 min 20 s past an hour."""
LATENCY_NS = 1_500_000
"""From the first shot of a packet to its arrival."""
WIDE = IngestSettings(min_range_m=0.0, max_range_m=200.0)


def spin(
    count: int,
    *,
    model: str = "VLP-16",
    hz: float = 10.0,
    return_mode: int = STRONGEST,
    t0_ns: int = T0_NS,
    clock_off_ns: int = 0,
) -> tuple[np.ndarray, np.ndarray]:
    """Arrival times and data packets; ``clock_off_ns`` is sensor's minus recorder's clock."""
    table = MODELS[model]
    t_ns = t0_ns + (np.arange(count) * table.packet_s(return_mode) * 1e9).astype(np.int64)
    block = np.arange(12) // (2 if return_mode == DUAL else 1)
    since_s = (t_ns - t0_ns)[:, None] / 1e9 + block * table.block_s
    azimuth = np.rint(since_s * hz * 36000).astype(np.int64)
    channel = np.arange(32)
    distance = 4000 + (azimuth[:, :, None] // 7 + 31 * channel) % 2000
    payloads = encode_packets(
        (t_ns + clock_off_ns) // 1000,
        PacketBlocks(
            azimuth,
            distance,
            (channel * 7 + np.arange(12)[:, None]) % 256 + np.zeros((count, 1, 1), dtype=int),
        ),
        model=table,
        return_mode=return_mode,
    )
    return t_ns + LATENCY_NS, payloads


def sensor(name: str = "lidar", model: str = "VLP-16", **fields: object) -> Sensor:
    return Sensor(name=name, model=model, T_body_sensor=SE3.identity(), **fields)


def rig(*sensors: Sensor) -> Rig:
    return Rig(
        name="test",
        sensors=sensors,
        T_body_imu=SE3.identity(),
        imu_time_offset_s=0.0,
        p_body_antenna=np.zeros(3),
        gnss_time_offset_s=0.0,
    )


def decode_all(
    t_ns: np.ndarray,
    payloads: np.ndarray,
    *,
    model: str = "VLP-16",
    settings: IngestSettings = WIDE,
    batch: int = 97,
) -> tuple[dict[str, np.ndarray], ImportReport]:
    """Columns of all shots, pushed in batches, and what the report says."""
    report = ImportReport()
    decoder = open_decoder(
        PacketSensor(row=0, sensor=sensor(model=model), settings=settings, report=report)
    )
    parts = [
        decoder.push(t_ns[at : at + batch], payloads[at : at + batch])
        for at in range(0, len(t_ns), batch)
    ]
    parts.append(decoder.flush())
    names = ("t_ns", "xyz", "intensity", "ring", "echo")
    return {n: np.concatenate([getattr(p, n) for p in parts]) for n in names}, report
