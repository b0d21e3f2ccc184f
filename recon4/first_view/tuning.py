"""How much of a map the page *Map* reads at once, and what its first view shows."""

from __future__ import annotations

from msgspec import Struct


class MapChunkTuning(Struct, frozen=True, kw_only=True):
    """Points as they are sent."""

    version: int = 6
    """Part of the names of kept files and of ETags: layout of index, sample and chunks."""
    sample_points: int = 60_000
    """Points of the coarsest sample of the whole map, which is sent first."""
    cube_tiles: int = 64
    """Most tiles whose coarse points are in one cube; the shader has as many sizes."""
    coarse_points: int = 512
    """Most first points of a tile that are in its cube: more would be drawn out of sight."""
    max_chunk_points: int = 1 << 18
    """Most points of one response."""
    max_parts: int = 64
    """Most parts of one response."""
    place_bytes: tuple[int, ...] = (6, 4, 1)
    """Of a point of a cube: position, normal with class, tile."""
    value_bytes: tuple[int, ...] = (2,)
    """Of one of its values."""
    place_steps: float = 65_535.0
    """Steps of a position within its box."""
    value_steps: int = 65_534
    """Steps of a value; the one after them says that there is no value."""
    length_step_m: float = 1e-4
    """Step of a standard deviation [m]."""
    intensity_step: float = 1.0 / 16.0
    """Step of a normalized intensity, as in LAZ exports."""
    max_sample_bytes: int = 16 << 20
    """A larger sample was not written by us."""
    max_index_bytes: int = 64 << 20
    """A larger index was not written by us."""


MAP_CHUNKS = MapChunkTuning()


class FirstViewTuning(Struct, frozen=True, kw_only=True):
    """What the first view is made for."""

    most_tiles: int = 128
    """Of a larger map, color scales and storeys are those of as many tiles, drawn at random."""
    surface_m: float = 0.01
    """Distance of points on a surface in a map that was not thinned [m]."""
    spread_points: int = 30
    """Points of a sample of a tile that tell how far apart its points are."""
    usual_percent: tuple[float, float] = (2.0, 98.0)
    """Ends of a color scale, among the values of the sample [%]."""
    varied: float = 1.5
    """Values within as many of their steps are the same everywhere."""
    extent_percent: tuple[float, float] = (0.5, 99.5)
    """Ends of the extent that the camera shows: few stray points do not decide it [%]."""
    margin: float = 0.02
    """Added to that extent on each side, as a part of it."""
    storey_gap_m: float = 1.5
    """Storeys are farther apart than this [m]."""
    storey_percent: float = 3.0
    """Less of the walk than this at one height is a landing, not a storey [%]."""
    level_m: float = 0.25
    """A walk that stays this near to one height is on a level [m]."""
    level_ratio: float = 0.6
    """Of the walk within half of `storey_gap_m`, as much is on the level; of a slope, a third."""
    carried_m: tuple[float, float] = (0.3, 2.5)
    """The floor is this far below the sensors [m]."""
    bin_m: float = 0.05
    """Bins of heights in which the floor is looked for [m]."""
    upright: float = 0.9
    """Vertical part of a normal of floors and ceilings."""
    ceiling_ratio: float = 0.2
    """With more points looking down above the walk, per point of its floor, there is a ceiling."""


FIRST_VIEW = FirstViewTuning()
