"""Registered pairs as bytes, and a log of them: a search that was killed goes on after it."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

import msgspec
import numpy as np

from recon4.geometry.se3 import SE3
from recon4.model.pose_graph import Edge, EdgeKind, Judge, Judgment, Measure, Reason, Verdict
from recon4.pose_graph.pair import Pair
from recon4.store.unfinished import RecordLog


class _Tried(msgspec.Struct, array_like=True):
    """A registered pair in the log."""

    pair: bytes
    edge: bytes
    """``T_i_j`` (rotation, translation) and the information, float64."""
    numbers: tuple[float, float, float, float]
    """`Edge.overlap`, ``error_m``, ``limit_m``, ``degeneracy``."""
    converged: bool
    iterations: int
    history: list[tuple[str, str, str, str, float | None, float | None]]


class TriedPairs:
    """What pairs gave, by their nodes and their predicted pose, bit for bit."""

    def __init__(self, log: RecordLog) -> None:
        """Take up the pairs of an earlier process."""
        self._log = log
        found = map(_tried, log)
        self._tried: Mapping[bytes, _Tried] = {one.pair: one for one in found}

    def known(self, pairs: Sequence[Pair]) -> dict[int, Edge]:
        """Row -> edge of the pairs that an earlier process has registered."""
        if not self._tried:
            return {}
        found = ((row, self._tried.get(_key(pair))) for row, pair in enumerate(pairs))
        return {row: _edge(pairs[row], one) for row, one in found if one is not None}

    def add(self, pair: Pair, edge: Edge) -> None:
        """Note what a pair gave."""
        self._log.append(tried_bytes(pair, edge))


def tried_bytes(pair: Pair, edge: Edge) -> bytes:
    """A pair and what it gave."""
    T, numbers = edge.T_i_j, (edge.overlap, edge.error_m, edge.limit_m, edge.degeneracy)
    record = _Tried(
        pair=_key(pair),
        edge=_bytes(T.R, T.t, edge.information),
        numbers=tuple(float(one) for one in numbers),  # type: ignore[arg-type]
        converged=bool(edge.converged),
        iterations=int(edge.iterations),
        history=[_row(one) for one in edge.judgments],
    )
    return msgspec.msgpack.encode(record)


def tried_edge(pair: Pair, record: bytes) -> Edge | None:
    """What a pair gave, by `tried_bytes`; None = they are those of another pair.

    Raises:
        msgspec.DecodeError: If they are damaged.
    """
    tried = _tried(record)
    return _edge(pair, tried) if tried.pair == _key(pair) else None


def _tried(record: bytes) -> _Tried:
    return msgspec.msgpack.decode(record, type=_Tried)


def _key(pair: Pair) -> bytes:
    head = f"{pair.i} {pair.j} {pair.kind} {pair.recognized} ".encode()
    return head + _bytes(pair.T_i_j.R, pair.T_i_j.t)


def _bytes(*arrays: Any) -> bytes:
    return b"".join(np.ascontiguousarray(one, np.float64).tobytes() for one in arrays)


def _row(one: Judgment) -> tuple[str, str, str, str, float | None, float | None]:
    figures = (None if value is None else float(value) for value in (one.value, one.limit))
    value, limit = figures
    return str(one.by), str(one.verdict), str(one.reason), str(one.measure), value, limit


def _edge(pair: Pair, tried: _Tried) -> Edge:
    values = np.frombuffer(tried.edge, np.float64).copy()
    overlap, error_m, limit_m, degeneracy = tried.numbers
    return Edge(
        i=pair.i,
        j=pair.j,
        kind=EdgeKind(pair.kind),
        T_i_j=SE3(values[:9].reshape(3, 3), values[9:12]),
        information=values[12:].reshape(6, 6),
        judgments=tuple(_judgment(*row) for row in tried.history),
        overlap=overlap,
        error_m=error_m,
        limit_m=limit_m,
        degeneracy=degeneracy,
        converged=tried.converged,
        iterations=tried.iterations,
    )


def _judgment(by: str, verdict: str, reason: str, *measured: Any) -> Judgment:
    measure, value, limit = measured
    return Judgment(Judge(by), Verdict(verdict), Reason(reason), Measure(measure), value, limit)
