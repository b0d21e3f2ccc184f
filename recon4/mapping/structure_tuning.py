"""Tuning of ground, buildings and vegetation. Study: docs/studies/structure-classes.md."""

from __future__ import annotations

from msgspec import Struct

from recon4.kernels.ground_cells import GroundRules
from recon4.kernels.structure_cells import GrowthRules, PlaneRules
from recon4.kernels.structure_points import PointRules


class StructureTuning(Struct, frozen=True, kw_only=True):
    """What stands in a map."""

    every_ns: int = 350_000_000
    """Time between multiframes that are looked at [ns]."""
    range_m: float = 40.0
    """Farther returns are not counted [m]: their cells would be half empty."""
    most: int = 10_000_000
    """Cells that are kept: a walk of some kilometers through streets."""
    least: int = 2
    """Returns of a cell that counts."""
    steep: float = 0.6
    """Cubes with a smaller vertical part of the normal are no ground: the sides of bushes."""
    layers: int = 2
    """Cells of the ground on each other are a cube."""
    per_meter: int = 5
    """Cubes along a meter."""
    spread: int = 15
    """The height of the ground is known so far beside it [m]."""
    storey: int = 1
    """But not in this number of cubes above and below ground that is known."""
    cubes: int = 60
    """A large surface has as many cubes, about 2 m²."""
    round_: float = 0.05
    """The mean square of its normals is not larger in the direction in which it is least: a crown
    is bent in two directions, a wall in one at most. If it is neither upright nor level, it has to
    be a plane, with the same for the direction between …"""
    folded: float = 0.012
    """… or sharply folded, as below stairs: in the first direction there is not more than this."""
    roof_m: float = 2.2
    """It reaches so high over the ground, higher than furniture [m] …"""
    tall_m: float = 2.3
    """… or is upright and as high itself [m]."""
    upright: float = 0.35
    """Largest vertical part of the normal of an upright surface, root mean square."""
    flat_level: float = 0.88
    """Least mean square of that of a level one."""
    level: float = 0.5
    """Least vertical part of the normal of a ceiling."""
    roofed: float = 0.4
    """A square meter is below a ceiling if as much of it is …"""
    around: int = 3
    wide: int = 7
    """… and as many of those around it, so far to each side [m]: a corridor, but no balcony."""
    eaves: int = 5
    """Nothing grows so near to that [m]."""
    tilt: tuple[float, float] = (0.3, 0.92)
    """Vertical part of a normal that is neither upright nor level."""
    echoes: float = 0.15
    """A cube with as many further echoes among its returns is of leaves."""
    bare_m: float = 0.15
    """Nor lower over the ground [m]."""


STRUCTURE = StructureTuning()


class RunTuning(Struct, frozen=True, kw_only=True):
    """Tables of cells, and runs of them on disk."""

    places: int = 1 << 20
    """Of a table (34 MB)."""
    filled: float = 0.6
    """It becomes a run when this part of it is filled …"""
    returns: int = 1 << 24
    """… or after as many returns: sums have 32 bits."""
    slab: int = 400_000
    """Rows of runs that are merged at a time."""


RUNS = RunTuning()

GROUND = GroundRules(
    cell_m=0.2,
    height_m=0.1,
    seen_above=0.5,
    clear=(2, 5),
    upright=2,
    carried_m=(0.3, 3.0),
    same_m=0.35,
    step_m=0.2,
    reach=2,
)
PLANES = PlaneRules(
    rounds=3,
    fit_m=0.08,
    least=5,
    alone=0.7,
    thin_m=0.07,
    on_m=0.09,
    reach=3,
    flat=14,
    cos=0.97,
    bridge=2,
)
GROWTH = GrowthRules(reach=3, least=12, irregular=0.5)
POINTS = PointRules(
    cell_m=(0.2, 0.1, 0.2),
    ground_m=0.08,
    bare_m=0.05,
    upward=0.7,
    beside=2,
    wall_m=0.1,
    along=0.8,
    low_m=0.5,
    medium_m=2.0,
    down=40,
)
