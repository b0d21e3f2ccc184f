"""Captions of picked edges, picked points and measurements."""

from __future__ import annotations

import csv
import io
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from urllib.parse import quote

import numpy as np

from recon4.geometry.se3 import Array
from recon4.locales.texts import Texts
from recon4.model.pose_graph import Edge, Judgment, Measure
from recon4_app.viewer.client.view import Position
from recon4_app.viewer.cloud.pick import PickedCell, PickedPoint
from recon4_app.viewer.scene.build import Content, GnssMarks
from recon4_app.viewer.scene.layers import EdgeTable, kind_text, reason_text
from recon4_app.viewer.words import word_of


@dataclass(frozen=True, slots=True)
class Facts:
    """A titled table of labels and values, with a link."""

    title: str
    rows: tuple[tuple[str, str], ...]
    link: tuple[str, str] | None = None
    """Text and path on this server."""


def edge_facts(table: EdgeTable, row: int, project: str, *, say: Texts) -> Facts:
    """Attributes of an edge, in the language of texts."""
    edge, t_ns = table.graph.edges[row], table.graph.t_ns
    at = [float(t_ns[node] - t_ns[0]) * 1e-9 for node in (edge.i, edge.j)]
    nodes = {"i": edge.i, "at-i": at[0], "j": edge.j, "at-j": at[1]}
    reason = reason_text(edge.reason)
    rows = [
        ("nodes", say("nodes-at", **nodes)),
        ("kind", say(kind_text(edge.kind))),
        ("verdict", word_of("verdict", str(edge.verdict), say)),
        ("reason", say(reason) if reason else ""),
        ("overlap", _figure("short-figure", edge.overlap, say)),
        ("error", _error(edge, say)),
        ("paths", _paths(edge, say)),
    ]
    kept = [(say(f"row-{name}"), value) for name, value in rows if value]
    if np.isfinite(edge.chi2):
        kept.append(("chi²", say("short-figure", value=float(edge.chi2))))
    kept += [(name, value) for name, value in _history(edge, say) if value]
    # seen from the viewer's page: the server may have a prefix
    link = f"../../{quote(project)}/review/?edge={edge.i}-{edge.j}"
    return Facts(say("title-edge", i=edge.i, j=edge.j), tuple(kept), (say("open-in-review"), link))


def _error(edge: Edge, say: Texts) -> str:
    if not np.isfinite(edge.error_m):
        return ""
    if not np.isfinite(edge.limit_m):
        return say("error-alone", error=float(edge.error_m))
    return say("error-of", error=float(edge.error_m), limit=float(edge.limit_m))


def _paths(edge: Edge, say: Texts) -> str:
    if not edge.paths:
        return ""
    return say("paths-median", count=edge.paths, median=float(edge.verification_m))


def _history(edge: Edge, say: Texts) -> Iterator[tuple[str, str]]:
    """Who judged an edge, in order: the verdict, why, and by which figure."""
    for count, one in enumerate(edge.judgments, start=1):
        judge = one.person or word_of("judge", str(one.by), say)
        reason = reason_text(one.reason)
        why = [
            word_of("verdict", str(one.verdict), say),
            say(reason) if reason else "",
            _judged(one, say),
            one.note,
        ]
        yield say("by-number", number=count, judge=judge), ", ".join(filter(None, why))


def _judged(one: Judgment, say: Texts) -> str:
    """The figure that decided a judgment, with its limit; empty without one."""
    if one.value is None or not np.isfinite(one.value):
        return ""
    name = one.measure.name.lower().replace("_", "-")
    known = f"judged-{name}" if one.measure is not Measure.NONE else "short-figure"
    figure = say(known, value=float(one.value))
    if one.limit is None or not np.isfinite(one.limit):
        return figure
    return say("figure-of", figure=figure, limit=float(one.limit))


def gnss_facts(marks: GnssMarks, row: int, *, began_ns: int, say: Texts) -> Facts:
    """Attributes of a GNSS fix, in the language of texts."""
    residual = marks.p_map[row] - marks.p_antenna[row]
    east, north, up = (float(value) for value in residual)
    horizontal_m = float(np.linalg.norm(residual[:2]))
    rows = (
        (say("row-time"), say("time-s", s=float(marks.t_ns[row] - began_ns) * 1e-9)),
        (say("row-verdict"), say("fix-used" if marks.used[row] else "fix-rejected")),
        (say("row-residual"), say("residual-enu", east=east, north=north, up=up)),
        (say("row-residual-horizontal"), say("meters-3", m=horizontal_m)),
        ("x y z, m", " ".join(f"{value:.4f}" for value in marks.p_map[row])),
    )
    return Facts(say("title-fix"), rows)


def point_facts(
    point: PickedPoint,
    content: Content,
    *,
    crs: tuple[str, Array] | None,
    say: Texts,
) -> Facts:
    """Attributes of a point of the map, in the language of texts."""
    sensors, cloud = content.sensors, content.cloud
    began_ns = cloud.began_ns if cloud is not None else 0
    named = point.sensor < len(sensors)
    normalized = point.intensity_normalized
    sensor = sensors[point.sensor] if named else point.sensor
    rows = [
        ("x y z, m", " ".join(f"{value:.4f}" for value in point.p_map)),
        *([(crs[0], " ".join(f"{value:.4f}" for value in crs[1][0]))] if crs else []),
        (say("row-time"), say("time-ms", s=float(point.t_ns - began_ns) * 1e-9)),
        (say("row-sensor"), f"{sensor}, {point.ring}"),
        (say("one-multiframe"), str(point.frame_id)),
        (say("row-raw-intensity"), str(point.intensity)),
        *(
            [(say("row-normalized"), say("figure", value=float(normalized)))]
            if normalized is not None
            else []
        ),
        (say("row-range"), say("meters-3", m=float(point.range_m))),
    ]
    return Facts(say("title-point"), tuple(rows))


def cell_facts(cell: PickedCell, say: Texts) -> Facts:
    """A place of a 2-D map, in the language of texts."""
    rows = (
        ("x y, m", " ".join(f"{value:.3f}" for value in cell.p_map[:2])),
        (say("row-what"), word_of("cell", cell.what, say)),
        (say("row-cell"), say("cell-cm", cm=100.0 * cell.cell_m)),
    )
    return Facts(say("title-place"), rows)


def measurement_facts(number: int, points: tuple[Position, ...], say: Texts) -> Facts:
    """A measured point, or a distance with its components, in the language of texts."""
    if len(points) == 1:
        place = " ".join(f"{v:.4f}" for v in points[0])
        return Facts(say("title-measured-point", number=number), (("x y z, m", place),))
    offset = np.subtract(points[1], points[0])
    length_m, horizontal_m = float(np.linalg.norm(offset)), float(np.linalg.norm(offset[:2]))
    return Facts(
        say("title-measured-distance", number=number),
        (
            (say("row-distance"), say("meters-4", m=length_m)),
            (say("row-horizontal"), say("meters-4", m=horizontal_m)),
            (say("row-vertical"), say("meters-signed", m=float(offset[2]))),
        ),
    )


def measurements_csv(measurements: Sequence[tuple[Position, ...]]) -> str:
    """All measurements as CSV, one per line."""
    text = io.StringIO()
    rows = csv.writer(text, lineterminator="\n")
    names = "number x1_m y1_m z1_m x2_m y2_m z2_m distance_m horizontal_m vertical_m"
    rows.writerow(names.split())
    for number, points in enumerate(measurements, start=1):
        offset = np.subtract(points[-1], points[0])
        lengths = (np.linalg.norm(offset), np.linalg.norm(offset[:2]), offset[2])
        second = (*points[1], *lengths) if len(points) == 2 else ("",) * 6
        values = (*points[0], *second)
        rows.writerow([number, *(v if v == "" else f"{float(v):.5f}" for v in values)])
    return text.getvalue()


def _figure(name: str, value: float, say: Texts) -> str:
    return say(name, value=float(value)) if np.isfinite(value) else ""
