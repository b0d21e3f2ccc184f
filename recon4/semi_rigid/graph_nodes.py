"""The nodes that a trajectory is to follow, with and without decisions of people."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path

from recon4.model.trajectory import Trajectory


@dataclass(frozen=True, slots=True, eq=False)
class Undecided:
    """What was refined without decisions."""

    nodes: Trajectory
    """``T_map_body`` of the nodes of the verified graph."""
    refined: Path
    """Artifact of the stage ``refine``."""


@dataclass(frozen=True, slots=True, eq=False)
class GraphNodes:
    """Nodes of the graph that a trajectory is to follow."""

    nodes: Trajectory
    """``T_map_body`` of the nodes."""
    undecided: Undecided | None = None
    """None = no decisions move them."""
