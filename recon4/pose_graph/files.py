"""Pose graph files: ``graph.npz`` (exact) and ``edges.json`` (readable)."""

from __future__ import annotations

import json
from collections.abc import Mapping
from dataclasses import asdict, dataclass
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from recon4.errors import StoreError
from recon4.geometry.se3 import SE3
from recon4.model.plain import finite_or_none
from recon4.model.pose_graph import Edge, EdgeKind, PoseGraph, Reason, Verdict
from recon4.store.arrays import load_arrays, save_arrays

_NUMBERS = ("overlap", "error_m", "limit_m", "degeneracy", "verification_m", "chi2")
_COUNTS = ("iterations", "paths")
_TEXTS = ("kind", "verdict", "reason", "decided_by")
_NODES = ("frame_ids", "t_ns", "node_R", "node_t")
_EDGES = ("i", "j", "edge_R", "edge_t", "information", "converged")


def save_graph(folder: Path, graph: PoseGraph) -> None:
    """Write ``graph.npz`` (all data, exact) and ``edges.json`` (every registered pair)."""
    of = graph.relations
    columns: dict[str, NDArray[Any]] = {
        "frame_ids": graph.frame_ids,
        "t_ns": graph.t_ns,
        "node_R": graph.T_map_body.R,
        "node_t": graph.T_map_body.t,
        "i": of.i.astype(np.int64),
        "j": of.j.astype(np.int64),
        "edge_R": of.T_i_j.R,
        "edge_t": of.T_i_j.t,
        "information": of.information,
        "converged": np.array([edge.converged for edge in graph.edges], dtype=np.bool_),
    }
    for names, kind in ((_NUMBERS, np.float64), (_COUNTS, np.int64), (_TEXTS, np.str_)):
        for name in names:
            columns[name] = np.array([getattr(edge, name) for edge in graph.edges], dtype=kind)
    save_arrays(folder / "graph.npz", columns)
    write_edges_json(folder / "edges.json", graph)


def load_graph(folder: Path) -> PoseGraph:
    """Read the ``graph.npz`` that `save_graph` wrote.

    Raises:
        StoreError: If the file is missing, damaged or its columns do not fit together.
    """
    names = [*_NODES, *_EDGES, *_NUMBERS, *_COUNTS, *_TEXTS]
    columns = load_arrays(folder / "graph.npz", names)
    for name in names:
        expected = len(columns["frame_ids"] if name in _NODES else columns["i"])
        if len(columns[name]) != expected:
            raise StoreError(
                f"graph.npz: {name}: expected {expected} rows, got {len(columns[name])}"
            )
    try:
        edges = tuple(_edge(columns, row) for row in range(len(columns["i"])))
    except ValueError as error:
        raise StoreError(f"graph.npz: {error}") from error
    T_map_body = SE3(columns["node_R"], columns["node_t"])
    return PoseGraph(columns["frame_ids"], columns["t_ns"], T_map_body, edges)


def _edge(columns: Mapping[str, NDArray[Any]], row: int) -> Edge:
    number = {name: float(columns[name][row]) for name in _NUMBERS}
    count = {name: int(columns[name][row]) for name in _COUNTS}
    return Edge(
        i=int(columns["i"][row]),
        j=int(columns["j"][row]),
        T_i_j=SE3(columns["edge_R"][row], columns["edge_t"][row]),
        kind=EdgeKind(str(columns["kind"][row])),
        verdict=Verdict(str(columns["verdict"][row])),
        reason=Reason(str(columns["reason"][row])),
        information=columns["information"][row],
        converged=bool(columns["converged"][row]),
        decided_by=str(columns["decided_by"][row]),
        overlap=number["overlap"],
        error_m=number["error_m"],
        limit_m=number["limit_m"],
        degeneracy=number["degeneracy"],
        verification_m=number["verification_m"],
        chi2=number["chi2"],
        iterations=count["iterations"],
        paths=count["paths"],
    )


def write_edges_json(path: Path, graph: PoseGraph) -> None:
    """Write every registered pair as JSON, one line per pair; an unknown number is ``null``."""
    lines = ",\n".join(json.dumps(asdict(edge_record(graph, edge))) for edge in graph.edges)
    head = json.dumps(
        {
            "convention": "T_a_b maps points of node b into node a; metres; quaternion x y z w",
            "nodes": len(graph),
        }
    )
    path.write_text(f'{head[:-1]}, "edges": [\n{lines}\n]}}\n', "utf-8")


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


def edge_record(graph: PoseGraph, edge: Edge) -> EdgeRecord:
    """One edge as in ``edges.json``."""
    i, j = edge.i, edge.j
    return EdgeRecord(
        nodes=(i, j),
        frames=(int(graph.frame_ids[i]), int(graph.frame_ids[j])),
        t_ns=(int(graph.t_ns[i]), int(graph.t_ns[j])),
        T_a_b=PoseRecord(edge.T_i_j.t.tolist(), edge.T_i_j.quat_xyzw().tolist()),
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
    )
