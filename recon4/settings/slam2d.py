"""Settings of 2-D mapping: scans, odometry, loop closure and the grid."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Annotated, Literal

from recon4.settings.require import Checked, ValueRange, require


@dataclass(frozen=True, slots=True, kw_only=True)
class Slam2dSettings(Checked):
    """Registration of the scans of a 2-D laser (stage ``odometry_2d``)."""

    method: Literal["lines", "hector"] = "lines"
    """``lines``: distances to lines of a sliding local map, correlative search when that fails.
    ``hector``: Gauss-Newton on the gradient of one occupancy grid (requirements A12 L-1)."""
    use_odometry: bool = True
    """Predict the motion with the odometry of the recording, if there is any."""
    min_range_m: Annotated[float, ValueRange(0, 100, "m")] = 0.1
    """Nearer returns are left out [m]."""
    max_range_m: Annotated[float, ValueRange(0.5, 250, "m")] = 30.0
    """Farther returns are left out [m]."""

    def check(self) -> None:
        """Limits of the range in their order."""
        require(
            self.min_range_m < self.max_range_m,
            "ranges",
            self.min_range_m,
        )


@dataclass(frozen=True, slots=True, kw_only=True)
class Loop2dSettings(Checked):
    """Loop closure of 2-D maps (stage ``graph_2d``)."""

    enabled: bool = True
    """Search for loop closures."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Grid2dSettings(Checked):
    """Occupancy grid of the finished 2-D map (stage ``map_2d``), as nav2 reads it."""

    cell_m: Annotated[float, ValueRange(0.005, 1, "m")] = 0.05
    """Edge of a cell [m]."""
