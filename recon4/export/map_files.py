"""A finished map and its trajectory as files of other programs, with their approval."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Protocol

import numpy as np

from recon4.errors import ConfigError, StoreError
from recon4.export.copc import export_copc
from recon4.export.e57 import export_e57
from recon4.export.laz import export_laz
from recon4.export.names import COPC, check_name
from recon4.export.node_scans import ScanPoses
from recon4.export.options import ExportOptions
from recon4.export.pcd import export_pcd
from recon4.export.ply import export_ply
from recon4.export.points import CRS_OF_MAP, OutputCrs, PointSource
from recon4.export.ptx import export_ptx
from recon4.export.selection import DELIVERED, PointSelection
from recon4.export.xyz import export_xyz
from recon4.georeference.crs_file import read_crs
from recon4.locales.coded import CodedText
from recon4.mapping.tiles import TileSet
from recon4.model.trajectory import Trajectory
from recon4.pose_graph.files import load_graph
from recon4.products.storeys import find_storeys, storey_heights
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

SCANS = {".e57": export_e57, ".ptx": export_ptx}
"""Ending of a file that has a scan for each node of the pose graph, and who writes it."""


@dataclass(frozen=True, slots=True)
class ExportedMap:
    """What was written."""

    points: int
    """In the file."""
    left_out: int
    """Points that the map leaves out."""
    of_points: int
    """Points of the map, without these."""
    approval: ApprovalState
    """Of the map in the file."""

    @property
    def text(self) -> str:
        """The numbers in words."""
        return points_text(self.points, self.of_points, self.left_out)


def points_text(points: int, of_points: int, left_out: int) -> str:
    """How many points are in a file of a map.

    Args:
        points: In the file.
        of_points: That the map delivers.
        left_out: That it leaves out.
    """
    if points == of_points + left_out and left_out:
        return CodedText("points-with", points=points, left_out=left_out)
    if points != of_points:
        return CodedText("points-of", points=points, all=of_points)
    if not left_out:
        return CodedText("points-all", points=points)
    return CodedText("points-without", points=points, left_out=left_out)


@dataclass(frozen=True, slots=True)
class MapToExport:
    """The map of a finished run, compared with its approval if there is one."""

    tiles: TileSet
    output: OutputCrs
    """The coordinates that are wanted, and the approval that the file has to name."""
    selection: PointSelection
    """The points that are wanted."""
    artifacts: Mapping[str, Path]
    stamp: Stamp | None
    """What the file has to say of the approval; None = not approved, or a draft."""


def map_to_export(
    artifacts: Mapping[str, Path], evidence: Evidence | None, wanted: ExportOptions
) -> MapToExport:
    """Open a map for an export.

    Args:
        artifacts: Of the run; it has a map.
        evidence: Of its approval; None = not approved, or a draft.
        wanted: Coordinates and points.

    Raises:
        Altered: If it is not what was approved.
        ConfigError: If there is no such class or storey.
        GeoreferenceError: If a CRS is requested and the map is not georeferenced.
        StoreError: If an artifact cannot be read.
    """
    wanted.selection()  # refuses what cannot be before the map is read
    checked = None
    if evidence:
        evidence.check_frame(artifacts)
        checked = evidence.artifact("map", artifacts["map"])
    place = read_crs(artifacts["level"], wanted.crs)
    stamp = evidence.stamp if evidence else None
    seal = _seal_with(stamp) if stamp else None
    output = OutputCrs(seal=seal)
    if place:
        output = OutputCrs(place.wkt, place.to_crs, seal)
    tiles = TileSet.open(artifacts["map"], checked)
    heights_m = storey_heights(find_storeys(tiles), wanted.storey) if wanted.storey else None
    tiles = tiles.as_measured() if wanted.raw else tiles
    return MapToExport(tiles, output, wanted.selection(heights_m), artifacts, stamp)


def _seal_with(stamp: Stamp) -> Callable[[Path], None]:
    return lambda path: stamp_file(path, path, stamp)


def write_map(map_: MapToExport, path: Path, *, progress: Progress) -> int:
    """Write a map in the format of the ending, and read it back; the file notes an approval.

    Args:
        map_: The map.
        path: File to write; its ending is one of `CLOUD_FORMATS`, or `SCANS`.
        progress: Counts points.

    Returns:
        How many points were written.

    Raises:
        ConfigError: If the ending is another, there are no such points, or the format cannot hold
            them (E57 and PTX have no classes).
        StoreError: If the file cannot be written, or reads back wrong.
    """
    if write_scans := SCANS.get(path.suffix.lower()):
        source = PointSource.of(map_.tiles, map_.output, map_.selection, progress=progress)
        with atomic_file(path) as temporary:
            return write_scans(source, temporary, _nodes(map_), progress=progress)
    write = cloud_writer(path)
    return write(map_.tiles, path, map_.output, selection=map_.selection, progress=progress)


def _nodes(map_: MapToExport) -> ScanPoses:
    """The nodes of the pose graph in the map, with what their scans say of the approval."""
    graph = load_graph(map_.artifacts["verification"])
    poses = load_trajectory(map_.artifacts["level"] / "trajectory.npz").at(graph.t_ns)
    note = f"recon4 approval {map_.stamp.json_line()}" if map_.stamp else "recon4, not approved"
    return ScanPoses(np.asarray(graph.frame_ids, np.int64), graph.t_ns, poses, note)


def export_map(
    project: Path, path: Path, wanted: ExportOptions, *, progress: Progress
) -> ExportedMap:
    """Write the map of a finished run; the file notes an approval.

    Args:
        project: The project folder.
        path: File to write; its ending is one of `CLOUD_FORMATS`, or `SCANS`.
        wanted: Coordinates and points.
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
        raise StoreError(CodedText("deliver-no-map", project=str(project)))
    keys = {name: folder.name for name, folder in artifacts.items()}
    approval = None if wanted.draft else approval_of(project, keys)
    evidence = approval.evidence if approval else None
    map_ = map_to_export(artifacts, evidence, wanted)
    count = write_map(map_, path, progress=progress)
    state = WRITTEN_AS_DRAFT if wanted.draft else approval_state(project, keys)
    return ExportedMap(count, map_.tiles.strays, len(map_.tiles), state)


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
        raise StoreError(CodedText("export-no-trajectory", project=str(project)))
    keys = {name: folder.name for name, folder in artifacts.items()}
    approval = None if draft else approval_of(project, keys)
    if approval:
        for stage in ("frames", "level"):
            approval.evidence.artifact(stage, artifacts[stage]).check_all()
    return load_trajectory(artifacts["level"] / "trajectory.npz")


class CloudWriter(Protocol):
    """Writes a map to a file, and returns how many points it wrote."""

    def __call__(
        self,
        map_: Path | TileSet,
        path: Path,
        output: OutputCrs = CRS_OF_MAP,
        *,
        selection: PointSelection = DELIVERED,
        progress: Progress | None = None,
    ) -> int: ...


CLOUD_FORMATS: dict[str, CloudWriter] = {
    COPC: export_copc,
    ".laz": export_laz,
    ".ply": export_ply,
    ".pcd": export_pcd,
    ".xyz": export_xyz,
}
"""Ending -> who writes such a file; the first that matches counts."""


def cloud_writer(path: Path) -> CloudWriter:
    """Who writes a file of points, by its ending.

    Raises:
        ConfigError: If no map is written to such a file.
    """
    name = path.name.lower()
    ending = next((one for one in CLOUD_FORMATS if name.endswith(one)), None)
    if ending is None:
        raise ConfigError(
            CodedText("export-formats", cloud_formats=", ".join(CLOUD_FORMATS), file=path.name)
        )
    check_name(path, ending)
    return CLOUD_FORMATS[ending]
