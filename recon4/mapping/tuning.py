"""Tuning of the map: placing, thinning, surfaces, mirrors."""

from __future__ import annotations

import numpy as np
from msgspec import Struct


class BucketTuning(Struct, frozen=True, kw_only=True):
    """Records of each tile on disk."""

    burst: int = 1500000
    """Records held in memory before they are thinned and written (48 MB)."""


BUCKETS = BucketTuning()


class MapBuildTuning(Struct, frozen=True, kw_only=True):
    """The stage ``map``."""

    workers: int = 2
    """Threads; the kernels do not hold Python's lock."""
    large: int = 600_000
    """A tile of as many records, which is fitted in parts, is made alone by all threads."""
    ahead: int = 3_000_000
    """A tile of at most as many records on disk is read while the one before is made: half of them
    are left then (50 MB)."""


MAP_BUILD = MapBuildTuning()


class MirrorTuning(Struct, frozen=True, kw_only=True):
    """Mirrors in a map."""

    cell_m: float = 0.15
    """Cells of the normals, which come from three of them."""
    vertical: float = 0.2
    min_support: int = 8
    """Largest z of the normal of a wall; normals from fewer points do not count."""
    angle_rad: float = float(np.deg2rad(3.0))
    offset_m: float = 0.1
    """Bins in which walls are searched."""
    most_walls: int = 24
    """Walls that are examined; the largest first."""
    wall_cells: int = 12
    """A wall covers at least this many cells of `grid_m`."""
    grid_m: float = 0.25
    """Cells on a wall, in which beams cross it."""
    before_m: float = 0.3
    behind_m: float = 0.4
    """Beams count that begin and end this far from the wall."""
    facing: float = 0.5
    """Cosine between a surface's normal and that of the wall above which it faces it."""
    near_m: float = 0.3
    same_m: float = 0.08
    same_cosine: float = 0.85
    """A reflected point is this near to one of a surface, this near to its plane, and has the same
    normal: far walls have few points."""
    hangs_m: float = 0.06
    """No mirror hangs farther before its wall [m]: the showroom's hangs 0.04, the middle between
    like flights of stairs is 0.13 before a rail."""
    min_beams: int = 3
    min_ratio: float = 0.75
    """A cell is mirrored if this many beams cross it, and this ratio of them shows the room before
    it."""
    opening_ratio: float = 0.65
    """The opening around it is no mirror if fewer of its beams do: 0.88 and 0.93 in rooms with
    mirrors, 0.47 over the wall of a staircase."""
    min_area_m2: float = 2.5
    """A smaller wall is no mirror [m²]."""
    entered_m: float = 0.12
    entered_ratio: float = 0.5
    """A room is real if this ratio of it was seen from behind the wall, too, within this [m]."""
    reflected_m: float = 0.1
    """A reflection lies at least this far behind the mirror."""
    most_beams: int = 20_000
    most_points: int = 60_000
    """No more beams through a wall, and points on walls, are used."""


MIRRORS = MirrorTuning()


class SmallMirrorTuning(Struct, frozen=True, kw_only=True):
    """Small mirrors: beams that seem to cross what stands show the room before them."""

    cell_m: float = 0.2
    """Edge of the cells in which beams end, or which they cross [m]."""
    margin_m: float = 0.4
    """The last part of a beam crosses nothing [m]: two copies of a wall."""
    farthest_m: float = 30.0
    """Longer beams are not followed [m]."""
    least_ends: int = 5
    crossed_ratio: float = 0.3
    """What stands is a cell in which this many beams end, and which few cross: at most this many
    for each that ends there."""
    most_beams: int = 6000
    """No more beams that cross what stands propose planes."""
    surface_m: float = 0.3
    """Of the surfaces in a cell of this edge [m], one is compared for each direction."""
    aside_m: float = 0.25
    """A plane maps a point to within this of a surface, along it [m]."""
    lift_m: float = 0.15
    """And no higher or lower than this [m]: mirrors are upright."""
    angle_rad: float = float(np.deg2rad(5.0))
    offset_m: float = 0.2
    along_m: float = 1.0
    """Bins in which planes are counted: direction, offset, and where on them beams cross [m]."""
    least_votes: int = 6
    most_planes: int = 30
    """Planes with fewer beams are not examined, and no more than this many."""
    reach_m: tuple[float, ...] = (0.2, 0.15, 0.1, 0.08)
    """Reflected points that fit a plane are this near to a surface [m], closer every time."""
    same_m: float = 0.05
    """And this near those that show the room [m]."""
    grid_m: float = 0.05
    """Edge of the cells on a mirror [m]."""
    around_m: float = 1.5
    """A mirror reaches no farther from the place that proposed it, to each side [m]."""
    other: float = 1.0 / 3.0
    """A beam that shows something else is worth so much of one that shows the room."""
    min_beams: int = 12
    min_ratio: float = 0.6
    """A mirror shows the room by at least this many beams, and this ratio of all: columns with
    mirrors 0.67 to 0.79, the best other plane that beams cross 0.46."""
    least_side_m: float = 0.3
    """It is this wide and high: two cells of normals."""
    most_seen: float = 0.35
    """No larger part of what it shows is seen by beams past it, too: columns with mirrors 0.03 to
    0.26, a house that a showroom's glass front shows 0.44."""
    min_crossing: float = 0.15
    """At least this ratio of its beams seem to cross what stands: columns with mirrors 0.21 to
    0.69, like rows of columns and flights of stairs at most 0.07."""


SMALL_MIRRORS = SmallMirrorTuning()


class NormalTuning(Struct, frozen=True, kw_only=True):
    """Normals of many points at once."""

    min_points: int = 6
    """Fewer points in a neighborhood have no normal."""


NORMALS = NormalTuning()


class PointPlaceTuning(Struct, frozen=True, kw_only=True):
    """Every point by the pose at its time."""

    knot_ns: int = 1_000_000
    """Interval of exactly interpolated poses [ns]; the poses of the trajectory are added."""


POINT_PLACES = PointPlaceTuning()


class SparseSurfaceTuning(Struct, frozen=True, kw_only=True):
    """Surfaces of sparse places."""

    scale: int = 3
    """Cells of the larger scale are as many times as large."""
    few: int = 60
    """A neighborhood of fewer points is sparse."""
    share: float = 0.02
    """A tile with a smaller part of such points is dense; they are then things, not surfaces."""
    noise: float = 3.0
    """Sparse points are far from the sensor or few recordings: poses and beams are less exact."""
    thicker: float = 1.4
    """Sparse surfaces this many times as thick as most of a tile are not trusted."""
    reach: int = 5
    """Cells along a window of windows: what the planes of a cell depend on."""


SPARSE_SURFACES = SparseSurfaceTuning()


class TileSurfaceTuning(Struct, frozen=True, kw_only=True):
    """Surfaces of a tile."""

    slab: int = 400_000
    """Records fitted at once: what is known of their cells is four times as large as themselves.
    With half as many, margins make the fit 1.2 times as expensive."""
    together: int = 1_200_000
    """No more records are fitted by all threads together (130 MB). A slab has a million where a
    wall fills a row of cells: such ones are fitted one after the other."""
    margin: int = 2
    """Rows of cells beyond a slab that its surfaces depend on, as many as in the halo of a tile."""
    least_noise_m: float = 0.015
    """Least noise of the returns, however exact the ranges are [m]: poses, beams and voxels add
    theirs. With the 5 mm of an XT32 its surfaces are 3.0 mm off, with this 2.0 mm."""


TILE_SURFACES = TileSurfaceTuning()


class TileTuning(Struct, frozen=True, kw_only=True):
    """The columns of a tile."""

    strata: int = 64
    """Number of uniform samples of itself in which a tile is stored, one after the other."""
    block: int = 1 << 16
    """Most rows of a block, which are made and stored together: the columns of a whole tile take
    more memory than all else of it."""
    sample: int = 16
    """The first block of a tile has this part of its rows: a sample of many tiles is read from
    few."""
    kept_bytes: int = 96 << 20
    """Memory of a process for blocks of a map that people look at."""
    intensity_step: float = 1.0 / 16.0
    """Steps of normalized intensities: finer than the raw ones."""
    position_step_m: float = 0.0001
    """Steps of positions, those of a LAZ [m]: what is exported is not rounded twice. Study:
    docs/studies/map-size.md."""
    deviation_step_m: float = 0.0001
    """Steps of the deviations of positions, those of a LAZ [m]."""
    time_step_ns: int = 1000
    """Steps of times, from the start of a multiframe [ns]. A sensor turns by 0.006° meanwhile."""
    path_step_ns: int = 10_000_000
    """Interval of the positions of the sensors [ns]. Between them a person moves straight to
    0.2 mm."""
    far_cell_m: float = 1.0
    """Size of the cubes of ``MapSettings.far_ratio`` [m]."""
    margin_m: float = 0.2
    """No point was measured farther than this from its surface [m]."""


TILES = TileTuning()


class CarryTuning(Struct, frozen=True, kw_only=True):
    """Which maps are carried along with decisions. Study: docs/studies/speed.md."""

    bent_m: float = 0.004
    """Across a surface, a point may move by this otherwise than what is around: the step at which
    the refinement stops [m] …"""
    bent_ratio: float = 0.01
    """… but for this ratio of the points."""
    around_m: float = 0.5
    """Edge of the cubes that move together [m]: about the window of a surface."""


CARRY = CarryTuning()


class VoxelRunTuning(Struct, frozen=True, kw_only=True):
    """Runs of records that are merged."""

    buffer: int = 8192
    """Most records of a run in memory."""
    together: int = 400_000
    """Most records of all runs in memory (13 MB): a tile has one run for each burst that saw it, so
    their number grows with the walk."""
    least: int = 64
    """A run has at least this many: reading fewer costs more than it saves."""


VOXEL_RUNS = VoxelRunTuning()
