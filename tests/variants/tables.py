"""Tables of IMU samples and positions, as people and their programs write them."""

from __future__ import annotations

from pathlib import Path

import numpy as np

from recon4.simulation.gnss import geodetic
from tests.line_tables import write_csv
from tests.variants.variant import Draw, Variant
from tests.variants.walk import RecordedWalk

_IMU = ("t_ns", "gx_rad_s", "gy_rad_s", "gz_rad_s", "ax_m_s2", "ay_m_s2", "az_m_s2")
_OTHER_NAMES = {
    "of EuRoC": (
        "#timestamp [ns]",
        *(f"w_RS_S_{axis} [rad s^-1]" for axis in "xyz"),
        *(f"a_RS_S_{axis} [m s^-2]" for axis in "xyz"),
    ),
    "of rostopic": (
        "%time",
        *(f"field.angular_velocity.{axis}" for axis in "xyz"),
        *(f"field.linear_acceleration.{axis}" for axis in "xyz"),
    ),
    "of a logger": ("timestamp", "gyro_x", "gyro_y", "gyro_z", "acc_x", "acc_y", "acc_z"),
}
_GNSS_NAMES = {"t_ns": "time", "lat_deg": "latitude", "lon_deg": "longitude"}


def write_tables(draw: Draw, walk: RecordedWalk, folder: Path, variant: Variant) -> None:
    """Draw and write tables beside a recording, with the columns of recon4 or with others.

    They hold the time of the points, so they are only drawn where it is UTC.
    """
    if draw.chance(0.7):
        _write_imu(draw, walk, folder, variant)
    if draw.chance(0.25):
        _write_gnss(draw, walk, folder, variant)


# -- IMU


def _write_imu(draw, walk, folder, variant):
    imu = walk.imu
    names = list(_IMU)
    gyro, accel = imu.gyro_rad_s, imu.accel_m_s2
    how = draw.one(*["", "another order"] * 4, "in g", "in degrees", *_OTHER_NAMES, "no header")
    if how:
        variant.say(f"IMU file {how}")
    if how == "in g":
        accel = accel / 9.80665
    elif how == "in degrees":
        gyro = np.rad2deg(gyro)
    elif how in _OTHER_NAMES:
        names = list(_OTHER_NAMES[how])
    columns = [imu.t_ns, *gyro.T, *accel.T]
    order = list(range(7))
    if how == "another order":
        draw.rng.shuffle(order)
    variant.imu = folder / "imu.csv"
    write_csv(variant.imu, {names[k]: columns[k] for k in order})
    variant.samples = len(imu) - 6
    lines = variant.imu.read_text().splitlines()
    if how == "no header":
        lines = lines[1:]
    if how in _OTHER_NAMES or how == "no header":
        variant.refusal, variant.remedies = f"IMU file {how}", ("expected header: t_ns",)
    _write_lines(draw, variant, variant.imu, lines, what="IMU", optional=names[4:])


def _write_lines(draw, variant, path, lines, *, what, optional):
    """Write the lines of a table as another program or a fault would."""
    how = draw.one(
        *("", "", "damaged lines", "decimal commas", "cut line", "columns left out"),
        *("a byte order mark", "carriage returns", "quoted cells", "tabs"),
    )
    if how:
        variant.say(f"{what} file with {how}")
    if how == "damaged lines":
        for k in draw.rows(len(lines) - 2, max(1, len(lines) // 200)):
            damaged = lines[k + 1].replace(".", "_")
            lines[k + 1] = draw.one("x", "1,2", "\0\0\0", damaged)
    elif how == "cut line":
        lines[-1] = lines[-1][:9]
    elif how == "columns left out":
        lines = _without(lines, optional)
    edited = {
        "decimal commas": lambda line: line.replace(",", ";").replace(".", ","),
        "tabs": lambda line: line.replace(",", "\t"),
        "quoted cells": lambda line: ",".join(f'"{cell}"' for cell in line.split(",")),
    }.get(how, str)
    end = "\r\n" if how == "carriage returns" else "\n"
    mark = "\ufeff" * (how == "a byte order mark")
    path.write_bytes((mark + end.join(map(edited, lines)) + end).encode())


def _without(lines, optional):
    header = lines[0].split(",")
    kept = [k for k, name in enumerate(header) if name not in optional]
    return [",".join(line.split(",")[k] for k in kept) for line in lines]


# -- positions


def _write_gnss(draw, walk, folder, variant):
    t_ns = np.arange(walk.clouds[0].t_ns, walk.clouds[-1].t_ns, 100_000_000)
    lat, lon, height = geodetic(walk.truth.at(t_ns).t, walk.setup.world.origin)
    columns = {"t_ns": t_ns, "lat_deg": np.rad2deg(lat), "lon_deg": np.rad2deg(lon)}
    stated = draw.one("ellipsoidal", "orthometric", "sum", "unstated", "none")
    if stated == "sum":
        columns |= {"orthometric_height_m": height - 44.2}
        columns |= {"geoid_separation_m": np.full(len(t_ns), 44.2)}
    elif stated != "none":
        columns[f"{stated}_height_m".removeprefix("unstated_")] = height
    columns |= {"sd_e_m": np.full(len(t_ns), 0.01), "sd_n_m": np.full(len(t_ns), 0.01)}
    columns |= {"sd_u_m": np.full(len(t_ns), 0.02), "quality": np.full(len(t_ns), 4)}
    variant.say(f"GNSS file, heights {stated}")
    other = draw.chance(0.2)
    if other:
        variant.say("GNSS file with other names")
        variant.refusal, variant.remedies = "GNSS columns", ("expected header: t_ns",)
        columns = {_GNSS_NAMES.get(name, name): column for name, column in columns.items()}
    variant.gnss = folder / "gnss.csv"
    write_csv(variant.gnss, columns)
    variant.fixes = len(t_ns) - 3
    lines = variant.gnss.read_text().splitlines()
    optional = [name for name in columns if name not in ("t_ns", "lat_deg", "lon_deg")]
    _write_lines(draw, variant, variant.gnss, lines, what="GNSS", optional=optional)
