"""Samples, markers and parameters as text files."""

from __future__ import annotations

from collections.abc import Iterable
from pathlib import Path

import numpy as np

from recon4.model.samples import GnssSamples, ImuSamples
from recon4.simulation.gnss import geodetic
from recon4.simulation.world import World

IMU_HEADER = "t_ns,gx_rad_s,gy_rad_s,gz_rad_s,ax_m_s2,ay_m_s2,az_m_s2"
GNSS_HEADER = (
    "t_ns,lat_deg,lon_deg,ellipsoidal_height_m,sd_e_m,sd_n_m,sd_u_m,quality,"
    "roll_deg,pitch_deg,heading_deg"
)
MARKER_HEADER = "id,x_m,y_m,z_m,lat_deg,lon_deg,height_m"


def write_imu(path: Path, samples: ImuSamples) -> None:
    """Write IMU samples as CSV."""
    rows = np.hstack([samples.gyro_rad_s, samples.accel_m_s2])
    lines = (
        f"{t}," + ",".join(f"{value:.9f}" for value in row)
        for t, row in zip(samples.t_ns, rows, strict=True)
    )
    _write(path, IMU_HEADER, lines)


def write_gnss(path: Path, samples: GnssSamples) -> None:
    """Write GNSS samples as CSV; degrees with 11 decimals are 1 µm."""
    lat, lon = np.rad2deg(samples.lat_rad), np.rad2deg(samples.lon_rad)
    rpy = np.rad2deg(samples.rpy_ned_rad)
    lines = (
        f"{samples.t_ns[k]},{lat[k]:.11f},{lon[k]:.11f},{samples.height_m[k]:.5f},"
        + ",".join(f"{value:.4f}" for value in samples.sd_enu_m[k])
        + f",{samples.quality[k]},"
        + ",".join(f"{value:.5f}" for value in rpy[k])
        for k in range(len(samples))
    )
    _write(path, GNSS_HEADER, lines)


def write_markers(path: Path, world: World) -> None:
    """Write the survey markers, in the map and on the earth."""
    p_map = np.array([[m.x_m, m.y_m, m.z_m] for m in world.markers]).reshape(-1, 3)
    lat_rad, lon_rad, height_m = geodetic(p_map, world.origin)
    lines = (
        f"{marker.name},{marker.x_m:.4f},{marker.y_m:.4f},{marker.z_m:.4f},"
        f"{np.rad2deg(lat_rad[k]):.11f},{np.rad2deg(lon_rad[k]):.11f},{height_m[k]:.4f}"
        for k, marker in enumerate(world.markers)
    )
    _write(path, MARKER_HEADER, lines)


def _write(path: Path, header: str, lines: Iterable[str]) -> None:
    with path.open("w", encoding="ascii") as file:
        file.write(header + "\n")
        for line in lines:
            file.write(line + "\n")
