"""Import of reference files: tiles of points with normals, or a mesh."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import asdict, replace
from pathlib import Path
from tempfile import TemporaryDirectory

import numpy as np
from numpy.typing import NDArray

from recon4.errors import CorruptFile, UnknownFormat
from recon4.geometry.se3 import SE3, Array
from recon4.mapping.normals import local_normals
from recon4.mapping.tile import progressive
from recon4.mapping.tile_writer import TileWriter
from recon4.mapping.tiles import TileSet
from recon4.names import visible
from recon4.recording.formats.reference_clouds import read_points
from recon4.slices.frames import MapFrame
from recon4.slices.meshes import is_mesh, load_mesh
from recon4.slices.reference import ReferenceFacts, read_facts
from recon4.store.atomic import atomic_folder, write_json

TILE_M = 5.0
NORMAL_CELLS_M = (0.05, 0.10, 0.20)
"""Cell sizes for normals: the smallest one with enough points is used."""
_BURST = 4_000_000
MAX_TILES = 100_000
"""Limit of temporary tile files: points scattered over the Earth are no survey."""


def import_reference(
    path: Path, out: Path, *, name: str = "", frame: MapFrame | None = None
) -> ReferenceFacts:
    """Import a cloud or mesh as a reference; atomic.

    Args:
        path: PLY, PCD, LAS, LAZ, E57, XYZ, CSV, OBJ, STL.
        out: New folder.
        name: Display name; empty = the file's name.
        frame: Set if the file's coordinates are in the map's CRS; None = map frame.

    Returns:
        ``reference.json``.

    Raises:
        CorruptFile, UnknownFormat, RecordingError: If the file cannot be used.
    """
    if not path.is_file():
        raise UnknownFormat(f"{path.name}: expected one file, got a folder or nothing")
    with atomic_folder(out) as folder:
        mesh = is_mesh(path)
        count = (_mesh if mesh else _cloud)(path, folder, frame)
        facts = ReferenceFacts(
            name=name or visible(path.name),
            file=visible(path.name),
            frame="crs" if frame else "map",
            T_map_reference=np.eye(4).tolist(),
            kind="mesh" if mesh else "cloud",
            points=0 if mesh else count,
            triangles=count if mesh else 0,
        )
        write_json(folder / "reference.json", asdict(facts))
    return facts


def set_alignment(folder: Path, T_map_reference: SE3, *, description: str) -> ReferenceFacts:
    """Store the alignment of a reference with the map."""
    matrix = T_map_reference.matrix().tolist()
    facts = replace(read_facts(folder), T_map_reference=matrix, alignment=description)
    write_json(folder / "reference.json", asdict(facts))
    return facts


def write_tiles(chunks: Iterable[Array], out: Path) -> TileSet:
    """Sort points into tiles and compute normals where the neighborhood is flat.

    Args:
        chunks: Points [m], (N, 3) each.
        out: Receives ``tiles/`` and ``tiles.json``.
    """
    with TemporaryDirectory(dir=out, prefix="buckets-") as place:
        names = _deal_out(chunks, Path(place))
        with TileWriter(out, ["xyz", "normal"], tile_m=TILE_M) as writer:
            for ijk in sorted(names):
                xyz = np.fromfile(names[ijk], np.float32).reshape(-1, 3)
                xyz = xyz[progressive(_spatial(xyz))]
                normal = _normals(np.ascontiguousarray(xyz))
                t_ns = np.zeros(len(xyz), np.int64)
                writer.append(ijk, {"xyz": xyz, "normal": normal, "t_ns": t_ns})
                names[ijk].unlink()
    return TileSet.open(out)


def _mesh(path: Path, out: Path, frame: MapFrame | None) -> int:
    mesh = load_mesh(path)
    vertices = frame.from_crs(mesh.vertices_m) if frame else mesh.vertices_m
    np.savez(out / "mesh.npz", vertices_m=vertices, triangles=mesh.triangles)
    return len(mesh.triangles)


def _cloud(path: Path, out: Path, frame: MapFrame | None) -> int:
    chunks = read_points(path)
    tiles = write_tiles((frame.from_crs(c) for c in chunks) if frame else chunks, out)
    return len(tiles)


def _deal_out(chunks: Iterable[Array], place: Path) -> dict[tuple[int, int, int], Path]:
    names: dict[tuple[int, int, int], Path] = {}
    for chunk in chunks:
        for first in range(0, len(chunk), _BURST):
            points = chunk[first : first + _BURST]
            ijk = np.floor(points / TILE_M).astype(np.int64)
            order = np.lexsort(ijk.T)
            _refuse_scattered(ijk, order, len(names))
            cuts = np.flatnonzero(np.any(np.diff(ijk[order], axis=0) != 0, axis=1)) + 1
            for rows in np.split(order, cuts) if len(points) else []:
                i, j, k = (int(x) for x in ijk[rows[0]])
                file = names.setdefault((i, j, k), place / f"{len(names)}.f4")
                local = points[rows] - np.array([i, j, k]) * TILE_M
                with file.open("ab") as out:
                    out.write(local.astype(np.float32).tobytes())
    return names


def _refuse_scattered(ijk: NDArray[np.int64], order: NDArray[np.intp], before: int) -> None:
    changes = np.any(np.diff(ijk[order], axis=0) != 0, axis=1)
    count = max(before, int(np.count_nonzero(changes)) + 1)
    if count > MAX_TILES:
        raise CorruptFile(
            f"expected points in at most {MAX_TILES} cubes of {TILE_M:g} m, got {count} or more: "
            "are the coordinates in meters?"
        )


def _normals(xyz: NDArray[np.float32]) -> NDArray[np.float32]:
    out = np.zeros_like(xyz)
    for cell_m in NORMAL_CELLS_M:
        missing = ~out.any(axis=1)
        if not missing.any():
            break
        out[missing] = local_normals(xyz, cell_m).normal[missing]
    return out


def _spatial(xyz: NDArray[np.float32]) -> NDArray[np.intp]:
    return np.lexsort(np.floor(xyz / 0.25).T)
