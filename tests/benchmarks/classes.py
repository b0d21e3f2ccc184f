"""Classes of points on simulated walks, against the true cause of each point, and what they change.

    python -m tests.benchmarks.classes [SCENE[:VARIANT] ...] [--seed 11] [--work FOLDER]
        [--lidar MODEL] [--estimated]

The carrier returns beams. Points are placed by the true poses, so the figures are those of the
stages `classes` and `map` alone: how many points of each cause are kept or left out, and the mean
distance of the delivered points from the true surfaces, without classes and with them.
``--estimated``: the packets of the walk are mapped, and multiframes, poses and mirrors are those
of the whole program; no distances, for which there is `tests.benchmarks.delivered`. ``--lidar``:
one LiDAR in place of two VLP-16.
"""

from __future__ import annotations

import argparse
import shutil
import tempfile
import time
from collections.abc import Sequence
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np

from recon4.classes.stage import classify, write_classes
from recon4.evaluation.table import text_table
from recon4.geometry.raycast import Scene
from recon4.geometry.se3 import SE3
from recon4.mapping.build import MapInputs, build_map
from recon4.mapping.mirrors import Mirror, Sight, find_mirrors, load_mirrors
from recon4.mapping.small_mirrors import find_small_mirrors
from recon4.mapping.undistort import place_with_origins
from recon4.model.classes import PointClass
from recon4.model.rig import Rig, load_rig
from recon4.model.trajectory import Trajectory
from recon4.progress import Silent
from recon4.recording.formats.poses import read_tum
from recon4.settings import MapSettings
from recon4.simulation.crowd import ALONE, Crowd
from recon4.simulation.degradation import PEOPLE, VEHICLES
from recon4.simulation.frames import simulate_frames
from recon4.simulation.lidar import LidarModel
from recon4.simulation.setup import Models, SimulationSetup, prepare, rig_of_lidars
from recon4.simulation.simulate import record
from recon4.store.arrays import load_trajectory
from recon4.store.classes import StoredClasses
from recon4.store.frames import FrameStore
from tests.benchmarks.causes import Cause, causes
from tests.benchmarks.proving_ground import map_walk


@dataclass(frozen=True, slots=True)
class WalkScene:
    """A walk in a world."""

    world: str
    seconds: float
    crowd: Crowd = ALONE
    tilt_deg: float = 0.0
    """The first LiDAR looks down ahead by this angle."""
    lidar: str = ""
    """Its model, if there is only one."""


SCENES = {
    "office": WalkScene("office", 20.0),
    "staircase": WalkScene("staircase", 25.0),
    "corridor": WalkScene("corridor", 20.0),
    "tunnel": WalkScene("tunnel", 20.0),
    "people": WalkScene("office", 20.0, Crowd(people=2)),
    "cars": WalkScene("street", 20.0, Crowd(people=1, vehicles=2)),
    "mirrors": WalkScene("mirrors", 16.0),
    "showroom": WalkScene("showroom", 20.0, Crowd(people=2, vehicles=2), tilt_deg=25.0),
}
EVERY = 4
"""One of this many points of a map is measured."""


def main() -> None:
    """Run the scenes and print their tables."""
    parser = argparse.ArgumentParser()
    parser.add_argument("scenes", nargs="*", default=list(SCENES))
    parser.add_argument("--seed", type=int, default=11)
    parser.add_argument("--work", type=Path)
    parser.add_argument("--lidar", default="")
    parser.add_argument("--estimated", action="store_true", help="poses of the whole program")
    a = parser.parse_args()
    tables = estimated_figures if a.estimated else figures
    with tempfile.TemporaryDirectory() as folder:
        for name in a.scenes:
            scene = scene_of(name, a.lidar)
            print(f"\n{name}\n{tables(scene, a.work or Path(folder), seed=a.seed)}", flush=True)


def scene_of(name: str, lidar: str) -> WalkScene:
    """The scene of a name, in a variant of its world behind a colon."""
    kind, colon, variant = name.partition(":")
    scene = SCENES[kind]
    return replace(scene, world=scene.world + colon + variant, lidar=lidar)


def figures(scene: WalkScene, work: Path, *, seed: int) -> str:
    """The tables of a scene by true poses; its walk is kept in the folder for the next run."""
    setup, folder = walk_of(scene, seed), work / folder_name(scene, seed)
    if not folder.exists():
        folder.mkdir(parents=True)
        simulate_frames(setup, folder)
    frames, truth = FrameStore.open(folder), read_tum(folder / "truth.tum")
    stored, cost = classified(frames, truth, mirrors_of(frames, truth), work)
    found = by_cause(frames, truth, stored, setup=setup)
    maps = [
        map_figures(label, frames, truth, work, classes=given, world=setup.surroundings.scene)
        for label, given in (("without", None), ("with", stored))
    ]
    head = ("", "points", "mean cm", "median cm", "> 10 cm %", "> 50 cm %")
    return f"{found}\n{cost}\n\n{text_table(head, maps)}"


def estimated_figures(scene: WalkScene, work: Path, *, seed: int) -> str:
    """The table of a scene whose packets the whole program maps; walk and project are kept."""
    setup, name = walk_of(scene, seed), folder_name(scene, seed)
    recording = work / f"{name}-packets"
    if not recording.exists():
        crowd = scene.crowd
        beside = {PEOPLE: crowd.people, VEHICLES: crowd.vehicles}
        values = {kind: float(number) for kind, number in beside.items() if number}
        record(setup, {recording: values}, bag=False, progress=Silent())
    runs, _ = map_walk(recording, work / f"{name}-project", audited=False)
    level = runs["level"].artifact.folder
    frames, truth = FrameStore.open(runs["frames"].artifact.folder), recording / "truth.tum"
    mirrors = load_mirrors(level / "mirrors.npz")
    stored, cost = classified(frames, load_trajectory(level / "trajectory.npz"), mirrors, work)
    return f"{by_cause(frames, read_tum(truth), stored, setup=setup)}\n{cost}"


def folder_name(scene: WalkScene, seed: int) -> str:
    """Of a walk and its map; no scene shares it with another."""
    crowd, world = scene.crowd, scene.world.replace(":", "-")
    return f"{world}-{crowd.people}-{crowd.vehicles}{scene.lidar}-{seed}"


def walk_of(scene: WalkScene, seed: int) -> SimulationSetup:
    """The walk of a scene."""
    rig = rig_of_lidars([scene.lidar]) if scene.lidar else load_rig("4recon")
    return prepare(
        scene.world,
        seconds=scene.seconds,
        seed=seed,
        rig=tilted(rig, scene.tilt_deg),
        models=Models(lidar=replace(LidarModel(), carrier_returns=True)),
        crowd=scene.crowd,
    )


def classified(
    frames: FrameStore, trajectory: Trajectory, mirrors: Sequence[Mirror], work: Path
) -> tuple[StoredClasses, str]:
    """The classes of a walk, and what they cost."""
    classes = work / "classes"
    shutil.rmtree(classes, ignore_errors=True)
    classes.mkdir()
    begun = time.process_time()
    write_classes(classify(frames, trajectory, mirrors=mirrors), classes)
    ms = 1e3 * (time.process_time() - begun) / len(frames)
    size = (classes / "classes.zst").stat().st_size / frames.points
    cost = f"{ms:.1f} ms of CPU a multiframe, {size:.3f} bytes a point"
    return StoredClasses.open(classes), cost


def tilted(rig: Rig, tilt_deg: float) -> Rig:
    """The rig with its first LiDAR turned about the body's y axis, so that it looks down ahead."""
    first = rig.sensors[0]
    turn = SE3.from_rpy(0.0, float(np.deg2rad(tilt_deg)), 0.0, t=[0.0] * 3).R
    mount = SE3(turn @ first.T_body_sensor.R, first.T_body_sensor.t)
    return replace(rig, sensors=(replace(first, T_body_sensor=mount), *rig.sensors[1:]))


def mirrors_of(frames: FrameStore, truth: Trajectory) -> list[Mirror]:
    """Mirrors in a sample of the walk, as the stage `level` finds them."""
    placed = []
    for k in range(0, len(frames), 1 + len(frames) // 60):
        frame = frames[k]
        frame = frame.take(slice(None, None, 1 + len(frame) // 6000))
        placed.append(place_with_origins(frame, truth, frames.rig))
    points = np.concatenate([one.xyz_m for one in placed])
    sight = Sight(points, np.concatenate([one.origin_m for one in placed]))
    large = find_mirrors(sight)
    return [*large, *find_small_mirrors(sight, large)]


def by_cause(
    frames: FrameStore, truth: Trajectory, stored: StoredClasses, *, setup: SimulationSetup
) -> str:
    """How many points of each cause are left out, and how many have the class of their cause."""
    counts = np.zeros((len(Cause), 256), np.int64)
    for k in range(0, len(frames), 2):
        frame = frames[k]
        placed = place_with_origins(frame, truth, frames.rig)
        t_ns = frame.t_ns + frame.dt_ns.astype(np.int64)
        cause = causes(setup, placed.xyz_m, placed.origin_m, t_ns=t_ns)
        np.add.at(counts, (cause, stored.of(k, len(frame))), 1)
    rows = []
    for cause in Cause:
        of, every = counts[cause], int(counts[cause].sum())
        if every:
            columns = (PointClass.MOVING, PointClass.CARRIER, PointClass.REFLECTION)
            parts = [f"{100 * of[one] / every:.2f}" for one in columns]
            kept = f"{100 * of[PointClass.UNCLASSIFIED] / every:.3f}"
            of_all = f"{100 * every / counts.sum():.3f}"
            rows.append((cause.name.lower(), of_all, kept, *parts))
    head = ("cause", "of all %", "kept %", "moving %", "carrier %", "reflection %")
    return text_table(head, rows)


def map_figures(
    label: str,
    frames: FrameStore,
    truth: Trajectory,
    work: Path,
    *,
    classes: StoredClasses | None,
    world: Scene,
) -> tuple[str, ...]:
    """Distances of the delivered points of a map from the true surfaces."""
    out = work / "map"
    shutil.rmtree(out, ignore_errors=True)
    out.mkdir()
    tiles = build_map(MapInputs(frames, truth, classes=classes), out, settings=MapSettings())
    away = np.concatenate([world.distance(tile.xyz_m()[::EVERY]) for tile in tiles])
    shown = (100 * away.mean(), 100 * np.median(away))
    far = (100 * (away > limit_m).mean() for limit_m in (0.1, 0.5))
    return (
        label,
        f"{len(tiles)}",
        *(f"{one:.3f}" for one in shown),
        *(f"{one:.4f}" for one in far),
    )


if __name__ == "__main__":
    main()
