"""The sections of the report for the client after its first page."""

from __future__ import annotations

from collections import Counter
from collections.abc import Mapping, Sequence

import numpy as np

from recon4.findings.wording import title_of, whole_text
from recon4.mapping.tiles import TileSet
from recon4.model.classes import CLASSES, PointClass
from recon4.model.finding import Finding
from recon4.model.pose_graph import Edge, EdgeKind, PoseGraph, Verdict
from recon4.report import charts
from recon4.report.assessment import Assessment
from recon4.report.client import Drawing, FindingBox, Row, Section, Table
from recon4.report.client_control import control_section
from recon4.report.client_drawings import MapDrawings, charts_on_paper
from recon4.report.client_front import accuracy_rows, grouped, shown
from recon4.report.client_words import Words
from recon4.report.html import changed_settings
from recon4.report.rig import origin_rows, rig_outcome, rig_rows, row_cells
from recon4.report.rows import imported_rows, placed_rows
from recon4.report.tuning import CLIENT_REPORT

_LOOPS = (EdgeKind.LOOP, EdgeKind.MANUAL)
"""Edges between two visits of a place."""


def sections(
    assessed: Assessment,
    drawings: MapDrawings,
    notes: Mapping[int, Sequence[str]],
    *,
    words: Words,
) -> list[Section]:
    """All sections that this map has facts for, but the list of files.

    Args:
        assessed: The run.
        drawings: Of its map.
        notes: Place of a finding in ``assessed.findings`` -> notes of reviewers about it.
        words: The catalog.
    """
    made = [
        _drawings(assessed, drawings, words),
        control_section(assessed.results.georeference, words),
        _findings(assessed, drawings, notes, words=words),
        _loops(assessed, drawings, words),
        _precision(assessed, words),
        _classes(assessed, words),
        _comparison(assessed, words),
        _coordinates(assessed, words),
        _sensors(assessed, words),
        _making(assessed, words),
    ]
    return [one for one in made if not one.empty]


def _drawings(assessed: Assessment, drawings: MapDrawings, words: Words) -> Section:
    title, drawn = words("section.drawings"), tuple(drawings.all())
    if not drawn:
        return Section(title=title)
    crs = assessed.results.georeference.get("crs") or {}
    text = words("text.axes_local")
    if isinstance(crs, Mapping) and "origin_m" in crs:
        east, north, up = (words.number(value, 3) for value in crs["origin_m"])
        name = words.term(shown(assessed.facts.crs))
        text = words("text.axes", east=east, north=north, up=up, crs=name)
    return Section(title=title, text=(text,), drawings=drawn)


def _sensors(assessed: Assessment, words: Words) -> Section:
    """The rig with its serial numbers and calibration, and what the recording says of it."""
    facts, results = assessed.facts, assessed.results
    rows = [Row(words("row.rig"), shown(facts.rig))] if facts.rig else []
    rows += _rows(origin_rows(facts.rig_origin), words)
    recorded = imported_rows({"sensors": results.imported.get("sensors", [])})
    rows += _rows(recorded, words)
    tables: tuple[Table, ...] = ()
    if found := rig_rows(results.calibration):
        head = (words("row.sensor"), "", "")
        cells = tuple(row_cells(one._replace(name=shown(one.name)), words) for one in found)
        tables = (Table(head=head, rows=cells, texts=(2,)),)
    outcome = rig_outcome(results.calibration, words.language)
    return Section(
        title=words("section.sensors"),
        text=(outcome,) if outcome else (),
        rows=tuple(rows),
        tables=tables,
    )


def _coordinates(assessed: Assessment, words: Words) -> Section:
    """Leveling, CRS with datum, geoid and factors, and the residuals of the positions."""
    results = assessed.results
    crs = words.term(shown(assessed.facts.crs))
    rows = [Row(words("front.crs"), crs)] if crs else []
    # The points have a section of their own.
    placed = placed_rows(results.georeference, words.language, points=False)
    rows += _rows([(name, text) for name, text in placed if name != "CRS: name" or not rows], words)
    drawn = charts_on_paper(charts.gnss_charts(results.placement.gnss), words)
    return Section(title=words("section.coordinates"), rows=tuple(rows), drawings=drawn)


def _findings(
    assessed: Assessment,
    drawings: MapDrawings,
    notes: Mapping[int, Sequence[str]],
    *,
    words: Words,
) -> Section:
    left = CLIENT_REPORT.most_drawings
    boxes = []
    for place, finding in enumerate(assessed.findings[: CLIENT_REPORT.most_findings]):
        drawing = drawings.of_finding(finding) if left and finding.is_reason else None
        left -= drawing is not None
        boxes.append(
            FindingBox(
                code=str(finding.kind),
                level=str(finding.level),
                label=words.term(finding.level),
                title=title_of(finding.kind, words.language),
                text=shown(whole_text(finding, words.language)),
                where=_where(finding, words),
                acknowledged=tuple(shown(text) for text in notes.get(place, ())),
                drawing=drawing,
            )
        )
    more = len(assessed.findings) - len(boxes)
    text = [words("text.findings")]
    if more > 0:
        text.append(words("text.more_findings", count=str(more)))
    return Section(title=words("section.findings"), text=tuple(text), findings=tuple(boxes))


def _where(finding: Finding, words: Words) -> str:
    """Stretch and place of a finding."""
    parts = []
    if finding.span_s is not None:
        parts.append(words.decimal(f"{finding.span_s[0]:.1f} s – {finding.span_s[1]:.1f} s"))
    if finding.place_m is not None:
        x, y, z = (words.number(value, 1) for value in finding.place_m[0])
        parts.append(f"x {x} m, y {y} m, z {z} m")
    if finding.sensor:
        parts.append(shown(finding.sensor))
    return ", ".join(parts)


def _loops(assessed: Assessment, drawings: MapDrawings, words: Words) -> Section:
    graph = assessed.results.graph
    if graph is None or not graph.edges:
        return Section(title=words("section.loops"))
    weakest = weakest_loops(graph)
    head = tuple(words(f"table.{name}") for name in ("pair", "at", "overlap", "error", "limit"))
    head += (words("table.discrepancy"), words("table.chi2"))
    rows = tuple(_loop_row(graph, edge, words) for edge in weakest[: CLIENT_REPORT.most_loops])
    drawing = drawings.loops(graph)
    return Section(
        title=words("section.loops"),
        text=(words("text.loops" if rows else "text.weakest"),),
        tables=(_verdicts(graph, words), *((Table(head=head, rows=rows),) if rows else ())),
        drawings=(drawing,) if drawing else (),
    )


def weakest_loops(graph: PoseGraph) -> list[Edge]:
    """Accepted loop closures, the one that fits worst first; without a residual the last."""
    loops = [one for one in graph.edges if one.verdict is Verdict.ACCEPTED and one.kind in _LOOPS]
    return sorted(loops, key=lambda one: -one.chi2 if np.isfinite(one.chi2) else np.inf)


def _loop_row(graph: PoseGraph, edge: Edge, words: Words) -> tuple[str, ...]:
    start = graph.t_ns[0]
    at = " / ".join(words.number((graph.t_ns[k] - start) / 1e9, 1) for k in (edge.i, edge.j))
    frames = f"{graph.frame_ids[edge.i]}–{graph.frame_ids[edge.j]}"
    return (
        frames,
        at,
        words.number(edge.overlap, 0, 100.0),
        words.number(edge.error_m, 1, 100.0),
        words.number(edge.limit_m, 1, 100.0),
        words.number(edge.verification_m, 1, 100.0),
        words.number(edge.chi2, 1),
    )


def _verdicts(graph: PoseGraph, words: Words) -> Table:
    """How many edges of each verdict."""
    rows = []
    for verdict in Verdict:
        of_it = [one for one in graph.edges if one.verdict is verdict]
        kinds = Counter(one.kind for one in of_it)
        loops = sum(kinds[kind] for kind in _LOOPS)
        counts = (loops, kinds[EdgeKind.NEIGHBOR], kinds[EdgeKind.ODOMETRY])
        rows.append((words.term(verdict), *map(grouped, counts)))
    head = tuple(words(f"table.{name}") for name in ("verdict", "loops", "neighbors", "odometry"))
    return Table(head=head, rows=tuple(rows))


def _precision(assessed: Assessment, words: Words) -> Section:
    results = assessed.results
    rows = accuracy_rows(assessed, words)
    stated = results.level.uncertainty if results.level else None
    if stated is not None:
        x, y = (words.number(value, 1) for value in stated.at_m[:2])
        at = words("row.at", at=words.number(stated.at_s, 0), x=x, y=y)
        rows.append(Row(words("row.largest_sd"), at))
        help_ = words(
            "row.help_value",
            start=words.number(stated.point_from_s, 0),
            end=words.number(stated.point_to_s, 0),
            sd=words.number(stated.point_sd_m, 1, 100.0),
        )
        rows.append(Row(words("row.help"), help_))
    thickness = results.map.thickness if results.map else None
    tables: tuple[Table, ...] = ()
    if thickness is not None and thickness.planar_coverage is not None:
        covered = f"{words.number(thickness.planar_coverage, 0, 100.0)} %"
        rows.append(Row(words("row.coverage"), covered))
    if thickness is not None and thickness.thickest:
        head = tuple(words(f"table.{name}") for name in ("x", "y", "z", "median", "coverage"))
        cells = tuple(
            (
                *(words.number(value, 1) for value in one.middle_m),
                words.number(one.p50_m, 2, 100.0),
                words.number(one.planar_coverage, 0, 100.0),
            )
            for one in thickness.thickest
        )
        tables = (Table(head=head, rows=cells, title=words("text.thickest")),)
    drawn = _walk_charts(assessed, words)
    title = words("section.precision")
    return Section(title=title, rows=tuple(rows), tables=tables, drawings=drawn)


def _walk_charts(assessed: Assessment, words: Words) -> tuple[Drawing, ...]:
    """Charts along the walk: findings, drift, uncertainty, height, tracking."""
    results = assessed.results
    final = results.final or results.odometry
    if final is None or len(final) < 2:
        return ()
    drawn = charts.walk_charts(
        final,
        results.steps,
        assessed.drift,
        uncertainty=results.uncertainty,
        findings=assessed.findings,
    )
    return charts_on_paper(drawn, words)


def _classes(assessed: Assessment, words: Words) -> Section:
    """The classes of the points of the map with their share, also of those left out."""
    title = words("section.classes")
    folder = assessed.facts.artifacts.get("map")
    counts = TileSet.open(folder).class_counts() if folder is not None else {}
    if not counts:
        return Section(title=title)
    head = tuple(words(f"table.{name}") for name in ("class", "points", "share", "delivered"))
    total = max(sum(counts.values()), 1)
    known = [(CLASSES[PointClass(code)], count) for code, count in counts.items()]
    rows = tuple(
        (
            words.term(facts.title),
            grouped(count),
            words.number(count / total, 2, 100.0),
            words("table.yes" if facts.delivered else "table.no"),
        )
        for facts, count in sorted(known, key=lambda one: (not one[0].delivered, -one[1]))
    )
    corrected = _corrected(assessed, words)
    text = (words("text.classes"), *((words("text.corrected"),) if corrected else ()))
    tables = (Table(head=head, rows=rows, texts=(3,)), *corrected)
    return Section(title=title, text=text, tables=tables)


def _corrected(assessed: Assessment, words: Words) -> tuple[Table, ...]:
    """What people corrected of the classes of the map's points."""
    found = assessed.results.map.corrections if assessed.results.map else ()
    names = ("class", "points", "who", "date", "why")
    rows = tuple(
        (
            words.term(shown(one.to)),
            grouped(one.points),
            shown(one.who),
            shown(one.time[:10]),
            shown(one.why),
        )
        for one in found
    )
    head = tuple(words(f"table.{name}") for name in names)
    return (Table(head=head, rows=rows, texts=(2, 3, 4)),) if rows else ()


def _comparison(assessed: Assessment, words: Words) -> Section:
    found = assessed.facts.evaluation
    title = words("section.comparison")
    if found is None:
        return Section(title=title)
    figures = [
        ("ate", found.aligned.position_m.rmse, 1, "cm"),
        ("ate_raw", found.unaligned.position_m.rmse, 1, "cm"),
        ("coverage", found.coverage_ratio, 1, "%"),
    ]
    if found.relative is not None:
        of = found.relative.point_weighted
        figures.append(("er", of.mean_m, 2, "cm"))
        figures.append(("within2", of.ratio_within_2cm, 1, "%"))
        figures.append(("within5", of.ratio_within_5cm, 1, "%"))
    rows = [
        Row(words(f"comparison.{key}"), f"{words.number(value, digits, 100.0)} {unit}")
        for key, value, digits, unit in figures
    ]
    drawn = charts_on_paper(charts.accuracy_charts(found), words)
    return Section(title=title, rows=tuple(rows), drawings=drawn)


def _making(assessed: Assessment, words: Words) -> Section:
    """Settings, versions, inputs."""
    facts = assessed.facts
    minutes = words.number(sum(stage.seconds for stage in facts.stages) / 60.0, 1)
    rows = [
        Row(words("row.preset"), shown(facts.preset)),
        *(Row(shown(name), shown(text)) for name, text in sorted(facts.versions.items())),
        Row(words("row.computing"), words("row.time", value=minutes)),
    ]
    changed = changed_settings(facts.settings, facts.preset)[: CLIENT_REPORT.most_settings]
    head = tuple(words(f"table.{name}") for name in ("setting", "usual", "used"))
    cells = tuple((shown(name), shown(usual), shown(used)) for name, usual, used in changed)
    key = "text.settings" if cells else "text.settings_none"
    return Section(
        title=words("section.making"),
        rows=tuple(rows),
        text=(words(key, preset=shown(facts.preset)),),
        tables=(Table(head=head, rows=cells, texts=(1, 2)),) if cells else (),
        hashes=tuple(
            Row(shown(one.name), one.sha256) for one in facts.inputs[: CLIENT_REPORT.most_files]
        ),
    )


def _rows(pairs: Sequence[tuple[str, str]], words: Words) -> list[Row]:
    return [Row(words.label(shown(name)), words.value(shown(text))) for name, text in pairs]
