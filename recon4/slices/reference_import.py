"""Import of reference files: tiles of points with normals, or a mesh."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import asdict, dataclass, replace
from itertools import chain
from pathlib import Path
from tempfile import TemporaryDirectory

import numpy as np
from numpy.typing import NDArray

from recon4.errors import ConfigError, CorruptFile, UnknownFormat
from recon4.evaluation.reference_mesh import TriangleMesh
from recon4.geometry.se3 import SE3, Array
from recon4.locales.coded import CodedText, StoredText
from recon4.mapping.normals import local_normals
from recon4.mapping.tile_order import progressive
from recon4.mapping.tile_writer import TileWriter
from recon4.mapping.tiles import TileSet
from recon4.recording.formats.cloud_crs import StatedCrs
from recon4.recording.formats.reference_clouds import open_cloud
from recon4.recording.tables.column_names import UNITS_M
from recon4.recording.tables.coordinates import AS_THE_TABLE_SAYS, ColumnChoice
from recon4.recording.tables.tuning import PLACES
from recon4.slices.map_crs import LOCAL, MapFrame
from recon4.slices.meshes import is_mesh, load_mesh
from recon4.slices.reference import EarlierAlignment, ReferenceFacts, read_facts
from recon4.slices.reference_placement import FilePlacement, FrameAsked, check_extent, place_file
from recon4.slices.tuning_files import REFERENCE_IMPORT
from recon4.store.atomic import atomic_folder, write_json
from recon4.untrusted.names import visible


@dataclass(frozen=True, slots=True)
class ReadAs:
    """What a person says of a reference file."""

    frame: FrameAsked = "auto"
    choice: ColumnChoice = AS_THE_TABLE_SAYS
    """Columns of a text; the unit of any file."""


AS_THE_FILE_SAYS = ReadAs()


@dataclass(frozen=True, slots=True, eq=False)
class MapPlace:
    """The map that a reference is for."""

    frame: MapFrame = LOCAL
    bounds_m: tuple[Array, Array] | None = None
    """Lowest and highest coordinates [m], (3,) each; None = not known."""

    @property
    def in_crs(self) -> Array | None:
        """Easting and northing of its origin [m], (2,); None = it is local."""
        return self.frame.to_crs(np.zeros((1, 3)))[0, :2] if self.frame.to_crs else None


UNKNOWN_PLACE = MapPlace()


def import_reference(
    path: Path,
    out: Path,
    *,
    name: str = "",
    read_as: ReadAs = AS_THE_FILE_SAYS,
    place: MapPlace = UNKNOWN_PLACE,
) -> ReferenceFacts:
    """Import a cloud or mesh as a reference; atomic.

    Args:
        path: PLY, PCD, LAS, LAZ, E57, XYZ, CSV, OBJ, STL.
        out: New folder.
        name: Display name; empty = the file's name.
        read_as: What a person says of its columns, unit and frame.
        place: The map.

    Returns:
        ``reference.json``.

    Raises:
        ConfigError: With a question, if columns, unit or frame are not certain.
        CorruptFile, UnknownFormat, RecordingError: If the file cannot be used.
        GeoreferenceError: If its CRS cannot be transformed to that of the map.
    """
    if not path.is_file():
        raise UnknownFormat(CodedText("reference-one-file", file=path.name))
    with atomic_folder(out) as folder:
        mesh = is_mesh(path)
        found = (_mesh if mesh else _cloud)(path, folder, read_as, place=place)
        remarks = check_extent(found.bounds_m, place.bounds_m, certain=found.unit_stated)
        notes = (found.columns, *found.placement.notes, *remarks)
        facts = ReferenceFacts(
            name=name or visible(path.name),
            file=visible(path.name),
            frame=found.placement.frame,
            T_map_reference=np.eye(4).tolist(),
            kind="mesh" if mesh else "cloud",
            points=0 if mesh else found.count,
            triangles=found.count if mesh else 0,
            columns=read_as.choice.columns,
            unit=read_as.choice.unit or "",
            notes=tuple(StoredText.of(one) for one in notes if one),
        )
        write_json(folder / "reference.json", asdict(facts))
    return facts


@dataclass(frozen=True, slots=True, eq=False)
class _Imported:
    """What was written of a file."""

    count: int
    """Points or triangles."""
    bounds_m: tuple[Array, Array]
    """In the map, before any alignment."""
    placement: FilePlacement
    unit_stated: bool
    columns: str = ""


def set_alignment(
    folder: Path, T_map_reference: SE3, *, steps: Sequence[str] = (), fit: str = ""
) -> ReferenceFacts:
    """Store the alignment of a reference with the map; the one before it is kept.

    Args:
        folder: Of the reference.
        T_map_reference: The alignment.
        steps: How it was found, one `CodedText` a step.
        fit: How well the reference lies on the map now; empty = not compared.
    """
    facts = read_facts(folder)
    return _keep(
        folder,
        replace(
            facts,
            T_map_reference=T_map_reference.matrix().tolist(),
            alignment=tuple(map(StoredText.of, steps)),
            fit=(StoredText.of(fit),) if fit else (),
            earlier=_present(facts),
        ),
    )


def undo_alignment(folder: Path) -> ReferenceFacts:
    """Return to the alignment before the last one; a second time undoes the undoing.

    Raises:
        ConfigError: If it was never aligned.
    """
    facts = read_facts(folder)
    if facts.earlier is None:
        raise ConfigError(CodedText("align-nothing-to-undo"))
    before = facts.earlier
    return _keep(
        folder,
        replace(
            facts,
            T_map_reference=before.T_map_reference,
            alignment=before.alignment,
            fit=before.fit,
            earlier=_present(facts),
        ),
    )


def _present(facts: ReferenceFacts) -> EarlierAlignment:
    return EarlierAlignment(
        T_map_reference=facts.T_map_reference, alignment=facts.alignment, fit=facts.fit
    )


def _keep(folder: Path, facts: ReferenceFacts) -> ReferenceFacts:
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
        with TileWriter(out, ["xyz", "normal"], tile_m=REFERENCE_IMPORT.tile_m) as writer:
            for ijk in sorted(names):
                xyz = np.fromfile(names[ijk], np.float32).reshape(-1, 3)
                xyz = xyz[progressive(_spatial(xyz))]
                normal = _normals(np.ascontiguousarray(xyz))
                t_ns = np.zeros(len(xyz), np.int64)
                writer.append(ijk, {"xyz": xyz, "normal": normal, "t_ns": t_ns})
                names[ijk].unlink()
    return TileSet.open(out)


def _mesh(path: Path, out: Path, read_as: ReadAs, *, place: MapPlace) -> _Imported:
    mesh = load_mesh(path)
    unit, stated = read_as.choice.unit, StatedCrs()
    frame = _frame_of(mesh.vertices_m, stated, read_as, place=place)
    placement = place_file(stated, place.frame, asked=frame, unit=unit)
    moved = TriangleMesh(placement.to_map(mesh.vertices_m), mesh.triangles)
    np.savez(out / "mesh.npz", vertices_m=moved.vertices_m, triangles=mesh.triangles)
    return _Imported(len(mesh.triangles), moved.bounds(), placement, unit is not None)


def _cloud(path: Path, out: Path, read_as: ReadAs, *, place: MapPlace) -> _Imported:
    source = open_cloud(path, read_as.choice, place=place.in_crs)
    stated, chunks = source.stated, source.chunks
    unit = None if source.columns else read_as.choice.unit  # a text is in meters already
    first = next(chunks)
    frame = _frame_of(first, stated, read_as, place=place)
    placement = place_file(stated, place.frame, asked=frame, unit=unit)
    tiles = write_tiles(map(placement.to_map, chain([first], chunks)), out)
    certain = read_as.choice.unit is not None or stated.unit_m is not None or stated.geographic
    low, high = tiles.bounds_m
    return _Imported(len(tiles), (low, high), placement, certain, source.columns)


def _frame_of(points: Array, stated: StatedCrs, read_as: ReadAs, *, place: MapPlace) -> FrameAsked:
    """The frame of a file that states none: that of the map's CRS if it lies there."""
    there = place.in_crs
    if read_as.frame != "auto" or stated.crs is not None or there is None or not len(points):
        return read_as.frame
    size = UNITS_M[read_as.choice.unit or "m"]
    middle = np.median(points[:, :2], axis=0) * (size if stated.unit_m is None else stated.unit_m)
    return "crs" if np.all(np.abs(middle - there) < PLACES.near_m) else "auto"


def _deal_out(chunks: Iterable[Array], place: Path) -> dict[tuple[int, int, int], Path]:
    names: dict[tuple[int, int, int], Path] = {}
    for chunk in chunks:
        for first in range(0, len(chunk), REFERENCE_IMPORT.burst):
            points = chunk[first : first + REFERENCE_IMPORT.burst]
            ijk = np.floor(points / REFERENCE_IMPORT.tile_m).astype(np.int64)
            order = np.lexsort(ijk.T)
            _refuse_scattered(ijk, order, len(names))
            cuts = np.flatnonzero(np.any(np.diff(ijk[order], axis=0) != 0, axis=1)) + 1
            for rows in np.split(order, cuts) if len(points) else []:
                i, j, k = (int(x) for x in ijk[rows[0]])
                file = names.setdefault((i, j, k), place / f"{len(names)}.f4")
                local = points[rows] - np.array([i, j, k]) * REFERENCE_IMPORT.tile_m
                with file.open("ab") as out:
                    out.write(local.astype(np.float32).tobytes())
    return names


def _refuse_scattered(ijk: NDArray[np.int64], order: NDArray[np.intp], before: int) -> None:
    changes = np.any(np.diff(ijk[order], axis=0) != 0, axis=1)
    count = max(before, int(np.count_nonzero(changes)) + 1)
    if count > REFERENCE_IMPORT.max_tiles:
        raise CorruptFile(
            CodedText(
                "reference-cubes",
                max_tiles=REFERENCE_IMPORT.max_tiles,
                tile_m=REFERENCE_IMPORT.tile_m,
                count=count,
            )
        )


def _normals(xyz: NDArray[np.float32]) -> NDArray[np.float32]:
    out = np.zeros_like(xyz)
    for cell_m in REFERENCE_IMPORT.normal_cells_m:
        missing = ~out.any(axis=1)
        if not missing.any():
            break
        out[missing] = local_normals(xyz, cell_m).normal[missing]
    return out


def _spatial(xyz: NDArray[np.float32]) -> NDArray[np.intp]:
    return np.lexsort(np.floor(xyz / 0.25).T)
