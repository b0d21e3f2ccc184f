"""Charts are drawn where their axes say."""

import re
from itertools import pairwise
from xml.etree import ElementTree

import numpy as np
import pytest

from recon4.report.chart import Chart
from recon4.report.chart_axes import AxisSpan, at_same_scale, span_of, ticks_of
from recon4.report.figures import histogram, lines


class Drawn:
    """A chart as its reader sees it: positions measured with the ticks of the axes."""

    def __init__(self, svg: str) -> None:
        root = ElementTree.fromstring(svg)
        axes = [one for one in root.iter("g") if one.find("svg") is not None][-1]
        area = axes.find("svg")
        assert area is not None
        self.size = float(area.get("width", "")), float(area.get("height", ""))
        self.paths = [path.get("d", "") for path in area.iter("path")]
        self.texts = [text.text or "" for text in root.iter("text")]
        (grid,) = [p.get("d", "") for p in axes.iter("path") if p.get("stroke") == "#808080"]
        ticks = [(t.get("text-anchor"), _number(t.text or "")) for t in axes.findall("text")]
        self.x = _scale(re.findall(r"M(\S+) 0V", grid), [v for a, v in ticks if a == "middle"])
        self.y = _scale(re.findall(r"M0 (\S+)H", grid), [v for a, v in ticks if a == "end"])

    def points(self, path: str) -> np.ndarray:
        at = np.array(re.findall(r"[ML](\S+) ([\d.-]+)", path), dtype=float)
        return np.stack([np.polyval(self.x, at[:, 0]), np.polyval(self.y, at[:, 1])], axis=1)


def _number(text: str) -> float:
    try:
        return float(text.replace("−", "-"))
    except ValueError:
        return np.nan


def _scale(at: list[str], values: list[float]) -> np.ndarray:
    """Position -> value, from the first and last tick; all between lie on that line."""
    shown = np.array([value for value in values if np.isfinite(value)])
    places = np.array(at, dtype=float)
    line = np.polyfit(places[[0, -1]], shown[[0, -1]], 1)
    assert np.polyval(line, places) == pytest.approx(shown, abs=0.02 * np.ptp(shown))
    return line


def test_points_are_where_the_ticks_say() -> None:
    x, y = np.array([-2.0, 0.5, 7.0]), np.array([30.0, -5.0, 12.0])

    drawn = Drawn(lines("one", [("", x, y, "#0072b2")], labels=("s", "m")))

    found = drawn.points(drawn.paths[0])
    assert found[:, 0] == pytest.approx(x, abs=0.05)
    assert found[:, 1] == pytest.approx(y, abs=0.2)


def test_every_point_lies_between_the_axes() -> None:
    x = np.linspace(0.0, 6.0, 40)
    for y in (0.12 * x, 0.12 * x - 0.1, -0.12 * x, np.full(40, 3.0)):
        drawn = Drawn(lines("one", [("", x, y, "#0072b2")], labels=("s", "m"), least=1.0))

        at = np.array(re.findall(r"[ML](\S+) ([\d.-]+)", drawn.paths[0]), dtype=float)
        assert (at >= 0.0).all() and (at <= np.array(drawn.size)).all()


def test_no_line_bridges_what_is_no_number() -> None:
    y = np.array([1.0, 2.0, np.nan, 3.0, np.inf, 5.0, 4.0])
    chart = Chart("one", labels=("s", "m"))
    chart.limit_y(0.0, 6.0)
    chart.limit_x(0.0, 6.0)
    chart.curve(np.arange(7.0), np.where(np.isinf(y), np.nan, y), color="#0072b2")

    drawn = Drawn(chart.svg())

    pieces = re.findall(r"M[^M]*", drawn.paths[0])
    assert [len(drawn.points(piece)) for piece in pieces] == [2, 1, 2]


def test_columns_are_as_high_as_there_are_values() -> None:
    values = np.array([0.5] * 7 + [9.9] * 3 + [np.nan])

    drawn = Drawn(histogram("h", [("all", values, "#0072b2")], labels=("x", "n")))

    found = drawn.points(drawn.paths[0])
    assert "all (10)" in drawn.texts
    for value, count in ((0.5, 7), (9.9, 3)):
        near = found[np.abs(found[:, 0] - value) < 0.26]
        assert near[:, 1].max() == pytest.approx(count, abs=0.05)


def test_dots_that_cover_each_other_are_drawn_once() -> None:
    chart = Chart("slice", labels=("x", "y"))
    chart.keep_aspect()
    chart.dots(np.repeat([0.0, 4.0, 4.0], 1000), np.repeat([0.0, 0.0, 3.0], 1000),
               color="#0072b2", width=1.0)  # fmt: skip

    drawn = Drawn(chart.svg())

    assert drawn.paths[0].count("M") == 3
    assert abs(drawn.x[0]) == pytest.approx(abs(drawn.y[0]), rel=0.02)


@pytest.mark.parametrize("height", [100.0, 1000.0])
def test_names_of_rows_stand_at_their_rows(height: float) -> None:
    chart = Chart("rig", labels=("mm", ""), height=height)
    chart.dots(np.zeros(3), np.arange(3.0), color="#0072b2", width=4.0)
    chart.list_rows(["first & x", "second", "third"])

    root = ElementTree.fromstring(chart.svg())

    texts = {text.text: float(text.get("y", "")) for text in root.iter("text")}
    assert texts["first & x"] < texts["second"] < texts["third"]
    (dots,) = [p.get("d", "") for p in root.iter("path") if "h0" in p.get("d", "")]
    for name, y in zip(
        ("first & x", "second", "third"), re.findall(r" ([\d.]+)h0", dots), strict=True
    ):
        assert texts[name] == pytest.approx(float(y) + 3.2, abs=0.1)


@pytest.mark.parametrize(
    ("first", "last"),
    [(0.0, 1.0), (-3e-4, 0.0), (0.0, 6.1), (9_990.0, 10_010.0), (0.0, 4e5), (0.0, 8.4)],
)
def test_ticks_are_round_few_and_different(first: float, last: float) -> None:
    ticks = ticks_of(AxisSpan(first, last), 7)

    assert 3 <= len(ticks) <= 8
    assert len({tick.text for tick in ticks}) == len(ticks)
    for tick in ticks:
        assert first - 1e-9 <= tick.value <= last + 1e-9
        assert _number(tick.text) == pytest.approx(tick.value, abs=1e-12)
    steps = [b.value - a.value for a, b in pairwise(ticks)]
    assert steps == pytest.approx([steps[0]] * len(steps))
    assert f"{steps[0]:.1e}"[:3] in {"1.0", "2.0", "5.0"}


def test_counts_have_whole_ticks_and_logarithms_decades() -> None:
    assert [tick.text for tick in ticks_of(AxisSpan(0.0, 1.05), 6, integer=True)] == ["0", "1"]
    assert [tick.text for tick in ticks_of(AxisSpan(0.0, 26.0), 6, integer=True)] == [
        *("0", "5", "10", "15", "20", "25"),
    ]
    assert [tick.text for tick in ticks_of(AxisSpan(0.0, 14.0), 6, integer=True)] == [
        "0",
        "5",
        "10",
    ]
    assert [tick.text for tick in ticks_of(AxisSpan(2e-3, 2.1, log=True), 6)] == [
        "0.01",
        "0.1",
        "1",
    ]


def test_spans_have_a_width_whatever_comes() -> None:
    for values in ([], [np.empty(0)], [np.array([np.nan])], [np.zeros(3)], [np.full(2, -7.0)]):
        span = span_of(values)
        assert span.last > span.first
    x, y = at_same_scale(AxisSpan(0.0, 10.0), AxisSpan(0.0, 1.0), 2.0)
    assert (x, y) == (AxisSpan(0.0, 10.0), AxisSpan(-2.0, 3.0))
