"""The figures that were walked under the measuring system (L Table 1), as routes."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace

import numpy as np

from recon4.errors import ConfigError
from recon4.geometry.se3 import Array
from recon4.locales.coded import CodedText
from recon4.simulation.world import Waypoint, World


@dataclass(frozen=True, slots=True, kw_only=True)
class FigureFit:
    """How figures lie on a floor."""

    inset: float = 0.85
    """Size as a part of the halves of the floor; for the circle, of the smaller one."""
    min_half_m: float = 2.0
    """Least half of a floor."""
    step_m: float = 0.4
    """Between two waypoints of a curve."""


FIT = FigureFit()


@dataclass(frozen=True, slots=True)
class Figure:
    """A figure with its row of L Table 1."""

    seconds: float
    line_scans: int
    points: int
    curve: Callable[[float, float, Array], Array]
    """x, y [m] by the halves of the floor and a parameter of 0..1, (N,) -> (N, 2)."""

    return_ratio: float = 0.916
    """Part of the shots that return in the hall; the rest hit panes, pass doors or are too weak."""

    @property
    def points_per_line(self) -> float:
        """Mean number of points of a line scan."""
        return self.points / self.line_scans

    @property
    def shots_per_line(self) -> int:
        """Number of shots of a line scan."""
        return round(self.points_per_line / self.return_ratio)


def _eight(half_x_m: float, half_y_m: float, s: Array) -> Array:
    """Lemniscate of Gerono."""
    angle = 2.0 * np.pi * s + 0.5 * np.pi
    x, y = FIT.inset * half_x_m * np.cos(angle), FIT.inset * half_y_m * np.sin(2.0 * angle)
    return np.stack([x, y], axis=1)


def _rectangle(half_x_m: float, half_y_m: float, s: Array) -> Array:
    a, b = FIT.inset * half_x_m, FIT.inset * half_y_m
    corners = np.array([[-a, -b], [a, -b], [a, b], [-a, b], [-a, -b]])
    along = np.concatenate([[0.0], np.cumsum(np.linalg.norm(np.diff(corners, axis=0), axis=1))])
    return np.stack([np.interp(s * along[-1], along, corners[:, k]) for k in range(2)], axis=1)


def _circle(half_x_m: float, half_y_m: float, s: Array) -> Array:
    radius = FIT.inset * min(half_x_m, half_y_m)
    return radius * np.stack([np.cos(2.0 * np.pi * s), np.sin(2.0 * np.pi * s)], axis=1)


FIGURES = {
    "eight": Figure(93.0, 9525, 5_078_759, _eight),
    "rectangle": Figure(103.0, 10_633, 7_654_005, _rectangle),
    "circle": Figure(60.0, 6201, 4_469_067, _circle),
}
"""By name (L Table 1)."""


def figure_named(name: str) -> Figure:
    """A figure by its name.

    Raises:
        ConfigError: If there is none of that name.
    """
    if name not in FIGURES:
        raise ConfigError(
            CodedText("simulate-no-figure", name=name[:80], figures=", ".join(FIGURES))
        )
    return FIGURES[name]


def along_figure(world: World, figure: Figure) -> World:
    """The world with rounds that follow a figure on its free floor.

    Raises:
        ConfigError: If the world has no free floor of 4 m x 4 m.
    """
    if world.floor is None or min(world.floor[2:]) < FIT.min_half_m:
        raise ConfigError(CodedText("simulate-figure-floor", world=world.name))
    x_m, y_m, half_x_m, half_y_m = world.floor
    dense = figure.curve(half_x_m, half_y_m, np.linspace(0.0, 1.0, 2001))
    length_m = float(np.linalg.norm(np.diff(dense, axis=0), axis=1).sum())
    places = figure.curve(
        half_x_m, half_y_m, np.linspace(0.0, 1.0, round(length_m / FIT.step_m) + 1)
    )

    def route(rng: np.random.Generator, stops: int) -> list[Waypoint]:
        stray = 0.05 * rng.standard_normal(2)
        return [Waypoint(x_m + x + stray[0], y_m + y + stray[1]) for x, y in places]

    return replace(world, route=route, stops=1)
