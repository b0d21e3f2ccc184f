"""Tuning of floor products: storeys, plans, orthophotos and terrain."""

from __future__ import annotations

from msgspec import Struct


class StoreyTuning(Struct, frozen=True, kw_only=True):
    """Storeys of a building."""

    level: float = 0.9
    """Smallest vertical part of the normal of a floor or a ceiling."""
    column_m: float = 0.5
    """Edge of the columns in which levels are counted [m]."""
    cell_m: float = 0.1
    """Edge of the cells that add up to the area of a level [m]."""
    bin_m: float = 0.05
    """Height of a level [m]."""
    least_area_m2: float = 4.0
    least_ratio: float = 0.15
    """A floor has this area, and this part of that of the largest floor."""
    apart_m: float = 2.2
    """Floors are farther apart than this [m]: landings and steps belong to a storey."""
    body_m: tuple[float, float] = (0.3, 2.5)
    """Least and largest height of the sensors over the floor that is walked on [m]."""
    walked_s: float = 2.0
    """A floor is walked on for this time at least [s]."""
    ceiling_m: tuple[float, float] = (1.9, 12.0)
    """Least and largest height of a ceiling over its floor [m]."""
    roofed: float = 0.3
    """Least part of a floor that is below a ceiling: outdoors there are no storeys."""
    usual_m: float = 2.6
    """Height of a storey whose ceiling was not seen [m]."""
    slab_m: float = 0.15
    """Points belong to a storey from this far below its floor on: noise of the floor, and little
    of the ceiling of the storey below [m]."""


STOREYS = StoreyTuning()


class WallCellTuning(Struct, frozen=True, kw_only=True):
    """Upright surfaces of a storey, seen from above."""

    cell_m: float = 0.025
    """Edge of a cell [m]."""
    sectors: int = 8
    """Directions of normals that are kept apart: the two faces of a thin wall."""
    upright: float = 0.25
    """Largest vertical part of the normal of an upright surface."""
    bits: int = 64
    bit_m: float = 0.05
    """Heights above the floor at which there is a surface: this many steps of this height [m]."""
    clear_m: float = 0.1
    """Below and above the floor: baseboards [m]."""
    below_ceiling_m: float = 0.33
    """A wall reaches higher than this below the ceiling before it [m]."""
    high_m: float = 2.8
    """What is higher than this reaches the ceiling, in tall rooms [m]."""
    front_m: float = 0.3
    """The ceiling of a wall is taken this far before it [m]."""


WALL_CELLS = WallCellTuning()


class FaceTuning(Struct, frozen=True, kw_only=True):
    """Faces of walls, as straight lines."""

    agree: float = 0.97
    """Least cosine between the normals of a face and of its cells."""
    wide_m: float = 0.04
    narrow_m: float = 0.012
    """Distance of cells from a line at the first and at the last fit [m]."""
    rounds: int = 6
    bridged_m: float = 0.35
    """Longest stretch without a wall up to the ceiling inside of one face [m]."""
    straight_m: float = 0.5
    """A shorter face has the direction of its normals [m]."""
    min_length_m: float = 0.12
    min_cells: int = 5
    min_fill: float = 0.4
    """Least part of a face's length that has cells."""
    column_m: float = 0.05
    tall_percentile: float = 75.0
    tall_m: float = 0.9
    """In columns of this width, this percentile of a face has so much surface [m]."""
    attached_m: float = 0.08
    """A face this near to a longer one with its normal is fixed to it [m]."""
    own_m: float = 0.03
    """What is nearer to a face belongs to it [m]."""
    corner_m: float = 0.18
    """Ends that are nearer to the corner of two faces are moved to it [m]."""
    alone_m: float = 0.4
    """A shorter face that meets no other one is none [m]."""
    square: float = 0.35
    """Largest cosine between two faces that meet in a corner."""


FACES = FaceTuning()


class OpeningTuning(Struct, frozen=True, kw_only=True):
    """Doors and windows."""

    bin_m: float = 0.025
    """Step along a face [m]."""
    cut_m: tuple[float, float] = (1.0, 1.9)
    """Heights of the cut over the floor [m]: through doors and windows."""
    solid: float = 0.25
    """Least part of the cut at which there is a wall."""
    bridged_m: float = 0.2
    """Narrower gaps are of the cells, not of the wall [m]."""
    min_width_m: float = 0.4
    max_width_m: float = 6.0
    pierced: float = 0.3
    """Least part of an opening through which something behind was seen."""
    ray_cell_m: float = 0.1
    """Cells of a face that rays go through [m]."""
    rays: int = 400_000
    """Most rays that are looked at, a sample of all."""
    behind_m: float = 0.05
    """A ray goes through a face if it ends this far behind it [m]."""
    door_m: float = 0.3
    """The sill of a door is lower [m]."""
    reveal_m: float = 0.4
    """Depth of the sides of an opening that is looked at [m]."""
    jamb_cells: int = 3
    """A side that was seen has as many cells."""
    jamb_m: float = 0.08
    """The side of an opening is looked for this near to its edge [m]."""


OPENINGS = OpeningTuning()


class FloorPlanTuning(Struct, frozen=True, kw_only=True):
    """What is drawn of a storey."""

    thickness_m: tuple[float, float] = (0.04, 0.65)
    """Least and largest thickness of a wall [m]."""
    overlap_m: float = 0.25
    """Two faces of a wall are opposite each other for this length at least [m]."""
    column_m: float = 1.2
    """A longer face is no column's [m]."""
    furniture_m: tuple[float, float] = (0.15, 1.6)
    """Heights of furniture over the floor [m]."""
    outline_m: float = 0.02
    """Tolerance of the outlines of furniture [m]."""
    least_m2: float = 0.01
    """Smallest piece of furniture."""


PLANS = FloorPlanTuning()


class OrthophotoTuning(Struct, frozen=True, kw_only=True):
    """Orthophotos."""

    band_m: tuple[float, float] = (0.3, 2.0)
    """Below and above the floor of a storey: what is seen from above [m]."""
    below_ceiling_m: float = 0.3
    """The band ends as far below the ceiling [m]."""
    surface_m: float = 0.04
    """Points this far behind the nearest one are of its surface [m]."""
    fill_px: int = 2
    """Pixels that are as near to a point have its value."""
    percentiles: tuple[float, float] = (2.0, 98.0)
    """Intensities that are black and white."""
    sample: int = 500_000
    """Pixels of which these are taken."""
    rows: int = 512
    """Rows that are made at once."""


ORTHOPHOTOS = OrthophotoTuning()


class TerrainTuning(Struct, frozen=True, kw_only=True):
    """Models of the terrain (Zhang et al. 2003, progressive morphological filter)."""

    level: float = 0.5
    """Smallest vertical part of the normal of the ground."""
    widest_m: float = 16.0
    """Larger objects are taken for ground [m]."""
    slope: float = 0.3
    """Steepest slope of the ground, rise over run."""
    step_m: float = 0.12
    """Smallest object that is not taken for ground [m]."""
    surface_m: float = 0.10
    """Points this far above the lowest one of a cell are of its ground [m]."""
    nodata: float = -9999.0
    """Value of cells that were not seen."""
    index: int = 5
    """Every fifth contour is an index contour."""
    max_levels: int = 2000
    """Most heights of contours."""
    shortest_m: float = 1.0
    """A shorter contour is left out [m]."""
    density_m: float = 0.25
    """Edge of the cells in which points are counted [m]."""
    border_m: float = 0.5
    """The base of a volume is fitted to the ground this near to the border of its polygon [m]."""
    border_cells: int = 8
    """The border has as many cells at least."""
    hypotheses: int = 300
    """Planes that are tried as base: 30 % good cells are enough for one of three (p > 0.999)."""
    triangle_m2: float = 1e-3
    """Smallest triangle of cells that gives such a plane [m²]."""
    most_cells: int = 4000
    """Cells that judge it."""
    border_sd_m: float = 0.002
    """Least deviation of heights from the base: cells of a smooth floor [m]."""


TERRAIN = TerrainTuning()


class ProductPreviewTuning(Struct, frozen=True, kw_only=True):
    """Previews of products."""

    side_px: int = 1400
    """Longest side of a preview."""
    margin_px: int = 12
    """White border of a drawing."""


PREVIEWS = ProductPreviewTuning()


class CurveTuning(Struct, frozen=True, kw_only=True):
    """Curved walls, as arcs of circles."""

    radius_m: tuple[float, float] = (0.8, 30.0)
    turn_rad: tuple[float, float] = (0.03, 1.1)
    """Chords that may be of one arc turn by this much from one to the next."""
    near_m: float = 0.6
    """Between the ends of two such chords [m]."""
    wide_m: float = 0.08
    narrow_m: float = 0.02
    """Distance of cells from the circle at the first and at the last fit [m]."""
    rounds: int = 5
    agree: float = 0.985
    """Least cosine between the normal of a cell and the radius: 10°."""
    bridged_m: float = 0.35
    """Longest stretch without a wall inside of one arc [m]."""
    sweep_rad: float = 0.52
    """Least turn of an arc: 30°; no straight wall stays on a circle for so long."""
    fill: float = 0.6
    """Least part of an arc that has cells, in steps of 6 cm."""
    rms_m: float = 0.012
    least_cells: int = 15
    chord_m: float = 0.001
    """A drawn arc is off the circle by this much at most [m]."""
    closed_m: float = 0.001
    """An arc whose ends are nearer is a whole circle [m]."""
    step_m: float = 0.06


CURVES = CurveTuning()
