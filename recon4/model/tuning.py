"""Tuning of what several stages judge alike."""

from __future__ import annotations

from msgspec import Struct


class ObservationTuning(Struct, frozen=True, kw_only=True):
    """When a multiframe observes a direction of the motion."""

    weak_sd_m: float = 0.05
    """With a larger standard deviation of its LiDAR measurement it hardly observes a direction."""
    observed_sd_m: float = 0.02
    """With a smaller one it observes the direction."""
    weak_s: float = 2.0
    """Shorter stretches of such multiframes are bridged by the motion before them."""
    unobserved_s: float = 10.0
    """A longer time without observation of a direction makes a map unusable."""


OBSERVATION = ObservationTuning()


class LossTuning(Struct, frozen=True, kw_only=True):
    """Data of a recording that is not used."""

    warned_ratio: float = 0.01
    """From this ratio on a loss is a warning; smaller ones stand in `recon4 info` and the
    report."""
    severe_ratio: float = 0.5
    """With a larger one the map must not be used."""


LOSSES = LossTuning()


class RejectedRunTuning(Struct, frozen=True, kw_only=True):
    """Runs of rejected fixes."""

    min_fixes: int = 10
    min_s: float = 1.0
    """Shorter runs count as noise."""
    bridged_s: float = 1.0
    """Two runs with less than this between them are one."""
    agreement: float = 0.25
    """Fixes of a run agree if their residuals change from one to the next by less than this part of
    their size."""


REJECTED_RUNS = RejectedRunTuning()


class SweepTuning(Struct, frozen=True, kw_only=True):
    """Sweeps of the head of a profiler."""

    wide_lines: int = 5
    """Lines over which the direction of the head is judged: its angles have noise."""
    min_part: float = 0.25
    """Shorter sweeps than this part of the median one are joined to their neighbor."""


SWEEPS = SweepTuning()


class GeoidTuning(Struct, frozen=True, kw_only=True):
    """Heights above the sea in place of those above the ellipsoid."""

    least_m: float = 5.0
    most_m: float = 110.0
    """Differences of heights that are taken for a geoid separation, which is -107 to 86 m; below,
    other errors look alike."""


GEOID = GeoidTuning()


class VolumeTuning(Struct, frozen=True, kw_only=True):
    """Volumes that people draw in a map."""

    farthest_m: float = 1e8
    """Largest coordinate [m]."""
    longest_m: float = 1e5
    """Longest edge [m]."""
    most_corners: int = 500
    """Corners of a polygon."""
    most_places: int = 2000
    """Places of a brush."""
    least_m2: float = 1e-9
    """Least area of a polygon [m²]."""
    axes: float = 1e-6
    """Axes are as far from length 1 and a right angle at most."""


VOLUMES = VolumeTuning()


class ClusterVolumeTuning(Struct, frozen=True, kw_only=True):
    """Clusters of cubes that people choose in a map."""

    most: int = 500
    """Clusters of a volume."""
    most_columns: int = 20_000
    """Columns of cubes in all of them: some 300 kB in the journal."""
    most_number: int = 20_000
    """A cube is fewer than this many from the origin of its cluster."""
    least_m: float = 0.01
    most_m: float = 10.0
    """Edge of a cube [m]."""
    most_different: float = 3.0
    """Clusters that are more different from a picked one are not proposed."""


CLUSTERS = ClusterVolumeTuning()


class SurveyCovarianceLimits(Struct, frozen=True, kw_only=True):
    """Covariances that surveys state for their points."""

    least_m: float = 1e-5
    most_m: float = 10.0
    """Standard deviations of a coordinate [m]; beyond, the unit is another one."""
    least_root: float = 1e-6
    """Least eigenvalue of the correlations: below, the covariance cannot be inverted."""


SURVEY_COVARIANCES = SurveyCovarianceLimits()


class EdgeColumnTuning(Struct, frozen=True, kw_only=True):
    """Edges as columns."""

    block: int = 4096
    """Edges that are objects at a time: 7 MB."""


EDGE_COLUMNS = EdgeColumnTuning()
