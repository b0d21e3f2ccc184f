"""What the slices' child processes do. Arguments and results are plain values."""

from __future__ import annotations

import base64
import time
from dataclasses import asdict, replace
from functools import lru_cache
from pathlib import Path
from typing import Any

import numpy as np

from app.slices.model import (
    CompareRequest,
    ControlState,
    PickView,
    SliceExportRequest,
    SliceFacts,
    SliceImageRequest,
    SliceImageView,
    SliceView,
    WindowSpec,
    Xyz,
)
from recon4.bounded import read_json_object
from recon4.errors import ConfigError, StoreError
from recon4.geometry.se3 import SE3
from recon4.mapping.tiles import TileSet
from recon4.names import visible
from recon4.review.evidence import Evidence
from recon4.review.stamp import stamp_file
from recon4.slices.acceptance import SheetWords, render_acceptance
from recon4.slices.align import align_by_icp, align_by_pairs
from recon4.slices.colors import SENSOR_COLORS, ColorBy, Ground, Span, table
from recon4.slices.compare import compare, to_csv, to_json, usual_cuts
from recon4.slices.control import ControlPoint, read_control
from recon4.slices.cut import Cut, horizontal
from recon4.slices.doubles import find_double_walls
from recon4.slices.export import write_csv, write_dxf, write_geotiff, write_laz
from recon4.slices.frames import MapFrame, frame_of
from recon4.slices.imports import import_reference, set_alignment
from recon4.slices.pick import nearest_surface, pick
from recon4.slices.points import SliceWindow, extent
from recon4.slices.reference import Method, Reference, load_reference, read_facts
from recon4.slices.residuals import ControlReport, residual_csv, residuals
from recon4.slices.sheet import (
    Words,
    approval_words,
    axis_words,
    lay_out,
    source_words,
    write_sheet,
)
from recon4.slices.slice_image import Paper, SliceImage, draw, png
from recon4.store.atomic import atomic_file, null_for_nan, write_json
from recon4.store.checked import CheckedArtifact

Artifacts = dict[str, str]
"""Stage -> folder of its artifact."""
FINEST_M = 0.005
"""Pixel of a GeoTIFF, unless it would get too large [m]."""
MOST_GEOTIFF_PX = 6000
MOST_KEPT_BYTES = 64 << 20


@lru_cache(maxsize=4)
def tiles_of(folder: str) -> TileSet:
    """A map; its folder is named by its content, so it never changes."""
    return TileSet.open(Path(folder))


@lru_cache(maxsize=4)
def _approved_tiles(folder: str, manifest_sha256: str) -> TileSet:
    """The same, every byte of it compared before it is used."""
    return TileSet.open(Path(folder), CheckedArtifact.open(Path(folder), manifest_sha256))


def _map_of(artifacts: Artifacts, evidence: Evidence | None) -> TileSet:
    """The map of a request; what is approved is compared with what was signed.

    Raises:
        Altered: If the map, or what says where it lies, is not what was approved.
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
    """A reference, read anew only when it was aligned anew."""
    if not folder:
        return None
    facts = Path(folder) / "reference.json"
    changed_ns = facts.stat().st_mtime_ns if facts.exists() else 0
    return _reference(folder, method, changed_ns)


def facts(artifacts: Artifacts, context: dict[str, Any]) -> SliceFacts:
    """What can be cut; ``context`` is what the front knows already."""
    tiles, frame = tiles_of(artifacts["map"]), _frame(artifacts)
    low, high = (_xyz(np.nan_to_num(corner)) for corner in tiles.bounds_m)
    times = tiles.facts["time_ns"] or [0, 0]
    return SliceFacts(
        points=len(tiles),
        bounds_m=(low, high),
        fields=list(tiles.fields),
        sensors=[str(name) for name in tiles.facts.get("sensors", [])],
        seconds=(times[1] - times[0]) / 1e9,
        key=Path(artifacts["map"]).name,
        crs=frame.crs,
        frame=frame.words,
        **context,
    )


def slice_image(
    map_folder: str, reference: str, ask: SliceImageRequest, evidence: Evidence | None = None
) -> SliceImageView:
    """A picture of a slice for the screen; of an approved map, of approved points only."""
    began = time.perf_counter()
    tiles, cut = _map_of({"map": map_folder}, evidence), ask.cut.cut()
    window = _shaped(_window(ask, tiles, cut), ask.width / ask.height)
    paper = Paper(window, (window.right - window.left) / ask.width)
    made = draw(tiles, cut, paper, color=ask.color, reference=reference_of(reference, ask.method))
    span = span_of(ask, made)
    image = base64.b64encode(png(made.rgba(span, ask.ground))).decode()
    return SliceImageView(
        png=image,
        window=WindowSpec(**asdict(window)),
        pixel_m=paper.pixel_m,
        points=made.points,
        name=cut.name,
        low=span.low,
        high=span.high,
        colors=_stops(ask.color, ask.ground),
        axes=axis_words(cut),
        origin_m=cut.origin_m,
        u=cut.u,
        v=cut.v,
        offset_m=cut.offset_m,
        seconds=time.perf_counter() - began,
    )


def overview(map_folder: str, image: str, about: str) -> None:
    """The map from above as a transparent picture, kept; walls are dark, floors are not."""
    tiles = tiles_of(map_folder)
    low, high = tiles.bounds_m
    if not np.isfinite(low).all():
        raise ConfigError("the map has no points")
    middle, height = float(low[2] + high[2]) / 2.0, float(high[2] - low[2]) + 0.1
    cut = horizontal(middle, thickness_m=height)
    margin = 0.02 * float((high - low)[:2].max()) + 0.1
    window = SliceWindow(low[0] - margin, low[1] - margin, high[0] + margin, high[1] + margin)
    pixel_m = max(window.right - window.left, window.top - window.bottom) / 1200.0
    made = draw(tiles, cut, Paper(window, pixel_m))
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
    # The picture comes last: whoever finds it finds its window too.
    write_json(Path(about), {name: float(value) for name, value in asdict(shown).items()})
    with atomic_file(Path(image)) as temporary:
        temporary.write_bytes(png(rgba))


def pick_point(
    artifacts: Artifacts, cut: Cut, uv: tuple[float, float], radius_m: float
) -> PickView:
    """The point of the map nearest to a place on a slice."""
    found = pick(tiles_of(artifacts["map"]), cut, uv, radius_m=radius_m)
    if found is None:
        return PickView(found=False)
    return PickView(
        found=True,
        p_map=found.p_map,
        p_crs=_in_crs(_frame(artifacts), found.p_map),
        uv=found.uv,
        about=found.about,
    )


def double_walls(map_folder: str, out: str) -> None:
    """The check of the whole map, kept as JSON."""
    found = find_double_walls(tiles_of(map_folder))
    context = asdict(found) | {"share": found.share}
    write_json(Path(out), null_for_nan(context))


def comparison(map_folder: str, reference: str, ask: CompareRequest) -> dict[str, Any]:
    """V Table 3.2 of some slices."""
    tiles = tiles_of(map_folder)
    against = reference_of(reference, ask.method)
    assert against is not None
    cuts = [spec.cut() for spec in ask.cuts] or usual_cuts(tiles)
    found = to_json(compare(tiles, cuts, against))
    context: dict[str, Any] = null_for_nan(found)
    return context | {"reference": against.name, "method": ask.method}


def comparison_csv(map_folder: str, reference: str, ask: CompareRequest) -> str:
    """The same as CSV."""
    tiles = tiles_of(map_folder)
    against = reference_of(reference, ask.method)
    assert against is not None
    return to_csv(compare(tiles, [spec.cut() for spec in ask.cuts] or usual_cuts(tiles), against))


def add_reference(path: str, out: str, name: str, artifacts: Artifacts | None) -> dict[str, Any]:
    """Read a file of unknown origin; ``artifacts`` when it is in the map's CRS."""
    frame = _frame(artifacts) if artifacts else None
    if frame is not None and frame.to_crs is None:
        raise ConfigError("the map is local: a reference in a CRS cannot be laid onto it")
    return import_reference(Path(path), Path(out), name=name, frame=frame)


def align_reference(
    map_folder: str, reference: str, how: str, pairs: tuple[list[Xyz], list[Xyz]]
) -> dict[str, Any]:
    """Lay a reference onto the map; what it was before is forgotten."""
    folder = Path(reference)
    if how == "none":
        return set_alignment(folder, SE3.identity(), words="none")
    if how == "pairs":
        p_map, p_reference = np.array(pairs[0]), np.array(pairs[1])
        T, left_m = align_by_pairs(p_map.reshape(-1, 3), p_reference.reshape(-1, 3))
        words = f"{len(left_m)} pairs, {100.0 * float(left_m.max()):.1f} cm left at most"
        return set_alignment(folder, T, words=words)
    against = reference_of(reference, "plane")
    assert against is not None
    fit = align_by_icp(tiles_of(map_folder), against, rng=np.random.default_rng(1))
    return set_alignment(folder, fit.T_map_reference, words=fit.words)


def export(
    artifacts: Artifacts,
    ask: SliceExportRequest,
    out: str,
    *,
    reference: str,
    context: dict[str, Any],
) -> str:
    """Write a file of slices; its ending says which. It carries the approval, if there is one.

    Raises:
        Altered: If a tile that it shows is not what was approved.
    """
    path, evidence = Path(out), context["evidence"]
    tiles, frame = _map_of(artifacts, evidence), _frame(artifacts)
    cuts = ask.cut.cut().repeated(ask.count, spacing_m=ask.spacing_m)
    window = SliceWindow(**ask.window.model_dump()) if ask.window else None
    if path.suffix == ".laz":
        write_laz(tiles, cuts, path, frame=frame, window=window)
    elif path.suffix == ".csv":
        write_csv(tiles, cuts, path, frame=frame, window=window)
    elif path.suffix == ".dxf":
        write_dxf(tiles, cuts, path, frame=frame, window=window, flat=ask.flat)
    elif path.suffix == ".tif":
        _export_geotiff(artifacts, ask, path, reference=reference, context=context)
    else:
        _export_sheet(artifacts, ask, path, reference=reference, context=context)
    if evidence and path.suffix in (".laz", ".csv", ".dxf"):
        stamp_file(path, path, evidence.stamp)
    return out


def _export_geotiff(
    artifacts: Artifacts,
    ask: SliceExportRequest,
    path: Path,
    *,
    reference: str,
    context: dict[str, Any],
) -> None:
    tiles, cut = _map_of(artifacts, context["evidence"]), ask.cut.cut()
    window = _window(ask, tiles, cut)
    side_m = max(window.right - window.left, window.top - window.bottom)
    paper = Paper(window, max(FINEST_M, side_m / MOST_GEOTIFF_PX))
    against = reference_of(reference, ask.method)
    made = draw(tiles, cut, paper, color=ask.color, reference=against)
    words = f"{context['project']}: {_approval_words(context['evidence'])}"
    frame = _frame(artifacts)
    write_geotiff(made, path, frame=frame, span=span_of(ask, made), words=words)


def _export_sheet(
    artifacts: Artifacts,
    ask: SliceExportRequest,
    path: Path,
    *,
    reference: str,
    context: dict[str, Any],
) -> None:
    tiles, cut = _map_of(artifacts, context["evidence"]), ask.cut.cut()
    against = reference_of(reference, ask.method)
    layout = lay_out(_window(ask, tiles, cut), ask.size, ask.scale)
    made = draw(tiles, cut, layout.paper, color=ask.color, reference=against)
    words = Words(
        project=context["project"],
        frame=_frame(artifacts).words,
        sources=source_words(context["key"]),
        approval=_approval_words(context["evidence"]),
        reference=against.name if against else "",
        sensors=tuple(str(name) for name in tiles.facts.get("sensors", [])),
    )
    write_sheet(made, layout, path, span=span_of(ask, made), words=words)


def preview_control(data: bytes, name: str, order: str | None) -> dict[str, Any]:
    """What a survey's file seems to hold."""
    return asdict(read_control(data, name=name, order=order))  # type: ignore[arg-type]


def control_report(artifacts: Artifacts, state: ControlState) -> dict[str, Any]:
    """Residuals of the points that were found in the map."""
    context: dict[str, Any] = null_for_nan(asdict(found := _residuals(artifacts, state)))
    return context | {"passed": found.passed}


def control_file(
    artifacts: Artifacts, state: ControlState, ending: str, context: dict[str, Any]
) -> str:
    """The same as CSV or as a sheet in HTML.

    Raises:
        Altered: If the map, or what says where it lies, is not what was approved.
    """
    evidence = context["evidence"]
    if evidence:
        _map_of(artifacts, evidence)
        evidence.artifact("map", Path(artifacts["map"])).check_all()  # points were found in it
    found, sources = _residuals(artifacts, state), source_words(Path(artifacts["map"]).name)
    words = SheetWords(
        project=context["project"],
        frame=_frame(artifacts).words,
        sources=sources,
        approval=_approval_words(evidence),
    )
    if ending == "html":
        return render_acceptance(found, words)
    line = f"of {words.project}, {words.sources}, {words.frame}. {words.approval}"
    return residual_csv(found, words=line)


def _residuals(artifacts: Artifacts, state: ControlState) -> ControlReport:
    own = _frame(artifacts)
    here = state.of_map(Path(artifacts["map"]).name)
    measured = {name: np.array(p_map) for name, p_map in here.items()}
    if state.frame == "crs":
        if own.to_crs is None:
            raise ConfigError("the map is local: points of a CRS have no place in it")
        measured = {name: own.to_crs(p[None])[0] for name, p in measured.items()}
    surveyed = [ControlPoint(**point.model_dump()) for point in state.points]
    return residuals(surveyed, measured, outdated=state.picks.keys() - here.keys())


def surface_at(artifacts: Artifacts, xyz_m: Xyz, frame: str) -> dict[str, Any]:
    """Where a surveyed point lies in the map, and the map's surface beside it."""
    p = np.array(xyz_m)
    if frame == "crs":
        p = _frame(artifacts).from_crs(p[None])[0]
    found = nearest_surface(tiles_of(artifacts["map"]), p)
    return {"p_map": _xyz(p), "surface": None if found is None else _xyz(found)}


def references_in(folder: Path) -> list[dict[str, Any]]:
    """The references of a project, by name."""
    entries = sorted(folder.iterdir()) if folder.is_dir() else []
    return [
        {"id": entry.name} | _facts_or_problem(entry)
        for entry in entries
        if not entry.name.startswith(".") and (entry / "reference.json").is_file()
    ]


def _facts_or_problem(folder: Path) -> dict[str, Any]:
    """One reference that cannot be read does not hide the others."""
    try:
        return read_facts(folder)
    except StoreError as error:
        words = visible(str(error).replace(f"{folder.parent}/", ""))
        return {"name": f"{folder.name}: {words}", "kind": "damaged", "problem": words}


def span_of(ask: SliceView, made: SliceImage) -> Span:
    """The ends of the colors: as asked, else as usual."""
    low = made.span.low if ask.low is None else ask.low
    high = made.span.high if ask.high is None else ask.high
    if not high > low:
        raise ConfigError(f"colors need a low end below the high end, got {low} and {high}")
    return Span(low, high)


def _approval_words(evidence: Evidence | None) -> str:
    return approval_words(asdict(evidence.stamp) if evidence else None)


def _window(ask: SliceView, tiles: TileSet, cut: Cut) -> SliceWindow:
    if ask.window is not None:
        return SliceWindow(**ask.window.model_dump())
    all_of_it = extent(tiles, cut)
    margin = 0.03 * max(all_of_it.right - all_of_it.left, all_of_it.top - all_of_it.bottom) + 0.05
    return SliceWindow(
        all_of_it.left - margin,
        all_of_it.bottom - margin,
        all_of_it.right + margin,
        all_of_it.top + margin,
    )


def _shaped(window: SliceWindow, aspect: float) -> SliceWindow:
    """Widened to a shape, about its middle."""
    width, height = window.right - window.left, window.top - window.bottom
    if not (width > 0.0 and height > 0.0):
        return window  # refused by the paper, in words
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
        return [f"#{r:02x}{g:02x}{b:02x}" for r, g, b in SENSOR_COLORS]
    return [f"#{r:02x}{g:02x}{b:02x}" for r, g, b in table(color, ground)[::15].tolist()]


def _frame(artifacts: Artifacts) -> MapFrame:
    return frame_of({stage: Path(folder) for stage, folder in artifacts.items()})


def _in_crs(frame: MapFrame, p_map: Xyz) -> Xyz | None:
    return _xyz(frame.to_crs(np.array([p_map]))[0]) if frame.to_crs else None


def _xyz(values: Any) -> Xyz:
    x, y, z = (float(value) for value in values)
    return x, y, z


def read_kept(path: Path) -> dict[str, Any]:
    """JSON that a child kept.

    Raises:
        StoreError: If it is damaged or too large.
    """
    return read_json_object(path, MOST_KEPT_BYTES, failure=StoreError)
