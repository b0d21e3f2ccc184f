"""A small genuine project: a walk around a room, written by the real writers."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import numpy as np

from recon4.first_view.files import FIRST_FILES, write_first_files
from recon4.geometry.se3 import SE3
from recon4.mapping.map_notes import MapNotes
from recon4.mapping.sensor_paths import SensorPaths
from recon4.mapping.tile import FIELDS, STORED
from recon4.mapping.tile_writer import TileWriter
from recon4.mapping.tiles import TileSet
from recon4.model.classes import PointClass
from recon4.model.figures import FrameFigures, LevelFigures, MapFigures
from recon4.model.multiframe import Multiframe
from recon4.model.odometry_figures import OdometryFigures
from recon4.model.pose_graph import Edge, EdgeKind, PoseGraph, Reason, Verdict, known_history
from recon4.model.rig import Rig, Sensor
from recon4.model.site_control import SITE_GRID
from recon4.model.trajectory import Trajectory
from recon4.pose_graph.files import save_graph
from recon4.progress import Silent
from recon4.report.approval import draft_block
from recon4.review.approval import approve
from recon4.review.approved import Approval
from recon4.settings import Settings
from recon4.settings.reads import ReadsNothing
from recon4.slices.map_crs import LOCAL
from recon4.store.arrays import save_trajectory
from recon4.store.atomic import write_json
from recon4.store.frames import FrameWriter
from recon4.store.hashing import hash_file
from recon4.store.project import Project, read_artifacts
from recon4.store.seal import changing
from recon4.store.stage import Input, Stage, StageContext, StageRunner

ROOM_M = (16.0, 10.0, 3.0)
TILE_M = 10.0
BEGAN_NS = 1_700_000_000_000_000_000


REMARK = "the gyroscope has a bias"


class EarlierOdometry(OdometryFigures, frozen=True, kw_only=True):
    """Figures of an odometry that was made before findings were records."""

    warnings: tuple[str, ...] = ()


def build_project(
    root: Path,
    *,
    points: int = 60_000,
    with_map: bool = True,
    strays: int = 0,
    normals: bool = False,
    moved_m: float = 0.0,
    first: bool = False,
) -> None:
    """Make a finished project in an empty folder (or one that has come as far as odometry).

    The map has that many stray returns in the middle of each tile, beside its points, and normals
    of the room's walls if asked for. Its wall at the largest x may have been moved out. It may
    have the files that the page *Map* reads first. Built again in the same folder, it has an
    earlier map.
    """
    with Project.open(root) as project:
        project.describe(preset="indoor", rig="4RECON")
        runner = StageRunner(project, Settings(), Silent())
        walk = Input("walk", loop_walk())
        runner.run(Stage("odometry", 1, ReadsNothing, _odometry, EarlierOdometry), walk=walk)
        if not with_map:
            return
        runner.run(Stage("verification", 1, ReadsNothing, _verification), walk=walk)
        runner.run(Stage("level", 1, ReadsNothing, _level, LevelFigures), walk=walk)
        count = Input(f"points {points}", points)
        loose = Input(f"strays {strays}", strays)
        faces = Input(f"normals {normals}", normals)
        moved = Input(f"moved {moved_m}", moved_m) if moved_m else None
        runner.run(
            Stage("map", 1, ReadsNothing, _map, MapFigures),
            points=count,
            strays=loose,
            normals=faces,
            moved=moved,
            first=Input("first", value=True) if first else None,
        )
    (root / "trajectory.tum").write_text("0 0 0 0 0 0 0 1\n")
    (root / "report.html").write_text(
        "<!doctype html><title>Report</title><h1>Report</h1>" + draft_block()
    )
    figures = {
        "name": root.name,
        "created": "2023-11-14T22:13:20+00:00",
        "preset": "indoor",
        "rig": "4RECON",
        "crs": "",
        "versions": {"recon4": "0.2.0", "python": "3.11"},
        "stages": [_ran(name, at.name) for name, at in read_artifacts(root).items()],
        "path_length_m": 58.2,
        "points": points,
        "duration_s": 59.9,
        "multiframes": 600,
        "lost": 0,
        "edges": {"accepted": 108, "rejected": 8, "unverified": 6},
        "verdict": {"usability": "good", "reasons": [], "unobserved": []},
        "seconds": 41.5,
        "peak_bytes": 812_000_000,
    }
    write_summary(root, figures)


def approve_project(root: Path, key_file: Path, *, who: str = "Eva") -> Approval:
    """Sign what `build_project` made."""
    with changing(root, "summary.json", compared=False):
        summary = json.loads((root / "summary.json").read_text())
        artifacts = read_artifacts(root)
        summary |= {
            "name": root.name,
            "approval": None,
            "stages": [_ran(name, at.name) for name, at in artifacts.items()],
            "hashes": {
                "inputs": {},
                "results": {n: hash_file(root / n) for n in ("trajectory.tum", "report.html")},
            },
        }
        write_summary(root, summary)
    return approve(root, key_file, {"who": who, "role": "reviewer", "why": ""}, confirmed=False)


def _ran(stage: str, key: str) -> dict[str, object]:
    """A stage in a summary."""
    took = {"seconds": 1.0, "cpu_seconds": 1.0, "peak_bytes": 1_000_000, "reused": False}
    return {"stage": stage, "key": key, **took}


def write_summary(root: Path, summary: dict[str, object]) -> None:
    """The way a run writes it."""
    write_json(root / "summary.json", summary)


def add_multiframes(root: Path) -> None:
    """Give a project the multiframes of the walk: few points each, seen from where it was."""
    with Project.open(root) as project:
        runner = StageRunner(project, Settings(), Silent())
        runner.run(Stage("frames", 1, ReadsNothing, _frames, FrameFigures))


def loop_walk() -> Trajectory:
    """Two rounds through the room at 10 Hz, looking ahead."""
    s = np.linspace(0.0, 4.0 * np.pi, 600)
    t_m = np.stack([8.0 + 6.0 * np.cos(s), 5.0 + 3.0 * np.sin(s), 1.2 + 0.0 * s], axis=1)
    half = (s + np.pi / 2.0) / 2.0
    quat = np.stack([0.0 * s, 0.0 * s, np.sin(half), np.cos(half)], axis=1)
    t_ns = BEGAN_NS + np.arange(600, dtype=np.int64) * 100_000_000
    return Trajectory(t_ns, SE3.from_quat(quat, t_m))


def verified_graph(walk: Trajectory) -> PoseGraph:
    """A node every 10 poses; odometry, neighbors, loops of the two rounds, some rejected."""
    rows = np.arange(0, len(walk), 10)
    T, n = walk.T_a_b[rows], len(rows)
    pairs = [(k, k + 1, EdgeKind.ODOMETRY) for k in range(n - 1)]
    pairs += [(k, k + 3, EdgeKind.NEIGHBOR) for k in range(0, n - 3, 2)]
    pairs += [(k, k + n // 2, EdgeKind.LOOP) for k in range(n // 2)]
    pairs += [(k, n - 1 - k, EdgeKind.LOOP) for k in range(0, n // 3, 3)]
    edges = tuple(_edge(T, i, j, kind) for i, j, kind in pairs)
    return PoseGraph(rows.astype(np.int64), walk.t_ns[rows], T, edges)


def _edge(T: SE3, i: int, j: int, kind: EdgeKind) -> Edge:
    near = np.linalg.norm(T.t[i] - T.t[j]) < 2.0
    verdict, reason = Verdict.ACCEPTED, Reason.NONE
    if kind is EdgeKind.LOOP and not near:
        verdict = Verdict.REJECTED
        reason = Reason.VERIFICATION if i % 2 else Reason.OVERLAP
    elif kind is EdgeKind.LOOP and i % 7 == 0:
        verdict = Verdict.UNVERIFIED
    T_i_j = T[i].inverse() @ T[j]
    return Edge(
        i=i,
        j=j,
        T_i_j=T_i_j,
        kind=kind,
        overlap=0.7,
        judgments=known_history(verdict, reason),
    )


def room_points(rng: np.random.Generator, count: int) -> np.ndarray:
    """Points on floor, ceiling-high walls and a row of pillars [m], (N, 3)."""
    size = np.array(ROOM_M)
    p = rng.uniform(size=(count, 3)) * size
    face = rng.choice(5, size=count, p=[0.4, 0.15, 0.15, 0.15, 0.15])
    p[face == 0, 2] = 0.0
    p[face == 1, 0], p[face == 2, 0] = 0.0, size[0]
    p[face == 3, 1], p[face == 4, 1] = 0.0, size[1]
    pillar = rng.random(count) < 0.1
    angle = rng.uniform(0.0, 2.0 * np.pi, count)
    x = rng.choice([4.0, 8.0, 12.0], count)
    p[pillar, 0] = (x + 0.3 * np.cos(angle))[pillar]
    p[pillar, 1] = (5.0 + 0.3 * np.sin(angle))[pillar]
    return p


def _frames(context: StageContext) -> FrameFigures:
    rng, walk = np.random.default_rng(8), loop_walk()
    sensors = tuple(
        Sensor(
            name=name, model="VLP-16", T_body_sensor=SE3.from_rpy(0.0, pitch, 0.0, t=[0.0, 0, z])
        )
        for name, pitch, z in (("horizontal", 0.0, 0.3), ("vertical", np.pi / 2.0, 0.5))
    )
    nothing = {"imu_time_offset_s": 0.0, "p_body_antenna": np.zeros(3), "gnss_time_offset_s": 0.0}
    rig = Rig(name="4RECON", sensors=sensors, T_body_imu=SE3.identity(), **nothing)
    with FrameWriter(context.out, rig) as writer:
        for k, t_ns in enumerate(walk.t_ns[:-1].tolist()):
            writer.append(_multiframe(k, t_ns, walk.T_a_b[k], rig, rng))
    return FrameFigures(multiframes=len(walk) - 1, points=0, rig=rig.name, imu=False, gnss=False)


def _multiframe(
    k: int, t_ns: int, T_map_body: SE3, rig: Rig, rng: np.random.Generator
) -> Multiframe:
    p_body = T_map_body.inverse() @ room_points(rng, 400)
    sensor = (np.arange(400) >= 200).astype(np.uint8)
    T_sensor_body = rig.T_body_sensor.inverse()
    xyz = np.where(sensor[:, None] == 0, T_sensor_body[0] @ p_body, T_sensor_body[1] @ p_body)
    return Multiframe(
        frame_id=k,
        t_ns=t_ns,
        duration_ns=100_000_000,
        xyz=xyz.astype(np.float32),
        intensity=rng.integers(0, 255, 400).astype(np.uint16),
        ring=rng.integers(0, 16, 400).astype(np.uint8),
        sensor=sensor,
        echo=np.zeros(400, np.uint8),
        dt_ns=np.zeros(400, np.int32),
    )


def _odometry(context: StageContext, *, walk: Trajectory) -> EarlierOdometry:
    drift = np.linspace(0.0, 1.0, len(walk))[:, None] * [0.4, -0.3, 0.1]
    save_trajectory(
        context.out / "trajectory.npz",
        Trajectory(walk.t_ns, SE3(walk.T_a_b.R, walk.T_a_b.t + drift)),
    )
    return EarlierOdometry(multiframes=len(walk), lost=0, warnings=(REMARK,))


def _verification(context: StageContext, *, walk: Trajectory) -> None:
    save_graph(context.out, verified_graph(walk))


def _level(context: StageContext, *, walk: Trajectory) -> LevelFigures:
    save_trajectory(context.out / "trajectory.npz", walk)
    save_graph(context.out, verified_graph(walk))
    local = {"origin": None, "reason": "no positions"}
    write_json(
        context.out / "georeference.json", {"levelling": {}, "georeference": local, "crs": {}}
    )
    return LevelFigures(leveled_by="imu", tilt_deg=0.0, crs="", local="no positions")


def _map(context: StageContext, *, first: bool | None, **what: Any) -> MapFigures:
    figures = _tiles(context, **what)
    if first:
        tiles = TileSet.open(context.out)
        walk_m = loop_walk().T_a_b.t
        write_first_files(context.out / FIRST_FILES, tiles, LOCAL, walk_m=walk_m)
    return figures


def _tiles(
    context: StageContext, *, points: int, strays: int, normals: bool, moved: float | None
) -> MapFigures:
    rng = np.random.default_rng(7)
    p = room_points(rng, points)
    faces = _room_normals(p)
    p[p[:, 0] == ROOM_M[0], 0] += moved or 0.0
    walk = loop_walk()
    paths = SensorPaths(walk.t_ns, walk.t_ns, np.stack([walk.T_a_b.t, walk.T_a_b.t]))
    with TileWriter(context.out, STORED, tile_m=TILE_M, paths=paths) as writer:
        writer.notes = MapNotes(voxel_m=0.01)
        ijk = np.floor(p / TILE_M).astype(np.int64)
        for key in np.unique(ijk, axis=0):
            here = np.all(ijk == key, axis=1)
            mine = p[here]
            xyz = np.vstack(
                [mine - key * TILE_M, np.tile([0.5 * TILE_M, 0.5 * TILE_M, 1.5], (strays, 1))]
            )
            columns = _columns(xyz, rng)
            columns["classification"] = np.full(len(xyz), PointClass.UNCLASSIFIED, np.uint8)
            columns["classification"][len(mine) :] = PointClass.LOW_NOISE
            if normals:
                columns["normal"][: len(mine)] = faces[here]
            writer.append(tuple(int(k) for k in key), columns, strays=strays)
    low, high = (tuple(corner.tolist()) for corner in (p.min(axis=0), p.max(axis=0)))
    return MapFigures(points=points, bounds_m=(low, high))


def _room_normals(p: np.ndarray) -> np.ndarray:
    """Into the room where a point lies on one of its six faces, else zero, (N, 3)."""
    out = np.zeros((len(p), 3), np.float16)
    for axis, end in enumerate(ROOM_M):
        out[np.abs(p[:, axis]) < 0.03, axis] = 1.0
        out[np.abs(p[:, axis] - end) < 0.03, axis] = -1.0
    return np.where(np.abs(out).sum(axis=1, keepdims=True) == 1.0, out, 0.0).astype(np.float16)


def _columns(xyz: np.ndarray, rng: np.random.Generator) -> dict[str, np.ndarray]:
    n = len(xyz)
    bright = 0.3 + 0.3 * np.sin(2.0 * xyz[:, 0]) * np.sin(2.0 * xyz[:, 1])
    known = {
        "xyz": xyz,
        "intensity": 10.0 + 80.0 * bright * rng.uniform(0.3, 1.0, n),
        "intensity_normalized": bright,
        "sensor": rng.integers(0, 2, n),
        "t_ns": BEGAN_NS + (rng.random(n) * 60e9).astype(np.int64),
    }
    empty = {
        name: np.zeros((n, width) if width > 1 else n, dtype)
        for name, (dtype, width) in FIELDS.items()
    }
    return empty | {name: values.astype(FIELDS[name][0]) for name, values in known.items()}


def put_on_site_grid(project: Path, origin_m: tuple[float, float, float]) -> None:
    """Place the map of a finished project in the grid of a site, as control points do."""
    (file,) = (project / "artifacts").glob("*/georeference.json")
    record = json.loads(file.read_text())
    write_json(file, record | {"crs": {"name": SITE_GRID, "origin_m": origin_m}})
