"""Work of the page *Map* in child processes. Arguments and results are records and plain values."""

from __future__ import annotations

from functools import lru_cache
from pathlib import Path
from typing import Any

import numpy as np

from recon4.errors import ConfigError
from recon4.findings.walk_record import final_trajectory
from recon4.first_view.cubes import write_cubes
from recon4.first_view.files import write_first_files
from recon4.first_view.index import class_name
from recon4.first_view.points import FIELD_OF, encoded
from recon4.first_view.records import Stored
from recon4.geometry.se3 import Array
from recon4.locales.coded import CodedText
from recon4.mapping.tile import DEVIATION
from recon4.mapping.tiles import Tile, TileSet
from recon4.pose_graph.files import load_graph
from recon4.products.terrain import TerrainPart, spacing_m, terrain
from recon4.products.tuning import TERRAIN
from recon4.products.volume import volume
from recon4.review.evidence import Evidence
from recon4.slices.pick import points_near
from recon4.slices.points import SliceWindow
from recon4.slices.snap import PickRay, radius_around, snap
from recon4.store.atomic import atomic_file
from recon4_app.map_view.model import (
    HitPoint,
    MapVolume,
    MapWalk,
    PointsInCrs,
    PointsInMap,
    RayHit,
    RayRequest,
    SnapPoint,
    VolumeRequest,
)
from recon4_app.map_view.operator_marks import operator_marks
from recon4_app.map_view.tuning import MAP_PICKS, MAP_VOLUMES, MAP_WALK
from recon4_app.slices.slice_work import Artifacts, map_frame, map_of, tiles_of
from recon4_app.viewer.cloud.parts import Cloud
from recon4_app.viewer.cloud.pick import Ray, hit_point

_MORE = ("normal", "range_m", "intensity_normalized", "classification", DEVIATION, "surface_sd_m")


def write_first(artifacts: Artifacts, out: str, *, evidence: Evidence | None) -> None:
    """Write what the page reads first of a map whose artifact does not have it."""
    tiles = map_of(artifacts, evidence)
    walk = final_trajectory({stage: Path(folder) for stage, folder in artifacts.items()})
    walk_m = np.empty((0, 3)) if walk is None else walk.T_a_b.t
    write_first_files(Path(out), tiles, map_frame(artifacts), walk_m=walk_m)


def write_coarse(
    artifacts: Artifacts, out: str, stored: Stored, *, evidence: Evidence | None
) -> None:
    """Write the coarse points of a whole map.

    Raises:
        ConfigError: If the map has no such values.
    """
    tiles = map_of(artifacts, evidence)
    _check_values(tiles, stored)
    with atomic_file(Path(out)) as temporary, temporary.open("wb") as file:
        write_cubes(tiles, stored, file)


def _check_values(tiles: TileSet, stored: Stored) -> None:
    if stored != "xyz" and FIELD_OF[stored] not in tiles.fields:
        raise ConfigError(CodedText("map-lacks-value", stored=stored))


def chunk(
    artifacts: Artifacts,
    stored: Stored,
    parts: tuple[tuple[int, int, int], ...],
    *,
    evidence: Evidence | None,
) -> bytes:
    """Points of tiles, part by part: row in the index, the first of its points, the last + 1.

    Raises:
        ConfigError: If there are no such points, or no such values.
    """
    tiles = map_of(artifacts, evidence)
    _check_values(tiles, stored)
    for row, start, stop in parts:
        if row >= len(tiles.tiles) or stop > len(tiles.tiles[row]):
            raise ConfigError(CodedText("map-lacks-points", start=start, stop=stop, tile=row))
    return b"".join(
        encoded(tiles, row, stored, rows=slice(start, stop)) for row, start, stop in parts
    )


def walk(artifacts: Artifacts, marks_file: str) -> MapWalk:
    """The walk, the nodes of the pose graph, and marks of the operator (empty = there are none)."""
    path = final_trajectory({stage: Path(folder) for stage, folder in artifacts.items()})
    if path is None or not len(path):
        return MapWalk(t_s=[], positions_m=[], nodes_m=[])
    step = max(1, -(-len(path) // MAP_WALK.most_positions))
    t_s = (path.t_ns[::step] - path.t_ns[0]) / 1e9
    marks, left_out = operator_marks(Path(marks_file), path) if marks_file else ([], 0)
    return MapWalk(
        t_s=np.round(t_s, 3).tolist(),
        positions_m=_rows(path.T_a_b.t[::step]),
        nodes_m=_rows(_nodes(artifacts)),
        marks=marks,
        marks_left_out=left_out,
    )


def hit(artifacts: Artifacts, ask: RayRequest) -> RayHit:
    """The point nearest to a ray on the first surface that it meets, among all that are shown.

    Raises:
        ConfigError: If the ray has no direction.
    """
    direction = np.array(ask.direction)
    length = float(np.linalg.norm(direction))
    if length < 1e-6:
        raise ConfigError(CodedText("ray-invalid", direction=str(list(ask.direction))))
    ray = Ray(
        np.array(ask.origin_m),
        direction / length,
        pixel_rad=ask.pixel_rad,
        point_m=ask.point_m,
        planes=np.array(ask.planes).reshape(-1, 4),
    )
    found = hit_point(_cloud(artifacts["map"]), ray)
    if found is None:
        return RayHit(point=None)
    point = _described(artifacts, *found)
    return RayHit(point=point, snap=_snapped(artifacts, ask, ray, hit=np.array(point.p_map)))


def _snapped(artifacts: Artifacts, ask: RayRequest, ray: Ray, *, hit: Array) -> SnapPoint | None:
    """Where a hit snaps to, by the points around it that are shown."""
    depth = float((hit - ray.origin_m) @ ray.direction)
    reach = min(ask.snap_m + ask.snap_rad * depth, MAP_PICKS.max_snap_m)
    if reach <= 0.0:
        return None
    points = points_near(tiles_of(artifacts["map"]), hit, radius_around(reach))
    shown = (ray.planes[:, :3] @ points.T + ray.planes[:, 3:] >= 0.0).all(axis=0)
    pick = PickRay(ray.origin_m, ray.direction, hit, reach)
    found = snap(points[shown], pick, rng=np.random.default_rng(1))
    if found is None:
        return None
    to_crs = map_frame(artifacts).to_crs
    p_crs = _xyz(to_crs(found.p_map[None])[0]) if to_crs else None
    return SnapPoint(kind=found.kind, p_map=_xyz(found.p_map), p_crs=p_crs, sd_m=found.sd_m)


def in_crs(artifacts: Artifacts, ask: PointsInMap) -> PointsInCrs:
    """Points of the map in its CRS.

    Raises:
        ConfigError: If the map is not georeferenced.
    """
    frame = map_frame(artifacts)
    if frame.to_crs is None:
        raise ConfigError(CodedText("map-local"))
    points = np.array(ask.p_map).reshape(-1, 3)
    return PointsInCrs(crs=frame.crs, p_crs=[_xyz(p) for p in frame.to_crs(points)])


def map_volume(artifacts: Artifacts, ask: VolumeRequest) -> MapVolume:
    """What lies over a plane inside of a polygon.

    Raises:
        ConfigError: If the polygon encloses no area, or nothing was seen in it.
    """
    corners = np.array(ask.polygon)
    low, high = corners.min(axis=0) - TERRAIN.border_m, corners.max(axis=0) + TERRAIN.border_m
    part = TerrainPart(
        SliceWindow(*low.tolist(), *high.tolist()),
        -np.inf if ask.low_m is None else ask.low_m,
        np.inf if ask.high_m is None else ask.high_m,
    )
    tiles = tiles_of(artifacts["map"])
    cell_m = max(
        MAP_VOLUMES.cell_m,
        MAP_VOLUMES.cell_times * spacing_m(tiles, part),
        float(np.sqrt(np.prod(high - low) / MAP_VOLUMES.most_cells)),
    )
    heights = terrain(tiles, "dsm", cell_m=cell_m, part=part)
    found = volume(heights, corners, base_m=ask.base_m, rng=np.random.default_rng(1))
    return MapVolume(
        above_m3=found.above_m3,
        below_m3=found.below_m3,
        sd_m3=found.sd_m3,
        area_m2=found.area_m2,
        unseen_m2=found.unseen_m2,
        base_m=found.base_m,
        fitted=found.fitted,
        cell_m=cell_m,
    )


@lru_cache(maxsize=2)
def _cloud(folder: str) -> Cloud:
    return Cloud(tiles_of(folder))


def _described(artifacts: Artifacts, tile: Tile, row: int) -> HitPoint:
    tiles, frame = tiles_of(artifacts["map"]), map_frame(artifacts)
    names = ["xyz", "t_ns", "sensor", "intensity", *(n for n in _MORE if n in tile.fields)]
    one = {name: values[0] for name, values in tile.read(names, rows=slice(row, row + 1)).items()}
    p = one["xyz"].astype(np.float64) + tile.origin_m
    normal = one.get("normal")
    names_of = dict(enumerate(tiles.notes.sensors))
    return HitPoint(
        p_map=_xyz(p),
        p_crs=_xyz(frame.to_crs(p[None])[0]) if frame.to_crs else None,
        normal=_xyz(normal) if normal is not None and np.any(normal) else None,
        t_s=(int(one["t_ns"]) - tiles.first_ns) / 1e9,
        sensor=names_of.get(int(one["sensor"]), str(one["sensor"])),
        classification=class_name(int(one.get("classification", 0))),
        intensity=int(one["intensity"]),
        normalized=_finite(one.get("intensity_normalized")),
        range_m=_finite(one.get("range_m")),
        position_sd_m=_finite(one.get(DEVIATION)),
        surface_sd_m=_finite(one.get("surface_sd_m")),
    )


def _nodes(artifacts: Artifacts) -> Array:
    for stage in ("level", "review", "verification", "graph"):
        if stage in artifacts and (Path(artifacts[stage]) / "graph.npz").is_file():
            nodes = load_graph(Path(artifacts[stage])).T_map_body.t
            return nodes[:: max(1, -(-len(nodes) // MAP_WALK.most_nodes))]
    return np.empty((0, 3))


def _rows(p_map: Array) -> list[tuple[float, float, float]]:
    return [_xyz(p) for p in np.round(p_map, 3)]


def _xyz(values: Any) -> tuple[float, float, float]:
    x, y, z = (float(value) for value in values)
    return x, y, z


def _finite(value: Any) -> float | None:
    return float(value) if value is not None and np.isfinite(value) else None
