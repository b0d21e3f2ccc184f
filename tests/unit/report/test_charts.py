"""Rasters, plans and charts of the report."""

from io import BytesIO
from typing import Literal
from xml.etree import ElementTree

import numpy as np
import pytest
from matplotlib.image import imread

from recon4.geometry.se3 import SE3
from recon4.model.calibration_figures import (
    CalibrationFigures,
    ParameterFigures,
    ParameterStatus,
)
from recon4.model.finding import Finding, Level
from recon4.model.finding_kinds import FindingKind
from recon4.model.pose_graph import Edge, EdgeKind, PoseGraph, Verdict, known_history
from recon4.model.trajectory import Trajectory
from recon4.report.beams import beam_charts
from recon4.report.charts import walk_charts
from recon4.report.edges import edge_paths
from recon4.report.figures import Chart, add_bars, histogram, lines, thinned
from recon4.report.maps import ABOVE, SIDE, MapChunk, ink_png, intensity_png, rasterize
from recon4.report.plan import PlanOverlay, PlanPath, frame_around, nice_step, plan_svg
from recon4.report.rig import rig_charts
from recon4.report.stretches import marked_times

NAMED = {"labels": ("x", "y")}


def chunk(points: list[list[float]], intensity: float = 10.0) -> MapChunk:
    xyz = np.array(points, dtype=np.float64)
    return MapChunk(xyz, np.full(len(xyz), intensity), np.full(len(xyz), 2 * intensity))


def test_every_point_of_a_small_map_lies_in_its_pixel() -> None:
    points = [[0.0, 0.0, 0.0], [10.0, 0.0, 1.0], [10.0, 5.0, 2.0], [10.0, 5.0, 4.0]]

    above = rasterize(lambda _: [chunk(points[:2]), chunk(points[2:])])[0]

    f = above.frame
    assert above.count.sum() == 4
    grid = above.count.reshape(f.height, f.width)
    row, column = np.argwhere(grid == 2)[0]
    assert f.left_m + (column + 0.5) * f.pixel_m == pytest.approx(10.0, abs=f.pixel_m)
    assert f.bottom_m + (f.height - row - 0.5) * f.pixel_m == pytest.approx(5.0, abs=f.pixel_m)
    mean_m = above.mean(above.z_sum)[above.seen == row * f.width + column]
    assert mean_m == pytest.approx([3.0])


def test_a_reflection_far_away_does_not_shrink_the_map() -> None:
    points = np.random.default_rng(0).uniform(0, 10, (5001, 3)).tolist()
    points[0] = [5000.0, 0.0, 0.0]

    above = rasterize(lambda _: [chunk(points)])[0]

    assert above.frame.width * above.frame.pixel_m < 12.0


def test_both_side_views_have_the_scale_of_the_plan() -> None:
    points = np.random.default_rng(0).uniform([0, 0, 0], [40, 10, 3], (5000, 3)).tolist()

    rasters = rasterize(lambda _: [chunk(points)])

    assert len({raster.frame.pixel_m for raster in rasters}) == 1
    side = next(raster for raster in rasters if raster.view is SIDE)
    assert side.frame.width * side.frame.pixel_m == pytest.approx(10.0, abs=1.5)


def test_the_outline_of_an_image_is_that_of_a_sample() -> None:
    asked: list[int] = []

    def sample(points: int) -> list[MapChunk]:
        asked.append(points)
        return [chunk([[0.0, 0.0, 0.0], [10.0, 5.0, 0.0]])]

    rasterize(sample)

    assert len(asked) == 2
    assert asked[0] * 10 < asked[1]


def test_no_points_make_no_images() -> None:
    assert rasterize(lambda _: []) == []


def test_more_points_are_darker_ink_and_none_are_clear() -> None:
    points = [[0.0, 0.0, 0.0]] + [[3.0, 3.0, 0.0]] * 50

    raster = rasterize(lambda _: [chunk(points)])[0]
    alpha = imread(BytesIO(ink_png(raster)))[..., 3]

    grid = raster.count.reshape(alpha.shape)
    assert 0.0 < alpha[grid == 1][0] < alpha[grid == 50][0] == 1.0
    assert alpha[grid == 0].max() == 0.0


def test_intensity_shows_the_mean_and_its_ends() -> None:
    chunks = [chunk([[0.0, 0, 0]], 10.0), chunk([[0.0, 0, 0]], 30.0), chunk([[4.0, 4, 0]], 60.0)]

    raster = rasterize(lambda _: chunks)[0]

    assert intensity_png(raster, normalized=False)[1] == pytest.approx((20.8, 59.2))
    assert intensity_png(raster, normalized=True)[1] == pytest.approx((41.6, 118.4))


@pytest.mark.parametrize(("extent", "step"), [(10.0, 2.0), (33.0, 5.0), (600.0, 100.0), (0.7, 0.1)])
def test_steps_are_round_numbers(extent: float, step: float) -> None:
    assert nice_step(extent, 6) == pytest.approx(step)


def test_a_plan_draws_a_point_where_its_coordinates_say() -> None:
    raster = rasterize(lambda _: [chunk([[0.0, 0.0, 0.0], [10.0, 10.0, 0.0]])])[0]
    line = np.array([[0.0, 0.0, 0.0], [10.0, 10.0, 0.0]])

    svg = ElementTree.fromstring(
        plan_svg(None, ABOVE, raster.frame, overlay=PlanOverlay((PlanPath("line-final", (line,)),)))
    )

    drawn = next(e for e in svg.iter("path") if e.get("class") == "line-final")
    x0, y0, x1, y1 = (float(v) for v in drawn.get("d", "")[1:].replace("L", " ").split())
    scale = 1000.0 / (raster.frame.width * raster.frame.pixel_m)
    assert (x1 - x0, y0 - y1) == pytest.approx((10 * scale, 10 * scale), abs=0.2)


@pytest.mark.parametrize(("x_m", "y_m"), [(4.0, 40.0), (40.0, 4.0)])
def test_a_tall_plan_is_no_longer_than_a_wide_one(x_m: float, y_m: float) -> None:
    raster = rasterize(lambda _: [chunk([[0.0, 0.0, 0.0], [x_m, y_m, 0.0]])])[0]

    svg = ElementTree.fromstring(plan_svg(b"", ABOVE, raster.frame))

    image = svg.find("image")
    assert image is not None
    width, height = (float(image.get(name, "")) for name in ("width", "height"))
    assert max(width, height) == pytest.approx(1000.0, abs=0.1)
    assert width / height == pytest.approx(raster.frame.width / raster.frame.height, rel=1e-3)


def test_less_than_the_least_span_looks_like_nothing() -> None:
    x = np.arange(3.0)
    series = [("", x, np.array([-2e-4, -3e-4, -2.5e-4]), "#000000")]

    wide = lines("height", series, labels=("t", "z"), least=0.1)

    assert "0.04" in wide
    assert "0.0003" not in wide
    assert "0.0003" in lines("height", series, labels=("t", "z"))


def elements(svg: str) -> int:
    return sum(1 for _ in ElementTree.fromstring(svg.replace("xlink:", "")).iter())


def test_values_between_holes_are_dots_of_one_path() -> None:
    t = np.arange(1400.0)
    broken = np.where(t % 2 == 0, np.sin(t / 100), np.nan)

    whole = lines("height", [("z", t, np.sin(t / 100), "#0072b2")], labels=("t", "z"))
    dots = lines("height", [("z", t, broken, "#0072b2")], labels=("t", "z"))

    assert elements(dots) < elements(whole) + 10
    assert dots.count("M") > 700


def test_charts_and_plan_of_a_large_graph_have_few_elements() -> None:
    rng = np.random.default_rng(0)
    count, nodes = 20_000, 5000
    verdicts = rng.choice(np.array(list(Verdict), dtype=object), count)
    edges = [
        Edge(
            i=int(i),
            j=nodes - 1,
            T_i_j=SE3.identity(),
            kind=EdgeKind.LOOP,
            judgments=known_history(verdict),
        )
        for i, verdict in zip(rng.integers(0, nodes - 1, count), verdicts, strict=True)
    ]
    place = rng.uniform(0.0, 500.0, (nodes, 3))
    T_map_body = SE3(np.tile(np.eye(3), (nodes, 1, 1)), place)
    graph = PoseGraph(np.arange(nodes), np.arange(nodes) * 10**9, T_map_body, edges)
    irregular = np.cumsum(rng.exponential(1.0, 20_000) ** 3)

    drawn = [
        plan_svg(None, ABOVE, frame_around(place, ABOVE), overlay=PlanOverlay(edge_paths(graph))),
        histogram("e", [(v, rng.exponential(1.0, count), "#0072b2") for v in Verdict], **NAMED),
        lines("span", [("n", irregular, irregular, "#0072b2")] * 3, **NAMED),
    ]

    assert [elements(svg) < 200 for svg in drawn] == [True] * 3, list(map(elements, drawn))


def made_up_calibration(lidars: int, beams: int) -> CalibrationFigures:
    rng = np.random.default_rng(3)
    names = [f"lidar {k}" for k in range(lidars)]
    statuses: tuple[ParameterStatus, ...] = ("consistent", "off", "not observable")

    def one(sensor: str, quantity: str, axis: str, unit: Literal["rad", "m"]) -> ParameterFigures:
        change, sd = rng.normal(0.0, 1e-3), rng.uniform(1e-4, 1e-3)
        status = statuses[rng.integers(3)]
        return ParameterFigures(
            sensor=sensor,
            quantity=quantity,
            axis=axis,
            unit=unit,
            change=change,
            sd=sd,
            status=status,
        )

    return CalibrationFigures(
        parameters=tuple(
            one(name, what, axis, unit)
            for name in names
            for what, unit in (("rotation", "rad"), ("position", "m"))
            for axis in "xyz"
        ),
        beams=tuple(
            one(name, f"beam {what}", str(ring), unit)
            for name in names
            for what, unit in (("range", "m"), ("elevation", "rad"), ("azimuth", "rad"))
            for ring in range(beams)
        ),
    )


def test_charts_of_many_lidars_and_beams_have_few_elements_and_every_value() -> None:
    found = made_up_calibration(lidars=8, beams=128)

    drawn = [svg for svg, _ in beam_charts(found)]
    of_rig = [svg for svg, _ in rig_charts(found)]

    assert [elements(svg) < 300 for svg in drawn] == [True] * 3, list(map(elements, drawn))
    assert [elements(svg) < 500 for svg in of_rig] == [True] * 2, list(map(elements, of_rig))
    assert [svg.count("M ") >= 2 * 8 * 128 for svg in drawn] == [True] * 3  # a dot and a bar each
    assert all(f"lidar {k}" in svg for svg in drawn for k in range(8))


def test_the_axes_of_a_chart_of_bars_reach_to_their_ends() -> None:
    chart = Chart("bars")

    add_bars(chart, np.array([[0.0, 1.0], [1.0, 2.0]]), np.array([[0.0, 5.0]] * 2), color="#0072b2")

    low, high = chart.axes.get_ylim()
    assert low <= -4.0
    assert high >= 7.0


def test_charts_take_the_color_of_the_page() -> None:
    svg = lines("one", [("a < b", np.arange(9.0), np.arange(9.0), "#0072b2")], labels=("s", "m"))

    ElementTree.fromstring(svg.replace("xlink:", ""))
    assert "currentColor" in svg
    assert "a &lt; b" in svg


def test_a_histogram_of_nothing_or_of_nan_is_empty_and_no_error() -> None:
    for values in (np.empty(0), np.full(5, np.nan)):
        svg = histogram("none", [("all", values, "#000000")], labels=("x", "n"), log=True)
        assert "<svg" in svg


def test_a_long_curve_is_thinned_but_keeps_its_ends() -> None:
    few = thinned(100_000, 100)

    assert (few[0], few[-1], len(few)) == (0, 99_999, 100)


def walk_of_60_s() -> Trajectory:
    t_ns = np.arange(601, dtype=np.int64) * 100_000_000
    return Trajectory(t_ns, SE3.identity(601))


def shades(svg: str) -> int:
    """How many translucent areas a chart has."""
    return svg.count("opacity: 0.25")


def test_findings_mark_their_stretches_on_every_time_axis() -> None:
    findings = [
        Finding(kind=FindingKind.TRACKING_LOST, level=Level.DO_NOT_USE, span_s=(20.0, 25.0)),
        Finding(kind=FindingKind.TOO_FAST, level=Level.NOTE, span_s=(40.0, 40.0)),
        Finding(kind=FindingKind.TOO_FAST, level=Level.NOTE, span_s=(50.0, 52.0)),
        Finding(kind=FindingKind.RIG_AGREES, level=Level.GOOD, span_s=(1.0, 2.0)),
        Finding(kind=FindingKind.RIG_NOT_COMPARED, level=Level.CHECK),
        Finding(kind=FindingKind.TOO_FAST, level=Level.NOTE, span_s=(70.0, 71.0)),  # never walked
    ]
    marked = marked_times(findings, 60.0)
    charts = dict(
        zip(
            ("findings", "height"),
            (svg for svg, _ in walk_charts(walk_of_60_s(), {}, None, findings=findings)),
            strict=True,
        )
    )

    assert [(begin, round(end, 2)) for begin, end, _ in marked.shaded] == [
        (50.0, 52.0),
        (40.0, 40.24),
        (20.0, 25.0),
    ]
    assert charts["findings"].index("TRACKING-LOST") < charts["findings"].index("TOO-FAST")
    assert shades(charts["height"]) == 3 + shades(lines("h", [], **NAMED))


def test_a_walk_without_stretches_of_findings_has_no_chart_of_them() -> None:
    (height,) = walk_charts(walk_of_60_s(), {}, None)

    assert "Height" in height[1] and shades(height[0]) == shades(lines("h", [], **NAMED))
