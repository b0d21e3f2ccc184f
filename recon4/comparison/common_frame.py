"""The maps of a comparison: opened with their approval, and put into one frame."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from recon4.comparison.tuning import RELATION
from recon4.errors import ConfigError, GeoreferenceError, StoreError
from recon4.geometry.se3 import SE3, Array, align_points
from recon4.locales.coded import CodedText
from recon4.mapping.tiles import TileSet
from recon4.review.approved import Approval, approval_of, approval_of_map
from recon4.slices.map_crs import MapFrame, frame_of
from recon4.store.ledger import FinishedStage
from recon4.store.project import ProjectDescription, read_artifacts, read_stages
from recon4.store.stage import read_manifest

_ARTIFACTS = "artifacts"


@dataclass(frozen=True, slots=True, eq=False)
class MapSide:
    """One of the two maps."""

    root: Path
    """Its project."""
    name: str
    """Of its project."""
    key: str
    """Of the artifact of the map."""
    tiles: TileSet
    frame: MapFrame
    recordings: frozenset[str]
    """SHA-256 of the files that it was made of; empty = not known."""


@dataclass(frozen=True, slots=True, eq=False)
class Relation:
    """How the second map lies in the first."""

    T_a_b: SE3
    text: str
    """Why, in words."""


def open_side(path: Path) -> MapSide:
    """Open the map of a project, or an earlier one of it.

    Args:
        path: A project, or the folder of a map in its ``artifacts``.

    Raises:
        Altered: If it was approved and is not what was approved, or the approval does not count.
        StoreError: If there is no map of points, or it is damaged.
    """
    path = path.resolve()
    earlier = path.parent.name == _ARTIFACTS and (path / "tiles.json").is_file()
    root = path.parent.parent if earlier else path
    artifacts = dict(read_artifacts(root))
    if not earlier and "map" not in artifacts:
        raise StoreError(CodedText("compare-no-map", root=root.name))
    map_folder = path if earlier else artifacts["map"]
    if earlier:
        approval = approval_of_map(root, path.name)
    else:
        approval = approval_of(root, {stage: folder.name for stage, folder in artifacts.items()})
    artifacts = _artifacts_of(map_folder, artifacts)
    about = ProjectDescription.read(root)
    return MapSide(
        root,
        about.name,
        map_folder.name,
        _tiles(map_folder, artifacts, approval),
        frame_of(artifacts),
        frozenset(file.sha256 for file in about.inputs),
    )


def earlier_maps(root: Path) -> list[Path]:
    """Folders of the maps of earlier runs that a project still has, the newest first.

    Raises:
        StoreError: If the folder is not a project or its ledger is damaged.
    """
    return [root / _ARTIFACTS / row.key for row in earlier_map_rows(root)]


def earlier_map_rows(root: Path) -> list[FinishedStage]:
    """The runs of the stage ``map`` that made them; raises as `earlier_maps`."""
    latest = read_artifacts(root).get("map")
    return [
        row
        for row in reversed(read_stages(root))
        if row.stage == "map"
        and root / _ARTIFACTS / row.key != latest
        and (root / _ARTIFACTS / row.key / "tiles.json").is_file()
    ]


def _artifacts_of(folder: Path, latest: Mapping[str, Path]) -> dict[str, Path]:
    """The artifacts of a map: an earlier one has the frame that it was made in."""
    made_in = read_manifest(folder)["recipe"]["inputs"].get("level")
    level = folder.parent / made_in if made_in else None
    own = {"level": level} if level is not None and level.is_dir() else {}
    return dict(latest) | {"map": folder} | own


def _tiles(folder: Path, artifacts: Mapping[str, Path], approval: Approval | None) -> TileSet:
    if approval is None:
        return TileSet.open(folder)
    approval.evidence.check_frame(artifacts)
    checked = approval.evidence.artifact("map", folder)
    return TileSet.open(folder, checked)


def relate(first: MapSide, second: MapSide) -> Relation | None:
    """How the second map lies in the first, if that follows from what they state.

    Two georeferenced maps in one system have its frame. Runs of one recording that are local begin
    at the same pose and are leveled.

    Returns:
        None if nothing relates them: then only an alignment can.

    Raises:
        ConfigError: If the second map has no points.
        GeoreferenceError: If their systems differ, or not by a rigid motion.
    """
    ours, theirs = first.frame, second.frame
    if ours.to_crs is not None and theirs.to_crs is not None:
        if (ours.wkt, ours.crs) != (theirs.wkt, theirs.crs):
            raise GeoreferenceError(
                CodedText(
                    "compare-crs",
                    first=first.name,
                    first_crs=ours.crs,
                    second=second.name,
                    second_crs=theirs.crs,
                )
            )
        return Relation(_between(first, second), CodedText("compare-georeferenced", crs=ours.crs))
    local = ours.to_crs is None and theirs.to_crs is None
    if local and _same_recording(first, second):
        return Relation(SE3.identity(), CodedText("compare-same-recording"))
    return None


def _same_recording(first: MapSide, second: MapSide) -> bool:
    if first.root == second.root:
        return True
    return bool(first.recordings) and first.recordings == second.recordings


def _between(first: MapSide, second: MapSide) -> SE3:
    """The rigid motion between two maps in one CRS."""
    low, high = second.tiles.bounds_m
    if not np.isfinite(low).all():
        raise ConfigError(CodedText("compare-no-points", second=second.name))
    corners = np.array(np.meshgrid(*zip(low, high, strict=True))).reshape(3, -1).T
    assert second.frame.to_crs is not None
    p_a: Array = first.frame.from_crs(second.frame.to_crs(corners))
    T_a_b = align_points(p_a, corners)
    off_m = float(np.linalg.norm(p_a - T_a_b @ corners, axis=1).max())
    if off_m > RELATION.rigid_m:
        raise GeoreferenceError(
            CodedText("compare-not-rigid", first=first.name, second=second.name, off_m=off_m)
        )
    return T_a_b
