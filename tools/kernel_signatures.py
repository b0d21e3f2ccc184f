"""Which types the kernels are called with: ``python -m tools.kernel_signatures`` writes them.

Short simulated walks do each kind of work with an empty cache, and the signatures that Numba
compiles meanwhile become `recon4/kernels/signatures.txt`, which `recon4 compile` compiles.
"""

from __future__ import annotations

import os
import subprocess
import sys
import tempfile
from pathlib import Path

import numpy as np
from numba import types
from numba.core import event

from recon4.classes.clusters import cells_of_class, connected, evidence
from recon4.comparison.m3c2 import differences
from recon4.comparison.records import M3C2Scales
from recon4.export.tuning import OCTREE
from recon4.geometry.se3 import SE3, Array
from recon4.kernels.octree import by_octant, first_of_cells
from recon4.kernels.signatures import SIGNATURES, kernel_name, spelled
from recon4.live.mapper.live_map import LiveMap
from recon4.mapping.carry import moved_points
from recon4.mapping.class_corrections import ClassVolumes
from recon4.mapping.mirrors import Mirror, Sight, Wall
from recon4.mapping.tiles import TileSet
from recon4.model.figures import MirrorFigures
from recon4.model.pose_graph import PoseGraph
from recon4.model.rig import Sensor
from recon4.pipeline import process
from recon4.pose_graph.alternative_paths import PathIndex
from recon4.pose_graph.files import load_graph
from recon4.progress import Silent
from recon4.recording.formats.datagrams import datagrams_of
from recon4.recording.packets.decoder import open_decoder
from recon4.recording.packets.family import Companion, PacketSensor
from recon4.recording.report import ImportReport
from recon4.recording.sources import Sources
from recon4.registration.odometry import Odometry
from recon4.registration.plane_map import PlaneMap
from recon4.registration.scan_registration import make_scan, overlay_plans
from recon4.settings import IngestSettings, override, preset
from recon4.settings.reads import OdometryReads, part_of
from recon4.simulation.backpack import measured_seconds, prepare_backpack, simulate_backpack
from recon4.simulation.families.families import family_of, pattern_of
from recon4.simulation.lidar import Firings, Lidar, LidarModel
from recon4.simulation.setup import prepare
from recon4.simulation.simulate import simulate
from recon4.slam2d.correlative import LikelihoodField
from recon4.slam2d.occupancy import OccupancyGrid, crossing_ratio
from recon4.slices.doubles import find_double_walls
from recon4.slices.points import extent
from recon4.slices.slice_image import RasterGrid, draw
from recon4.slices.slice_plane import SlicePlane
from recon4.store.frames import FrameStore
from recon4.store.project import read_artifacts

FEW = ["map.voxel_m=0.1"]
LIDAR_S, PROFILER_S = 5.0, 8.0
FRAMES = 20
PIXEL_M = 0.05
MODELS = ("VLP-16", "XT32", "OS0-32", "Mid-360")
"""One model for each decoder that people often need; the others compile when they are met."""
PACKETS = 20
START_NS = 1_700_000_000_000_000_000


class Compiled(event.Listener):
    """Remembers the kernels that Numba compiles, as lines of ``signatures.txt``."""

    def __init__(self) -> None:
        self.lines: set[str] = set()

    def on_start(self, event: event.Event) -> None:
        """A kernel with literal arguments is compiled with the one that calls it."""
        dispatcher, arguments = event.data["dispatcher"], event.data["args"]
        ours = dispatcher.py_func.__module__.startswith("recon4.kernels.")
        if ours and not any(isinstance(of, types.Literal) for of in arguments):
            text = ", ".join(spelled(of) for of in arguments)
            self.lines.add(f"{kernel_name(dispatcher)} of({text})")

    def on_end(self, event: event.Event) -> None:
        """Nothing."""


def main() -> None:
    """Write ``signatures.txt``: another process does, which finds no compiled kernel."""
    with tempfile.TemporaryDirectory() as cache:
        command = [sys.executable, "-c", "from tools.kernel_signatures import write; write()"]
        subprocess.run(command, env={**os.environ, "NUMBA_CACHE_DIR": cache}, check=True)


def write() -> None:
    """Write what is compiled by this process."""
    compiled = Compiled()
    with tempfile.TemporaryDirectory() as folder, event.install_listener("numba:compile", compiled):
        _lidars(Path(folder))
        _backpack(Path(folder))
    SIGNATURES.write_text("".join(f"{line}\n" for line in sorted(compiled.lines)), "ascii")


def _lidars(folder: Path) -> None:
    """Packets, a map of LiDARs, its slices, a live map, and odometry without an IMU."""
    _packets()
    walk, project = folder / "walk", folder / "map"
    simulate(prepare("office", seconds=LIDAR_S, seed=1), walk, bag=False, progress=Silent())
    sources = Sources((walk / "recording.pcap",), None, walk / "imu.csv", None)
    process(sources, project, settings=override(preset("indoor"), FEW))
    made = read_artifacts(project)
    tiles = TileSet.open(made["map"])
    find_double_walls(tiles)
    _things(tiles)
    _octree()
    list(differences(tiles, tiles, SE3.identity(), scales=M3C2Scales()))
    plane = SlicePlane.horizontal(1.0)
    paper = RasterGrid(extent(tiles, plane), PIXEL_M)
    draw(tiles, plane, paper, color="height")
    draw(tiles, plane, paper, color="sensor")
    store = FrameStore.open(made["frames"])
    frames = list(store)[:FRAMES]
    settings = preset("indoor")
    live = LiveMap(store.rig, settings)
    without_imu = Odometry(store.rig, part_of(settings, OdometryReads))
    if store.imu is not None:
        live.extend_imu(store.imu)
    for frame in frames:
        live.push(frame)
        without_imu.push(frame)
    _longer_walk(frames[0].xyz.astype(np.float64), load_graph(made["graph"]))
    _carried_and_mirrored()


def _longer_walk(p: Array, graph: PoseGraph) -> None:
    """What walks of seconds lack: places left behind, loops that are searched and rejected."""
    planes = PlaneMap()
    planes.add(p)
    planes.forget_beyond(1.0, np.zeros(3))
    overlay_plans(make_scan(p), make_scan(p), count=1, height_m=0.0)
    paths = PathIndex.build(graph.relations, nodes=len(graph), max_edges=3)
    paths.remove([0])


def _carried_and_mirrored() -> None:
    """What an office before any decision lacks: points carried along, a mirror that is found."""
    p, moves = np.zeros((1, 3)), SE3(np.eye(3)[None], np.zeros((1, 3)))
    moved_points(p.astype(np.float32), np.zeros(1, np.uint32), moves, origin_m=p[0])
    figures = MirrorFigures(area_m2=1.0, middle_m=(0.0, 0.0), behind=0.0)
    mirror = Mirror(Wall(np.array([1.0, 0.0, 0.0]), 1.0), np.zeros((1, 2), np.int64), figures)
    mirror.reflects(Sight(p, p))


def _backpack(folder: Path) -> None:
    """A map of line scans; the loop closure of 2-D maps, which a walk of seconds has none of."""
    setup = prepare_backpack("hall", figure="circle", seconds=PROFILER_S, seed=3)
    simulate_backpack(setup, folder / "lines", progress=Silent())
    sources = Sources((folder / "lines" / "rosbag2",), setup.rig)
    process(sources, folder / "lines-map", settings=override(preset("indoor"), FEW))
    scans = next(scans for _, scans in measured_seconds(setup) if scans is not None)
    points, at = scans.points(0), np.zeros(2)
    field = LikelihoodField.of(points)
    field.search(
        points, initial_pose=np.zeros(3), half_window_m=1.0, half_window_rad=0.1, min_score=0.5
    )
    grid = OccupancyGrid(0.1, 0.4, 0.6)
    grid.add_scan(points, at)
    crossing_ratio(grid, [(points, at)])


def _things(tiles: TileSet) -> None:
    """Clusters of the points of the first class that there is."""
    code = next(iter(tiles.class_counts()))
    cells = cells_of_class(tiles, code, ClassVolumes(()))
    evidence(tiles, cells, connected(cells.key))


def _octree() -> None:
    """What COPC of more points than this map has calls."""
    rows, marks = np.arange(2, dtype=np.int32), np.zeros(2, np.bool_)
    steps = np.zeros((3, 2), np.int32)
    first_of_cells(steps, rows, 0, OCTREE.side_bits, marks)
    by_octant(steps, rows, OCTREE.side_bits - 1, marks, rows.copy())


def _packets() -> None:
    """Decode a few packets of each of `MODELS`."""
    for model in MODELS:
        _decode(Sensor(name="lidar", model=model, T_body_sensor=SE3.identity()))


def _decode(sensor: Sensor) -> None:
    pattern, family = pattern_of(sensor.model), family_of(sensor.model)
    lidar = Lidar.drawn(sensor, pattern, model=LidarModel.perfect(), rng=np.random.default_rng(1))
    start_ns = pattern.packet_ns * np.arange(PACKETS, dtype=np.int64)
    t_ns = start_ns[:, None, None] + pattern.offset_ns
    nothing = np.zeros(t_ns.shape, np.uint8)
    turn = np.asarray(2.0 * np.pi * lidar.turn_rate_hz * 1e-9 * t_ns, np.float64)
    firings = Firings(t_ns, turn, nothing.astype(np.uint32), nothing, nothing)
    payloads = family.data_packets(lidar, firings, START_NS + start_ns)
    of = PacketSensor(
        row=0,
        sensor=sensor,
        head=datagrams_of((START_NS + start_ns).tolist(), [one.tobytes() for one in payloads]),
        companions=[Companion(*one) for one in family.companions(lidar).items()],
        settings=IngestSettings(),
        report=ImportReport(),
    )
    decoder = open_decoder(of)
    decoder.push(START_NS + start_ns, payloads)
    decoder.flush()


if __name__ == "__main__":
    main()
