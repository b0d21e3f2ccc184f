"""Every setting of the pipeline, declared once: code, command line, API and docs read this file.

A stage receives its own group only, so a changed setting reruns only what depends on it.
"""

from __future__ import annotations

import json
import re
from dataclasses import asdict, dataclass, field, fields, is_dataclass, replace
from typing import Any, Literal, get_args, get_type_hints

from recon4.errors import ConfigError, WrongSettings


def _require(holds: bool, rule: str, value: object) -> None:
    if not holds:
        raise ConfigError(f"{rule}, got {value}")


@dataclass(frozen=True, slots=True, kw_only=True)
class IngestSettings:
    """Reading a recording into multiframes."""

    rate_hz: float = 0.0
    """Multiframes per second. 0 = one a revolution of the slowest LiDAR, as measured."""
    reorder_window_s: float = 0.2
    """Packets out of order by at most this are put back in order [s]."""
    min_range_m: float = 0.7
    """Nearer returns are the carrier and are dropped [m]."""
    max_range_m: float = 120.0
    """Farther returns are dropped [m]."""
    gap_s: float = 0.2
    """A jump of the clock larger than this is reported as a gap [s]."""

    def __post_init__(self) -> None:
        _require(0.0 <= self.rate_hz <= 100.0, "rate_hz must be 0 to 100", self.rate_hz)
        _require(
            0.0 <= self.min_range_m < self.max_range_m,
            "min_range_m must be below max_range_m",
            self.min_range_m,
        )


@dataclass(frozen=True, slots=True, kw_only=True)
class SegmentSettings:
    """Collar line segments (V §2.4, requirements A3.1)."""

    azimuth_bins: int = 36
    """Cells around the spin axis."""
    generated: int = 20
    """Random segments drawn in a cell between two neighboring rings."""
    preserved: int = 5
    """Shortest of them that are kept."""
    max_length_per_range: float = 0.34
    """A segment longer than this times its nearer end's range bridges a depth edge and is dropped
    (a third: 2° between beams, at least 6° of incidence)."""
    seed: int = 4
    """Seed of the random draws; combined with the frame id."""

    def __post_init__(self) -> None:
        _require(
            4 <= self.azimuth_bins <= 3600, "azimuth_bins must be 4 to 3600", self.azimuth_bins
        )
        _require(
            1 <= self.preserved <= self.generated,
            "preserved must be 1 to generated",
            self.preserved,
        )


@dataclass(frozen=True, slots=True, kw_only=True)
class OverlapSettings:
    """Overlap by a spherical z-buffer (V §2.5, requirements A4)."""

    azimuth_bins: int = 180
    elevation_bins: int = 90
    min_points: int = 5
    """A bin with fewer points is empty."""
    relative_tolerance: float = 0.1
    """t_r of V Eq. 2.6, read as ``p_r < r_min * (1 + t_r) + t_a`` (A0 no. 2)."""
    absolute_tolerance_m: float = 0.3
    """t_a of V Eq. 2.6 [m]."""
    threshold: float = 0.5
    """t_o: pairs that overlap less are rejected."""
    mode: Literal["target", "source", "min", "harmonic"] = "target"
    """Whose points are tested in whose buffer; ``target`` is the text."""


@dataclass(frozen=True, slots=True, kw_only=True)
class RegistrationSettings:
    """Registration of two sets of collar line segments (V §2.4, requirements A3)."""

    solver: Literal["planes", "common_normal", "svd"] = "planes"
    """``svd`` is the documents' closed form on closest points of lines, ``common_normal`` moves
    along the common normals of lines, ``planes`` holds segments against a map of small planes."""
    max_iterations: int = 20
    """Upper bound on match-and-solve rounds (thesis: 500)."""
    max_move_m: float = 2.5
    """A solution farther from its guess counts as not converged [m, rotation as at 5 m]."""
    converged_step_m: float = 5e-4
    """Stop once a round moves a point at 5 m by less than this [m] (``common_normal``)."""
    max_distance_m: float = 1.0
    """Midpoints farther apart never match [m] (``common_normal``)."""
    kernel_m: float = 0.05
    """Scale of the Cauchy kernel on the line distance [m] (``common_normal``)."""
    portion: float = 0.5
    """Share of nearest matches that odometry keeps at least, however small the overlap seems
    (``svd``, ``common_normal``)."""
    error_window: int = 20
    """Rounds over which the error must not change (``svd``)."""
    error_deviation: float = 1e-4
    """Standard deviation of the error in that window below which it has converged (``svd``)."""
    target_error_m: float = 0.01
    """An error below this has converged [m] (``svd``)."""

    def __post_init__(self) -> None:
        _require(
            self.solver in {"planes", "common_normal", "svd"},
            "solver must be planes, common_normal or svd (single scans are registered only inside "
            "odometry without an IMU, by solver planes and the group scans)",
            self.solver,
        )
        _require(self.max_iterations >= 1, "max_iterations must be 1 or more", self.max_iterations)


@dataclass(frozen=True, slots=True, kw_only=True)
class PlaneSettings:
    """The map of small planes that solver ``planes`` registers segments to."""

    finest_m: float = 0.2
    """Edge of the smallest cubes [m]."""
    levels: int = 4
    """Sizes of cubes, each twice the one before."""
    min_points: int = 8
    """A cube with fewer points has no plane."""
    max_sd_m: float = 0.03
    """Points of one plane scatter by at most this across it [m]."""
    point_sd_m: float = 0.02
    """Standard deviation of one measured point [m]."""
    kernel_m: float = 0.02
    """Scale of the Cauchy kernel on the distance from the plane [m]."""


@dataclass(frozen=True, slots=True, kw_only=True)
class ScanSettings:
    """Registration of two single scans: the first guess and the recovery without an IMU."""

    voxel_m: float = 0.25
    """Scans are thinned to one point in a cube of this edge [m]."""
    neighbors: int = 12
    """Points whose plane gives a point its normal, itself included."""
    source_points: int = 20_000
    """Of the source no more points than this are used."""
    gate_m: float = 0.7
    """Points farther apart never match [m]; three times as far in the first two rounds."""
    kernel_m: float = 0.3
    """Scale of the Cauchy kernel on the symmetric distance [m]."""
    rounds: int = 30
    """Upper bound on match-and-solve rounds."""
    inlier_m: float = 0.1
    """A point this near to its plane lies on it [m]."""
    min_share: float = 0.3
    """With a smaller share of points in place the registration has not converged."""
    sure_share: float = 0.45
    """With a smaller share other starts are tried."""
    starts: int = 10
    """Overlays of the ground plans that are tried."""


@dataclass(frozen=True, slots=True, kw_only=True)
class OdometrySettings:
    """Pose of each multiframe from the ones before (V §2.4, requirements A3, A5)."""

    history: int = 10
    """Keyframes in the local map; multiframes that line odometry looks back on."""
    history_mode: Literal["joined", "averaged"] = "joined"
    """Line odometry: ``joined`` registers to the lines of the history together, ``averaged`` to
    each of them, the mean of the poses being taken (V Table 3.1, multi-frame; as many times the
    work)."""
    keyframe_m: float = 0.3
    """A multiframe joins the local map once the body moved so far [m] …"""
    keyframe_rad: float = 0.26
    """… or turned so far [rad] since the last that did."""
    rounds: int = 8
    """Upper bound on match-and-solve rounds."""
    information_scale: float = 0.02
    """Share of the matches counted as independent: neighbors see the same plane's error."""
    use_imu: bool = True
    """Predict and undistort with the IMU when the recording has one."""
    use_gnss: bool = True
    """Let GNSS/INS with heading hold odometry where the LiDAR cannot."""
    gnss_sd_m: float = 0.1
    """Smallest standard deviation given to a fix [m]: its errors are alike for seconds."""
    heading_sd_rad: float = 0.01
    """Standard deviation given to a heading of the INS [rad]."""
    normal_noise_rad: float = 0.03
    """Error of a plane's normal [rad]: directions that are held no better than by such errors
    count as free."""
    gyro_noise: float = 3e-4
    """Noise density of the gyroscope [rad/s/sqrt(Hz)]."""
    accel_noise: float = 1e-2
    """Noise density of the accelerometer [m/s²/sqrt(Hz)]."""
    gyro_bias_walk: float = 1e-4
    """Random walk of the gyroscope's bias [rad/s/sqrt(s)]."""
    accel_bias_walk: float = 1e-3
    """Random walk of the accelerometer's bias [m/s²/sqrt(s)]."""
    free_turn_walk: float = 3.0
    """Without an IMU: random walk of the turn rate [rad/s/sqrt(s)]."""
    free_accel: float = 2.0
    """Without an IMU: random walk of the velocity [m/s/sqrt(s)]."""
    line_sd_m: float = 0.01
    """Standard deviation of the motion over a multiframe by line odometry [m] …"""
    line_sd_rad: float = 0.002
    """… and of its rotation [rad]."""
    restart_after: int = 10
    """With an IMU: after so many lost multiframes a new local map is begun."""
    lost_error_m: float = 0.1
    """A larger error means lost [m]."""
    lost_share: float = 0.3
    """A smaller share of matched segments means lost."""


@dataclass(frozen=True, slots=True, kw_only=True)
class GraphSettings:
    """Progressive pose graph (V §2.7, Algorithm 2.1, requirements A6)."""

    mode: Literal["10", "overlap", "verification", "beyond"] = "beyond"
    """What V Table 3.2 compares, and our own."""
    node_stride: int = 5
    """A node every so many multiframes."""
    closed_trajectory: bool = False
    """The walk ends where it began: pairs may wrap around (A0 no. 5)."""
    exhaustive: bool = False
    """Test all pairs as the thesis does: quadratic in the walk."""
    neighbors: int = 4
    """Pairs with the nodes before, at growing distance."""
    revisits: int = 6
    """At most so many pairs of a node with earlier visits of the same place."""
    revisit_radius_m: float = 4.0
    """Nodes farther apart are not revisits of one place [m] …"""
    drift_share: float = 0.005
    """… plus this share of the distance walked in between, for the drift not yet closed."""
    retry_rounds: int = 2
    """So many times pairs turned down are tried again from better poses; 0 = never."""
    retry_move_m: float = 0.2
    """A pair is tried again if its expected pose moved by more than this since [m, rotation as at
    5 m]."""
    source_reach: int = 2
    """Multiframes before and after a node that it brings to a pair."""
    source_segments: int = 6000
    """Segments of them that are used."""
    target_reach: int = 5
    """Multiframes before and after the other node that make the target."""
    workers: int = 2
    """Threads that register pairs; the result does not depend on it."""
    min_share: float = 0.4
    """A pair of which a smaller share of segments finds a match is rejected."""
    min_degeneracy: float = 0.005
    """A pair held less than this along one direction is rejected (0 = free, 1/3 = held alike)."""
    error_relative: float = 0.01
    """t_r of the acceptance limit ``median_range * t_r + t_a`` (A0 no. 12)."""
    error_absolute_m: float = 0.05
    """t_a of that limit [m]."""
    odometry_sd_m: float = 0.001
    """Smallest standard deviation of an odometry edge [m]."""
    odometry_sd_rad: float = 0.0002
    """The same for its rotation [rad]."""
    loop_sd_m: float = 0.008
    """Smallest standard deviation of a registered edge [m]."""
    loop_sd_rad: float = 0.001
    """The same for its rotation [rad]."""

    def __post_init__(self) -> None:
        for name in ("node_stride", "workers", "source_segments"):
            value = getattr(self, name)
            _require(value >= 1, f"{name} must be 1 or more", value)
        for name in ("neighbors", "revisits", "retry_rounds", "source_reach", "target_reach"):
            value = getattr(self, name)
            _require(value >= 0, f"{name} must be 0 or more", value)
        _require(self.retry_move_m > 0.0, "retry_move_m must be above 0", self.retry_move_m)


@dataclass(frozen=True, slots=True, kw_only=True)
class VerificationSettings:
    """Verification by alternative paths (V §2.8, requirements A7)."""

    variant: Literal["paths", "cycle"] = "paths"
    """``paths`` is the text; ``cycle`` takes triangles only and counts the edge itself as a path
    without error, as the author's code does."""
    max_path_edges: int = 3
    """Longest alternative path, 2 or 3 edges."""
    limit_m: float = 0.1
    """An edge whose median disagreement is above this is rejected [m] (A0 no. 1)."""
    robust: Literal["gnc", "cauchy", "none"] = "gnc"
    """The final solve after verification: ``gnc`` and ``cauchy`` also reject edges that do not fit
    the whole graph, ``none`` is the text."""
    inlier_probability: float = 0.999
    """Share of correct edges that the robust solve keeps if their information is true."""

    def __post_init__(self) -> None:
        _require(
            2 <= self.max_path_edges <= 3, "max_path_edges must be 2 or 3", self.max_path_edges
        )
        _require(self.limit_m > 0.0, "limit_m must be above 0", self.limit_m)
        _require(
            0.5 <= self.inlier_probability < 1.0,
            "inlier_probability must be 0.5 to below 1",
            self.inlier_probability,
        )


@dataclass(frozen=True, slots=True, kw_only=True)
class RefineSettings:
    """Semi-rigid refinement of every multiframe (requirements A12 L-4; mode ``beyond`` only)."""

    rounds: int = 3
    """At most so many rounds of building the map and moving all multiframes onto it."""
    map_stride: int = 2
    """Every so many multiframes are built into the map; all of them are moved."""
    gate_m: float = 0.1
    """Segments farther from their plane do not match [m]."""
    min_gap_s: float = 6.0
    """A multiframe is matched with points at least so much earlier or later only [s]
    (requirements A12 L-4); 0, or a recording shorter than three gaps: with all, its own as well."""
    step_sd_m: float = 0.001
    """How much the correction may change from one multiframe to the next [m] …"""
    step_sd_rad: float = 2e-4
    """… and its rotation [rad]: how well odometry knows the motion in between."""
    total_sd_m: float = 0.02
    """How much a multiframe may move in all [m]: how well the pose graph knows it."""
    total_sd_rad: float = 0.005
    """The same for its rotation [rad]."""
    converged_step_m: float = 4e-3
    """Stop once no multiframe moves farther than this [m]."""

    def __post_init__(self) -> None:
        _require(self.min_gap_s >= 0.0, "min_gap_s must be 0 or more", self.min_gap_s)


@dataclass(frozen=True, slots=True, kw_only=True)
class LevelSettings:
    """Horizontal alignment (V §2.9, requirements A8)."""

    source: Literal["auto", "imu", "floor", "none"] = "auto"
    """``auto``: the IMU if there is one, else the dominant floor."""


@dataclass(frozen=True, slots=True, kw_only=True)
class GnssSettings:
    """Georeferencing by GNSS/INS (requirements A10)."""

    enabled: bool = True
    """Use the positions when the recording has them."""
    crs: str = ""
    """EPSG code of the map's horizontal (and vertical) CRS, as ``EPSG:5514+8357``.
    Empty = UTM zone of the place with ellipsoidal heights."""
    min_quality: Literal["single", "differential", "float", "fixed"] = "single"
    """Fixes of lower quality are not used."""
    correlation_s: float = 5.0
    """Errors of fixes nearer in time than this are alike; so many count as one [s]. Larger leaves
    more of the shape of the map to SLAM."""
    min_sd_m: float = 0.01
    """No fix is better than this, whatever it promises [m]."""
    gate_m: float = 1.0
    """A fix farther than this plus ``gate_relative`` from the track laid rigidly over all fixes is
    an outlier [m]."""
    gate_relative: float = 0.02
    """Drift of SLAM that may hide in that distance, per metre of track."""
    tilt_sd_rad: float = 0.005
    """How well the levelled map is horizontal [rad]."""
    judge_edges: bool = True
    """Turn down edges of the graph that contradict the positions."""
    min_extent_m: float = 3.0
    """Fixes must span at least this for a heading [m]."""
    seed: int = 4
    """Seed of the draws that find the first alignment."""

    def __post_init__(self) -> None:
        _require(self.correlation_s >= 0.0, "correlation_s must be 0 or more", self.correlation_s)
        _require(self.min_sd_m > 0.0, "min_sd_m must be above 0", self.min_sd_m)
        _require(self.tilt_sd_rad > 0.0, "tilt_sd_rad must be above 0", self.tilt_sd_rad)


@dataclass(frozen=True, slots=True, kw_only=True)
class IntensitySettings:
    """Intensity normalization (V §2.10, Eq. 2.17, requirements A9)."""

    method: Literal["surfaces", "bins"] = "surfaces"
    """``surfaces`` compares points of the same place, so that near floors and far walls are not
    taken for an effect of range; ``bins`` is the text: the plain mean of each bin."""
    surface_cell_m: float = 0.25
    """Points in a cube of this edge lie on one surface [m] (``surfaces``)."""
    surface_points: int = 500_000
    """About so many of the sampled points are compared (``surfaces``)."""
    range_bin_m: float = 0.2
    """Width of a bin of range [m]."""
    incidence_bin_deg: float = 1.0
    """Width of a bin of incidence angle [deg]."""
    max_range_m: float = 60.0
    """Farther points share the last bin of range [m]."""
    min_count: int = 200
    """Bins with fewer points fall back to a coarser bin, or to the product of the factors of beam,
    incidence and range (``surfaces``)."""
    min_contrast: float = 0.5
    """With ``bins``: a bin's deviation counts as at least this share of what its mean lets
    expect, so that a bin of one material is not stretched to the contrast of all; 0 = Eq. 2.17 as
    it stands."""
    normal_cell_m: float = 0.15
    """Normals come from neighborhoods of three of these cells [m]."""
    windows: int = 40
    """At most so many stretches of the walk, ten multiframes each, are sampled."""
    upper: Literal["raw", "twice_mean"] = "raw"
    """Normalized values are clamped to 0 and the largest raw value, or twice the target mean as in
    the author's code, which clips reflectors."""

    def __post_init__(self) -> None:
        _require(self.range_bin_m > 0.0, "range_bin_m must be above 0", self.range_bin_m)
        _require(
            0.1 <= self.incidence_bin_deg <= 90.0,
            "incidence_bin_deg must be 0.1 to 90",
            self.incidence_bin_deg,
        )
        _require(
            self.max_range_m >= self.range_bin_m,
            "max_range_m must be at least range_bin_m",
            self.max_range_m,
        )
        _require(self.min_count >= 2, "min_count must be at least 2", self.min_count)
        _require(0.0 <= self.min_contrast <= 1.0, "min_contrast must be 0 to 1", self.min_contrast)
        _require(self.normal_cell_m > 0.0, "normal_cell_m must be above 0", self.normal_cell_m)
        _require(self.windows >= 1, "windows must be at least 1", self.windows)
        _require(self.surface_cell_m > 0.0, "surface_cell_m must be above 0", self.surface_cell_m)
        _require(self.surface_points >= 1, "surface_points must be at least 1", self.surface_points)


@dataclass(frozen=True, slots=True, kw_only=True)
class MapSettings:
    """The point map and what is written of it."""

    voxel_m: float = 0.01
    """Keep at most one point in a cube of this size, that with the shortest range [m]; 0 = all."""
    max_range_m: float = 60.0
    """Points farther from the sensor are left out of the map [m]."""
    tile_m: float = 5.0
    """Edge length of the tiles in which the map is made and stored [m]."""
    normal_cell_m: float = 0.05
    """Normals come from neighborhoods of three of these cells [m]."""
    min_neighborhood: int = 2
    """Points with fewer points in that neighborhood, themselves included, are noise; 1 = keep."""
    far_ratio: float = 0.0
    """Points measured from more than so many times the shortest range in their cubic meter are
    left out (requirements A13 O-9: 2); 0 = keep."""

    def __post_init__(self) -> None:
        _require(0.0 <= self.voxel_m <= 1.0, "voxel_m must be 0 to 1", self.voxel_m)
        _require(0.0 < self.max_range_m <= 130.0, "max_range_m must be 0 to 130", self.max_range_m)
        _require(self.normal_cell_m >= 0.01, "normal_cell_m must be over 0.01", self.normal_cell_m)
        _require(
            1.0 <= self.tile_m <= 100.0
            and self.tile_m >= 4 * max(self.normal_cell_m, self.voxel_m),
            "tile_m must be 1 to 100 and at least four cells or voxels",
            self.tile_m,
        )
        _require(
            self.min_neighborhood >= 1, "min_neighborhood must be 1 or more", self.min_neighborhood
        )
        _require(
            self.far_ratio == 0.0 or self.far_ratio > 1.0,
            "far_ratio must be 0 or above 1",
            self.far_ratio,
        )


@dataclass(frozen=True, slots=True, kw_only=True)
class Settings:
    """All of them. A preset is one of these; ``--set group.field=value`` changes one field."""

    ingest: IngestSettings = field(default_factory=IngestSettings)
    segments: SegmentSettings = field(default_factory=SegmentSettings)
    overlap: OverlapSettings = field(default_factory=OverlapSettings)
    registration: RegistrationSettings = field(default_factory=RegistrationSettings)
    planes: PlaneSettings = field(default_factory=PlaneSettings)
    scans: ScanSettings = field(default_factory=ScanSettings)
    odometry: OdometrySettings = field(default_factory=OdometrySettings)
    graph: GraphSettings = field(default_factory=GraphSettings)
    verification: VerificationSettings = field(default_factory=VerificationSettings)
    refine: RefineSettings = field(default_factory=RefineSettings)
    level: LevelSettings = field(default_factory=LevelSettings)
    gnss: GnssSettings = field(default_factory=GnssSettings)
    intensity: IntensitySettings = field(default_factory=IntensitySettings)
    map: MapSettings = field(default_factory=MapSettings)


PRESETS: dict[str, Settings] = {
    "indoor": Settings(),
    "staircase": Settings(),
    "outdoor": Settings(
        map=MapSettings(voxel_m=0.03, max_range_m=100.0, tile_m=20.0, normal_cell_m=0.15)
    ),
    "thesis": Settings(
        registration=RegistrationSettings(solver="svd", max_iterations=500),
        odometry=OdometrySettings(
            use_imu=False, use_gnss=False, history=1, history_mode="averaged", line_sd_rad=0.02
        ),
        graph=GraphSettings(
            mode="verification",
            exhaustive=True,
            retry_rounds=0,
            source_reach=0,
            target_reach=0,
            min_share=0.0,
            min_degeneracy=0.0,
            loop_sd_m=0.1,
            loop_sd_rad=0.01,
        ),
        verification=VerificationSettings(robust="none"),
        gnss=GnssSettings(judge_edges=False),
        intensity=IntensitySettings(method="bins", min_contrast=0.0),
    ),
}


def preset(name: str) -> Settings:
    """The settings of a preset.

    Raises:
        ConfigError: If there is no such preset.
    """
    if name not in PRESETS:
        raise ConfigError(f"no preset named {name!r}; there are: {', '.join(sorted(PRESETS))}")
    return PRESETS[name]


def override(settings: Settings, assignments: list[str]) -> Settings:
    """Apply ``group.field=value`` texts; of two for one field the later counts.

    Raises:
        WrongSettings: Naming every wrong one, what was expected and what was given.
    """
    problems: dict[str, str] = {}
    values: dict[str, dict[str, Any]] = {}
    for text in assignments:
        path, _, value = (part.strip() for part in text.partition("="))
        try:
            group, name, kind = _find(settings, text)
            values.setdefault(group, {})[name] = _parse(value, kind, path)
        except ConfigError as error:
            problems[path] = str(error)
    changed = {
        group: _replaced(getattr(settings, group), group, fresh, problems)
        for group, fresh in values.items()
    }
    if problems:
        raise WrongSettings(problems)
    return replace(settings, **changed)


def _find(settings: Settings, text: str) -> tuple[str, str, Any]:
    """Group, name and type of the setting a text assigns."""
    path, sign, _ = text.partition("=")
    group_name, dot, name = path.strip().partition(".")
    if not sign or not dot:
        raise ConfigError(f"expected group.field=value, got {text!r}")
    if group_name not in _names(settings):
        raise ConfigError(f"no setting group {group_name!r}; known: {_names(settings)}")
    group = getattr(settings, group_name)
    if name not in _names(group):
        raise ConfigError(f"no setting {path!r}; known in {group_name}: {_names(group)}")
    return group_name, name, get_type_hints(type(group))[name]


def _replaced(group: Any, name: str, values: dict[str, Any], problems: dict[str, str]) -> Any:
    """The group with other values; those it refuses are left out and told."""
    left = dict(values)
    while left:
        try:
            return replace(group, **left)
        except ConfigError as error:
            # A rule may speak of two fields: blame those given, the first named first.
            words = str(error)
            blamed = [field for field in re.findall(r"\w+", words) if field in left]
            wrong = blamed[0] if blamed else next(iter(left))
            problems[f"{name}.{wrong}"] = words
            del left[wrong]
    return group


def to_json(settings: object) -> dict[str, Any]:
    """Plain JSON values of a group or of all settings."""
    assert is_dataclass(settings) and not isinstance(settings, type)
    return asdict(settings)


def canonical(settings: object) -> str:
    """One text for equal settings: what a stage's key is hashed from."""
    return json.dumps(to_json(settings), sort_keys=True, separators=(",", ":"))


def _parse(text: str, kind: Any, path: str) -> Any:
    choices = get_args(kind)
    if choices:
        if text not in choices:
            raise ConfigError(f"{path} must be one of {', '.join(choices)}, got {text!r}")
        return text
    if kind is bool:
        if text.lower() not in {"true", "false"}:
            raise ConfigError(f"{path} must be true or false, got {text!r}")
        return text.lower() == "true"
    try:
        return kind(text)
    except ValueError as error:
        raise ConfigError(f"{path} must be {kind.__name__}, got {text!r}") from error


def _names(group: object) -> list[str]:
    assert is_dataclass(group)
    return [f.name for f in fields(group)]
