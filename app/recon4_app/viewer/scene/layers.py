"""Layers of the viewer, and the assignment of edges to them."""

from __future__ import annotations

import re
from collections import Counter
from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from recon4.geometry.se3 import Array
from recon4.locales.texts import Texts
from recon4.model.pose_graph import AUTOMATIC, Edge, EdgeKind, PoseGraph, Reason, Verdict
from recon4_app.viewer.cloud.palette import Rgb
from recon4_app.viewer.tuning import EDGE_COLORS


@dataclass(frozen=True, slots=True)
class Layer:
    """A group of objects that is shown or hidden."""

    key: str
    """Key, also part of a path in the scene."""
    name: str
    """Name of the text that labels it."""
    rgb: Rgb
    shown: bool = True
    """Whether it is shown by default."""
    count: int = 0
    """Number of objects; 0 = not counted."""
    width_px: float = 1.5
    of: str = ""
    """Name of the text that its label quotes."""

    def label(self, say: Texts) -> str:
        """Its label in the language of texts, with the number of objects."""
        quoted = say(self.of) if self.of else ""
        label = say(self.name, reason=quoted, kind=quoted)
        return say("layer-counted", layer=label, count=self.count) if self.count else label


ACCEPTED_COLORS: dict[EdgeKind, Rgb] = {
    EdgeKind.ODOMETRY: (120, 144, 156),
    EdgeKind.NEIGHBOR: (77, 182, 172),
    EdgeKind.LOOP: (64, 156, 255),
    EdgeKind.MANUAL: (206, 147, 216),
}
DECIDED_COLORS: dict[Verdict, Rgb] = {
    Verdict.ACCEPTED: (206, 147, 216),
    Verdict.UNVERIFIED: (206, 147, 216),
    Verdict.REJECTED: (255, 112, 190),
}
"""Colors of edges that a person decided."""

HIDDEN_AT_FIRST = {Reason.OVERLAP}
"""Candidates without overlap are many and not informative."""

PLAN = Layer("plan", "layer-plan", (236, 239, 241))
FINAL = Layer("trajectory", "layer-trajectory", (255, 179, 0))
ODOMETRY = Layer("odometry", "layer-odometry", (128, 110, 200), shown=False)
FRAMES = Layer("frames", "layer-frames", (144, 164, 174), shown=False)
LIDARS = Layer("lidars", "layer-lidars", (0, 188, 212), shown=False)
GNSS_USED = Layer("gnss/used", "layer-gnss-used", (102, 187, 106), shown=False)
GNSS_REJECTED = Layer(
    "gnss/rejected", "layer-gnss-rejected", EDGE_COLORS.rejected_color, shown=False
)
GRAVITY = Layer("gravity", "layer-gravity", (255, 255, 255), shown=False)
NORTH = Layer("north", "layer-north", (239, 83, 80))
GRID = Layer("grid", "layer-grid", (96, 108, 118))

ORDER = {"decided": 0, "accepted": 1, "unverified": 2, "rejected": 3}


def edge_layer(edge: Edge) -> Layer:
    """The layer an edge belongs to."""
    if edge.decided_by != AUTOMATIC:
        verdict = "rejected" if edge.verdict is Verdict.REJECTED else "accepted"
        rgb = DECIDED_COLORS[edge.verdict]
        return Layer(f"decided/{verdict}", f"layer-decided-{verdict}", rgb, width_px=3.0)
    if edge.verdict is Verdict.REJECTED:
        return Layer(
            f"rejected/{_path(str(edge.reason) or 'no reason given')}",
            "layer-rejected",
            EDGE_COLORS.rejected_color,
            shown=edge.reason not in HIDDEN_AT_FIRST,
            width_px=2.5,
            of=reason_text(edge.reason) or "no-reason",
        )
    kind, of = str(edge.kind), kind_text(edge.kind)
    if edge.verdict is Verdict.UNVERIFIED:
        rgb = EDGE_COLORS.unverified_color
        return Layer(f"unverified/{kind}", "layer-unverified", rgb, of=of)
    return Layer(f"accepted/{kind}", "layer-accepted", ACCEPTED_COLORS[edge.kind], of=of)


def kind_text(kind: EdgeKind) -> str:
    """Name of the text for a kind of edges."""
    return f"joint-{kind.name.lower()}"


def reason_text(reason: Reason) -> str:
    """Name of the text for a reason; empty without one."""
    return f"reason-{_path(reason.name)}" if reason is not Reason.NONE else ""


def edge_layers(edges: Sequence[Edge]) -> tuple[Layer, ...]:
    """The layers of all edges with counts: decided by a person, accepted, unverified, rejected."""
    counts = Counter(edge_layer(edge) for edge in edges)
    rows = [replace(layer, count=count) for layer, count in counts.items()]
    return tuple(sorted(rows, key=lambda row: (ORDER[row.key.split("/")[0]], row.key)))


@dataclass(frozen=True, slots=True, eq=False)
class EdgeTable:
    """The edges of a graph in columns, to draw and pick them quickly."""

    graph: PoseGraph
    layers: tuple[Layer, ...]
    layer: NDArray[np.intp]
    """Row in `layers` of each edge, (E,)."""
    ends: NDArray[np.intp]
    """Its nodes, (E, 2)."""
    error_ratio: Array
    """Error divided by its limit; NaN = not known, (E,)."""
    chi2: Array
    """(E,)"""

    @staticmethod
    def of(graph: PoseGraph) -> EdgeTable:
        """The table of a graph."""
        edges = graph.edges
        layers = edge_layers(edges)
        row_of = {layer.key: row for row, layer in enumerate(layers)}
        limit = np.array([edge.limit_m for edge in edges])
        error = np.array([edge.error_m for edge in edges])
        return EdgeTable(
            graph,
            layers,
            np.array([row_of[edge_layer(edge).key] for edge in edges], dtype=np.intp),
            np.array([(edge.i, edge.j) for edge in edges], dtype=np.intp).reshape(-1, 2),
            error / np.where(limit > 0.0, limit, np.nan),
            np.array([edge.chi2 for edge in edges]),
        )


def _path(label: str) -> str:
    return re.sub(r"[^a-z0-9]+", "-", label.lower()).strip("-")
