"""Settings of pair registration."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal

from recon4.settings.require import Checked, require


@dataclass(frozen=True, slots=True, kw_only=True)
class RegistrationSettings(Checked):
    """Registration of two sets of collar line segments (V §2.4, requirements A3)."""

    solver: Literal["planes", "common_normal", "svd"] = "planes"
    """``svd``: closed form on closest points of lines, as in the documents. ``common_normal``:
    distance along the common normals of lines. ``planes``: distance from a map of small planes."""

    def check(self) -> None:
        """Known solvers: single scans have none."""
        require(
            self.solver in {"planes", "common_normal", "svd"},
            "solver",
            self.solver,
        )
