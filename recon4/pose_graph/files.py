"""Pose graph files: ``graph.npz`` (exact) and ``edges.json`` (readable)."""

from __future__ import annotations

import json
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import msgspec
import numpy as np
from numpy.typing import NDArray

from recon4.errors import StoreError
from recon4.geometry.se3 import SE3
from recon4.locales.coded import CodedText, at, text_of
from recon4.model.edge_columns import COUNTS, NUMBERS, EdgeColumns, numbers_of
from recon4.model.plain import finite_or_none
from recon4.model.pose_graph import Edge, EdgeKind, Judgment, PoseGraph
from recon4.model.trajectory import Trajectory
from recon4.pose_graph.histories import Columns, judgment_columns, judgments_in, judgments_of
from recon4.pose_graph.tuning_solve import GRAPH_FILES
from recon4.store.arrays import load_arrays, save_arrays

_NODES = ("frame_ids", "t_ns", "node_R", "node_t")
_EDGES = ("i", "j", "edge_R", "edge_t", "information", "converged", "kind")

HISTORY = ("by", "verdict", "reason", "measure", "value", "limit", "person", "note")
"""Names of the values of a judgment in ``edges.json``."""


def save_graph(folder: Path, graph: PoseGraph) -> None:
    """Write ``graph.npz`` (all data, exact) and ``edges.json`` (every registered pair)."""
    edges = EdgeColumns.of(graph.edges)
    of = edges.columns
    columns: dict[str, NDArray[Any]] = {
        "frame_ids": graph.frame_ids,
        "t_ns": graph.t_ns,
        "node_R": graph.T_map_body.R,
        "node_t": graph.T_map_body.t,
        **{name: of[name] for name in _EDGES if name != "kind"},
        "kind": np.array(edges.kinds, dtype=np.str_),
        **judgment_columns(edges.histories),
        **{name: of[name] for name in (*NUMBERS, *COUNTS)},
    }
    save_arrays(folder / "graph.npz", columns)
    write_edges_json(folder / "edges.json", graph)


def load_graph(folder: Path) -> PoseGraph:
    """Read the ``graph.npz`` that `save_graph` wrote.

    Of a file from before edges had a history, the history is what its one verdict says.

    Raises:
        StoreError: If the file is missing, damaged or its columns do not fit together.
    """
    names = [*_NODES, *_EDGES, *NUMBERS, *COUNTS]
    columns = load_arrays(folder / "graph.npz")
    if missing := [name for name in names if name not in columns]:
        raise StoreError(
            CodedText("arrays-missing", file="graph.npz", names=str(names), missing=str(missing))
        )
    for name in names:
        expected = len(columns["frame_ids"] if name in _NODES else columns["i"])
        if len(columns[name]) != expected:
            raise StoreError(
                f"graph.npz: {name}: expected {expected} rows, got {len(columns[name])}"
            )
    try:
        kind = numbers_of(columns["kind"].tolist())
        edges = EdgeColumns(_checked({**columns, "kind": kind}), judgments_in(columns))
    except ValueError as error:
        raise StoreError(at("graph.npz", text_of(error))) from error
    if len(edges.histories.count) != len(edges):
        raise StoreError("graph.npz: the judgments do not fit the edges")
    T_map_body = SE3(columns["node_R"], columns["node_t"])
    return PoseGraph(columns["frame_ids"], columns["t_ns"], T_map_body, edges)


def load_nodes(folder: Path) -> Trajectory:
    """The nodes of a graph with their poses ``T_map_body``, without its edges.

    Args:
        folder: With a ``graph.npz``.

    Raises:
        StoreError: If the file is missing or damaged.
    """
    columns = load_arrays(folder / "graph.npz", list(_NODES))
    return Trajectory(columns["t_ns"], SE3(columns["node_R"], columns["node_t"]))


def load_history(folder: Path, frames: tuple[int, int]) -> tuple[Judgment, ...]:
    """The judgments on one pair, without the rest of the graph; odometry edges do not count.

    Args:
        folder: With a ``graph.npz``.
        frames: Ids of the two multiframes.

    Returns:
        Empty if the graph does not have the pair.

    Raises:
        StoreError: If the file is missing or damaged.
    """
    columns = load_arrays(folder / "graph.npz")
    try:
        ends = [columns["frame_ids"][columns[name]] for name in ("i", "j")]
        is_pair = (ends[0] == frames[0]) & (ends[1] == frames[1])
        rows = np.flatnonzero(is_pair & (columns["kind"] != EdgeKind.ODOMETRY.value))
        return judgments_of(columns, int(rows[-1])) if len(rows) else ()
    except (KeyError, IndexError, ValueError) as error:
        raise StoreError(at("graph.npz", text_of(error))) from error


def _checked(columns: Columns) -> dict[str, NDArray[Any]]:
    """The columns of the edges.

    Raises:
        StoreError: If one has another type, or other rows, than an edge has.
    """
    found = {}
    for name, meant in EdgeColumns.of(()).columns.items():
        one = columns[name]
        if one.shape[1:] != meant.shape[1:] or not np.can_cast(one.dtype, meant.dtype, "same_kind"):
            expected, got = (f"{of.dtype} {of.shape[1:]}" for of in (meant, one))
            raise StoreError(
                CodedText("array-rows", file="graph.npz", name=name, expected=expected, got=got)
            )
        found[name] = one.astype(meant.dtype, copy=False)
    return found


def write_edges_json(path: Path, graph: PoseGraph) -> None:
    """Write every registered pair as JSON, one line per pair; an unknown number is ``null``.

    Written in blocks: the memory does not grow with the number of pairs.
    """
    head = json.dumps(
        {
            "convention": "T_a_b maps points of node b into node a; metres; quaternion x y z w",
            "nodes": len(graph),
            "history": HISTORY,
        }
    )
    with path.open("w", encoding="utf-8") as file:
        file.write(f'{head[:-1]}, "edges": [\n')
        between = ""
        for start in range(0, len(graph.edges), GRAPH_FILES.block):
            records = _records(graph, graph.edges[start : start + GRAPH_FILES.block])
            file.write(between)
            file.write(",\n".join(json.dumps(msgspec.to_builtins(one)) for one in records))
            between = ",\n"
        file.write("\n]}\n")


@dataclass(frozen=True, slots=True)
class PoseRecord:
    """A pose in ``edges.json``."""

    translation: list[float]
    """[m], (3,)."""
    quaternion_xyzw: list[float]


@dataclass(frozen=True, slots=True, kw_only=True)
class EdgeRecord:
    """An edge in ``edges.json``; the fields are its keys, an unknown number is None."""

    nodes: tuple[int, int]
    frames: tuple[int, int]
    """Ids of the multiframes."""
    t_ns: tuple[int, int]
    T_a_b: PoseRecord
    kind: str
    verdict: str
    reason: str
    overlap: float | None
    error_m: float | None
    limit_m: float | None
    degeneracy: float | None
    converged: bool
    iterations: int
    verification_m: float | None
    paths: int
    chi2: float | None
    decided_by: str
    history: list[list[str | float | None]]
    """Verdicts in the order in which they were given, the last one counts; `HISTORY` names the
    values of each. The last two are left out where no person decided."""


def _records(graph: PoseGraph, edges: Sequence[Edge]) -> Iterator[EdgeRecord]:
    """Edges as in ``edges.json``."""
    T_i_j = SE3.stack(edge.T_i_j for edge in edges)
    poses = zip(T_i_j.t.tolist(), T_i_j.quat_xyzw().tolist(), strict=True)
    frame_ids, t_ns = graph.frame_ids, graph.t_ns
    for edge, pose in zip(edges, poses, strict=True):
        i, j = edge.i, edge.j
        yield EdgeRecord(
            nodes=(i, j),
            frames=(int(frame_ids[i]), int(frame_ids[j])),
            t_ns=(int(t_ns[i]), int(t_ns[j])),
            T_a_b=PoseRecord(*pose),
            kind=str(edge.kind),
            verdict=str(edge.verdict),
            reason=str(edge.reason),
            overlap=finite_or_none(edge.overlap),
            error_m=finite_or_none(edge.error_m),
            limit_m=finite_or_none(edge.limit_m),
            degeneracy=finite_or_none(edge.degeneracy),
            converged=edge.converged,
            iterations=edge.iterations,
            verification_m=finite_or_none(edge.verification_m),
            paths=edge.paths,
            chi2=finite_or_none(edge.chi2),
            decided_by=edge.decided_by,
            history=[_history_row(judgment) for judgment in edge.judgments],
        )


def _history_row(one: Judgment) -> list[str | float | None]:
    figures = [
        None if value is None else finite_or_none(value, GRAPH_FILES.digits)
        for value in (one.value, one.limit)
    ]
    row = [str(one.by), str(one.verdict), str(one.reason), str(one.measure), *figures]
    return [*row, one.person, one.note] if one.person else row
