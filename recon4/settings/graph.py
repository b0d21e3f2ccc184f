"""Settings of the stages `graph` and `verification`."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Annotated, Literal

from recon4.settings.require import Checked, ValueRange


@dataclass(frozen=True, slots=True, kw_only=True)
class GraphSettings(Checked):
    """Progressive pose graph (V §2.7, Algorithm 2.1, requirements A6)."""

    mode: Literal["10", "overlap", "verification", "beyond"] = "beyond"
    """The modes that V Table 3.2 compares, and ``beyond``, with semi-rigid refinement."""
    pairs: Literal["submaps", "published"] = "submaps"
    """``submaps``: the multiframes around two nodes are registered to each other, poor results are
    rejected by several figures and tried again from better poses. ``published``: single
    multiframes, once, rejected by overlap and error only."""
    node_stride: Annotated[int, ValueRange(1, 1000)] = 5
    """Number of multiframes per node."""
    closed_trajectory: bool = False
    """The walk ends at its start: pairs may wrap around (A0 no. 5)."""
    exhaustive: bool = False
    """Test all pairs as the thesis does; the work is quadratic in the path length."""
    workers: Annotated[int, ValueRange(1, 256)] = 2
    """Threads that register pairs; the result does not depend on it."""


@dataclass(frozen=True, slots=True, kw_only=True)
class VerificationSettings(Checked):
    """Verification by alternative paths (V §2.8, requirements A7)."""

    variant: Literal["paths", "cycle"] = "paths"
    """``paths``: as in the text. ``cycle``: triangles only, with the edge itself as a path without
    error, as in the author's code."""
    limit_m: Annotated[float, ValueRange(1e-6, 100, "m")] = 0.1
    """An edge with a larger path discrepancy is rejected [m] (A0 no. 1)."""
    robust: Literal["gnc", "cauchy", "none"] = "gnc"
    """The final solve after verification: ``gnc`` and ``cauchy`` also reject outliers of the whole
    graph, ``none`` is as in the text."""


@dataclass(frozen=True, slots=True, kw_only=True)
class RecognitionSettings(Checked):
    """Place recognition: loop closures that lie beyond the search radius of revisits."""

    enabled: bool = True
    """Search for places beyond the search radius; off = only revisits near the predicted pose."""
