"""What a solve is given beside the graph: priors of poses, and how gross errors are treated."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal

from recon4.geometry.se3 import SE3, Array
from recon4.model.pose_graph import Rows

Kernel = Literal["none", "cauchy"]


@dataclass(frozen=True, slots=True, eq=False)
class PosePriors:
    """Priors on poses of nodes."""

    node: Rows
    """Rows of the nodes, (M,)."""
    T_map_body: SE3
    """Their poses, a batch of M."""
    information: Array
    """Inverse covariance of the tangent in the body, rotation first, (M, 6, 6)."""


@dataclass(frozen=True, slots=True, eq=False)
class PositionPriors:
    """Priors on positions of a point of the body, for example of a GNSS antenna."""

    node: Rows
    """Rows of the nodes, (M,)."""
    p_map: Array
    """Measured positions [m], (M, 3)."""
    p_body: Array
    """Measured point in the body (lever arm) [m], (M, 3)."""
    sd_m: Array
    """Standard deviations along the axes of the map [m], (M, 3)."""


@dataclass(frozen=True, slots=True, eq=False)
class TargetPriors:
    """Surveyed targets that nodes saw; no kernel limits their influence."""

    node: Rows
    """Rows of the nodes, (M,)."""
    p_map: Array
    """Surveyed positions in the map [m], (M, 3)."""
    p_body: Array
    """The target in the body of the node [m], (M, 3)."""
    information: Array
    """Inverse covariance in axes of the map [1/m²], positive definite, (M, 3, 3)."""


Priors = PosePriors | PositionPriors | TargetPriors
