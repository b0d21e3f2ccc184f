"""The findings of a map as a table (CSV) and as geometries for a GIS (GeoJSON)."""

from __future__ import annotations

import csv
import io
from pathlib import Path

import numpy as np

from recon4.errors import ConfigError, StoreError
from recon4.export.cells import safe_cell
from recon4.export.geojson import MapSystem, collection, feature
from recon4.export.tuning import FINDING_EXPORT
from recon4.findings.summary_notes import SaidFinding, findings_in
from recon4.geometry.se3 import Array
from recon4.georeference.crs_file import read_crs
from recon4.locales.coded import CodedText
from recon4.model.trajectory import Trajectory
from recon4.review.state import read_summary
from recon4.store.arrays import load_trajectory
from recon4.store.atomic import write_text
from recon4.store.project import read_artifacts

ENDINGS = (".csv", ".geojson")
_STAGES = ("level", "map_2d")
"""Whose trajectory the map has, of each kind of walk."""
_COLUMNS = ("kind", "level", "title", "start_s", "end_s", "sensor", "direction", "text", "remedy")


def export_findings(project: Path, path: Path) -> int:
    """Write the findings of a finished map; returns how many.

    Args:
        project: The project folder.
        path: File to write, ``.csv`` or ``.geojson``.

    Raises:
        ConfigError: If the ending is another.
        StoreError: If there is no map yet, an earlier version made it, or the file cannot be
            written.
    """
    found, text = findings_file(project, path.suffix.lower())
    write_text(path, text)
    return found


def findings_file(project: Path, ending: str) -> tuple[int, str]:
    """How many findings a finished map has, and the file as text; see `export_findings`."""
    if ending not in ENDINGS:
        raise ConfigError(CodedText("findings-endings", got=ending or CodedText("no-ending")))
    placed = placed_findings(project)
    findings, lines = [one for one, _ in placed], [line for _, line in placed]
    artifacts = read_artifacts(project)
    place = read_crs(artifacts["level"]) if "level" in artifacts else None
    if ending == ".csv":
        return len(findings), _table(findings, lines, place)
    return len(findings), _geometries(findings, lines, place)


def placed_findings(project: Path) -> list[tuple[SaidFinding, Array]]:
    """The findings of a finished map with their positions in it [m], (N, 3); see `_line`.

    Raises:
        StoreError: If there is no map yet, or an earlier version made it.
    """
    findings = findings_in(read_summary(project) or {})
    if findings is None:
        raise StoreError(CodedText("findings-none", project=str(project)))
    walk = _walk(read_artifacts(project))
    return [(one, _line(one, walk)) for one in findings]


def _walk(artifacts: dict[str, Path]) -> Trajectory | None:
    files = [artifacts[name] / "trajectory.npz" for name in _STAGES if name in artifacts]
    return next((load_trajectory(file) for file in files if file.exists()), None)


def _line(finding: SaidFinding, walk: Trajectory | None) -> Array:
    """Positions along the stretch of a finding in the map [m], (N, 3); none if it has no place."""
    if finding.span_s is None or walk is None or not len(walk):
        return np.array(finding.place_m or ()).reshape(-1, 3)
    ends_ns = walk.t_ns[0] + np.rint(1e9 * np.array(finding.span_s)).astype(np.int64)
    ends_ns = np.clip(ends_ns, walk.t_ns[0], walk.t_ns[-1])
    between = walk.T_a_b.t[(walk.t_ns > ends_ns[0]) & (walk.t_ns < ends_ns[1])]
    first, last = walk.at(ends_ns).t
    return np.concatenate(
        [[first], between[:: max(1, -(-len(between) // FINDING_EXPORT.max_line_points))], [last]]
    )


def _table(findings: list[SaidFinding], lines: list[Array], place: MapSystem | None) -> str:
    """One row a finding, with both ends of its stretch in the CRS of the map or its local frame."""
    out = io.StringIO()
    frame = f"easting, northing, height in {place.crs}" if place else "x, y, z in the map frame"
    out.write(f"# recon4 findings; coordinates: {frame} [m]\n")
    axes = ("easting", "northing", "height") if place else ("x", "y", "z")
    ends = [f"{end}_{axis}_m" for end in ("from", "to") for axis in axes]
    rows = csv.writer(out, lineterminator="\n")
    rows.writerow([*_COLUMNS, *ends])
    for finding, line in zip(findings, lines, strict=True):
        start_s, end_s = finding.span_s or ("", "")
        values = {"start_s": start_s, "end_s": end_s}
        cells = [str(values.get(name, getattr(finding, name, ""))) for name in _COLUMNS]
        p = line[[0, -1]] if len(line) else line
        p = place.to_crs(p) if place and len(p) else p
        rows.writerow([*map(safe_cell, cells), *(f"{value:.3f}" for value in p.ravel())])
    return out.getvalue()


def _geometries(findings: list[SaidFinding], lines: list[Array], place: MapSystem | None) -> str:
    """A feature a finding: its stretch of the walk, a point, or no geometry."""
    features = [
        feature(line, place, _properties(finding))
        for finding, line in zip(findings, lines, strict=True)
    ]
    return collection(features, place)


def _properties(finding: SaidFinding) -> dict[str, object]:
    start_s, end_s = finding.span_s or (None, None)
    return {
        "kind": finding.kind,
        "level": finding.level,
        "title": finding.title,
        "start_s": start_s,
        "end_s": end_s,
        "sensor": finding.sensor,
        "direction": finding.direction,
        "text": finding.text,
        "remedy": finding.remedy,
        "values": finding.values,
    }
