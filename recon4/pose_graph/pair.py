"""Two nodes of a pose graph that are to be registered."""

from __future__ import annotations

from dataclasses import dataclass

from recon4.geometry.se3 import SE3
from recon4.model.pose_graph import EdgeKind


@dataclass(frozen=True, slots=True)
class Pair:
    """Two nodes to register, with the predicted relative pose."""

    i: int
    j: int
    kind: EdgeKind
    T_i_j: SE3
    recognized: bool = False
    """Nothing predicted it: the free space is compared by `RecognitionTuning`."""
