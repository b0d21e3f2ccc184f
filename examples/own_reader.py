"""Map a format that recon4 does not know: write what it does know.

A folder with one PCD file a revolution is enough. The file name is the time in nanoseconds. Each
point has x, y, z in meters, `intensity`, `ring` (0 = lowest beam) and `t`, its time in seconds
after that of the file. Samples of an IMU, if there is one, go into a CSV file.
"""

from collections.abc import Iterator
from pathlib import Path

import numpy as np

from recon4 import api

START_NS, TURN_NS = 1_700_000_000_000_000_000, 100_000_000
POINT = np.dtype([*((name, "<f4") for name in ("x", "y", "z", "intensity", "t")), ("ring", "<u2")])
HEADER = """VERSION 0.7
FIELDS x y z intensity t ring
SIZE 4 4 4 4 4 2
TYPE F F F F F U
COUNT 1 1 1 1 1 1
WIDTH {count}
HEIGHT 1
POINTS {count}
DATA binary
"""


def my_lidar() -> Iterator[tuple[int, np.ndarray]]:
    """Stand-in for your format: 30 revolutions of a LiDAR that moves through a room at 1 m/s."""
    azimuth, ring = (grid.ravel() for grid in np.mgrid[0.005 : 2 * np.pi : 0.01, 0:16])
    rays = np.stack([np.cos(azimuth), np.sin(azimuth), np.tan(np.deg2rad(2 * ring - 15))]).T
    for revolution in range(30):
        points = np.zeros(len(rays), POINT)
        points["t"], points["ring"], points["intensity"] = azimuth / (20.0 * np.pi), ring, 100.0
        x_m = 0.1 * revolution + points["t"]
        place_m = np.stack([x_m - 1.0, 0.3 * x_m, 0.0 * x_m]).T  # in a room of 12 x 9 x 2.4 m
        to_walls = (np.sign(rays) * [6.0, 4.5, 1.2] - place_m) / rays
        points["x"], points["y"], points["z"] = (rays * to_walls.min(axis=1, keepdims=True)).T
        yield START_NS + TURN_NS * revolution, points


def my_imu() -> Iterator[tuple[int, np.ndarray]]:
    """Stand-in for an IMU at the LiDAR: rad/s and m/s², at rest z points up with 9.8."""
    random = np.random.default_rng(1)
    for t_ns in range(START_NS - TURN_NS, START_NS + 31 * TURN_NS, 5_000_000):
        yield t_ns, np.array([0, 0, 0, 0, 0, 9.81]) + random.normal(0.0, 0.005, 6)


def main() -> None:
    """Write the files, then map them."""
    frames, imu = Path("frames"), Path("imu.csv")
    frames.mkdir(exist_ok=True)
    for t_ns, points in my_lidar():
        header = HEADER.format(count=len(points)).encode()
        (frames / f"{t_ns}.pcd").write_bytes(header + points.tobytes())
    rows = (f"{t_ns},{','.join(map(str, values))}\n" for t_ns, values in my_imu())
    imu.write_text("t_ns,gx_rad_s,gy_rad_s,gz_rad_s,ax_m_s2,ay_m_s2,az_m_s2\n" + "".join(rows))

    sources = api.Sources.of(frames, imu=imu)
    project = api.process(sources, "own_format", settings={"map.voxel_m": 0.05})
    moved_m = np.linalg.norm(project.trajectory.T_a_b.t[-1] - project.trajectory.T_a_b.t[0])
    print(f"the LiDAR moved {moved_m:.2f} m, {project.summary.points} points in the map")
    print(
        f"verdict: {project.summary.verdict.usability}",
        *project.summary.verdict.reasons,
        sep="\n  ",
    )


if __name__ == "__main__":
    main()
