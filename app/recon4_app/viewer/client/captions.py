"""Captions of picked edges, picked points and measurements."""

from __future__ import annotations

import csv
import io
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from urllib.parse import quote

import numpy as np

from recon4.geometry.se3 import Array
from recon4.model.pose_graph import Edge, Measure
from recon4_app.viewer.client.view import Position
from recon4_app.viewer.cloud.pick import PickedCell, PickedPoint
from recon4_app.viewer.scene.build import GnssMarks
from recon4_app.viewer.scene.layers import KIND_LABELS, EdgeTable

_MEASURES = {
    Measure.NONE: "{}",
    Measure.OVERLAP: "overlap {}",
    Measure.ERROR: "error {} m",
    Measure.MATCHES: "matches {}",
    Measure.DEGENERACY: "degeneracy {}",
    Measure.SEEN_THROUGH: "seen through {}",
    Measure.CONFIRMED: "{} nodes confirm it",
    Measure.CONTRADICTED: "{} nodes contradict it",
    Measure.PATHS: "path discrepancy {} m",
    Measure.CHI2: "chi² {}",
}


@dataclass(frozen=True, slots=True)
class Facts:
    """A titled table of labels and values, with a link."""

    title: str
    rows: tuple[tuple[str, str], ...]
    link: tuple[str, str] | None = None
    """Text and path on this server."""


def edge_facts(table: EdgeTable, row: int, project: str) -> Facts:
    """Attributes of an edge."""
    edge, t_ns = table.graph.edges[row], table.graph.t_ns
    began_ns = t_ns[0]
    at = [f"{(t_ns[node] - began_ns) * 1e-9:.1f} s" for node in (edge.i, edge.j)]
    limit = f" of {_number(edge.limit_m)} m" if np.isfinite(edge.limit_m) else ""
    rows = [
        ("Nodes", f"{edge.i} at {at[0]}, {edge.j} at {at[1]}"),
        ("Kind", KIND_LABELS[edge.kind]),
        ("Verdict", str(edge.verdict)),
        ("Reason", str(edge.reason)),
        ("Overlap", _number(edge.overlap)),
        ("Error", f"{_number(edge.error_m)} m{limit}" if np.isfinite(edge.error_m) else ""),
        (
            "Alternative paths",
            f"{edge.paths}, median {_number(edge.verification_m)} m" * (edge.paths > 0),
        ),
        ("chi²", _number(edge.chi2)),
        *_history(edge),
    ]
    # seen from the viewer's page: the server may have a prefix
    link = f"../../{quote(project)}/review/?edge={edge.i}-{edge.j}"
    kept = tuple((label, value) for label, value in rows if value)
    return Facts(f"Edge {edge.i}\u2013{edge.j}", kept, ("Open in review", link))


def _history(edge: Edge) -> Iterator[tuple[str, str]]:
    """Who judged an edge, in order: the verdict, why, and by which figure."""
    for count, one in enumerate(edge.judgments, start=1):
        figure = _MEASURES[one.measure].format(_number(one.value)) if one.value is not None else ""
        limit = f" of {_number(one.limit)}" if figure and one.limit is not None else ""
        why = [str(one.verdict), str(one.reason), figure + limit, one.note]
        yield f"{count}. {one.person or one.by}", ", ".join(filter(None, why))


def gnss_facts(marks: GnssMarks, row: int, *, began_ns: int) -> Facts:
    """Attributes of a GNSS fix."""
    residual = marks.p_map[row] - marks.p_antenna[row]
    rows = (
        ("Time", f"{(marks.t_ns[row] - began_ns) * 1e-9:.1f} s"),
        ("Verdict", "used" if marks.used[row] else "rejected as an outlier"),
        ("Residual, east north up", " ".join(f"{value:+.3f}" for value in residual) + " m"),
        ("Horizontal residual", f"{np.linalg.norm(residual[:2]):.3f} m"),
        ("x y z, m", " ".join(f"{value:.4f}" for value in marks.p_map[row])),
    )
    return Facts("GNSS fix", rows)


def point_facts(
    point: PickedPoint,
    *,
    sensors: Sequence[str],
    began_ns: int,
    crs: tuple[str, Array] | None,
) -> Facts:
    """Attributes of a point of the map."""
    named = point.sensor < len(sensors)
    normalized = point.intensity_normalized
    rows = [
        ("x y z, m", " ".join(f"{value:.4f}" for value in point.p_map)),
        *([(crs[0], " ".join(f"{value:.4f}" for value in crs[1][0]))] if crs else []),
        ("Time", f"{(point.t_ns - began_ns) * 1e-9:.3f} s"),
        ("Sensor, ring", f"{sensors[point.sensor] if named else point.sensor}, {point.ring}"),
        ("Multiframe", str(point.frame_id)),
        ("Raw intensity", str(point.intensity)),
        *([("Normalized", f"{normalized:.4g}")] if normalized is not None else []),
        ("Distance from the sensor", f"{point.range_m:.3f} m"),
    ]
    return Facts("Point", tuple(rows))


def cell_facts(cell: PickedCell) -> Facts:
    """A place of a 2-D map."""
    rows = (
        ("x y, m", " ".join(f"{value:.3f}" for value in cell.p_map[:2])),
        ("What", cell.what),
        ("Cell", f"{100.0 * cell.cell_m:g} cm"),
    )
    return Facts("Place", rows)


def measurement_facts(number: int, points: tuple[Position, ...]) -> Facts:
    """A measured point, or a distance with its components."""
    if len(points) == 1:
        return Facts(f"{number}. Point", (("x y z, m", " ".join(f"{v:.4f}" for v in points[0])),))
    offset = np.subtract(points[1], points[0])
    return Facts(
        f"{number}. Distance",
        (
            ("Distance", f"{np.linalg.norm(offset):.4f} m"),
            ("Horizontal", f"{np.linalg.norm(offset[:2]):.4f} m"),
            ("Vertical", f"{offset[2]:+.4f} m"),
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


def _number(value: float) -> str:
    return f"{value:.3g}" if np.isfinite(value) else ""
