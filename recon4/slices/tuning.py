"""Tuning of comparisons of slices with references, and of double walls."""

from __future__ import annotations

import numpy as np
from msgspec import Struct


class AlignmentTuning(Struct, frozen=True, kw_only=True):
    """Alignment of a reference with the map by ICP."""

    samples: int = 60_000
    """Points of the map that are compared."""
    rounds: int = 60
    """Upper bound on the rounds."""
    near_m: float = 0.5
    """Largest distance of a match in the first rounds [m]."""
    on_m: float = 0.10
    """A point this near lies on the reference [m]."""
    min_points: int = 100
    """With fewer matches there is no alignment."""
    floor_samples: int = 400_000
    """Points among which floors are looked for."""
    floor_near_m: float = 3.0
    """Largest difference of two floors that may be the same one [m]."""
    level: float = np.cos(np.deg2rad(30.0))
    """Cosine of the largest tilt of a floor."""
    bin_m: float = 0.05
    """Step of the histogram of heights [m]."""
    min_near: float = 0.02
    """Smallest ratio of map points near the reference, which may be one room of a building."""
    min_on: float = 0.6
    """Smallest inlier ratio among those points."""


ALIGNMENT = AlignmentTuning()


class ControlVerdictTuning(Struct, frozen=True, kw_only=True):
    """Residuals compared with the limits."""

    named: int = 5
    """Points named in the verdict."""


CONTROL_VERDICT = ControlVerdictTuning()


class DoublePlaceTuning(Struct, frozen=True, kw_only=True):
    """Patches grouped into places."""

    max_surfaces: int = 3000
    """Surfaces that are listed; the thickest first."""
    place_m: float = 1.5
    """Patches within this distance that face alike form one place [m]."""
    min_patches: int = 10
    """Smallest number of patches of a place: an edge or a moved chair makes one or two."""


DOUBLE_PLACES = DoublePlaceTuning()


class DoubleWallTuning(Struct, frozen=True, kw_only=True):
    """Double walls."""

    block: int = 2_000_000
    """Points that are read at a time."""
    first_table: int = 1 << 15
    """Number of cells for which there is room at first."""


DOUBLE_WALLS = DoubleWallTuning()


class EllipseTuning(Struct, frozen=True, kw_only=True):
    """How well a place of the map is known."""

    near_m: float = 0.1
    """Points this near belong to a place [m]."""
    sample: int = 200_000
    """Most points of a tile that are looked at."""
    poses: int = 300
    """Most points near a place whose poses are averaged."""


ELLIPSES = EllipseTuning()


class ReferenceFitTuning(Struct, frozen=True, kw_only=True):
    """Whether a reference fits the map at all."""

    compared: int = 60_000
    """Points of the reference that are compared."""
    samples: int = 400_000
    """Points of the map that are compared."""
    covered_m: float = 2.0
    """Surfaces farther from the other are outside of it, and not compared [m]."""
    on_m: float = 0.10
    """A point within this of a surface of the same orientation agrees with it [m]."""
    least_near: float = 0.02
    """Smallest ratio of the map near the reference, which may be one room of a building."""
    least_agreeing: float = 0.6
    """Smallest ratio of agreeing points among those near the other."""
    parallel: float = 0.8
    """Cosine of the angle between normals that are alike."""
    level: float = np.cos(np.deg2rad(30.0))
    """Cosine of the largest tilt of a floor."""
    least_points: int = 100
    """Fewer points do not show whether a reference fits."""
    least_part: float = 0.05
    """Fewer of the points near the other are no group of their own."""


REFERENCE_FIT = ReferenceFitTuning()


class MapFrameTuning(Struct, frozen=True, kw_only=True):
    """Between the map frame and its CRS."""

    step_m: float = 10.0
    """Step of the numerical derivative [m]."""
    rounds: int = 4
    """Rounds of the inverse transformation."""


MAP_FRAMES = MapFrameTuning()


class HeightHintTuning(Struct, frozen=True, kw_only=True):
    """Heights above sea level against those above the ellipsoid."""

    nearly_m: float = 1.0
    """Largest deviation from it, and largest horizontal error: heights alone are of another
    kind."""


HEIGHT_HINTS = HeightHintTuning()


class MeasuredTuning(Struct, frozen=True, kw_only=True):
    """Surveyed points in the map."""

    in_span: float = np.cos(np.deg2rad(10.0))
    """A component counts as measured if a measured direction lies within 10° of its axis."""


MEASURED = MeasuredTuning()


class PickTuning(Struct, frozen=True, kw_only=True):
    """Picking a point of a slice."""

    plane_m: float = 0.10
    """Radius within which a surface is fitted by a plane [m]."""
    least_points: int = 8
    """Fewer points are no surface."""
    sample: int = 50_000
    """These points of each tile show most places that the map has; the others are looked for among
    all, which takes fifteen times as long."""


PICKS = PickTuning()


class SnapTuning(Struct, frozen=True, kw_only=True):
    """Snapping of a pick to a plane, an edge or a corner."""

    around: tuple[float, float] = (0.3, 0.6)
    """Least and largest radius in which planes are looked for [m]: of a corner within less, a plane
    across it would have more points than its walls."""
    times: float = 3.0
    """It is as many times the reach of the pick, within these."""
    most_points: int = 8000
    """More points are thinned out evenly."""
    planes: int = 3
    """Planes that are looked for, the largest first."""
    hypotheses: int = 160
    """Of each plane: with a third of the points on it one of them is right (1 - 5e-3)."""
    near_m: float = 0.02
    """A point this near is on a plane that three points make [m]."""
    fitted_m: tuple[float, float] = (0.004, 0.02)
    """Least and largest distance of a point from its plane after the fit [m]."""
    sigmas: float = 3.0
    """It is as many standard deviations of the points, within these."""
    rounds: int = 4
    """Of the fit."""
    guard_m: float = 0.04
    """What is nearer to another plane does not count in the last fit [m]."""
    least_points: int = 40
    """With fewer there is no plane."""
    least_width_m: float = 0.015
    """Least standard deviation of a plane's points along its narrower side [m]: a line is none."""
    contrast: float = 0.5
    """Of the points within three times `near_m`, as many are within it; of a bush, a third."""
    apart: float = 0.94
    """Planes with a larger cosine between their normals do not meet in an edge (20°)."""
    support_m: float = 0.06
    """Each plane has points this near to where a pick snaps to [m]."""
    support_times: float = 3.0
    """Or this many times as near as its points are to each other, if that is more."""
    support_points: int = 5
    """As many."""
    grazing: float = 0.1
    """Least cosine between ray and normal: seen more flatly, the ray does not say where [-]."""


SNAPS = SnapTuning()


class PlacementTuning(Struct, frozen=True, kw_only=True):
    """Where the coordinates of a reference belong."""

    earth_m: tuple[float, float] = (6.2e6, 6.6e6)
    """Distance of the surface of the Earth from its center [m]."""
    accurate_m: float = 0.05
    """A CRS that is less accurate is named [m]."""
    times: float = 30.0
    """A reference that exceeds the map this many times in length, width and height is in another
    unit: a whole town around one building is as flat as a few of its storeys."""
    small_m: float = 0.1
    """A file smaller than this is no building in meters [m]."""
    beside_m: float = 2.0
    """A reference this far beside the map does not overlap it [m]."""
    kilometers_m: float = 10_000.0
    """From here on that is said in kilometers [m]."""


PLACEMENT = PlacementTuning()


class ResidualTuning(Struct, frozen=True, kw_only=True):
    """Residuals at control points."""

    outlier_sigmas: tuple[float, float, float] = (3.0, 3.4393, 3.7625)
    """Limits of `Residual.sigmas` for one, two and three measured directions: a good residual
    exceeds them with a probability of 0.27 % (square roots of the quantiles of χ²)."""


RESIDUALS = ResidualTuning()


class SignedDistanceTuning(Struct, frozen=True, kw_only=True):
    """Signed distances of a map from a reference."""

    histogram_step_m: float = 0.002
    """Step of the histogram [m]."""
    histogram_end_m: float = 0.10
    """The histogram goes from minus this to plus this; points beyond it are in its end classes."""
    least_points: int = 100
    """Fewer points say nothing."""
    least_facing: float = 0.02
    """Smallest mean of ``(n · axis)²``: with fewer surfaces across an axis its shift is not
    known."""
    in_span: float = np.cos(np.deg2rad(10.0))
    """Cosine of the largest angle between a direction and the span of the normals."""


SIGNED = SignedDistanceTuning()


class BlackWhiteTuning(Struct, frozen=True, kw_only=True):
    """Search for the center of a black-white target near a pick."""

    radius_m: float = 0.09
    """Around the center that is compared with the pattern: boards of 20 cm and more have it all."""
    reach_m: float = 0.1
    """Farthest that the center lies from the pick."""
    beam_m: float = 0.005
    """Half width of the blur at an edge: a beam at 3 m."""
    search_m: float = 0.02
    turns: int = 12
    """Steps of the coarse search, within half a turn."""
    search_points: int = 1500
    """Points that the coarse search looks at."""
    plane_rounds: int = 3
    least_off_m: float = 0.01
    off_sd: float = 3.0
    """Points farther from the plane are of something else."""
    most_rough_m: float = 0.02
    """A board scatters less about its plane."""
    least_points: int = 40
    least_sector: int = 5
    """Points in each sector: a board that is hidden in part has no known center."""
    least_agreement: float = 0.8
    """Simulated boards have 0.84 and more, stripes and posters up to 0.73."""
    contrast_sd: float = 2.0
    """White is brighter than black by this many deviations within a sector."""
    most_sd_m: float = 0.005
    tiny: float = 1e-9


BLACK_WHITE = BlackWhiteTuning()
