"""What can be switched on and off in the viewer, and how the edges are sorted into it."""

from __future__ import annotations

import re
from collections import Counter
from collections.abc import Sequence
from dataclasses import dataclass, replace

from app.viewer.palette import Rgb
from recon4.model.pose_graph import Edge, EdgeKind, Reason, Verdict


@dataclass(frozen=True, slots=True)
class Layer:
    """A group of things that is shown or not."""

    key: str
    """Fit for a path of the scene."""
    words: str
    rgb: Rgb
    shown: bool = True
    """Whether it is on at first."""
    count: int = 0
    """Things in it; 0 = not counted."""
    width_px: float = 1.5


KIND_WORDS = {
    EdgeKind.ODOMETRY: "odometry",
    EdgeKind.NEIGHBOR: "neighbor",
    EdgeKind.LOOP: "loop",
    EdgeKind.MANUAL: "made by an operator",
}
ACCEPTED_COLORS: dict[EdgeKind, Rgb] = {
    EdgeKind.ODOMETRY: (120, 144, 156),
    EdgeKind.NEIGHBOR: (77, 182, 172),
    EdgeKind.LOOP: (64, 156, 255),
    EdgeKind.MANUAL: (206, 147, 216),
}
REJECTED_COLOR: Rgb = (244, 67, 54)
UNVERIFIED_COLOR: Rgb = (158, 158, 158)

HIDDEN_AT_FIRST = {Reason.OVERLAP}
"""Pairs that never overlapped are many and say little."""


def edge_layer(edge: Edge) -> Layer:
    """The layer an edge belongs to."""
    kind = KIND_WORDS[edge.kind]
    if edge.verdict is Verdict.REJECTED:
        reason = str(edge.reason) or "no reason given"
        return Layer(
            f"rejected/{_path(reason)}",
            f"Rejected, {reason}",
            REJECTED_COLOR,
            shown=edge.reason not in HIDDEN_AT_FIRST,
            width_px=2.5,
        )
    if edge.verdict is Verdict.UNVERIFIED:
        return Layer(f"unverified/{_path(kind)}", f"Unverified, {kind}", UNVERIFIED_COLOR)
    return Layer(f"accepted/{_path(kind)}", f"Accepted, {kind}", ACCEPTED_COLORS[edge.kind])


def edge_layers(edges: Sequence[Edge]) -> tuple[Layer, ...]:
    """The layers of all edges with their counts: accepted, unverified, then rejected."""
    counts = Counter(edge_layer(edge) for edge in edges)
    order = {"accepted": 0, "unverified": 1, "rejected": 2}
    rows = [replace(layer, count=count) for layer, count in counts.items()]
    return tuple(sorted(rows, key=lambda row: (order[row.key.split("/")[0]], row.key)))


def _path(words: str) -> str:
    return re.sub(r"[^a-z0-9]+", "-", words.lower()).strip("-")
