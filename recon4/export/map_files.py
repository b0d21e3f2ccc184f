"""A finished map and its trajectory as files of other programs, with their approval."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from recon4.errors import ConfigError, StoreError
from recon4.export.clouds import CLOUD_FORMATS, cloud_writer
from recon4.export.e57 import ScanPoses, export_e57
from recon4.export.names import check_name
from recon4.export.points import CRS_OF_MAP, OutputCrs
from recon4.georeference.crs_file import read_crs
from recon4.mapping.tiles import TileSet
from recon4.model.trajectory import Trajectory
from recon4.pose_graph.files import load_graph
from recon4.progress import Progress
from recon4.recording.formats.poses import write_kitti
from recon4.review.approval_state import WRITTEN_AS_DRAFT, ApprovalState, approval_state
from recon4.review.approved import approval_of
from recon4.review.evidence import Evidence
from recon4.review.stamp import Stamp, stamp_file
from recon4.store.arrays import load_trajectory
from recon4.store.atomic import atomic_file
from recon4.store.frames import FrameStore
from recon4.store.project import read_artifacts

SCANS = ".e57"
"""Ending of a file that has a scan for each node of the pose graph."""
MAP_ENDINGS = (*CLOUD_FORMATS, SCANS)


@dataclass(frozen=True, slots=True, kw_only=True)
class MapExport:
    """What of a map is written to a file."""

    crs: str = ""
    """Code of a CRS; empty = that of the map, or its local frame."""
    raw: bool = False
    """Points where they were measured, not on their surfaces."""
    all_points: bool = False
    """Also those that the map leaves out: the carrier, what moves, noise; not as E57."""
    draft: bool = False
    """Without an approval, whether or not there is one."""


@dataclass(frozen=True, slots=True)
class ExportedMap:
    """What was written."""

    points: int
    """In the file."""
    left_out: int
    """Points that the map leaves out."""
    all_points: bool
    """Whether they are in the file."""
    approval: ApprovalState
    """Of the map in the file."""

    @property
    def text(self) -> str:
        """Both numbers in words."""
        if not self.left_out:
            return f"{self.points} points"
        if self.all_points:
            return f"{self.points} points, with the {self.left_out} that the map leaves out,"
        return f"{self.points} points, without {self.left_out} (noise, moving, carrier),"


@dataclass(frozen=True, slots=True)
class MapToExport:
    """The map of a finished run, compared with its approval if there is one."""

    tiles: TileSet
    output: OutputCrs
    """The coordinates that are wanted."""
    artifacts: Mapping[str, Path]
    stamp: Stamp | None
    """What the file has to say of the approval; None = not approved, or a draft."""


def map_to_export(
    artifacts: Mapping[str, Path], evidence: Evidence | None, wanted: MapExport
) -> MapToExport:
    """Open a map for an export.

    Args:
        artifacts: Of the run; it has a map.
        evidence: Of its approval; None = not approved, or a draft.
        wanted: Coordinates and kinds of points.

    Raises:
        Altered: If it is not what was approved.
        GeoreferenceError: If a CRS is requested and the map is not georeferenced.
        StoreError: If an artifact cannot be read.
    """
    checked = None
    if evidence:
        evidence.check_frame(artifacts)
        checked = evidence.artifact("map", artifacts["map"])
    place = read_crs(artifacts["level"], wanted.crs)
    output = OutputCrs(place.wkt, place.to_crs) if place else CRS_OF_MAP
    tiles = TileSet.open(artifacts["map"], checked)
    tiles = tiles.as_measured() if wanted.raw else tiles
    return MapToExport(tiles, output, artifacts, evidence.stamp if evidence else None)


def write_map(map_: MapToExport, path: Path, *, all_points: bool, progress: Progress) -> int:
    """Write a map in the format of the ending; the file notes an approval.

    Args:
        map_: The map.
        path: File to write; its ending is one of `MAP_ENDINGS`.
        all_points: Also the points that the map leaves out.
        progress: Counts points.

    Returns:
        How many points were written.

    Raises:
        ConfigError: If the ending is another, or all points are wanted as E57 (no classes).
        StoreError: If the file cannot be written.
    """
    if path.suffix.lower() == SCANS:
        if all_points:
            raise ConfigError(f"E57 has no classes, so it cannot hold all points: {path.name}")
        with atomic_file(path) as temporary:
            return export_e57(
                map_.tiles, temporary, _nodes(map_), output=map_.output, progress=progress
            )
    write = cloud_writer(path)
    # The stamp goes onto a file beside it, so that a file without one is never there.
    with atomic_file(path) as temporary:
        count = write(map_.tiles, temporary, map_.output, all_points=all_points, progress=progress)
        if map_.stamp:
            stamp_file(temporary, temporary, map_.stamp)
    return count


def _nodes(map_: MapToExport) -> ScanPoses:
    """The nodes of the pose graph in the map, with what their scans say of the approval."""
    graph = load_graph(map_.artifacts["verification"])
    poses = load_trajectory(map_.artifacts["level"] / "trajectory.npz").at(graph.t_ns)
    note = f"recon4 approval {map_.stamp.json_line()}" if map_.stamp else "recon4, not approved"
    return ScanPoses(np.asarray(graph.frame_ids, np.int64), graph.t_ns, poses, note)


def export_map(project: Path, path: Path, wanted: MapExport, *, progress: Progress) -> ExportedMap:
    """Write the map of a finished run; the file notes an approval.

    Args:
        project: The project folder.
        path: File to write; its ending is one of `MAP_ENDINGS`.
        wanted: Coordinates and kinds of points.
        progress: Counts points.

    Returns:
        How many points were written, and how many the map leaves out.

    Raises:
        Altered: If it was approved and is not what was approved, or its approval is not to be
            trusted (`approval_of`), unless a draft is wanted; nothing is written.
        ConfigError: If the ending is another.
        GeoreferenceError: If a CRS is requested and the map is not georeferenced.
        StoreError: If there is no map yet or the file cannot be written.
    """
    artifacts = read_artifacts(project)
    if "map" not in artifacts:
        raise StoreError(f"{project} has no map yet: run recon4 process")
    keys = {name: folder.name for name, folder in artifacts.items()}
    approval = None if wanted.draft else approval_of(project, keys)
    map_ = map_to_export(artifacts, approval.evidence if approval else None, wanted)
    count = write_map(map_, path, all_points=wanted.all_points, progress=progress)
    state = WRITTEN_AS_DRAFT if wanted.draft else approval_state(project, keys)
    return ExportedMap(count, map_.tiles.strays, wanted.all_points, state)


def export_poses(project: Path, path: Path, *, draft: bool = False) -> int:
    """Write the poses ``T_map_body`` of all multiframes as KITTI poses, a line each.

    The format has no times and no comments: an approval cannot be noted in it.

    Args:
        project: The project folder.
        path: File to write, ``.txt``.
        draft: Whatever the approval is.

    Returns:
        How many poses were written.

    Raises:
        Altered: If the trajectory was approved and is not what was approved; nothing is written.
        ConfigError: If the ending is another.
        StoreError: If there is no finished trajectory yet or the file cannot be written.
    """
    check_name(path, ".txt")
    artifacts = read_artifacts(project)
    dense = final_trajectory(project, artifacts, draft=draft)
    t_ns = FrameStore.open(artifacts["frames"]).t_mid_ns
    with atomic_file(path) as temporary:
        write_kitti(temporary, Trajectory(t_ns, dense.at(t_ns)))
    return len(t_ns)


def final_trajectory(
    project: Path, artifacts: Mapping[str, Path], *, draft: bool = False
) -> Trajectory:
    """The trajectory ``T_map_body`` of a finished run, compared with its approval if there is one.

    A draft is not compared.

    Raises:
        Altered: If it was approved and is not what was approved.
        StoreError: If there is none yet.
    """
    if not {"frames", "level"} <= artifacts.keys():
        raise StoreError(f"{project} has no finished trajectory yet: run recon4 process")
    keys = {name: folder.name for name, folder in artifacts.items()}
    approval = None if draft else approval_of(project, keys)
    if approval:
        for stage in ("frames", "level"):
            approval.evidence.artifact(stage, artifacts[stage]).check_all()
    return load_trajectory(artifacts["level"] / "trajectory.npz")
