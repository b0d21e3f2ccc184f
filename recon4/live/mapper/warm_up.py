"""Loads the compiled kernels of the mapping before the first measurement."""

from __future__ import annotations

import numpy as np

from recon4.live.mapper.live_map import LiveMap
from recon4.live.mapper.scan_map import ScanMap
from recon4.model.laser_scans import LaserScans
from recon4.model.multiframe import Multiframe
from recon4.model.rig import Rig
from recon4.model.samples import ImuSamples
from recon4.settings import Settings
from recon4.units import STANDARD_GRAVITY_M_S2


def warm_up(rig: Rig, settings: Settings) -> None:
    """Map synthetic measurements, so that real ones are not delayed."""
    if rig.row_of("laser2d") is None:
        _warm_up_lidars(rig, settings)
    else:
        _warm_up_scans(rig, settings)


def _warm_up_scans(rig: Rig, settings: Settings) -> None:
    """A laser in a square room of 6 m."""
    scan_map = ScanMap(rig, settings)
    angles = np.linspace(-np.pi, np.pi, 361)
    ranges = 3.0 / np.maximum(np.abs(np.cos(angles)), np.abs(np.sin(angles)))
    for k in range(4):
        t_ns = (20 + 10 * k) * 100_000_000  # late enough for a summary
        scan_map.extend_imu(_still(t_ns, rig))
        scan = LaserScans.of_rows(
            np.array([t_ns + 20_000_000], np.int64),
            ranges[None].astype(np.float32),
            angles=(-np.pi, float(angles[1] - angles[0])),
            range_max_m=30.0,
        )
        scan_map.push(scan)


def _still(t_ns: int, rig: Rig) -> ImuSamples:
    """Samples of 0.1 s of an IMU at rest."""
    imu_ns = t_ns + 10_000_000 * np.arange(11, dtype=np.int64)
    up = np.array([0.0, 0.0, STANDARD_GRAVITY_M_S2]) @ rig.T_body_imu.R
    return ImuSamples(imu_ns, np.zeros((11, 3)), np.tile(up, (11, 1)))


def _warm_up_lidars(rig: Rig, settings: Settings) -> None:
    """Three multiframes in a room."""
    live_map = LiveMap(rig, settings)
    rng = np.random.default_rng(0)
    ring, step = np.meshgrid(np.arange(16), np.arange(900))
    azimuth, elevation = step.ravel() * 2 * np.pi / 900, np.deg2rad(2.0 * ring.ravel() - 15)
    ray = np.stack([np.cos(azimuth), np.sin(azimuth), np.tan(elevation)], axis=1)
    reach_m = 3.0 / np.abs(ray).max(axis=1, keepdims=True) + rng.normal(0, 0.01, (len(ray), 1))
    count = len(ray)
    for k in range(3):
        t_ns = (20 + k) * 100_000_000  # late enough for a summary
        imu_ns = t_ns + 10_000_000 * np.arange(11, dtype=np.int64)
        accel = np.tile([0.0, 0.0, STANDARD_GRAVITY_M_S2], (11, 1))
        live_map.extend_imu(ImuSamples(imu_ns, np.zeros((11, 3)), accel))
        frame = Multiframe(
            frame_id=k,
            t_ns=t_ns,
            duration_ns=100_000_000,
            xyz=(ray * reach_m).astype(np.float32),
            intensity=np.full(count, 30, np.uint16),
            ring=ring.ravel().astype(np.uint8),
            sensor=np.zeros(count, np.uint8),
            echo=np.zeros(count, np.uint8),
            dt_ns=np.sort(rng.integers(0, 100_000_000, count)).astype(np.int32),
        )
        live_map.push(frame)
