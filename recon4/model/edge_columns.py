"""The edges of a pose graph as columns: an `Edge` is made when one is looked at.

As an object an edge takes 1.8 kB, here 0.5. A walk of two hours has 160 000 of them.
"""

from __future__ import annotations

from array import array
from collections.abc import Callable, Collection, Iterable, Iterator, Mapping
from dataclasses import dataclass, replace
from itertools import islice
from math import isnan
from typing import Any, NamedTuple, overload

import numpy as np
from numpy.typing import NDArray

from recon4.geometry.se3 import SE3, Array
from recon4.model.pose_graph import (
    Edge,
    EdgeKind,
    EdgeSource,
    Flags,
    Judge,
    Judgment,
    Measure,
    Reason,
    Relations,
    Rows,
    Verdict,
)
from recon4.model.tuning import EDGE_COLUMNS

Columns = Mapping[str, NDArray[Any]]


class Wording(NamedTuple):
    """A judgment without its figures."""

    by: Judge
    verdict: Verdict
    reason: Reason
    measure: Measure
    person: str
    note: str


NUMBERS = ("overlap", "error_m", "limit_m", "degeneracy", "verification_m", "chi2")
COUNTS = ("iterations", "paths")
_PLAIN = {
    "i": np.int64,
    "j": np.int64,
    "converged": np.bool_,
    **dict.fromkeys(NUMBERS, np.float64),
    **dict.fromkeys(COUNTS, np.int64),
}
"""Columns of plain values, by the name of their field."""
_KINDS = tuple(EdgeKind)


def wording_of(one: Judgment) -> Wording:
    """What a judgment says in words."""
    return Wording(one.by, one.verdict, one.reason, one.measure, one.person, one.note)


@dataclass(frozen=True, slots=True, eq=False)
class Histories:
    """The judgments of some edges. What they say in words repeats, and is stored once."""

    first: Rows
    """Row of the first judgment of each edge, (E,)."""
    count: Rows
    """Number of its judgments, (E,)."""
    wording: Rows
    """Row of ``wordings`` of each judgment, (J,)."""
    value: Array
    """Of its measure; NaN = not known, (J,)."""
    limit: Array
    """Of the value; NaN = not known, (J,)."""
    wordings: tuple[Wording, ...]

    @staticmethod
    def of(histories: Iterable[tuple[Judgment, ...]]) -> Histories:
        """Pack the judgments of each edge."""
        wordings: dict[Wording, int] = {}
        counts, wording, value, limit = array("q"), array("q"), array("d"), array("d")
        for history in histories:
            counts.append(len(history))
            for one in history:
                wording.append(wordings.setdefault(wording_of(one), len(wordings)))
                value.append(np.nan if one.value is None else one.value)
                limit.append(np.nan if one.limit is None else one.limit)
        count = np.array(counts, np.int64)
        figures = np.array(value, np.float64), np.array(limit, np.float64)
        rows = np.array(wording, np.int64)
        return Histories(np.cumsum(count) - count, count, rows, *figures, tuple(wordings))

    def __iter__(self) -> Iterator[tuple[Judgment, ...]]:
        """The judgments of each edge."""
        at = self.rows()
        columns = (column[at].tolist() for column in (self.wording, self.value, self.limit))
        every = map(self._judgment, *columns)
        return (tuple(islice(every, count)) for count in self.count.tolist())

    def _judgment(self, wording: int, value: float, limit: float) -> Judgment:
        by, verdict, reason, measure, person, note = self.wordings[wording]
        known, most = (None if isnan(one) else one for one in (value, limit))
        return Judgment(by, verdict, reason, measure, known, most, person, note)

    def rows(self) -> Rows:
        """Rows of the judgments of all edges, one edge after the other."""
        ends = np.cumsum(self.count)
        return np.repeat(self.first - (ends - self.count), self.count) + np.arange(
            ends[-1] if len(ends) else 0
        )

    def some(self, rows: Any) -> Histories:
        """Those of some edges."""
        return replace(self, first=self.first[rows], count=self.count[rows])

    def where_last(self, is_so: Callable[[Wording], bool]) -> Flags:
        """Whether something is true of the last judgment of each edge, (E,)."""
        return self._is_so(is_so)[self.wording[self.first + self.count - 1]]

    def before(self, judges: frozenset[Judge]) -> Histories:
        """As `Edge.before`, of each edge."""
        theirs, count = self._is_so(lambda words: words.by in judges), self.count.copy()
        while (later := (count > 1) & theirs[self.wording[self.first + count - 1]]).any():
            count[later] -= 1
        return replace(self, count=count)

    def replaced(self, rows: Rows, other: Histories) -> Histories:
        """With the first histories of others in some rows, and their rest at the end."""
        wordings = {words: row for row, words in enumerate(self.wordings)}
        rows_of = [wordings.setdefault(words, len(wordings)) for words in other.wordings]
        moved = replace(
            other,
            first=other.first + len(self.wording),
            wording=np.array(rows_of, np.int64)[other.wording],
        )
        names = ("wording", "value", "limit")
        joined = {n: np.concatenate([getattr(self, n), getattr(moved, n)]) for n in names}
        joined |= {n: put(getattr(self, n), rows, getattr(moved, n)) for n in ("first", "count")}
        return Histories(**joined, wordings=tuple(wordings))

    def _is_so(self, is_so: Callable[[Wording], bool]) -> Flags:
        return np.array([is_so(words) for words in self.wordings], np.bool_)


def put(column: NDArray[Any], rows: Rows, other: NDArray[Any]) -> NDArray[Any]:
    """A column with the first of other values in some rows, and their rest at the end."""
    out = np.concatenate([column, other[len(rows) :]])
    out[rows] = other[: len(rows)]
    return out


@dataclass(frozen=True, slots=True, eq=False)
class EdgeColumns(EdgeSource):
    """Edges, of which objects are made when they are looked at."""

    columns: Columns
    """Fields of `Edge` by their name in ``graph.npz``, (E, …) each; kinds are their number."""
    histories: Histories

    @staticmethod
    def of(edges: Iterable[Edge]) -> EdgeColumns:
        """Pack edges; what is packed stays as it is. They need not be there all at once."""
        if isinstance(edges, EdgeColumns):
            return edges
        parts: list[dict[str, NDArray[Any]]] = []
        histories = Histories.of(_packed(iter(edges), parts))
        names = tuple(parts[0])
        return EdgeColumns(
            {name: np.concatenate([part.pop(name) for part in parts]) for name in names}, histories
        )

    def __len__(self) -> int:
        """Number of edges."""
        return len(self.columns["i"])

    @overload
    def __getitem__(self, at: int) -> Edge: ...
    @overload
    def __getitem__(self, at: slice) -> EdgeColumns: ...
    def __getitem__(self, at: int | slice) -> Edge | EdgeColumns:
        """One edge, or some of them."""
        if isinstance(at, slice):
            return self.some(at)
        row = range(len(self))[at]
        return next(self.some(slice(row, row + 1))._made())

    def __iter__(self) -> Iterator[Edge]:
        """All edges, some made at a time."""
        block = EDGE_COLUMNS.block
        for start in range(0, len(self), block):
            yield from self.some(slice(start, start + block))._made()

    def some(self, rows: Any) -> EdgeColumns:
        """The edges of some rows."""
        columns = {name: column[rows] for name, column in self.columns.items()}
        return EdgeColumns(columns, self.histories.some(rows))

    def _made(self) -> Iterator[Edge]:
        of = self.columns
        plain = zip(*(of[name].tolist() for name in _PLAIN), strict=True)
        arrays = zip(of["edge_R"], of["edge_t"], of["information"], strict=True)
        for values, (R, t, information), kind, judgments in zip(
            plain, arrays, self.kinds, self.histories, strict=True
        ):
            fields = dict(zip(_PLAIN, values, strict=True))
            yield Edge(
                T_i_j=SE3(R, t), information=information, kind=kind, judgments=judgments, **fields
            )

    def with_columns(self, **columns: NDArray[Any]) -> EdgeColumns:
        """With other values of some fields, (E,) each."""
        return replace(self, columns={**self.columns, **columns})

    def replaced(self, changed: Mapping[int, Edge], more: Collection[Edge] = ()) -> EdgeColumns:
        """With other edges in some rows, and more at the end."""
        if not changed and not more:
            return self
        other = EdgeColumns.of((*changed.values(), *more))
        rows = np.array(list(changed), np.intp)
        columns = {
            name: put(column, rows, other.columns[name]) for name, column in self.columns.items()
        }
        return EdgeColumns(columns, self.histories.replaced(rows, other.histories))

    def are(self, kind: EdgeKind) -> Flags:
        """Whether each edge is of a kind, (E,)."""
        return self.columns["kind"] == _KINDS.index(kind)

    @property
    def kinds(self) -> list[EdgeKind]:
        """Kind of each edge."""
        return [_KINDS[kind] for kind in self.columns["kind"].tolist()]

    @property
    def relations(self) -> Relations:
        """The same arrays."""
        of, is_decided = self.columns, self.histories.where_last(lambda words: bool(words.person))
        return Relations(
            i=of["i"],
            j=of["j"],
            T_i_j=SE3(of["edge_R"], of["edge_t"]),
            information=of["information"],
            in_graph=self.histories.where_last(lambda words: words.verdict is not Verdict.REJECTED),
            protected=self.are(EdgeKind.ODOMETRY) | is_decided,
        )


def numbers_of(kinds: Iterable[str]) -> NDArray[np.uint8]:
    """Kinds as `EdgeColumns` has them, (E,).

    Raises:
        ValueError: If one is not known.
    """
    return np.array([_KINDS.index(EdgeKind(kind)) for kind in kinds], np.uint8)


def _packed(
    edges: Iterator[Edge], parts: list[dict[str, NDArray[Any]]]
) -> Iterator[tuple[Judgment, ...]]:
    """Add columns of edges, some at a time, and give the judgments of each edge."""
    while True:
        some = list(islice(edges, EDGE_COLUMNS.block))
        part: dict[str, NDArray[Any]] = {
            name: np.array([getattr(edge, name) for edge in some], kind)
            for name, kind in _PLAIN.items()
        }
        part["kind"] = numbers_of(edge.kind for edge in some)
        part["edge_R"] = np.array([edge.T_i_j.R for edge in some]).reshape(-1, 3, 3)
        part["edge_t"] = np.array([edge.T_i_j.t for edge in some]).reshape(-1, 3)
        part["information"] = np.array([edge.information for edge in some]).reshape(-1, 6, 6)
        parts.append(part)
        yield from (edge.judgments for edge in some)
        if len(some) < EDGE_COLUMNS.block:
            return
