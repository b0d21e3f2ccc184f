"""Compile the kernels once, before processes that run side by side would each do it.

``python -m tests.compile_kernels`` maps a short walk with each kind of rig, cuts slices of the map
and draws a live one; without effect when the kernels are compiled already. A confined process keeps
what it compiles for itself: each would compile again what is not compiled here.
"""

import tempfile
from pathlib import Path

from recon4.cli.main import main
from recon4.live.mapper.live_map import LiveMap
from recon4.mapping.tiles import TileSet
from recon4.pipeline import process
from recon4.progress import Silent
from recon4.recording.sources import Sources
from recon4.sandbox.private_cache import is_compiled, mark_compiled
from recon4.settings import preset
from recon4.simulation.backpack import prepare_backpack, simulate_backpack
from recon4.simulation.setup import prepare
from recon4.simulation.simulate import simulate
from recon4.slices.doubles import find_double_walls
from recon4.store.frames import FrameStore
from recon4.store.project import read_artifacts
from tests.planar_walks import ring_corridor, ring_walk, scanned, write_carmen

SECONDS = 5.0


def compile_kernels() -> None:
    """Simulate and process walks in a folder of its own."""
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        _lidars(folder / "lidars")
        _laser(folder / "laser")
        _profiler(folder / "profiler")
    mark_compiled()


def _lidars(folder: Path) -> None:
    """A map of LiDARs, its slices, and a live map."""
    folder.mkdir()
    office = prepare("office", seconds=SECONDS, seed=1)
    walk, project = folder / "walk", folder / "map"
    simulate(office, walk, bag=False, progress=Silent())
    process(Sources((walk / "recording.pcap",), None, walk / "imu.csv", None), project)
    made = read_artifacts(project)
    find_double_walls(TileSet.open(made["map"]))
    for image in ("slice.png", "slice.svg"):
        assert main(["slice", str(project), str(folder / image), "--z", "1.0"]) == 0
    store = FrameStore.open(made["frames"])
    live = LiveMap(store.rig, preset("indoor"))
    live.extend_imu(store.imu)
    for frame in list(store)[:20]:
        live.push(frame)


def _laser(folder: Path) -> None:
    """A 2-D map that closes a loop."""
    folder.mkdir()
    write_carmen(folder / "walk.log", scanned(ring_corridor(), ring_walk()).scans)
    process(Sources((folder / "walk.log",)), folder / "map")


def _profiler(folder: Path) -> None:
    """A map of a backpack with a profiler."""
    folder.mkdir()
    setup = prepare_backpack("hall", figure="circle", seconds=8.0, seed=3)
    simulate_backpack(setup, folder / "walk", progress=Silent())
    process(Sources((folder / "walk" / "rosbag2",), setup.rig), folder / "map")


if __name__ == "__main__" and not is_compiled():
    compile_kernels()
