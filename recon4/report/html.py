"""The quality report: one self-contained HTML file (no scripts, no network)."""

from __future__ import annotations

import json
from dataclasses import asdict
from functools import cache, partial
from pathlib import Path
from typing import Any

import numpy as np
from jinja2 import Environment, PackageLoader, StrictUndefined

from recon4.evaluation.table import number, percentage
from recon4.findings.derived import derived_text
from recon4.findings.drift import DriftClosed
from recon4.findings.walk_record import WalkRecord, path_length_m
from recon4.findings.wording import headline
from recon4.mapping.tiles import Surface, TileSet, surface_text
from recon4.model.figures import MapFigures
from recon4.model.import_notes import derived_in
from recon4.model.pose_graph import EdgeKind
from recon4.model.tried_hypotheses import TriedHypothesis
from recon4.report import chart_groups
from recon4.report.approval import draft_block
from recon4.report.assessment import Assessment
from recon4.report.edges import EdgeRow, edge_rows
from recon4.report.facts import ReportFacts
from recon4.report.findings import LEVELS, shown_findings
from recon4.report.maps import map_chunks, rasterize
from recon4.report.rig import origin_rows, rig_outcome, rig_rows
from recon4.report.rows import imported_rows, placed_rows
from recon4.report.tried_hypotheses import COLUMNS, tried_rows
from recon4.settings import Settings, preset
from recon4.store.atomic import write_text
from recon4.store.tried_hypotheses import read_tried


def write_report(path: Path, assessed: Assessment) -> None:
    """Write the report of a finished run.

    Args:
        path: The ``.html`` file; replaced only when the new one is complete.
        assessed: The run as read and judged; sections without facts are left out.

    Raises:
        StoreError: If an artifact is damaged or the file cannot be written.
    """
    write_text(path, render(assessed))


def render(assessed: Assessment) -> str:
    """The report as HTML text; all names are escaped."""
    facts, results, drift = assessed.facts, assessed.results, assessed.drift
    tiles = TileSet.open(facts.artifacts["map"]) if "map" in facts.artifacts else None
    rasters = rasterize(partial(map_chunks, tiles)) if tiles is not None else []
    usability = assessed.verdict.usability
    page = (
        environment()
        .get_template("template.html.jinja")
        .render(
            facts=facts,
            thickness=results.map.thickness if results.map else None,
            results=results,
            findings=shown_findings(assessed.findings),
            approval=draft_block(),
            level=LEVELS[usability],
            verdict=headline(usability),
            key_figures=_key_figures(facts, results, drift, tiles=tiles),
            maps=chart_groups.map_figures(rasters),
            walk=chart_groups.trajectory_figures(
                results, drift, rasters, findings=assessed.findings
            ),
            edges=chart_groups.edge_figures(results, rasters),
            edge_kinds=[str(kind) for kind in EdgeKind],
            edge_rows=_edge_rows(facts, results),
            tried_columns=COLUMNS,
            tried=tried_rows(_tried(facts)),
            accuracy=chart_groups.accuracy_figures(facts),
            intensity=chart_groups.intensity_figures(results, rasters),
            rig_origin=origin_rows(facts.rig_origin),
            rig_rows=rig_rows(results.calibration),
            rig_outcome=rig_outcome(results.calibration),
            rig_figures=chart_groups.rig_figures(results),
            placed=placed_rows(results.georeference),
            placed_charts=chart_groups.georeference_figures(results),
            imported=imported_rows(results.imported),
            derived=[derived_text(one) for one in derived_in(results.imported)],
            changed=changed_settings(facts.settings, facts.preset),
            all_settings=_flat(asdict(facts.settings)),
            frame=_frame(facts, results),
            total_s=sum(stage.seconds for stage in facts.stages),
            peak_bytes=max((stage.peak_bytes for stage in facts.stages), default=0),
        )
    )
    return page.encode("utf-8", errors="replace").decode("utf-8")  # invalid file names


@cache
def environment() -> Environment:
    """Templates of this folder, with the filters they use; all texts are escaped.

    Each is compiled once in a process.
    """
    made = Environment(
        loader=PackageLoader("recon4.report", "."),
        autoescape=True,
        undefined=StrictUndefined,
        trim_blocks=True,
        lstrip_blocks=True,
    )
    made.filters |= {"number": number, "percentage": percentage, "short": _short, "size": _size}
    return made


def _tried(facts: ReportFacts) -> tuple[TriedHypothesis, ...]:
    folder = facts.artifacts.get("odometry")
    return read_tried(folder) if folder is not None else ()


def _edge_rows(facts: ReportFacts, results: WalkRecord) -> list[EdgeRow]:
    if results.graph is None:
        return []
    return edge_rows(results.graph, limit_m=facts.settings.verification.limit_m)


def _frame(facts: ReportFacts, results: WalkRecord) -> str:
    """Frame and unit of the coordinates."""
    if facts.crs:
        return f"{facts.crs} (meters)"
    leveled = results.placement.is_leveled
    return f"local map frame, {'z up' if leveled else 'not leveled'} (meters)"


def changed_settings(settings: Settings, preset_name: str) -> list[tuple[str, str, str]]:
    """Settings that differ from their preset: name, value in the preset, value used."""
    usual, used = dict(_flat(asdict(preset(preset_name)))), dict(_flat(asdict(settings)))
    return [(name, usual[name], used[name]) for name in used if used[name] != usual[name]]


def _key_figures(
    facts: ReportFacts, results: WalkRecord, drift: DriftClosed | None, *, tiles: TileSet | None
) -> list[tuple[str, str, str]]:
    """Name, value and unit of the figures on top."""
    out: list[tuple[str, str, str]] = []
    walk = results.final or results.odometry
    if walk is not None and len(walk) > 1:
        seconds = (walk.t_ns[-1] - walk.t_ns[0]) / 1e9
        out.append(("duration", _duration(seconds), "min:s"))
        out.append(("path length", number(float(path_length_m(walk)[-1]), 1), "m"))
    if "lost" in results.steps:
        out.append(("multiframes", _grouped(len(results.steps["lost"])), ""))
    if tiles is not None:
        out.append(("points in the map", _grouped(len(tiles)), ""))
        if tiles.surface == "fitted":
            out.append(("points left out", _grouped(tiles.strays), ""))
    if results.graph is not None:
        kept = sum(edge.in_graph for edge in results.graph.edges)
        out.append(
            (
                "edges accepted / registered",
                f"{_grouped(kept)} / {_grouped(len(results.graph.edges))}",
                "",
            )
        )
    if drift is not None:
        name = "largest drift corrected" if len(drift.loop_after_m) else "largest correction"
        out.append((name, number(drift.largest_m, 1, 100.0), "cm"))
    if facts.evaluation is not None and facts.evaluation.relative is not None:
        e_r = facts.evaluation.relative.point_weighted.mean_m
        out.append(("e_r", number(e_r, 2, 100.0), "cm"))
    if facts.stages:
        out.append(("computing time", _duration(sum(s.seconds for s in facts.stages)), "min:s"))
    return out + _thickness(results.map)


def _thickness(found: MapFigures | None) -> list[tuple[str, str, str]]:
    """Thickness where the points lie and where they were measured, in the words of the slices."""
    if found is None:
        return []
    where: Surface = found.surface
    rows = [(surface_text(where), found.thickness)]
    if found.thickness_as_measured is not None:
        rows.append((surface_text("raw"), found.thickness_as_measured))
    out = []
    for words, thickness in rows:
        if thickness is None or thickness.p50_m is None or thickness.p95_m is None:
            continue
        spread = f"{number(thickness.p50_m, 2, 100.0)} / {number(thickness.p95_m, 2, 100.0)}"
        out.append((f"thickness σ {words}, median / p95", spread, "cm"))
    covered = found.thickness.planar_coverage if found.thickness else None
    if out and covered is not None:
        out.append(("planar places", number(covered, 0, 100.0), "%"))
    return out


def _flat(value: Any, prefix: str = "") -> list[tuple[str, str]]:
    """Nested facts as dotted names and short texts."""
    if isinstance(value, dict):
        pairs = [
            _flat(item, f"{prefix}.{key}" if prefix else str(key)) for key, item in value.items()
        ]
        return [row for rows in pairs for row in rows]
    if isinstance(value, (list, tuple)) and len(value) > 6:
        return [(prefix, f"{len(value)} entries")]
    return [(prefix, _short(value))]


def _short(value: Any) -> str:
    if isinstance(value, float):
        return f"{value:.6g}" if np.isfinite(value) else "–"
    if isinstance(value, int) and not isinstance(value, bool):
        return _grouped(value) if abs(value) >= 10_000 else str(value)
    if isinstance(value, str):
        return value
    return json.dumps(value, ensure_ascii=False)


def _grouped(count: int) -> str:
    """12 345 678, with thin spaces that do not break."""
    return f"{count:,}".replace(",", "\u202f")


def _size(count: int) -> str:
    for unit, size in (("GB", 1e9), ("MB", 1e6), ("kB", 1e3)):
        if count >= size:
            return f"{count / size:.1f} {unit}"
    return f"{count} bytes"


def _duration(seconds: float) -> str:
    whole = round(seconds)
    return f"{whole // 60}:{whole % 60:02d}"
