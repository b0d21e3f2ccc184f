"""Writes a pose graph in the g2o text format, for other solvers.

g2o puts the translation first; recon4 and gtsam the rotation. The rotation's information is taken
as that of the rotation vector, as gtsam and most sets do.
"""

from __future__ import annotations

from pathlib import Path

import numpy as np

from recon4.model.pose_graph import PoseGraph

_ROTATION_FIRST = [3, 4, 5, 0, 1, 2]


def write_g2o(path: Path, graph: PoseGraph) -> None:
    """Write the nodes and the edges in use; numbers with enough digits to be read back exactly."""
    used = [edge for edge in graph.edges if edge.in_graph]
    lines = [f"# recon4 vertices {len(graph)} edges {len(used)}"]
    for row, (t, q) in enumerate(
        zip(graph.T_map_body.t, graph.T_map_body.quat_xyzw(), strict=True)
    ):
        lines.append(f"VERTEX_SE3:QUAT {row} {_text([*t, *q])}")
    upper = np.triu_indices(6)
    for edge in used:
        information = edge.information[np.ix_(_ROTATION_FIRST, _ROTATION_FIRST)][upper]
        numbers = [*edge.T_i_j.t, *edge.T_i_j.quat_xyzw(), *information]
        lines.append(f"EDGE_SE3:QUAT {edge.i} {edge.j} {_text(numbers)}")
    path.write_text("\n".join(lines) + "\n", "ascii")


def _text(numbers: list[float]) -> str:
    return " ".join(repr(float(number)) for number in numbers)
