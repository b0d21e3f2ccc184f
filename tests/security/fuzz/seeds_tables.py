"""Tiny valid tables, trajectories, graphs, rigs and files of a project, made by code."""

from __future__ import annotations

import json
import tempfile
from collections.abc import Callable
from functools import cache
from pathlib import Path

import numpy as np

from recon4.geometry.se3 import SE3
from recon4.model.multiframe import Multiframe
from recon4.model.pose_graph import Edge, EdgeKind, PoseGraph, Verdict, known_history
from recon4.model.rig import Rig, format_rig, load_rig
from recon4.model.samples import ImuSamples
from recon4.model.trajectory import Trajectory
from recon4.pose_graph.files import save_graph
from recon4.recording.formats.poses import write_tum
from recon4.recording.samples.csv_files import GNSS_HEADER, IMU_HEADER
from recon4.slices.reference_import import write_tiles
from recon4.store.arrays import save_trajectory
from recon4.store.frames import FrameWriter
from recon4.store.ledger import FinishedStage, Ledger
from tests.security.fuzz.seeds_clouds import table

T0_NS = 1_700_000_000_000_000_000


@cache
def imu_csv() -> tuple[bytes, ...]:
    """As specified; and with semicolons, decimal commas and other columns."""
    rows = [(T0_NS + k * 10_000_000, 0.1, -0.2, 0.3, 0.0, 0.0, 9.81) for k in range(30)]
    plain = ",".join(IMU_HEADER) + "\n"
    plain += "".join(",".join(str(v) for v in row) + "\n" for row in rows)
    german = plain.replace(",", ";").replace(".", ",")
    return plain.encode(), b"\xef\xbb\xbf" + german.replace("\n", "\r\n").encode()


@cache
def gnss_csv() -> tuple[bytes, ...]:
    """With and without attitudes."""
    rows = [(T0_NS + k * 10**9, 49.78, 9.93, 250.0, 0.02, 0.02, 0.04, 4) for k in range(20)]
    short = ",".join(GNSS_HEADER[:8]) + "\n"
    short += "".join(",".join(str(v) for v in row) + "\n" for row in rows)
    full = ",".join(GNSS_HEADER) + "\n"
    full += "".join(",".join(str(v) for v in row) + ",0.1,,12.5\n" for row in rows)
    return short.encode(), full.encode()


@cache
def control_csv() -> tuple[bytes, ...]:
    """With a head line; semicolons and decimal commas; tabs."""
    head = "id,easting,northing,height,radius,role\n"
    rows = "".join(f"P{k},{500000 + k}.25,{5500000 + k}.5,2.75,0.1,check\n" for k in range(12))
    german = rows.replace(",", ";").replace(".", ",")
    return (head + rows).encode(), german.encode(), rows.replace(",", "\t").encode()


@cache
def marker_csv() -> tuple[bytes, ...]:
    """Points of known coordinates."""
    rows = "".join(f"P{k},{k}.25,{k}.5,2.75,check\n" for k in range(12))
    return (("name,x_m,y_m,z_m,role\n" + rows).encode(),)


def walk() -> Trajectory:
    """A short trajectory."""
    s = np.linspace(0.0, 1.0, 25)
    quat = np.stack([0.0 * s, 0.0 * s, np.sin(s), np.cos(s)], axis=1)
    t_m = np.stack([s, 0.5 * s, 0.0 * s], axis=1)
    return Trajectory(T0_NS + np.arange(25, dtype=np.int64) * 10**8, SE3.from_quat(quat, t_m))


def graph() -> PoseGraph:
    """A short pose graph."""
    T = walk().T_a_b
    edges = tuple(
        Edge(
            i=i,
            j=j,
            T_i_j=T[i].inverse() @ T[j],
            kind=kind,
            judgments=known_history(Verdict.ACCEPTED),
        )
        for i, j, kind in [
            *((k, k + 1, EdgeKind.ODOMETRY) for k in range(9)),
            (0, 5, EdgeKind.LOOP),
        ]
    )
    return PoseGraph(np.arange(10), walk().t_ns[:10], T[np.arange(10)], edges)


def _file(write: Callable[[Path], object], name: str = "a") -> bytes:
    with tempfile.TemporaryDirectory() as folder:
        write(Path(folder) / name)
        return (Path(folder) / name).read_bytes()


@cache
def tum() -> tuple[bytes, ...]:
    """With and without a comment."""
    data = _file(lambda path: write_tum(path, walk()))
    return data, b"# t x y z qx qy qz qw\n" + data


@cache
def rig() -> Rig:
    """The thesis's rig."""
    return load_rig("4recon")


@cache
def rig_toml() -> tuple[bytes, ...]:
    """As written by us, and by hand."""
    hand = (
        'name = "one"\n[[sensor]]\nname = "top"\nmodel = "VLP-16"\nxyz_m = [0.1, 0, 1]\n'
        "rpy_deg = [0, 5.5, 0]\n[imu]\nport = 0\n[gnss]\nlever_arm_m = [0, 0, 0.3]\n"
    )
    return format_rig(rig()).encode(), hand.encode()


@cache
def trajectory_npz() -> tuple[bytes, ...]:
    """A trajectory as arrays."""
    return (_file(lambda path: save_trajectory(path, walk()), "trajectory.npz"),)


@cache
def graph_npz() -> tuple[bytes, ...]:
    """A pose graph as arrays."""
    return (_file(lambda path: save_graph(path.parent, graph()), "graph.npz"),)


def frame_store(folder: Path) -> None:
    """A store of three multiframes."""
    cloud = table()
    n = len(cloud["x"])
    zero = np.zeros(n, np.uint8)
    xyz = np.column_stack([cloud[k] for k in "xyz"])
    with FrameWriter(folder, rig()) as writer:
        for k in range(3):
            writer.append(
                Multiframe(
                    k,
                    T0_NS + k * 10**8,
                    10**8,
                    xyz,
                    cloud["intensity"].astype(np.uint16),
                    cloud["ring"].astype(np.uint8),
                    zero,
                    zero,
                    np.zeros(n, np.int32),
                )
            )
        imu = ImuSamples(np.arange(5, dtype=np.int64), np.zeros((5, 3)), np.ones((5, 3)))
        writer.add(imu=imu, report={"outcome": "complete"})


@cache
def _of_folder(make: Callable[[Path], object], name: str) -> tuple[bytes, ...]:
    with tempfile.TemporaryDirectory() as folder:
        make(Path(folder))
        return ((Path(folder) / name).read_bytes(),)


def frame_index() -> tuple[bytes, ...]:
    """``index.npy`` of a frame store."""
    return _of_folder(frame_store, "index.npy")


def frame_points() -> tuple[bytes, ...]:
    """``points.zst`` of a frame store."""
    return _of_folder(frame_store, "points.zst")


def tiles(folder: Path) -> None:
    """A reference cloud of two tiles, with its facts."""
    cloud = table()
    write_tiles([np.column_stack([cloud[k] for k in "xyz"]).astype(np.float64)], folder)
    facts = {"name": "a", "kind": "cloud", "T_map_reference": np.eye(4).tolist()}
    (folder / "reference.json").write_text(json.dumps(facts))


def tiles_json() -> tuple[bytes, ...]:
    """``tiles.json`` of a map."""
    return _of_folder(tiles, "tiles.json")


def reference_json() -> tuple[bytes, ...]:
    """``reference.json`` of a reference."""
    return _of_folder(tiles, "reference.json")


@cache
def mesh_npz() -> tuple[bytes, ...]:
    """``mesh.npz`` of a reference."""
    corners = np.array([[0.0, 0, 0], [1, 0, 0], [0, 1, 0]])
    return (
        _file(
            lambda path: np.savez(path, vertices_m=corners, triangles=np.array([[0, 1, 2]])),
            "m.npz",
        ),
    )


@cache
def project_json() -> tuple[bytes, ...]:
    """A project's description."""
    facts = {"format": 1, "name": "office ä", "created": "2026-01-01T00:00:00Z"}
    facts |= {"preset": "indoor", "rig": "4RECON", "inputs": [{"name": "walk.pcap", "bytes": 12}]}
    return (json.dumps(facts, indent=1).encode(),)


@cache
def manifest_json() -> tuple[bytes, ...]:
    """An artifact's manifest."""
    row = FinishedStage("ab" * 32, "map", 1, "2026-01-01T00:00:00Z", 1.0, 1.0, 10)
    done = {name: getattr(row, name) for name in row.__slots__}
    facts = {"recipe": {"stage": "map", "inputs": {}}, "done": done, "figures": {"points": 5}}
    facts |= {"versions": {"recon4": "0.1"}, "files": {"a.npy": {"bytes": 5, "sha256": "00" * 32}}}
    return (json.dumps(facts, indent=1).encode(),)


@cache
def ledger() -> tuple[bytes, ...]:
    """A ledger of three stages."""

    def write(path: Path) -> None:
        with Ledger(path) as made:
            for k in range(3):
                row = FinishedStage(f"{k:064d}", f"s{k}", 1, "2026-01-01T00:00:00Z", 1.0, 1.0, 10)
                made.add(row)
                made.set_current(row.stage, row.key)

    return (_file(write, "ledger.sqlite"),)
