"""Reads pose graphs in the g2o text format, 3-D and 2-D: public sets, and what recon4 writes.

g2o puts the translation first; recon4 and gtsam the rotation. The rotation's information is taken
as that of the rotation vector, as gtsam and most sets do.
"""

from __future__ import annotations

from pathlib import Path

import numpy as np

from recon4.errors import CorruptFile
from recon4.geometry.se3 import SE3, Array
from recon4.model.pose_graph import Edge, EdgeKind, PoseGraph, Verdict, known_history
from recon4.pose_graph.relations import reverse
from recon4.untrusted.bounded import lines_limited, parse_float

_FIELDS = {"VERTEX_SE3:QUAT": 9, "EDGE_SE3:QUAT": 31, "VERTEX_SE2": 5, "EDGE_SE2": 12, "FIX": 2}
"""Number of fields in a line of each kind, its tag included."""
_MAX_BYTES = 1 << 30
_MAX_LINE_BYTES = 4096
_MAX_ID = 1 << 53
"""Numbers of vertices pass through a float64."""
_LENGTH_TOLERANCE = 1e-2
_ROTATION_FIRST = [3, 4, 5, 0, 1, 2]
_PLANAR_SD = 1e-3
"""Standard deviation of height [m], roll and pitch [rad] of a 2-D relation lifted to 3-D."""


def read_g2o(path: Path) -> PoseGraph:
    """Read a graph; 2-D vertices and edges are lifted to 3-D.

    Edges between consecutive nodes become odometry, all others loops; relations are reversed if
    needed so that ``i < j``. The file has no times: the nodes get 0, 1, 2, … seconds.

    Raises:
        CorruptFile: Names the line if its kind is unknown, it has missing or surplus fields or an
            invalid number, an edge names a missing vertex, or lines are missing at the end.
    """
    rows = _read_rows(path)
    vertices = {int(fields[0]): _vertex(tag, fields) for _, tag, fields in rows if "VERTEX" in tag}
    if not vertices:
        raise CorruptFile(f"{path.name}: there is no vertex")
    if len(vertices) < sum("VERTEX" in tag for _, tag, _ in rows):
        raise CorruptFile(f"{path.name}: a vertex is there twice")
    ids = sorted(vertices)
    row_of = {vertex: row for row, vertex in enumerate(ids)}
    edges = []
    for line, tag, fields in rows:
        if "EDGE" in tag:
            if fields[0] == fields[1]:
                raise CorruptFile(
                    f"{path.name}, line {line}: expected two vertices, got {int(fields[0])} twice"
                )
            if int(fields[0]) not in row_of or int(fields[1]) not in row_of:
                raise CorruptFile(f"{path.name}, line {line}: an edge names a missing vertex")
            edges.append(_edge(tag, fields, row_of))
    return PoseGraph(
        np.array(ids, dtype=np.int64),
        np.arange(len(ids), dtype=np.int64) * 1_000_000_000,
        SE3.stack(vertices[vertex] for vertex in ids),
        tuple(edges),
    )


def _read_rows(path: Path) -> list[tuple[int, str, Array]]:
    """Line number, tag and numbers of each line."""
    rows: list[tuple[int, str, Array]] = []
    first = line = ""
    lines = lines_limited(path, max_bytes=_MAX_BYTES, max_line_bytes=_MAX_LINE_BYTES)
    for number, line in enumerate(lines, start=1):
        first = first if number > 1 else line
        fields = line.split()
        if not fields or fields[0].startswith("#"):
            continue
        rows.append((number, fields[0], _numbers(fields, f"{path.name}, line {number}")))
    if first.startswith("# recon4 vertices"):
        _check_counts(first, rows, path.name, complete=line.endswith("\n"))
    return rows


def _numbers(fields: list[str], where: str) -> Array:
    expected = _FIELDS.get(fields[0])
    if expected is None:
        raise CorruptFile(f"{where}: expected one of {', '.join(_FIELDS)}, got {fields[0]!r}")
    if len(fields) != expected:
        raise CorruptFile(f"{where}: {fields[0]} has {expected} fields, got {len(fields)}")
    try:
        numbers = np.array([parse_float(field) for field in fields[1:]])
    except ValueError as error:
        raise CorruptFile(f"{where}: {error}") from error
    if not np.isfinite(numbers).all():
        raise CorruptFile(f"{where}: a number is not finite")
    for number in numbers[: 2 if "EDGE" in fields[0] else 1]:
        if number != int(number) or not 0 <= number < _MAX_ID:
            raise CorruptFile(f"{where}: expected a vertex 0 to 2^53, got {number:g}")
    if fields[0].endswith("QUAT"):
        quat = numbers[4:8] if "VERTEX" in fields[0] else numbers[5:9]
        if abs(np.linalg.norm(quat) - 1.0) > _LENGTH_TOLERANCE:
            raise CorruptFile(f"{where}: a quaternion has length 1, got {np.linalg.norm(quat):.4g}")
    return numbers


def _check_counts(
    head: str, rows: list[tuple[int, str, Array]], name: str, *, complete: bool
) -> None:
    """Check the counts in the first line of files of recon4, to detect truncated ones."""
    fields = [*head.split(), *[""] * 6]
    tags = [tag for _, tag, _ in rows]
    found = (sum("VERTEX" in tag for tag in tags), sum("EDGE" in tag for tag in tags))
    if not complete or [str(count) for count in found] != [fields[3], fields[5]]:
        raise CorruptFile(
            f"{name}: expected {fields[3][:20]} vertices and {fields[5][:20]} edges "
            f"and an end of line, got {found[0]} and {found[1]}"
        )


def _vertex(tag: str, fields: Array) -> SE3:
    return _motion(tag, fields[1:])


def _motion(tag: str, numbers: Array) -> SE3:
    if tag.endswith("SE2"):
        return SE3.from_rpy(0.0, 0.0, numbers[2], t=[numbers[0], numbers[1], 0.0])
    return SE3.from_quat(numbers[3:7], numbers[:3])


def _edge(tag: str, fields: Array, row_of: dict[int, int]) -> Edge:
    i, j = row_of[int(fields[0])], row_of[int(fields[1])]
    T_i_j = _motion(tag, fields[2:])
    information = _information(tag, fields[2:])
    if i > j:
        i, j = j, i
        T_i_j, information = reverse(T_i_j, information)
    kind = EdgeKind.ODOMETRY if j == i + 1 else EdgeKind.LOOP
    return Edge(
        i=i,
        j=j,
        T_i_j=T_i_j,
        kind=kind,
        information=information,
        judgments=known_history(Verdict.ACCEPTED),
    )


def _information(tag: str, numbers: Array) -> Array:
    """(6, 6), rotation first, of the upper triangle in the file."""
    if tag.endswith("SE2"):
        planar = _symmetric(numbers[3:], 3)
        out = np.eye(6) / _PLANAR_SD**2
        out[np.ix_([3, 4, 2], [3, 4, 2])] = planar
        return out
    return _symmetric(numbers[7:], 6)[np.ix_(_ROTATION_FIRST, _ROTATION_FIRST)]


def _symmetric(upper: Array, size: int) -> Array:
    out = np.zeros((size, size))
    out[np.triu_indices(size)] = upper
    return out + np.triu(out, 1).T
