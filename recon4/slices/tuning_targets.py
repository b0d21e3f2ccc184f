"""Tuning of the search for survey targets in a whole map."""

from __future__ import annotations

from msgspec import Struct


class TargetCellTuning(Struct, frozen=True, kw_only=True):
    """Cells in which tiles are looked through."""

    cell_m: float = 0.03
    blocks: int = 3
    """A block has as many cells along each edge."""
    sampled: int = 20_000
    """Points of each tile by which the usual intensities are known."""


TARGET_CELLS = TargetCellTuning()


class PlateTuning(Struct, frozen=True, kw_only=True):
    """Retro-reflective plates."""

    usual: float = 0.98
    """Quantile of the intensities of a map that is still usual."""
    bright: float = 1.7
    """Intensity of a plate, in those: paint of a backpack's walk has up to 1.3, plates 2 and more.
    """
    least_cells: int = 4
    """Bright cells of a plate."""
    sizes_m: tuple[float, float] = (0.04, 0.8)
    """Least and largest extent of a bright place."""
    around_m: float = 0.15
    """What surrounds a plate within this shows its edges."""
    off_plane_m: float = 0.03
    """Points farther from the plane of a plate are not on it."""
    least_points: int = 60
    """Bright spots of walls that are no plates have up to 38."""
    least_around: int = 30
    """With fewer points around it, a plate stands free: its middle is that of its outline."""
    around_part: float = 0.15
    """Or with fewer than this part of its own: on a wall there are several times as many."""
    edge_m: float = 0.008
    """Half width of the blur at an edge: a beam at 5 m."""
    halves_m: tuple[float, float] = (0.02, 0.35)
    """Half of the least and of the largest edge."""
    most_aspect: float = 4.0
    """A longer strip has no middle that is surveyed."""
    least_agreement: float = 0.75
    """Correlation of the intensities with a rectangle."""
    least_filled: float = 0.6
    """Part of the outline of a free plate that is bright."""
    outline: tuple[float, float] = (0.02, 0.98)
    """Quantiles of points that are the outline of a free plate."""
    outline_sd_m: float = 0.005
    """Deviation of its middle."""
    most_sd_m: float = 0.02
    most_places: int = 2000
    """Bright places that are looked at; those with most cells first."""


PLATES = PlateTuning()


class BoardSearchTuning(Struct, frozen=True, kw_only=True):
    """Places where a black-white board may be."""

    contrast: float = 0.4
    """Between the cells of a block: brightest minus darkest, in the brightest."""
    radius_m: float = 0.1
    """Around a place that is compared with four sectors."""
    inner_m: float = 0.02
    """Nearer to the place all sectors are mixed."""
    neighbors: int = 64
    least_neighbors: int = 12
    counted: float = 4.0
    """Points of a cell that count: those at the rim of a layer have few."""
    second: float = 0.35
    """Least second harmonic of the intensities about the place, which four sectors have (0.64) …"""
    first: float = 0.4
    """… and largest first one, which edges have."""
    sectors: float = 0.2
    """Least difference of the darker white and the brighter black sector, in the white one."""
    rough_m: float = 0.015
    """Deviation of the cells from a plane."""
    behind_m: float = 0.05
    """Cells farther from the plane of all are of another surface: the other face of a thin wall."""
    apart_m: float = 0.12
    """Places closer to a better one are the same."""
    reach_m: float = 0.04
    """A center lies this near to the best place."""
    most_places: int = 800
    """Places that are compared with the pattern, the best first."""


BOARD_SEARCH = BoardSearchTuning()


class SphereTuning(Struct, frozen=True, kw_only=True):
    """Spheres."""

    radii_m: tuple[float, ...] = (0.07, 0.1, 0.15)
    """Looked for without a survey that states them: those that are sold, within a quarter."""
    flat: float = 0.985
    """Length of the mean normal of a block above which it is flat (10°)."""
    near_m: float = 0.03
    """Normals that meet this near point to the same middle."""
    covered: float = 0.1
    """Least part of the cells of a sphere whose normals meet."""
    shell_m: float = 0.03
    """Points this near to the surface decide about the sphere."""
    rounds: int = 6
    least_points: int = 60
    most_rough_m: float = 0.015
    """Largest deviation of its points."""
    radius_off: float = 0.25
    """Largest relative difference from the radius that was looked for."""
    survey_off_m: float = 0.012
    """The same from a surveyed radius."""
    least_round: float = 0.08
    """Least eigenvalue of the mean of ``n nᵀ``: a third on a whole sphere, 0 on a cylinder."""
    empty_m: tuple[float, float] = (0.04, 0.12)
    """From the surface outwards: a sphere stands free, but for what holds it …"""
    most_around: float = 0.35
    """… so there are fewer points than this part of its own."""
    most_places: int = 600


SPHERES = SphereTuning()


class TargetMatchTuning(Struct, frozen=True, kw_only=True):
    """Names of found targets by the distances between surveyed points."""

    distance_m: float = 0.06
    """Two distances are the same within this, and one part in a thousand."""
    relative: float = 0.001
    height_m: float = 0.06
    """Differences of height on a leveled map, too."""
    near_m: float = 0.08
    """A surveyed point is a candidate this near, after a rigid fit …"""
    fitted_m: float = 0.05
    """… and this near in the end."""
    least: int = 3
    """Fewer points that agree name nothing."""
    least_apart_m: float = 0.5
    """Two targets that are nearer do not say how a map is turned."""
    most_trials: int = 20_000
    """Positions of the survey that are tried."""
    tilt_rad: float = 0.01
    """Largest tilt of a map against its survey: leveling by an IMU is within 1 mrad to 5 mrad."""
    rounds: int = 4
    alike: float = 2.0
    """Another reading of the names that agrees for as many points is as good up to this many times
    the misfit."""
    alike_m: float = 0.02
    """Or up to this misfit [m]."""


TARGET_MATCH = TargetMatchTuning()


class NearPointTuning(Struct, frozen=True, kw_only=True):
    """Points around many places."""

    column_m: float = 0.2
    tiles: int = 8
    """Kept at hand: all that meet in a corner."""


NEAR_POINTS = NearPointTuning()
