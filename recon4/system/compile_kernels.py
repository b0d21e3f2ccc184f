"""Compile the kernels once after an installation, for every later process.

Numba's cache is code that the next process loads, so a confined process must not write it: what it
compiles itself is lost with it. `compile_kernels` does each kind of work on short simulated walks,
outside any confinement, before a process reads a file of a user.
"""

from __future__ import annotations

import os
import tempfile
from pathlib import Path

import numpy as np

from recon4.live.mapper.live_map import LiveMap
from recon4.mapping.tiles import TileSet
from recon4.pipeline import process
from recon4.progress import Progress, Silent, track
from recon4.recording.sources import Sources
from recon4.registration.odometry import Odometry
from recon4.sandbox.private_cache import is_compiled, mark_compiled
from recon4.settings import override, preset
from recon4.settings.reads import OdometryReads, part_of
from recon4.simulation.backpack import measured_seconds, prepare_backpack, simulate_backpack
from recon4.simulation.setup import prepare
from recon4.simulation.simulate import simulate
from recon4.slam2d.correlative import LikelihoodField
from recon4.slam2d.occupancy import OccupancyGrid, crossing_ratio
from recon4.slices.doubles import find_double_walls
from recon4.slices.points import extent
from recon4.slices.slice_image import RasterGrid, draw
from recon4.slices.slice_plane import SlicePlane
from recon4.store.frames import FrameStore
from recon4.store.locks import open_lock_file, wait_for_lock
from recon4.store.project import read_artifacts
from recon4.system.compile_packets import compile_packets
from recon4.system.runtime_folder import runtime_folder
from recon4.system.tuning import COMPILING

_FEW = ["map.voxel_m=0.1", "graph.node_stride=10"]


def compile_kernels(progress: Progress) -> bool:
    """Compile all kernels, unless they are compiled; a second process waits for the first.

    Args:
        progress: Receives each kind of work.

    Returns:
        Whether there was anything to compile.

    Raises:
        StoreError: If there is no place for the walks.
    """
    lock = open_lock_file(runtime_folder() / "compiling.lock")
    try:
        wait_for_lock(lock)
        if is_compiled():
            return False
        with tempfile.TemporaryDirectory(prefix="recon4-compile-") as folder:
            for work in track((_lidars, _backpack), progress, what="Compile", unit=""):
                work(Path(folder))
        mark_compiled()
        return True
    finally:
        os.close(lock)


def _lidars(folder: Path) -> None:
    """Packets, a map of LiDARs, its slices, a live map, and odometry without an IMU."""
    compile_packets()
    walk, project = folder / "walk", folder / "map"
    simulate(
        prepare("office", seconds=COMPILING.lidar_s, seed=1), walk, bag=False, progress=Silent()
    )
    sources = Sources((walk / "recording.pcap",), None, walk / "imu.csv", None)
    process(sources, project, settings=override(preset("indoor"), _FEW))
    made = read_artifacts(project)
    tiles = TileSet.open(made["map"])
    find_double_walls(tiles)
    plane = SlicePlane.horizontal(1.0)
    paper = RasterGrid(extent(tiles, plane), COMPILING.pixel_m)
    draw(tiles, plane, paper, color="height")
    draw(tiles, plane, paper, color="sensor")
    store = FrameStore.open(made["frames"])
    frames = list(store)[: COMPILING.frames]
    settings = preset("indoor")
    live = LiveMap(store.rig, settings)
    without_imu = Odometry(store.rig, part_of(settings, OdometryReads))
    if store.imu is not None:
        live.extend_imu(store.imu)
    for frame in frames:
        live.push(frame)
        without_imu.push(frame)


def _backpack(folder: Path) -> None:
    """A map of line scans; the loop closure of 2-D maps, which a walk of seconds has none of."""
    setup = prepare_backpack("hall", figure="circle", seconds=COMPILING.profiler_s, seed=3)
    simulate_backpack(setup, folder / "lines", progress=Silent())
    sources = Sources((folder / "lines" / "rosbag2",), setup.rig)
    process(sources, folder / "lines-map", settings=override(preset("indoor"), _FEW))
    scans = next(scans for _, scans in measured_seconds(setup) if scans is not None)
    points, at = scans.points(0), np.zeros(2)
    field = LikelihoodField.of(points)
    field.search(
        points, initial_pose=np.zeros(3), half_window_m=1.0, half_window_rad=0.1, min_score=0.5
    )
    grid = OccupancyGrid(0.1, 0.4, 0.6)
    grid.add_scan(points, at)
    crossing_ratio(grid, [(points, at)])
