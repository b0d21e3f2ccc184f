"""Work of the slices in child processes. Arguments and results are records and plain values."""

from __future__ import annotations

import base64
import time
from dataclasses import asdict, replace
from functools import lru_cache
from pathlib import Path
from typing import Any

import numpy as np

from recon4.errors import ConfigError, StoreError
from recon4.findings.walk_record import final_trajectory, positions_along
from recon4.geometry.se3 import Array
from recon4.locales.coded import CodedText
from recon4.locales.languages import ENGLISH
from recon4.mapping.tiles import TileSet
from recon4.mapping.tuning import TILES
from recon4.model.plain import to_plain
from recon4.review.approval_state import ApprovalState
from recon4.review.evidence import Evidence
from recon4.slices.black_white import find_black_white
from recon4.slices.colors import ColorBy, Ground, Span, table
from recon4.slices.compare import Comparison, compare, to_csv, usual_planes
from recon4.slices.doubles import find_double_walls
from recon4.slices.map_crs import MapFrame, frame_of
from recon4.slices.pick import measured_directions, nearest_surface, pick
from recon4.slices.points import SliceWindow, extent
from recon4.slices.reference import (
    Method,
    Reference,
    load_reference,
    read_facts,
)
from recon4.slices.sheet import (
    approval_text,
    axis_labels,
)
from recon4.slices.slice_image import RasterGrid, SliceImage, draw, png
from recon4.slices.slice_plane import SlicePlane
from recon4.slices.tuning_files import SLICE_COLORS
from recon4.store.atomic import atomic_file, write_json
from recon4.store.checked import CheckedArtifact
from recon4.untrusted.names import visible
from recon4_app.slices.listed_reference import ListedReference
from recon4_app.slices.model import (
    CompareRequest,
    FoundTarget,
    OtherMap,
    PickRequest,
    PickView,
    SliceFacts,
    SliceImageRequest,
    SliceImageView,
    SliceView,
    SurfacePoint,
    WalkStretch,
    WindowSpec,
    Xyz,
)
from recon4_app.slices.tuning import WALK_STRETCH

Artifacts = dict[str, str]
"""Stage -> folder of its artifact."""


@lru_cache(maxsize=4)
def tiles_of(folder: str) -> TileSet:
    """Open a map; its folder name is its hash, so it never changes."""
    return TileSet.open(Path(folder), kept_bytes=TILES.kept_bytes)


@lru_cache(maxsize=4)
def _approved_tiles(folder: str, manifest_sha256: str) -> TileSet:
    """Open an approved map; every byte is checked before it is used."""
    checked = CheckedArtifact.open(Path(folder), manifest_sha256)
    return TileSet.open(Path(folder), checked, kept_bytes=TILES.kept_bytes)


def map_of(artifacts: Artifacts, evidence: Evidence | None) -> TileSet:
    """The map of a request; an approved map is compared with its signed hashes.

    Raises:
        Altered: If the map or its georeference differs from the approved one.
    """
    if evidence is None:
        return tiles_of(artifacts["map"])
    evidence.check_frame({stage: Path(folder) for stage, folder in artifacts.items()})
    evidence.artifact("map", Path(artifacts["map"])).check("tiles.json")
    return _approved_tiles(artifacts["map"], evidence.manifests["map"])


@lru_cache(maxsize=2)
def _reference(folder: str, method: Method, changed_ns: int) -> Reference:
    return load_reference(Path(folder), method=method)


def reference_of(folder: str, method: Method) -> Reference | None:
    """Load a reference; it is cached until its alignment changes."""
    if not folder:
        return None
    facts = Path(folder) / "reference.json"
    changed_ns = facts.stat().st_mtime_ns if facts.exists() else 0
    return _reference(folder, method, changed_ns)


def walk_stretch(artifacts: Artifacts, span_s: tuple[float, float]) -> WalkStretch:
    """Positions of the walk during a stretch, at most about `most_positions`."""
    walk = final_trajectory({stage: Path(folder) for stage, folder in artifacts.items()})
    if walk is None or not len(walk):
        return WalkStretch(positions_m=[])
    p_map = positions_along(walk, span_s, most=WALK_STRETCH.most_positions)
    return WalkStretch(positions_m=[_xyz(p) for p in np.round(p_map, 3)])


def facts(
    artifacts: Artifacts,
    references: list[ListedReference],
    sources: list[OtherMap],
    *,
    approval: ApprovalState,
) -> SliceFacts:
    """Facts about the map, its references, other maps and its approval."""
    tiles, frame = tiles_of(artifacts["map"]), map_frame(artifacts)
    low, high = (_xyz(np.nan_to_num(corner)) for corner in tiles.bounds_m)
    return SliceFacts(
        points=len(tiles),
        strays=tiles.strays,
        surface=tiles.surface,
        bounds_m=(low, high),
        fields=list(tiles.fields),
        sensors=list(tiles.notes.sensors),
        seconds=(tiles.last_ns - tiles.first_ns) / 1e9,
        key=Path(artifacts["map"]).name,
        crs=frame.crs,
        frame=frame.text,
        references=references,
        sources=sources,
        approval=approval,
    )


def slice_image(
    map_folder: str, reference: str, ask: SliceImageRequest, *, evidence: Evidence | None = None
) -> SliceImageView:
    """Draw an image of a slice; of an approved map only checked tiles are drawn."""
    began = time.perf_counter()
    tiles, plane = map_of({"map": map_folder}, evidence).on(ask.surface), ask.plane.slice_plane()
    window = _shaped(window_of(ask, tiles, plane), ask.width / ask.height)
    paper = RasterGrid(window, (window.right - window.left) / ask.width)
    made = draw(tiles, plane, paper, color=ask.color, reference=reference_of(reference, ask.method))
    span = span_of(ask, made)
    image = base64.b64encode(png(made.rgba(span, ask.ground))).decode()
    return SliceImageView(
        png=image,
        window=WindowSpec(**asdict(window)),
        pixel_m=paper.pixel_m,
        points=made.points,
        surface=tiles.surface,
        name=plane.name,
        position=plane.position,
        low=span.low,
        high=span.high,
        colors=_stops(ask.color, ask.ground),
        axes=axis_labels(plane),
        origin_m=plane.origin_m,
        u=plane.u,
        v=plane.v,
        offset_m=plane.offset_m,
        seconds=time.perf_counter() - began,
    )


def overview(map_folder: str, image: str, about: str) -> None:
    """Write the map from above as a transparent image; walls are dark, floors are not."""
    tiles = tiles_of(map_folder)
    low, high = tiles.bounds_m
    if not np.isfinite(low).all():
        raise ConfigError(CodedText("map-empty"))
    middle, height = float(low[2] + high[2]) / 2.0, float(high[2] - low[2]) + 0.1
    plane = SlicePlane.horizontal(middle, thickness_m=height)
    margin = 0.02 * float((high - low)[:2].max()) + 0.1
    window = SliceWindow(low[0] - margin, low[1] - margin, high[0] + margin, high[1] + margin)
    pixel_m = max(window.right - window.left, window.top - window.bottom) / 1200.0
    made = draw(tiles, plane, RasterGrid(window, pixel_m))
    dense = np.log1p(made.count / max(1.0, float(np.percentile(made.count[made.count > 0], 75))))
    rgba = np.zeros((*dense.shape, 4), np.uint8)
    rgba[..., :3] = (100, 116, 130)
    rgba[..., 3] = (255.0 * np.clip(dense / 1.6, 0.0, 1.0)).astype(np.uint8)
    shown = SliceWindow(
        window.left,
        window.top - dense.shape[0] * pixel_m,
        window.left + dense.shape[1] * pixel_m,
        window.top,
    )
    # The image is written last: if it exists, its window exists too.
    write_json(Path(about), {name: float(value) for name, value in asdict(shown).items()})
    with atomic_file(Path(image)) as temporary:
        temporary.write_bytes(png(rgba))


def pick_point(artifacts: Artifacts, ask: PickRequest) -> PickView:
    """The point of the map nearest to a position on a slice."""
    tiles = tiles_of(artifacts["map"]).on(ask.surface)
    plane = ask.plane.slice_plane()
    found = pick(tiles, plane, ask.uv, radius_m=ask.radius_m)
    if found is None:
        return PickView(found=False)
    return PickView(
        found=True,
        p_map=found.p_map,
        p_crs=_in_crs(map_frame(artifacts), found.p_map),
        uv=found.uv,
        about=found.about,
        along=[_xyz(row) for row in measured_directions(tiles, plane, np.array(found.p_map))],
        target=_target_at(tiles, np.array(found.p_map)),
    )


def _target_at(tiles: TileSet, p_map: Array) -> FoundTarget | None:
    """The black-white target around a pick."""
    found = find_black_white(tiles, p_map)
    if found is None:
        return None
    off_m = float(np.linalg.norm(found.p_map - p_map))
    return FoundTarget(
        p_map=_xyz(found.p_map), sd_m=found.sd_m, sd_across_m=found.sd_across_m, off_m=off_m
    )


def double_walls(map_folder: str, out: str) -> None:
    """Write the double wall check of the whole map as JSON."""
    found = find_double_walls(tiles_of(map_folder))
    write_json(Path(out), to_plain(found))


def comparison(
    map_folder: str, reference: str, ask: CompareRequest, *, language: str
) -> Comparison:
    """Compare slices with a reference (V Table 3.2)."""
    tiles = tiles_of(map_folder)
    against = reference_of(reference, ask.method)
    assert against is not None
    planes = [spec.slice_plane() for spec in ask.planes] or usual_planes(tiles)
    return compare(tiles, planes, against, rng=np.random.default_rng(1), language=language)


def comparison_csv(map_folder: str, reference: str, ask: CompareRequest) -> str:
    """Compare slices with a reference, as CSV."""
    return to_csv(comparison(map_folder, reference, ask, language=ENGLISH))


def surface_at(artifacts: Artifacts, xyz_m: Xyz, frame: str) -> SurfacePoint:
    """Position of a surveyed point in the map, and the nearest point of the map's surface."""
    p = np.array(xyz_m)
    if frame == "crs":
        p = map_frame(artifacts).from_crs(p[None])[0]
    found = nearest_surface(tiles_of(artifacts["map"]), p)
    if found is None:
        return SurfacePoint(_xyz(p), None, None)
    return SurfacePoint(_xyz(p), _xyz(found.p_map), _xyz(found.normal))


def references_in(folder: Path, language: str) -> list[ListedReference]:
    """The references of a project, by name."""
    entries = sorted(folder.iterdir()) if folder.is_dir() else []
    return [
        _facts_or_problem(entry, language)
        for entry in entries
        if not entry.name.startswith(".") and (entry / "reference.json").is_file()
    ]


def _facts_or_problem(folder: Path, language: str) -> ListedReference:
    """Facts of a reference, or the problem if it cannot be read."""
    try:
        return ListedReference.of(folder.name, read_facts(folder), language)
    except StoreError as error:
        problem = visible(str(error).replace(f"{folder.parent}/", ""))
        name = f"{folder.name}: {problem}"
        return ListedReference(id=folder.name, name=name, kind="damaged", problem=problem)


def span_of(ask: SliceView, made: SliceImage) -> Span:
    """Ends of the color scale: requested values, else those of the image."""
    low = made.span.low if ask.low is None else ask.low
    high = made.span.high if ask.high is None else ask.high
    if not high > low:
        raise ConfigError(CodedText("color-scale", low=low, high=high))
    return Span(low, high)


def stamp_text(evidence: Evidence | None) -> str:
    """Who approved a map, as one line."""
    return approval_text(evidence.stamp.to_json() if evidence else None)


def window_of(ask: SliceView, tiles: TileSet, plane: SlicePlane) -> SliceWindow:
    """The requested window of a slice, or its whole extent with a margin."""
    if ask.window is not None:
        return SliceWindow(**ask.window.model_dump())
    all_of_it = extent(tiles, plane)
    margin = 0.03 * max(all_of_it.right - all_of_it.left, all_of_it.top - all_of_it.bottom) + 0.05
    return SliceWindow(
        all_of_it.left - margin,
        all_of_it.bottom - margin,
        all_of_it.right + margin,
        all_of_it.top + margin,
    )


def _shaped(window: SliceWindow, aspect: float) -> SliceWindow:
    """Widened to an aspect ratio, about its center."""
    width, height = window.right - window.left, window.top - window.bottom
    if not (width > 0.0 and height > 0.0):
        return window  # `RasterGrid` rejects it with a message
    more_u = max(0.0, height * aspect - width) / 2.0
    more_v = max(0.0, width / aspect - height) / 2.0
    return replace(
        window,
        left=window.left - more_u,
        right=window.right + more_u,
        bottom=window.bottom - more_v,
        top=window.top + more_v,
    )


def _stops(color: ColorBy, ground: Ground) -> list[str]:
    if color == "sensor":
        return [f"#{r:02x}{g:02x}{b:02x}" for r, g, b in SLICE_COLORS.sensor_colors]
    return [f"#{r:02x}{g:02x}{b:02x}" for r, g, b in table(color, ground)[::15].tolist()]


def map_frame(artifacts: Artifacts) -> MapFrame:
    """The frame of the map of a request."""
    return frame_of({stage: Path(folder) for stage, folder in artifacts.items()})


def _in_crs(frame: MapFrame, p_map: Xyz) -> Xyz | None:
    return _xyz(frame.to_crs(np.array([p_map]))[0]) if frame.to_crs else None


def _xyz(values: Any) -> Xyz:
    x, y, z = (float(value) for value in values)
    return x, y, z
