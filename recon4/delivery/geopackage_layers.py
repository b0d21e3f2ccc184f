"""What a map has for a GIS: trajectory, control points, findings, notes, double walls."""

from __future__ import annotations

import json
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from recon4.errors import StoreError
from recon4.evaluation.site_control import ControlRow, control_in
from recon4.export.findings import placed_findings
from recon4.export.geopackage import Feature, FeatureLayer, Value, write_geopackage
from recon4.findings.summary_notes import SaidFinding
from recon4.georeference.crs_file import read_crs
from recon4.locales.coded import CodedText
from recon4.mapping.tiles import TileSet
from recon4.model.site_control import SeenTarget
from recon4.model.trajectory import Trajectory
from recon4.progress import Progress
from recon4.review.annotations import pinned_notes
from recon4.review.journal import read_decided
from recon4.review.state import read_summary
from recon4.slices.doubles import find_double_walls
from recon4.store.arrays import load_trajectory
from recon4.store.json_files import read_object
from recon4.store.stage import read_manifest
from recon4.untrusted.limits import LIMITS


@dataclass(frozen=True, slots=True, eq=False)
class LayerSource:
    """The map of which layers are made."""

    level: Path
    """Artifact with its trajectory and its place."""
    tiles: TileSet
    """In which double walls are searched."""
    crs: str = ""
    """Code of another CRS; empty = that of the map."""


def write_layers(project: Path, path: Path, source: LayerSource, *, progress: Progress) -> str:
    """Write a GeoPackage of a finished map; what is in it, in words.

    Args:
        project: The project folder.
        path: File to write.
        source: The map.
        progress: Counts points.

    Raises:
        GeoreferenceError: If another CRS is requested and the map is not georeferenced.
        StoreError: If a file is damaged, or cannot be written.
    """
    level = source.level
    place = read_crs(level, source.crs)
    layers = (
        _trajectory(load_trajectory(level / "trajectory.npz")),
        _control(project, level),
        *_findings(project),
        _notes(project),
        _double_walls(source.tiles, progress),
    )
    created = str((read_summary(project) or {}).get("created") or "1970-01-01T00:00:00")
    write_geopackage(path, layers, place, changed=f"{created[:19]}.000Z")
    counted = ";".join(f"{one.title}:{len(one.features)}" for one in layers)
    return CodedText("layers-made", layers=counted)


def _trajectory(walk: Trajectory) -> FeatureLayer:
    columns: dict[str, type] = {"start_ns": int, "end_ns": int, "poses": int, "length_m": float}
    t_m = walk.T_a_b.t
    length_m = float(np.linalg.norm(np.diff(t_m, axis=0), axis=1).sum())
    ends = {"start_ns": int(walk.t_ns[0]), "end_ns": int(walk.t_ns[-1])} if len(walk) else {}
    about: dict[str, Value] = {**ends, "poses": len(walk), "length_m": length_m}
    features = [Feature(t_m, about)] if len(walk) > 1 else []
    return FeatureLayer("trajectory", "trajectory", "LINESTRING", columns, features)


def _control(project: Path, level: Path) -> FeatureLayer:
    """Surveyed points that placed or judged this map, with their residuals."""
    names = ("east", "north", "up")
    columns: dict[str, type] = {"id": str, "role": str} | {f"{name}_off_m": float for name in names}
    columns |= {"sd_horizontal_m": float, "sd_height_m": float, "single_handed": int, "w": float}
    record = read_object(level / "georeference.json", max_bytes=LIMITS.findings_bytes)
    outcome, system = control_in(record), read_crs(level)
    surveyed = read_decided(project).control
    used = read_manifest(level)["recipe"]["inputs"].get("control")
    if used is not None and used != read_decided(project).control_key:
        raise StoreError(CodedText("control-changed"))
    features = []
    if outcome is not None and surveyed is not None and system is not None:
        rows = {one.id: one for one in outcome.points}
        features = [
            Feature(system.to_map(np.array([one.xyz_m])), _residual(one, rows[one.id]))
            for one in surveyed.targets
            if one.id in rows
        ]
    return FeatureLayer("control_points", "control and check points", "POINT", columns, features)


def _residual(target: SeenTarget, row: ControlRow) -> dict[str, Value]:
    east, north, up = row.adjusted_m
    test = row.test
    return {
        "id": target.id,
        "role": row.role,
        "east_off_m": east,
        "north_off_m": north,
        "up_off_m": up,
        "sd_horizontal_m": row.sd_m[0],
        "sd_height_m": row.sd_m[1],
        "single_handed": None if test is None else int(test.single_handed),
        "w": None if test is None else test.w,
    }


def _findings(project: Path) -> tuple[FeatureLayer, FeatureLayer]:
    """Each finding at the middle of its stretch, if it has a place; and the stretches as lines."""
    texts = ("kind", "level", "title", "text", "remedy", "sensor", "direction", "values")
    columns: dict[str, type] = dict.fromkeys(texts, str) | {"start_s": float, "end_s": float}
    found = [(line, _said(one)) for one, line in placed_findings(project)]
    places = [Feature(line[len(line) // 2 :][:1], about) for line, about in found]
    stretches = [
        Feature(line, about)
        for line, about in found
        if len(line) > 1 and np.ptp(line, axis=0).max() > 0.0
    ]
    return (
        FeatureLayer("findings", "findings", "POINT", columns, places),
        FeatureLayer(
            "finding_stretches", "stretches of findings", "LINESTRING", columns, stretches
        ),
    )


def _said(one: SaidFinding) -> dict[str, Value]:
    start_s, end_s = one.span_s or (None, None)
    return {
        "kind": str(one.kind),
        "level": str(one.level),
        "title": one.title,
        "text": one.text,
        "remedy": one.remedy,
        "sensor": one.sensor,
        "direction": one.direction,
        "values": json.dumps(one.values, ensure_ascii=False, sort_keys=True),
        "start_s": start_s,
        "end_s": end_s,
    }


def _notes(project: Path) -> FeatureLayer:
    columns: dict[str, type] = dict.fromkeys(("text", "status", "who", "time"), str)
    features = [
        Feature(
            np.array([one.p_map]),
            {"text": one.text, "status": one.status, "who": one.who, "time": one.time},
        )
        for one in pinned_notes(project)
    ]
    return FeatureLayer("notes", "notes", "POINT", columns, features)


def _double_walls(tiles: TileSet, progress: Progress) -> FeatureLayer:
    figures = ("separation_m", "limit_m", "sigma_m", "bimodality")
    columns: dict[str, type] = dict.fromkeys(figures, float) | {"patches": int, "points": int}
    features = []
    if {"normal", "t_ns", "frame_id"} <= set(tiles.fields):  # earlier maps have no normals
        found = find_double_walls(tiles, progress=progress)
        features = [
            Feature(np.array([one.middle_m]), {name: getattr(one, name) for name in columns})
            for one in found.walls
        ]
    return FeatureLayer("double_walls", "double walls", "POINT", columns, features)
