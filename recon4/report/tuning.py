"""Layout of the report: how much is drawn and listed."""

from __future__ import annotations

from msgspec import Struct


class BeamChartTuning(Struct, frozen=True, kw_only=True):
    """Charts of single beams."""

    apart: float = 0.6
    """Width over which the LiDARs of one ring are spread."""
    width_sd: float = 2.0
    """Standard deviations that the bars extend to each side."""


BEAM_CHARTS = BeamChartTuning()


class CalibrationPageTuning(Struct, frozen=True, kw_only=True):
    """The page of a calibration."""

    thickness_m: float = 0.2
    """Of the slice [m]."""
    height_in: float = 4.6
    """Height of a slice [in]."""


CALIBRATION_PAGE = CalibrationPageTuning()


class EdgeChartTuning(Struct, frozen=True, kw_only=True):
    """Verdicts of pairs."""

    max_drawn: int = 4000
    """Edges that are drawn."""


EDGE_CHARTS = EdgeChartTuning()


class ChartTuning(Struct, frozen=True, kw_only=True):
    """Charts as inline SVG."""

    many_bars: int = 40
    """More bars of a color are drawn finer."""


CHARTS = ChartTuning()


class FindingListTuning(Struct, frozen=True, kw_only=True):
    """Findings in reports."""

    most_of_a_kind: int = 12
    """Findings of one kind that are listed."""


FINDING_LISTS = FindingListTuning()


class IntensityChartTuning(Struct, frozen=True, kw_only=True):
    """Charts of intensity."""

    min_points: int = 100
    """Bins with fewer points are not drawn."""


INTENSITY_CHARTS = IntensityChartTuning()


class MapImageTuning(Struct, frozen=True, kw_only=True):
    """Images of the map."""

    points: int = 8_000_000
    """Points that are drawn at most, an even sample of a larger map."""
    outline_points: int = 500_000
    """Of them, those that say how large the image is: 500 of them are what `trim` cuts off."""
    max_pixels: int = 1300
    """Pixels along the longer side."""
    levels: int = 48
    """Shades of an image: fewer compress better, more are not visible."""
    bin_m: float = 0.25
    """Step of the histogram of heights [m]."""
    trim: float = 0.001
    """Fraction of points cut off at either end of the image: reflections far away."""


MAP_IMAGES = MapImageTuning()


class PlanTuning(Struct, frozen=True, kw_only=True):
    """Plan of the map."""

    longest: float = 1000.0
    """Units of the longer side: a tall image is scaled down, and its text must stay readable."""
    ticks: int = 6
    """Coordinates along an axis."""


PLANS = PlanTuning()


class ProjectFactLimits(Struct, frozen=True, kw_only=True):
    """Summaries that are read."""

    max_bytes: int = 16 << 20
    """Largest summary."""


PROJECT_FACTS = ProjectFactLimits()


class RigChartTuning(Struct, frozen=True, kw_only=True):
    """Charts of the rig."""

    width_sd: float = 2.0
    """Standard deviations that the bars extend to each side."""


RIG_CHARTS = RigChartTuning()


class StretchChartTuning(Struct, frozen=True, kw_only=True):
    """Stretches of findings on the time axis."""

    least: float = 0.004
    """Of the axis: a moment is drawn as wide."""


STRETCH_CHART = StretchChartTuning()


class ClientReportTuning(Struct, frozen=True, kw_only=True):
    """The report for the client: short enough to be read."""

    cut_m: tuple[float, float] = (0.2, 0.6)
    """Depths of the plan below the scanner [m]: above tables, below lintels."""
    around_m: float = 4.0
    """Half the width of the drawing of a place, at least [m]."""
    most_findings: int = 24
    """Findings that are listed."""
    most_drawings: int = 10
    """Findings with a drawing."""
    most_loops: int = 10
    """Weakest loop closures that are named."""
    most_settings: int = 40
    most_files: int = 200
    most_points: int = 200
    """Control and check points."""
    most_notes: int = 100
    """Notes, and measurements."""
    most_characters: int = 600
    """Of a text that people gave."""


CLIENT_REPORT = ClientReportTuning()
