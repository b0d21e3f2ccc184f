"""Every kind of file that recon4 reads, with the reader the program uses."""

from __future__ import annotations

import contextlib
import re
import struct
from collections.abc import Callable, Iterator, Sized
from functools import cache, partial
from importlib import import_module
from pathlib import Path
from pkgutil import iter_modules

import numpy as np

from recon4.errors import Recon4Error
from recon4.evaluation.markers import read_markers
from recon4.evaluation.reference_mesh import read_mesh
from recon4.evaluation.trajectories import find_trajectory
from recon4.mapping.tiles import TileSet
from recon4.model.rig import load_rig
from recon4.pose_graph.files import load_graph
from recon4.recording.formats.reference_clouds import read_points
from recon4.recording.frame_files.folders import list_frames, read_frames
from recon4.recording.info.describe import describe
from recon4.recording.report import ImportReport
from recon4.recording.samples.csv_files import read_gnss_csv, read_imu_csv
from recon4.settings import IngestSettings
from recon4.slices.control_points import read_control
from recon4.slices.meshes import is_mesh, load_mesh
from recon4.slices.reference import load_reference, read_facts
from recon4.store.arrays import load_trajectory
from recon4.store.frames import FrameStore
from recon4.store.ledger import Ledger
from recon4.store.project import read_description
from recon4.store.stage import damage_of, read_manifest
from tests.security import fuzz
from tests.security.fuzz import seeds_clouds as clouds
from tests.security.fuzz import seeds_recordings as recordings
from tests.security.fuzz import seeds_tables as tables
from tests.security.fuzz.kind import Kind, Reading


def _info(path: Path) -> None:
    """``recon4 info``: an error message is expected, everything else is a finding."""
    with contextlib.suppress(Recon4Error):
        describe(path).lines()


def _cloud(path: Path) -> Reading:
    _info(path)
    if is_mesh(path):
        return Reading(len(load_mesh(path).vertices_m))
    return Reading(sum(len(chunk) for chunk in read_points(path)))


def _frames(path: Path) -> Reading:
    """As a frame of a recording."""
    _info(path)
    report = ImportReport()
    sensor = tables.rig().sensors[0]
    frames = read_frames(list_frames(path), sensor, settings=IngestSettings(), report=report)
    read = sum(len(frame) for frame in frames)
    return Reading(read, salvaged=report.outcome != "complete")


def _mesh(path: Path) -> Reading:
    assert is_mesh(path)
    read_mesh(path)
    return Reading(len(load_mesh(path).triangles))


def _las(path: Path) -> Reading:
    return Reading(sum(len(chunk) for chunk in read_points(path)))


def _samples(read: Callable[[Path], object], path: Path) -> Reading:
    _info(path)
    return Reading(len(read(path)))  # type: ignore[arg-type]


def _control(path: Path) -> Reading:
    found = read_control(path.read_bytes(), name=path.name)
    return Reading(len(found.points), salvaged=bool(found.skipped))


def _lines(read: Callable[[Path, ImportReport], Sized], path: Path) -> Reading:
    """A table whose reader drops single damaged lines and counts them."""
    _info(path)
    report = ImportReport()
    return Reading(len(read(path, report)), salvaged=bool(report.lost()))


def _rig(path: Path) -> Reading:
    return Reading(len(load_rig(path).sensors))


def _graph(path: Path) -> Reading:
    graph = load_graph(path.parent)
    return Reading(len(graph) + len(graph.edges))


def _store(path: Path) -> Reading:
    store = FrameStore.open(path.parent)
    imu = len(store.imu) if store.imu is not None else 0
    return Reading(
        sum(len(frame.xyz) + int(frame.ring.max(initial=0)) * 0 for frame in store) + imu
    )


def _tiles(path: Path) -> Reading:
    tiles = TileSet.open(path.parent)
    low, high = tiles.bounds_m
    assert low.shape == high.shape
    return Reading(sum(len(tile.xyz_m()) for tile in tiles))


def _reference(path: Path) -> Reading:
    read_facts(path.parent)
    reference = load_reference(path.parent)
    found = reference.distance(np.zeros((3, 3)))
    return Reading(len(found))


def _manifest(path: Path) -> Reading:
    damage_of(path.parent, hashes=True)
    return Reading(len(read_manifest(path.parent)["files"]))


def _ledger(path: Path) -> Reading:
    for beside in ("-wal", "-shm"):
        path.with_name(path.name + beside).unlink(missing_ok=True)
    empty = not path.stat().st_size
    with Ledger(path) as ledger:
        ledger.current()
        ledger.find("0" * 64)
        # An empty file is a new ledger: its rows are made again from the artifacts.
        return Reading(len(ledger.stages()), salvaged=empty)


# -- counts in headers, parsed independently of the readers


def _header_count(pattern: bytes, data: bytes) -> int | None:
    found = re.search(pattern, data[: 64 * 1024])
    return int(found[1]) if found else None


def _las_count(data: bytes) -> int | None:
    if len(data) < 227 or data[:4] != b"LASF":
        return None
    if data[25] >= 4 and len(data) >= 255:
        return int(struct.unpack_from("<Q", data, 247)[0])
    return int(struct.unpack_from("<I", data, 107)[0])


def _stl_count(data: bytes) -> int | None:
    if data[:5].lower() == b"solid" or len(data) < 84:
        return None
    return int(struct.unpack_from("<I", data, 80)[0])


def _mesh_reference(folder: Path) -> None:
    tables.tiles(folder)
    text = (folder / "reference.json").read_text().replace('"cloud"', '"mesh"')
    (folder / "reference.json").write_text(text)


_PCD = partial(_header_count, rb"\nPOINTS (\d+)")
_PLY = partial(_header_count, rb"element vertex (\d+)")

_ALL = (
    Kind(name="pcd", file_name="a.pcd", seeds=clouds.pcd, read=_cloud, promised=_PCD),
    Kind(name="pcd-frames", file_name="a.pcd", seeds=clouds.pcd, read=_frames),
    Kind(name="ply", file_name="a.ply", seeds=clouds.ply, read=_cloud, promised=_PLY),
    Kind(name="bin", file_name="a.bin", seeds=clouds.kitti_bin, read=_frames, knows_end=False),
    Kind(name="obj", file_name="a.obj", seeds=clouds.obj, read=_mesh, knows_end=False),
    Kind(name="stl", file_name="a.stl", seeds=clouds.stl, read=_mesh, promised=_stl_count),
    Kind(
        name="las",
        file_name="a.las",
        seeds=partial(clouds.las, compressed=False),
        read=_las,
        promised=_las_count,
    ),
    Kind(
        name="laz",
        file_name="a.laz",
        seeds=partial(clouds.las, compressed=True),
        read=_las,
        promised=_las_count,
        header_bytes=1024,
    ),
    Kind(
        name="e57",
        file_name="a.e57",
        seeds=clouds.e57,
        read=_las,
        repair=clouds.e57_checksums,
        header_bytes=4096,
    ),
    Kind(name="ptx", file_name="a.ptx", seeds=clouds.ptx, read=_las, knows_end=False),
    Kind(name="xyz", file_name="a.xyz", seeds=clouds.xyz, read=_las, knows_end=False),
    Kind(
        name="csv-imu",
        file_name="imu.csv",
        seeds=tables.imu_csv,
        read=partial(_lines, read_imu_csv),
        knows_end=False,
    ),
    Kind(
        name="csv-gnss",
        file_name="gnss.csv",
        seeds=tables.gnss_csv,
        read=partial(_lines, read_gnss_csv),
        knows_end=False,
    ),
    Kind(
        name="csv-control",
        file_name="points.csv",
        seeds=tables.control_csv,
        read=_control,
        knows_end=False,
    ),
    Kind(
        name="csv-markers",
        file_name="markers.csv",
        seeds=tables.marker_csv,
        read=partial(_samples, read_markers),
        knows_end=False,
    ),
    Kind(name="toml", file_name="rig.toml", seeds=tables.rig_toml, read=_rig, knows_end=False),
    Kind(
        name="tum",
        file_name="a.tum",
        seeds=tables.tum,
        read=partial(_lines, find_trajectory),
        knows_end=False,
    ),
    Kind(
        name="npz-trajectory",
        file_name="trajectory.npz",
        seeds=tables.trajectory_npz,
        read=lambda path: Reading(len(load_trajectory(path))),
    ),
    Kind(name="npz-graph", file_name="graph.npz", seeds=tables.graph_npz, read=_graph),
    Kind(
        name="npz-mesh",
        file_name="mesh.npz",
        seeds=tables.mesh_npz,
        read=_reference,
        prepare=_mesh_reference,
    ),
    Kind(
        name="npy-index",
        file_name="index.npy",
        seeds=tables.frame_index,
        read=_store,
        prepare=tables.frame_store,
    ),
    Kind(
        name="zst-points",
        file_name="points.zst",
        seeds=tables.frame_points,
        read=_store,
        prepare=tables.frame_store,
    ),
    Kind(
        name="json-tiles",
        file_name="tiles.json",
        seeds=tables.tiles_json,
        read=_tiles,
        prepare=tables.tiles,
    ),
    Kind(
        name="json-reference",
        file_name="reference.json",
        seeds=tables.reference_json,
        read=_reference,
        prepare=tables.tiles,
    ),
    Kind(
        name="json-project",
        file_name="project.json",
        seeds=tables.project_json,
        read=lambda path: Reading(len(read_description(path.parent))),
    ),
    Kind(
        name="json-manifest",
        file_name="manifest.json",
        seeds=tables.manifest_json,
        read=_manifest,
    ),
    Kind(name="sqlite-ledger", file_name="ledger.sqlite", seeds=tables.ledger, read=_ledger),
)


def _recording(path: Path) -> Reading:
    found = recordings.read_recording(path)
    return Reading(found.items, salvaged=found.outcome != "complete" or bool(found.findings))


def _metadata(path: Path) -> Reading:
    found = recordings.read_metadata(path)
    return Reading(found.items, salvaged=found.outcome != "complete" or bool(found.findings))


def _recordings() -> Iterator[Kind]:
    """Captures and bags, with every compression as a seed."""
    seeds = {
        "pcap": ("a.pcap", [recordings.seed_pcap]),
        "pcapng": ("a.pcapng", [recordings.seed_pcapng]),
        "bag1": (
            "a.bag",
            [recordings.seed_bag1, recordings.seed_bag1_bz2, recordings.seed_bag1_lz4],
        ),
        "db3": ("a.db3", [recordings.seed_db3]),
        "mcap": (
            "a.mcap",
            [recordings.seed_mcap, recordings.seed_mcap_lz4, recordings.seed_mcap_zstd],
        ),
    }
    for name, (file_name, makers) in seeds.items():
        yield Kind(
            name=name,
            file_name=file_name,
            seeds=partial(_made, tuple(makers)),
            read=_recording,
            # A capture has no end mark: it is whole up to its last whole packet.
            knows_end=name not in ("pcap", "pcapng"),
            header_bytes=4096,
        )
    yield Kind(
        name="yaml",
        file_name="metadata.yaml",
        seeds=partial(_made, (recordings.seed_metadata,)),
        read=_metadata,
        knows_end=False,
    )


@cache
def _made(makers: tuple[Callable[[], bytes], ...]) -> tuple[bytes, ...]:
    return tuple(make() for make in makers)


def _beside() -> Iterator[Kind]:
    """``KINDS`` of each module of this folder whose name begins with ``kinds_``."""
    for found in iter_modules(fuzz.__path__):
        if found.name.startswith("kinds_"):
            yield from import_module(f"{fuzz.__name__}.{found.name}").KINDS


KINDS: dict[str, Kind] = {kind.name: kind for kind in (*_ALL, *_recordings(), *_beside())}
"""By name."""
