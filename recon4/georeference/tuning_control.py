"""Tuning of control points."""

from __future__ import annotations

from msgspec import Struct


class ControlFitTuning(Struct, frozen=True, kw_only=True):
    """Rigid fit of a map to control points, and the test of single points."""

    least_points: int = 3
    """Fewer control points place no map."""
    apart_m: float = 0.02
    """Two targets that are closer are one [m]."""
    other_unit: float = 10.0
    """All distances of a survey are this many times as long or short as in the map: another unit;
    feet are 3.3 times."""
    iterations: int = 20
    """Steps of Gauss and Newton."""
    in_span: float = 0.985
    """An axis within 10° of the measured directions is measured (cosine)."""
    tilt_sd_rad: float = 0.001
    """A leveled map is tilted only by points that determine the tilt better; leveling by an IMU is
    within 1 mrad to 5 mrad (`GnssTuning.tilt_sd_rad`)."""
    most_tilt_rad: float = 0.05
    """A leveled map that points tilt more is not tilted: something is wrong with them."""
    turn_sd_rad: float = 0.02
    """Points that determine a turn worse lie in one place or on one line."""
    significance: float = 0.001
    """Of the test of a point (Baarda 1968: 0.1 %)."""
    noncentrality: float = 4.13
    """Of a normal variable at this significance and a power of 80 % (Baarda 1968)."""
    controlled: float = 0.1
    """A coordinate with a smaller redundancy number is controlled by no other point."""
    few_points: int = 6
    """With at most this many points a turn of the map may hide an exchange of two names."""
    most_pairs: int = 60
    """Exchanges that are tried: each takes a fit."""


CONTROL_FIT = ControlFitTuning()


class BlunderTuning(Struct, frozen=True, kw_only=True):
    """Blunders of a whole survey."""

    better: float = 0.1
    """A swap is named if the squared misfit falls below this part of it …"""
    least_m: float = 0.10
    """… and if it was at least this large before [m], root mean square of a coordinate …"""
    most_m: float = 0.30
    """… and is at most this large afterwards, or 5 % of the extent of a smaller site [m]."""
    pairs: int = 40
    """With more control points only pairs of the worst ones are swapped."""
    contradicting: float = 4.0
    """Residuals that are this many times as large as stated contradict each other."""
    other: float = 2.0
    """Another explanation is as good if its misfit is below this multiple."""
    check_m: float = 0.10
    check_ratio: float = 7.0
    """A check point is named beyond this length [m] and this multiple of their median residual."""
    offset_sd: float = 4.0
    offset_m: float = 0.03
    """A common offset of the check points is named beyond this many deviations of it and this
    length [m]."""


BLUNDERS = BlunderTuning()


class SightingTuning(Struct, frozen=True, kw_only=True):
    """Which nodes saw a target."""

    range_m: float = 25.0
    """Nodes farther away are not asked [m]."""
    around_m: float = 0.25
    """A node with points this close to the target saw it [m] …"""
    points: int = 3
    """… if there are this many."""
    visit_s: float = 10.0
    """Nodes that are farther apart in time belong to two visits [s]."""
    per_visit: int = 5
    """Nodes used of each visit: those with the most points."""


SIGHTINGS = SightingTuning()


class AdjustmentTuning(Struct, frozen=True, kw_only=True):
    """Adjustment of the trajectory to control points."""

    weak: float = 1e-6
    """Information of a direction that was not measured, relative to the others: gtsam requires a
    positive definite matrix."""
    datum_sd: float = 4.0
    datum_m: float = 0.05
    """GNSS and control points differ beyond this many deviations and this length [m]."""


ADJUSTMENT = AdjustmentTuning()


class SiteGridTuning(Struct, frozen=True, kw_only=True):
    """Where a map has its origin in the grid of a site."""

    small_m: float = 5000.0
    """Coordinates below this need no origin of their own [m]."""
    step_m: float = 100.0
    """Other origins are multiples of this [m]."""


SITE_GRIDS = SiteGridTuning()


class SurveySystemTuning(Struct, frozen=True, kw_only=True):
    """Whether a survey is in the system that is said (`survey_system.py`)."""

    far_m: float = 20_000.0
    """Farther from the map by GNSS it is in another system; datums differ by less than 2 km [m]."""
    zone_m: float = 1e6
    """Some lists have the number of the zone before the easting, in millions of meters."""
    zones: tuple[int, ...] = (-1, 1, -2, 2)
    """Codes beside the one that is said are those of the zones beside it."""


SURVEY_SYSTEMS = SurveySystemTuning()
