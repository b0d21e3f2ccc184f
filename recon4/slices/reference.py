"""Reference models, clouds or meshes, and distances of map points to them."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass, replace
from functools import cached_property
from pathlib import Path
from typing import TYPE_CHECKING, Literal

import msgspec
import numpy as np

from recon4.errors import ConfigError, StoreError
from recon4.evaluation.reference_mesh import TriangleMesh, scene_of
from recon4.geometry.se3 import SE3, Array
from recon4.locales.coded import CodedText, StoredText, at
from recon4.locales.languages import ENGLISH
from recon4.mapping.tiles import TileSet
from recon4.recording.tables.column_names import Meaning, Unit
from recon4.slices.points import SliceWindow, points_in
from recon4.slices.slice_plane import SlicePlane
from recon4.slices.tuning_files import REFERENCES
from recon4.store.arrays import load_arrays
from recon4.store.json_files import read_object
from recon4.untrusted.names import visible
from recon4.untrusted.typed import as_type

if TYPE_CHECKING:
    from recon4.geometry.raycast import Scene

Method = Literal["plane", "point"]
FITS, MISFIT, FAR = "reference-fits", "reference-misfit", "reference-far"
"""Codes of what is said of a reference that fits the map, and of others."""
Statements = tuple[StoredText, ...]
"""Texts, one after the other."""


@dataclass(frozen=True, slots=True, kw_only=True)
class EarlierAlignment:
    """An alignment that was replaced."""

    T_map_reference: list[list[float]]
    alignment: Statements
    fit: Statements = ()


@dataclass(frozen=True, slots=True, kw_only=True)
class ReferenceFacts:
    """What is known of a reference: ``reference.json``."""

    name: str
    file: str = ""
    """Name of the imported file."""
    frame: Literal["map", "crs"] = "map"
    """Frame of the file's coordinates."""
    T_map_reference: list[list[float]]
    """4 x 4, row by row."""
    alignment: Statements = ()
    """How it was aligned with the map, step by step; empty = not at all."""
    fit: Statements = ()
    """How well it lies on the map after its last alignment; empty = not compared."""
    earlier: EarlierAlignment | None = None
    """The alignment before the last one, to undo that."""
    kind: Literal["mesh", "cloud"]
    points: int = 0
    """Of a cloud."""
    triangles: int = 0
    """Of a mesh."""
    columns: tuple[Meaning, ...] = ()
    """Meaning of the columns of a text, if a person chose it."""
    unit: Unit | Literal[""] = ""
    """Unit of the file, if a person chose it."""
    notes: Statements = ()
    """How its columns, units and CRS were read."""

    @property
    def fits(self) -> bool | None:
        """Whether it lies on the map since its last alignment; None = not compared or judged."""
        return next((one.code == FITS for one in self.fit if one.code in (FITS, MISFIT, FAR)), None)


@dataclass(frozen=True, slots=True, eq=False)
class ReferenceOffsets:
    """Where points lie beside a reference."""

    distance_m: Array
    """Distance to the reference [m], (N,); inf = over `REFERENCES.far_m`."""
    across_m: Array
    """Signed distance from the nearest surface along its normal [m], (N,); 0 without normal."""
    normal: Array
    """Unit normal of that surface, of either sign, (N, 3); zeros = not known."""


@dataclass(frozen=True, eq=False)
class Reference:
    """A model to compare with.

    ``plane``: distance from the plane through the nearest point of the reference, where it has a
    normal, so a coarse reference does not count its own spacing as error. ``point``: distance to
    the nearest point, as V §3.2. Of a mesh always the distance to the nearest triangle.
    """

    name: str
    folder: Path
    T_map_reference: SE3
    method: Method = "plane"
    mesh: TriangleMesh | None = None
    tiles: TileSet | None = None
    notes: Statements = ()
    """How its columns, units and CRS were read."""
    alignment: Statements = ()
    """How it was aligned with the map, step by step; empty = not at all."""

    @property
    def caption(self) -> str:
        """Its name and how it was read, for one line of a sheet."""
        notes = " ".join(one.text for one in self.notes)
        text = f"{self.name}. {notes}" if notes else self.name
        return (
            text
            if len(text) <= REFERENCES.longest_caption
            else f"{text[: REFERENCES.longest_caption - 1]}…"
        )

    def distance(self, p_map: Array) -> Array:
        """Distance of points of the map (N, 3) to the reference [m], (N,); inf = far from it."""
        return self.offsets(p_map).distance_m

    def offsets(self, p_map: Array) -> ReferenceOffsets:
        """Where points of the map (N, 3) lie beside the reference."""
        p = self.T_map_reference.inverse() @ np.ascontiguousarray(p_map, dtype=np.float64)
        found = self._to_mesh(p) if self.mesh is not None else self._to_cloud(p)
        return replace(found, normal=found.normal @ self.T_map_reference.R.T)

    def outline(self, plane: SlicePlane, window: SliceWindow, *, step_m: float) -> Iterator[Array]:
        """The reference inside a slice, as points u, v, distance from the plane [m], (M, 3) each.

        Args:
            plane: In the map.
            window: Only this part.
            step_m: Lines of a mesh become points this far apart [m].
        """
        own = moved_plane(plane, self.T_map_reference.inverse())
        if self.mesh is not None:
            yield _along(mesh_lines(self.mesh, own), window, step_m)
        elif self.tiles is not None:
            for part in points_in(self.tiles, own, window=window):
                yield part.uvd

    @cached_property
    def _scene(self) -> Scene:
        assert self.mesh is not None
        return scene_of(self.mesh)

    def _to_mesh(self, p: Array) -> ReferenceOffsets:
        foot, normal = self._scene.nearest(p)
        distance = np.linalg.norm(p - foot, axis=1)
        across = np.einsum("ni,ni->n", normal, p - foot)
        return ReferenceOffsets(
            np.where(distance <= REFERENCES.far_m, distance, np.inf), across, normal
        )

    def _to_cloud(self, p: Array) -> ReferenceOffsets:
        """Offsets from a cloud, cube by cube, so that only nearby points are in memory."""
        assert self.tiles is not None
        out = ReferenceOffsets(np.full(len(p), np.inf), np.zeros(len(p)), np.zeros((len(p), 3)))
        cubes = np.floor(p / REFERENCES.margin_m).astype(np.int64)
        order = np.lexsort(cubes.T)
        changes = np.flatnonzero(np.any(np.diff(cubes[order], axis=0) != 0, axis=1)) + 1
        for rows in np.split(order, changes) if len(p) else []:
            low = p[rows].min(axis=0) - REFERENCES.far_m
            high = p[rows].max(axis=0) + REFERENCES.far_m
            found = self._near(p[rows], low, high)
            out.distance_m[rows], out.across_m[rows] = found.distance_m, found.across_m
            out.normal[rows] = found.normal
        return out

    def _near(self, p: Array, low: Array, high: Array) -> ReferenceOffsets:
        from scipy.spatial import cKDTree

        q, normal = points_between(self.tiles, low, high)
        out = ReferenceOffsets(np.full(len(p), np.inf), np.zeros(len(p)), np.zeros((len(p), 3)))
        if not len(q):
            return out
        tree = cKDTree(q, balanced_tree=False, compact_nodes=False)
        distance, row = tree.query(p, distance_upper_bound=REFERENCES.far_m)
        near = np.isfinite(distance)
        n = normal[row[near]]
        known = np.einsum("ni,ni->n", n, n) > REFERENCES.known
        n[~known] = 0.0
        across = np.einsum("ni,ni->n", n, p[near] - q[row[near]])
        if self.method == "plane":
            distance[near] = np.where(known, np.abs(across), distance[near])
        out.distance_m[:] = distance
        out.normal[near], out.across_m[near] = n, across
        return out


def points_between(tiles: TileSet | None, low: Array, high: Array) -> tuple[Array, Array]:
    """Points of a reference in a box of its own frame, and their normals, (N, 3) each."""
    assert tiles is not None
    points, normals = [np.empty((0, 3))], [np.empty((0, 3))]
    for tile in tiles:
        if np.any(np.array(tile.low_m) > high) or np.any(np.array(tile.high_m) < low):
            continue
        columns = tile.read(["xyz", "normal"])
        xyz = columns["xyz"].astype(np.float64) + tile.origin_m
        inside = np.all((xyz >= low) & (xyz <= high), axis=1)
        points.append(xyz[inside])
        normals.append(columns["normal"][inside].astype(np.float64))
    return np.concatenate(points), np.concatenate(normals)


def load_reference(folder: Path, *, method: Method = "plane") -> Reference:
    """Load a reference written by `recon4.slices.reference_import.import_reference`.

    Raises:
        StoreError: If it is missing or damaged.
    """
    facts = read_facts(folder)
    T = SE3.from_matrix(_matrix(facts.T_map_reference, folder.name))
    mesh = _mesh(folder / "mesh.npz") if facts.kind == "mesh" else None
    tiles = TileSet.open(folder) if mesh is None else None
    return Reference(
        facts.name,
        folder,
        T,
        method,
        mesh=mesh,
        tiles=tiles,
        notes=facts.notes,
        alignment=facts.alignment,
    )


def read_facts(folder: Path) -> ReferenceFacts:
    """``reference.json`` of a reference.

    Raises:
        StoreError: If it is missing or damaged.
    """
    record = read_object(folder / "reference.json", max_bytes=REFERENCES.max_facts_bytes)
    try:
        facts = as_type(_with_statements(record), ReferenceFacts)
    except msgspec.ValidationError as error:
        raise StoreError(at(f"{folder.name}/reference.json", str(error))) from error
    return replace(
        facts,
        name=visible(facts.name),
        alignment=_visible(facts.alignment),
        fit=_visible(facts.fit),
        notes=_visible(facts.notes),
    )


def alignment_text(alignment: Statements, language: str = ENGLISH) -> str:
    """How a reference is aligned, in a language."""
    steps = [one.said(language) for one in alignment]
    return "; ".join(steps) or CodedText("alignment-none").said(language)


def _with_statements(record: Mapping[str, object]) -> dict[str, object]:
    """The record of a file; earlier versions wrote its statements in English only."""
    out = dict(record)
    for name in ("alignment", "fit", "notes"):
        written = out.get(name, [])
        listed = written if isinstance(written, list) else [written]
        out[name] = [
            {"text": one} if isinstance(one, str) else one
            for one in listed
            if one not in ("", "none")
        ]
    earlier = out.get("earlier")
    if isinstance(earlier, dict):
        out["earlier"] = _with_statements(earlier)
    return out


def _visible(statements: Statements) -> Statements:
    """Statements of a file, fit to be shown."""

    def shown(value: float | str) -> float | str:
        return visible(value, most=REFERENCES.longest_note) if isinstance(value, str) else value

    return tuple(
        StoredText(
            text=visible(one.text, most=REFERENCES.longest_note),
            code=one.code,
            values={name: shown(value) for name, value in one.values.items()},
        )
        for one in statements
    )


def _mesh(path: Path) -> TriangleMesh:
    arrays = load_arrays(path, ["vertices_m", "triangles"])
    vertices, triangles = arrays["vertices_m"], arrays["triangles"]
    fits = vertices.shape[1:] == (3,) and triangles.shape[1:] == (3,) and len(triangles) > 0
    if not fits or vertices.dtype.kind != "f" or triangles.dtype.kind not in "iu":
        raise StoreError(
            CodedText(
                "reference-mesh-shape",
                file=path.name,
                vertex_type=str(vertices.dtype),
                vertex_shape=str(vertices.shape),
                corner_type=str(triangles.dtype),
                corner_shape=str(triangles.shape),
            )
        )
    if triangles.min() < 0 or triangles.max() >= len(vertices):
        raise StoreError(CodedText("reference-mesh-corners", file=path.name))
    return TriangleMesh(vertices.astype(np.float64), triangles.astype(np.int64))


def _matrix(value: list[list[float]], name: str) -> Array:
    try:
        matrix = np.array(value, dtype=np.float64)
    except (TypeError, ValueError, OverflowError) as error:
        raise StoreError(CodedText("reference-matrix", name=name, why=str(error))) from error
    turned = matrix[:3, :3] if matrix.shape == (4, 4) else np.zeros((3, 3))
    if not np.isfinite(matrix).all() or np.abs(turned @ turned.T - np.eye(3)).max() > 1e-3:
        raise StoreError(CodedText("reference-transform", name=name, value=str(value)[:80]))
    return matrix


def moved_plane(plane: SlicePlane, T_b_a: SE3) -> SlicePlane:
    """The same slice in another frame: points keep their u, v and distance from the plane."""
    origin = (T_b_a @ np.array([plane.origin_m]))[0]
    u, v = T_b_a.R @ np.array(plane.u), T_b_a.R @ np.array(plane.v)
    return SlicePlane("free", _triple(origin), _triple(u), _triple(v), plane.thickness_m)


def mesh_lines(mesh: TriangleMesh, plane: SlicePlane) -> Array:
    """Where the middle plane of a slice meets the triangles: segments in u, v [m], (S, 2, 2)."""
    if not len(mesh.triangles):
        raise ConfigError(CodedText("reference-no-triangles"))
    uvd = plane.to_plane(mesh.vertices_m)
    corner = uvd[mesh.triangles]
    d = corner[:, :, 2]
    crossed = (d.min(axis=1) <= 0.0) & (d.max(axis=1) > 0.0)
    corner, d = corner[crossed], d[crossed]
    above = d > 0.0
    ends = []
    for i, j in ((0, 1), (1, 2), (2, 0)):
        with np.errstate(divide="ignore", invalid="ignore"):
            s = d[:, i] / (d[:, i] - d[:, j])
            point = corner[:, i, :2] + s[:, None] * (corner[:, j, :2] - corner[:, i, :2])
        point[above[:, i] == above[:, j]] = np.nan
        ends.append(point)
    three = np.stack(ends, axis=1)
    # A plane that crosses a triangle crosses two of its sides: the third entry is NaN.
    order = np.argsort(np.isnan(three[:, :, 0]), axis=1, kind="stable")[:, :2]
    out: Array = np.take_along_axis(three, order[:, :, None], axis=1)
    return out


def _along(lines: Array, window: SliceWindow, step_m: float) -> Array:
    """Points along segments, u, v and 0, (M, 3); only segments that can meet the window."""
    low, high = lines.min(axis=1), lines.max(axis=1)
    seen = np.all(high >= [window.left, window.bottom], axis=1)
    seen &= np.all(low <= [window.right, window.top], axis=1)
    points = [np.empty((0, 2))]
    for a, b in lines[seen]:
        n = min(20_000, int(np.ceil(np.linalg.norm(b - a) / step_m)) + 1)
        points.append(a + np.linspace(0.0, 1.0, n)[:, None] * (b - a))
    uv = np.concatenate(points)
    return np.column_stack([uv, np.zeros(len(uv))])


def _triple(values: Array) -> tuple[float, float, float]:
    x, y, z = (float(value) for value in values)
    return x, y, z
