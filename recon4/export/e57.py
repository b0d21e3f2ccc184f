"""The map as E57 (ASTM E2807): one scan for each node of the pose graph, with its pose."""

from __future__ import annotations

import uuid
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

import recon4
from recon4.errors import StoreError
from recon4.export.node_scans import SCAN_ROW, ScanPoses, node_scans
from recon4.export.points import PointSource
from recon4.export.tuning import POINT_EXPORT
from recon4.geometry.se3 import SE3, Array
from recon4.locales.coded import CodedText
from recon4.model.gps_time import adjusted_gps_s, is_absolute
from recon4.progress import Progress


def export_e57(source: PointSource, path: Path, scans: ScanPoses, *, progress: Progress) -> int:
    """Write a map as E57, and read its points back.

    Intensity is the normalized one if the map has it. Memory grows with the points of one scan.

    Args:
        source: The points, in the coordinates of the file.
        path: File to write.
        scans: Nodes of the pose graph.
        progress: Who watches.

    Returns:
        How many points were written.

    Raises:
        ConfigError: If points are wanted that the map leaves out.
        StoreError: If the file cannot be written or does not read back.
    """
    from pye57 import libe57

    with node_scans(source, path, scans, progress=progress) as sorted_:
        try:
            image = libe57.ImageFile(str(path), "w")
            data = _head(image, source.crs)
            for number, file in sorted_.files:
                rows = np.fromfile(file, SCAN_ROW)
                _write_scan(image, data, _Scan(number, rows, scans, sorted_.origins[number]))
                progress.advance(len(rows))
            image.close()
            _check(path, dict(sorted_.files), source, progress=progress)
        except libe57.E57Exception as error:
            reason = str(error).partition("\n")[0]  # it goes on for a page
            raise StoreError(CodedText("e57-not-written", reason=reason)) from error
    return source.count


@dataclass(frozen=True, slots=True, eq=False)
class _Scan:
    """What is written of a scan."""

    number: int
    rows: NDArray[Any]
    nodes: ScanPoses
    origin: Array
    """Position of its pose in the coordinates of the file, (3,)."""


def _head(image: Any, crs: str) -> Any:
    """Write what comes before the scans; the list of these."""
    from pye57 import libe57

    image.extensionsAdd("", libe57.E57_V1_0_URI)
    root = image.root()
    root.set("formatName", libe57.StringNode(image, "ASTM E57 3D Imaging Data File"))
    root.set("guid", libe57.StringNode(image, _guid(f"map {crs}")))
    root.set("versionMajor", libe57.IntegerNode(image, libe57.E57_FORMAT_MAJOR))
    root.set("versionMinor", libe57.IntegerNode(image, libe57.E57_FORMAT_MINOR))
    root.set("e57LibraryVersion", libe57.StringNode(image, f"recon4 {recon4.__version__}"))
    root.set("coordinateMetadata", libe57.StringNode(image, crs))
    data = libe57.VectorNode(image, True)
    root.set("data3D", data)
    root.set("images2D", libe57.VectorNode(image, True))
    return data


def _write_scan(image: Any, data: Any, scan: _Scan) -> None:
    from pye57 import libe57

    node = libe57.StructureNode(image)
    frame_id = int(scan.nodes.frame_ids[scan.number])
    node.set("guid", libe57.StringNode(image, _guid(f"scan {frame_id}")))
    node.set("name", libe57.StringNode(image, f"multiframe {frame_id}"))
    node.set("description", libe57.StringNode(image, scan.nodes.note))
    node.set("pose", _pose(image, scan.nodes.T_map_body[scan.number], scan.origin))
    t_ns = scan.nodes.t_ns[[scan.number]]
    if is_absolute(int(t_ns[0])):
        node.set("acquisitionStart", _time(image, float(adjusted_gps_s(t_ns)[0] + 1e9)))
    node.set("cartesianBounds", _bounds(image, scan.rows, ("X", "Y", "Z")))
    node.set("intensityLimits", _bounds(image, scan.rows, ("intensity",)))
    prototype = libe57.StructureNode(image)
    for name in SCAN_ROW.names or ():
        low, high = float(scan.rows[name].min()), float(scan.rows[name].max())
        prototype.set(name, libe57.FloatNode(image, low, libe57.E57_SINGLE, low, high))
    points = libe57.CompressedVectorNode(image, prototype, libe57.VectorNode(image, True))
    node.set("points", points)
    data.append(node)
    buffers = libe57.VectorSourceDestBuffer()
    held = {name: np.empty(POINT_EXPORT.block) for name in SCAN_ROW.names or ()}
    for name, values in held.items():
        buffers.append(libe57.SourceDestBuffer(image, name, values, len(values), True, True))
    writer = points.writer(buffers)
    for first in range(0, len(scan.rows), POINT_EXPORT.block):
        part = scan.rows[first : first + POINT_EXPORT.block]
        for name, values in held.items():
            values[: len(part)] = part[name]
        writer.write(len(part))
    writer.close()


def _pose(image: Any, T_map_body: SE3, origin: Array) -> Any:
    from pye57 import libe57

    x, y, z, w = np.asarray(T_map_body.quat_xyzw()).tolist()
    parts = {
        "rotation": {"w": w, "x": x, "y": y, "z": z},  # some readers go by this order
        "translation": dict(zip("xyz", origin, strict=True)),
    }
    pose = libe57.StructureNode(image)
    for name, values in parts.items():
        part = libe57.StructureNode(image)
        for axis, value in values.items():
            part.set(axis, libe57.FloatNode(image, float(value)))
        pose.set(name, part)
    return pose


def _time(image: Any, gps_s: float) -> Any:
    from pye57 import libe57

    node = libe57.StructureNode(image)
    node.set("dateTimeValue", libe57.FloatNode(image, gps_s))
    node.set("isAtomicClockReferenced", libe57.IntegerNode(image, 0))
    return node


def _bounds(image: Any, rows: NDArray[Any], names: tuple[str, ...]) -> Any:
    """Limits of some columns, as xMinimum or intensityMaximum."""
    from pye57 import libe57

    node = libe57.StructureNode(image)
    for name in names:
        values = rows[f"cartesian{name}" if name in "XYZ" else name]
        node.set(f"{name.lower()}Minimum", libe57.FloatNode(image, float(values.min())))
        node.set(f"{name.lower()}Maximum", libe57.FloatNode(image, float(values.max())))
    return node


def _guid(of: str) -> str:
    """The same map gives the same file."""
    return f"{{{uuid.uuid5(uuid.NAMESPACE_URL, f'recon4 {of}')}}}"


def _check(path: Path, files: dict[int, Path], source: PointSource, *, progress: Progress) -> None:
    """Read every scan back and compare it with what was written.

    Raises:
        StoreError: If it differs.
    """
    import pye57

    count = 0
    progress.start("compare", source.count, "points")
    with pye57.E57(str(path)) as file:
        crs = file.root["coordinateMetadata"].value()
        if crs != source.crs:
            raise StoreError(CodedText("reread-crs", file=path.name, crs=source.crs))
        if file.scan_count != len(files):
            raise StoreError(
                CodedText(
                    "reread-scans",
                    file=path.name,
                    scan_count=str(file.scan_count),
                    count=len(files),
                )
            )
        for index, rows in enumerate(files.values()):
            expected, found = np.fromfile(rows, SCAN_ROW), file.read_scan_raw(index)
            for name in SCAN_ROW.names or ():
                if not np.array_equal(found[name], expected[name]):
                    raise StoreError(
                        CodedText("reread-scan-field", file=path.name, name=name, index=index)
                    )
            count += len(expected)
            progress.advance(len(expected))
    if count != source.count:
        raise StoreError(
            CodedText("reread-points", file=path.name, got=count, expected=source.count)
        )
