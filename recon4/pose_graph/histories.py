"""The histories of edges as columns of ``graph.npz``.

Judgments of all edges stand one after the other. What they say in words repeats, so each distinct
wording is stored once.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from typing import Any

import numpy as np
from numpy.typing import NDArray

from recon4.errors import StoreError
from recon4.locales.coded import CodedText
from recon4.model.edge_columns import Histories, Wording, wording_of
from recon4.model.pose_graph import (
    EdgeKind,
    Judge,
    Judgment,
    Measure,
    Reason,
    Verdict,
    known_history,
)

Columns = Mapping[str, NDArray[Any]]
_FIELDS = ("judges", "verdicts", "reasons", "measures", "persons", "notes")
_ROWS = ("judgment", "judged_value", "judged_limit")
_KINDS = {"judgments": "iu", "judgment": "iu", "judged_value": "f", "judged_limit": "f"}
"""Kinds of numbers; every other column has texts."""
_BEFORE_HISTORIES = ("verdict", "reason", "decided_by")
"""Columns of a file from before edges had a history."""


def judgment_columns(histories: Histories) -> dict[str, NDArray[Any]]:
    """Columns of the judgments of all edges.

    Returns:
        ``judgments``: their number, (E,). ``judgment``: the wording of each, a row of ``judges``,
        ``verdicts``, ``reasons``, ``measures``, ``persons`` and ``notes``; ``judged_value`` and
        ``judged_limit``: its figures, NaN = not known, (J,) each.
    """
    rows = histories.rows()
    # Wordings in the order in which they appear, without those of judgments that were replaced.
    used, first, wording = np.unique(
        histories.wording[rows], return_index=True, return_inverse=True
    )
    order = np.argsort(first)
    wordings = [histories.wordings[row] for row in used[order].tolist()]
    fields = zip(_FIELDS, zip(*wordings, strict=True), strict=True) if wordings else ()
    texts = {name: np.array(column, dtype=np.str_) for name, column in fields}
    return {
        "judgments": histories.count,
        "judgment": np.argsort(order)[wording],
        "judged_value": histories.value[rows],
        "judged_limit": histories.limit[rows],
        **(texts or {name: np.array([], dtype=np.str_) for name in _FIELDS}),
    }


def judgments_in(columns: Columns) -> Histories:
    """The judgments of all edges.

    Args:
        columns: Of ``graph.npz``.

    Raises:
        StoreError: If a column is missing, or the columns do not fit together.
        ValueError: If a word is not known.
    """
    if "judgments" not in columns:
        return Histories.of(_known_alone(columns))
    _check(columns, [*_FIELDS, *_ROWS, "judgments"])
    wordings, count = _wordings(columns), columns["judgments"]
    row, ends = columns["judgment"], np.cumsum(count)
    texts = {len(columns[name]) for name in _FIELDS}
    fits = len(texts) == 1 and {len(columns[name]) for name in _ROWS} == {int(count.sum())}
    if not fits or np.any(count < 1) or np.any((row < 0) | (row >= len(wordings))):
        raise StoreError("graph.npz: the judgments do not fit the edges")
    value, limit = (_finite(columns[name]) for name in _ROWS[1:])
    return Histories(ends - count, count, row, value, limit, tuple(wordings))


def judgments_of(columns: Columns, row: int) -> tuple[Judgment, ...]:
    """The judgments of one edge; arguments and errors as of `judgments_in`.

    Args:
        columns: Of ``graph.npz``.
        row: Row of the edge.
    """
    own: dict[str, NDArray[Any]]
    if "judgments" in columns:
        _check(columns, ["judgments", *_ROWS])
        start = int(columns["judgments"][:row].sum())
        span = slice(start, start + int(columns["judgments"][row]))
        own = {name: columns[name][span] for name in _ROWS}
        own["judgments"] = columns["judgments"][row : row + 1]
    else:
        _check(columns, ["kind", *_BEFORE_HISTORIES])
        own = {name: columns[name][row : row + 1] for name in ("kind", *_BEFORE_HISTORIES)}
    return next(iter(judgments_in({**columns, **own})))


def _wordings(columns: Columns) -> list[Wording]:
    texts = zip(*(columns[name].tolist() for name in _FIELDS), strict=False)
    judgments = [  # they refuse a person who is no judge, and a judge without a name
        Judgment(Judge(by), Verdict(verdict), Reason(reason), Measure(measure), None, None, *person)
        for by, verdict, reason, measure, *person in texts
    ]
    return [wording_of(one) for one in judgments]


def _finite(column: NDArray[Any]) -> NDArray[np.float64]:
    return np.where(np.isfinite(column), column, np.nan).astype(np.float64)


def _known_alone(columns: Columns) -> Iterator[tuple[Judgment, ...]]:
    _check(columns, ("kind", *_BEFORE_HISTORIES))
    for kind, verdict, reason, by in zip(
        columns["kind"], *(columns[name] for name in _BEFORE_HISTORIES), strict=True
    ):
        yield known_history(
            Verdict(str(verdict)), Reason(str(reason)), str(by), kind=EdgeKind(str(kind))
        )


def _check(columns: Columns, names: Sequence[str]) -> None:
    if missing := [name for name in names if name not in columns]:
        raise StoreError(
            CodedText(
                "arrays-missing", file="graph.npz", names=str(list(names)), missing=str(missing)
            )
        )
    for name in names:
        found, expected = columns[name], _KINDS.get(name, "U")
        if found.ndim != 1 or found.dtype.kind not in expected:
            raise StoreError(
                f"graph.npz: {name}: expected one row of kind {expected}, got {found.dtype} "
                f"with the shape {found.shape}"
            )
