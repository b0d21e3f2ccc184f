"""A showroom with a round end, a front of clear glass to a street, and a mirror on its back wall.

The round end is a half circle of chords that are off it by 1 mm at most. Through the front a LiDAR
sees the street and the house across it; at grazing incidence the glass shows the room again.

From above::

    y
   9.0 +---------====== mirror ===-----.
       |  shelves                        '.
       |  o     o                         |
       |  desk                           .'
   0.0 +| | | glass front, 2.9 m | | |-'
       |
  -4.0    kerb, street
 -11.0 ============ house across ==========   x
       0                        12      16.5
"""

from __future__ import annotations

from dataclasses import dataclass
from itertools import pairwise

import numpy as np

from recon4.geometry.mesh import MeshBuilder, SurfaceKind
from recon4.geometry.tuning import SURFACES
from recon4.simulation.materials import MATERIAL
from recon4.simulation.world import Waypoint, World
from recon4.simulation.worlds.furniture import desk, lamp, shelf
from recon4.simulation.worlds.walls import WallShape, wall, window


@dataclass(frozen=True, slots=True, kw_only=True)
class ShowroomPlan:
    """Measures, see the drawing."""

    length_m: float = 12.0
    depth_m: float = 9.0
    height_m: float = 3.4
    chord_m: float = 0.001
    """Chords of the round end are off their circle by this much [m]."""
    mirror_m: tuple[float, float] = (5.0, 9.0)
    """From and to along the back wall."""
    pane_m: float = 2.0
    """Width of a pane of the front."""
    across_m: float = 11.0
    """To the house across the street."""

    @property
    def radius_m(self) -> float:
        """Of the round end [m]."""
        return self.depth_m / 2.0


def build() -> World:
    """The showroom."""
    plan, rng = ShowroomPlan(), np.random.default_rng(31)
    builder = MeshBuilder()
    _shell(builder, plan)
    _round_end(builder, plan)
    _front(builder, plan)
    _street(builder, plan)
    for x in (1.2, 3.1):
        shelf(builder, x, plan.depth_m - 0.5, height_m=rng.uniform(1.2, 2.2), rng=rng)
    desk(builder, 0.7, 4.1, side=1.0, rng=rng)
    for x in (4.8, 7.2):
        builder.block([x, 4.2, 0.0], [0.5, 0.5, 0.9], MATERIAL.wood)
    return World(name="showroom", mesh=builder.mesh(), route=_route, stops=3)


def _shell(builder: MeshBuilder, plan: ShowroomPlan) -> None:
    """Floor, ceiling, back wall with a mirror, and the west wall with a window."""
    length_m, depth_m, height_m = plan.length_m, plan.depth_m, plan.height_m
    along, across = [length_m + plan.radius_m, 0, 0], [0, depth_m, 0]
    builder.quad([0, 0, 0], along, across, reflectivity=MATERIAL.linoleum)
    builder.quad([0, 0, height_m], along, across, reflectivity=MATERIAL.ceiling)
    shape = WallShape(height_m=height_m)
    wall(builder, (0, depth_m + 0.06), (length_m, depth_m + 0.06), shape=shape)
    wall(builder, (-0.06, 0), (-0.06, depth_m), shape=shape, openings=[window(6.0)])
    (left, right), (bottom, top) = plan.mirror_m, (0.3, 2.4)
    width = [right - left, 0, 0]
    builder.quad(
        [left, depth_m - 0.04, bottom], width, [0, 0, top - bottom], reflectivity=SURFACES.mirror
    )
    for x in np.arange(2.0, length_m + 3.0, 3.4):
        for y in (2.4, 6.6):
            lamp(builder, float(x), y, ceiling_m=height_m)


def _round_end(builder: MeshBuilder, plan: ShowroomPlan) -> None:
    """The half circle at the east end."""
    radius_m = plan.radius_m
    count = int(np.ceil(np.pi / (2.0 * np.arccos(1.0 - plan.chord_m / radius_m))))
    angle = np.linspace(-np.pi / 2.0, np.pi / 2.0, count + 1)
    corners = np.column_stack([np.cos(angle), np.sin(angle)]) * radius_m
    corners += [plan.length_m, plan.depth_m / 2.0]
    with builder.of(SurfaceKind.BUILDING):
        for a, b in pairwise(corners):
            chord, up = [*(b - a), 0.0], [0, 0, plan.height_m]
            builder.quad([*a, 0.0], chord, up, reflectivity=MATERIAL.plaster)


def _front(builder: MeshBuilder, plan: ShowroomPlan) -> None:
    """Panes from the floor up between posts of steel, below a beam."""
    top_m = plan.height_m - 0.5
    for left in np.arange(0.0, plan.length_m, plan.pane_m):
        builder.quad([left, 0, 0], [plan.pane_m, 0, 0], [0, 0, top_m], reflectivity=SURFACES.clear)
        builder.box([left - 0.03, -0.04, 0], [left + 0.03, 0.04, top_m], MATERIAL.steel)
    with builder.of(SurfaceKind.BUILDING):
        builder.box([0, -0.1, top_m], [plan.length_m, 0.1, plan.height_m], MATERIAL.plaster)


def _street(builder: MeshBuilder, plan: ShowroomPlan) -> None:
    """Pavement, street and the house across it."""
    far_m, reach_m = plan.across_m, 14.0
    wide = [plan.length_m + 2.0 * reach_m, 0, 0]
    builder.quad([-reach_m, -4.0, -0.02], wide, [0, 4.0, 0], reflectivity=MATERIAL.concrete)
    builder.quad(
        [-reach_m, -far_m, -0.14], wide, [0, far_m - 4.0, 0], reflectivity=MATERIAL.asphalt
    )
    house = WallShape(bottom_m=-0.14, height_m=7.0, thickness_m=0.3, reflectivity=MATERIAL.concrete)
    holes = [window(x) for x in np.arange(3.0, plan.length_m + 2.0 * reach_m - 2.0, 3.2).tolist()]
    ends = (-reach_m, -far_m - 0.15), (plan.length_m + reach_m, -far_m - 0.15)
    wall(builder, *ends, shape=house, openings=holes)


def _route(rng: np.random.Generator, stops: int) -> list[Waypoint]:
    """Along the front into the round end, and back along the mirror."""
    a, b = rng.uniform(-0.2, 0.2, 2)
    far = 12.6 if stops > 1 else 9.0
    return [
        Waypoint(2.4, 2.3),
        Waypoint(7.0, 2.2 + a),
        Waypoint(far, 2.8, stop=stops > 1, look_deg=70.0),
        Waypoint(far, 5.8),
        Waypoint(7.0, 6.2 + b, stop=stops > 2, look_deg=-50.0),
        Waypoint(2.4, 5.9),
        Waypoint(2.4, 2.3),
    ]
