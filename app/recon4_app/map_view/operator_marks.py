"""Marks of the operator of a live capture, at their places on the walk."""

from __future__ import annotations

import json
from pathlib import Path

import numpy as np

from recon4.errors import CorruptFile
from recon4.model.trajectory import Trajectory
from recon4.untrusted.bounded import read_text_limited
from recon4.untrusted.names import visible
from recon4_app.map_view.model import OperatorMark
from recon4_app.map_view.tuning import MAP_WALK

_SHOWN = ("point", "place")
"""Kinds of marks with a place: a pause has none."""


def operator_marks(file: Path, walk: Trajectory) -> tuple[list[OperatorMark], int]:
    """The marks of a capture, and how many are left out: unreadable, or of no time of the walk.

    Args:
        file: ``marks.jsonl``, one JSON object a line.
        walk: The walk of the map; not empty.
    """
    try:
        lines = read_text_limited(file, MAP_WALK.max_marks_bytes).splitlines()
    except CorruptFile:
        return [], 1
    read = [_read(line) for line in lines if line.strip()]
    found = [_placed(one, walk) for one in read if one is None or one["what"] in _SHOWN]
    marks = [one for one in found if one is not None]
    return marks, len(found) - len(marks)


def _read(line: str) -> dict[str, object] | None:
    """A mark; None = the line is none."""
    try:
        found = json.loads(line)
    except (ValueError, RecursionError):
        return None
    sound = isinstance(found, dict) and type(found.get("t_ns")) is int
    return found if sound and isinstance(found.get("what"), str) else None


def _placed(mark: dict[str, object] | None, walk: Trajectory) -> OperatorMark | None:
    """A mark at its place; None = the walk has no such time."""
    if mark is None:
        return None
    t_ns, reach_ns = mark["t_ns"], int(1e9 * MAP_WALK.marks_s)
    assert isinstance(t_ns, int)
    first_ns, last_ns = int(walk.t_ns[0]), int(walk.t_ns[-1])
    if not first_ns - reach_ns <= t_ns <= last_ns + reach_ns:
        return None
    at_ns = min(max(t_ns, first_ns), last_ns)
    x, y, z = walk.at(np.array([at_ns])).t[0].tolist()
    return OperatorMark(
        t_s=(at_ns - first_ns) / 1e9,
        p_map=(x, y, z),
        text=visible(str(mark.get("text") or "")),
        who=visible(str(mark.get("who") or "")),
    )
