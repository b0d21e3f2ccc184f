"""What a position measures: components that it does not measure are no figure and count nowhere."""

import math

import numpy as np
import pytest
from scipy.special import gammaincc

from recon4.slices.acceptance import AcceptanceText, render_acceptance
from recon4.slices.control_points import ControlPoint
from recon4.slices.measured_points import MeasuredPosition, orthonormal
from recon4.slices.pick import measured_directions, nearest_surface
from recon4.slices.residual_table import residual_csv, residual_text
from recon4.slices.residuals import ControlContext, residuals
from recon4.slices.slice_plane import SlicePlane
from recon4.slices.tuning import RESIDUALS
from tests.unit.slices.room_map import wall, write_map

MOVED_M = np.array([0.004, 0.0, 0.002])
"""The survey beside the map: 0.4 cm east, 0.2 cm up."""
SHEET = AcceptanceText(project="a", frame="b", sources="c", approval="d")


def across(normal, xyz, offset_m):
    n = np.array(normal, dtype=np.float64)
    n /= np.linalg.norm(n)
    return MeasuredPosition(np.array(xyz) + offset_m * n, n[None])


def on_walls(count, normal=(1.0, 0.0, 0.0), offset_m=0.02):
    points = [ControlPoint(str(k), (0.0, 3.0 * k, 1.0)) for k in range(count)]
    return points, {p.id: across(normal, p.xyz_m, offset_m) for p in points}


def test_a_survey_that_is_moved_along_a_wall_is_not_found_to_be_in_place(tmp_path):
    rng = np.random.default_rng(1)
    tiles = write_map(tmp_path, wall(rng, 40_000, sigma_m=0.001)[0][:, [1, 0, 2]])  # across y
    point = ControlPoint("A", tuple(np.array([2.0, 0.0, 1.0]) + MOVED_M))

    foot = nearest_surface(tiles, np.array(point.xyz_m))
    found = residuals([point], {"A": MeasuredPosition(foot.p_map, foot.normal[None])})

    row = found.rows[0]
    assert (row.east_m, row.up_m, row.d2_m, row.d3_m) == (None, None, None, None)
    assert row.north_m == pytest.approx(0.0, abs=1e-3) and row.directions == 1
    east, north, up = found.figures[0].axes
    assert (east.points, east.rmse_m, up.points, up.rmse_m) == (0, None, 0, None)
    assert north.points == 1
    assert found.passed is None and "height – (not measured)" in found.verdict.text


def test_what_was_not_measured_is_a_dash_in_every_file():
    found = residuals(*on_walls(3))

    table, sheet = residual_csv(found), render_acceptance(found, SHEET)
    assert "0,check,0.0200,–,–,–,–" in table
    assert "RMSE,check,0.0200,–,–,,–" in table
    assert "points,check,3,0,0" in table
    assert "<td>2.0</td><td>–</td><td>–</td><td>–</td><td>–</td><td>2.0</td>" in sheet
    assert residual_text(found).splitlines()[2].split()[2:] == ["2.0", "–", "–", "–", "–"]
    german = residual_text(found, "de").splitlines()
    assert german[0].split()[0] == "Marke" and german[2].split()[1:3] == ["(Kontrollpunkt)", "2,0"]


def test_one_horizontal_component_is_judged_alone_against_its_part_of_the_limit():
    points, measured = on_walls(3, offset_m=0.11)

    found = residuals(points, measured)

    lines = {line.label: line for line in found.figures[0].requirements}
    assert lines["mean east"].limit_m == pytest.approx(0.14 / math.sqrt(2))
    assert lines["mean east"].holds is False and lines["largest east"].holds is True
    assert lines["mean north"].holds is None and lines["mean north"].text == "– not measured"
    assert found.passed is False


def test_a_large_component_exceeds_the_horizontal_limit_among_points_measured_in_both():
    points = [ControlPoint(str(k), (4.0 * k, k * k, 1.0)) for k in range(4)]
    measured = {p.id: MeasuredPosition.full(np.array(p.xyz_m)) for p in points[:3]}
    measured["3"] = across((0.0, 1.0, 0.0), points[3].xyz_m, 0.3)

    found = residuals(points, measured)

    lines = {line.label: line for line in found.figures[0].requirements}
    assert lines["largest horizontal"].value_m == pytest.approx(0.3)
    assert lines["mean horizontal"].value_m == 0.0 and lines["mean horizontal"].points == 3
    assert found.passed is False


def test_a_slanting_surface_measures_no_component_but_a_residual_across():
    found = residuals(*on_walls(3, normal=(1.0, 1.0, 0.0), offset_m=-0.05))

    row = found.rows[0]
    assert (row.east_m, row.north_m, row.up_m) == (None, None, None)
    assert row.across_m == pytest.approx(-0.05, abs=1e-9) or row.across_m == pytest.approx(0.05)
    assert found.passed is None


def test_axes_within_ten_degrees_of_a_measured_direction_are_measured():
    turned = np.deg2rad(8.0)
    near = MeasuredPosition(np.zeros(3), np.array([[np.cos(turned), np.sin(turned), 0.0]]))
    two = MeasuredPosition(np.zeros(3), orthonormal([[1.0, 1.0, 0.0], [1.0, -1.0, 0.0]]))

    assert near.axes == (True, False, False) and two.axes == (True, True, False)


@pytest.mark.parametrize(
    ("directions", "along"), [(1, [[1, 0, 0]]), (2, [[1, 0, 0], [0, 0, 1]]), (3, np.eye(3))]
)
def test_a_residual_far_beyond_its_sigma_is_flagged(directions, along):
    points = [ControlPoint(str(k), (3.0 * k, k * k, 1.0)) for k in range(5)]
    offsets_m = [0.091, 0.01, -0.01, 0.005, 0.0]
    measured = {
        p.id: MeasuredPosition(np.add(p.xyz_m, (d, 0.0, 0.0)), np.array(along, dtype=float))
        for p, d in zip(points, offsets_m, strict=True)
    }
    covariances = {p.id: np.eye(3) * 0.004**2 for p in points}

    found = residuals(points, measured, ControlContext(covariances=covariances))

    assert [row.outlier for row in found.rows] == [True, False, False, False, False]
    assert found.rows[0].sigmas == pytest.approx(0.091 / math.hypot(0.004, 0.01))
    assert "⚠ Far beyond the stated σ: 0 (9.1 cm, 8 σ)" in found.verdict.text
    assert found.verdict.level in ("warning", "bad") and not found.verdict.text.startswith("✓")
    assert "⚠ 8.4" in render_acceptance(found, SHEET) and ",8.4,YES" in residual_csv(found)


def test_a_good_residual_is_flagged_with_the_probability_of_three_sigmas():
    beyond = [gammaincc(k / 2, x**2 / 2) for k, x in enumerate(RESIDUALS.outlier_sigmas, start=1)]

    assert beyond == pytest.approx([0.0027] * 3, abs=2e-5)


def test_good_residuals_are_rarely_flagged():
    rng = np.random.default_rng(5)
    points = [ControlPoint(str(k), (0.1 * k, 0.0, 0.0)) for k in range(2000)]
    sd_m = math.hypot(0.02, 0.01)
    measured = {
        p.id: MeasuredPosition.full(np.array(p.xyz_m) + sd_m * rng.standard_normal(3))
        for p in points
    }

    context = ControlContext(covariances={p.id: np.eye(3) * 0.02**2 for p in points})
    found = residuals(points, measured, context)

    assert sum(row.outlier for row in found.rows) <= 14  # expected 5.4


def test_without_a_stated_sigma_it_is_said_that_outliers_are_not_tested():
    found = residuals(*on_walls(3))

    assert "Outliers are not tested: the map states no σ." in found.verdict.text
    assert found.rows[0].sigmas is None and not found.rows[0].outlier


def test_a_point_shifted_as_all_are_is_not_called_a_wrong_place():
    points, measured = on_walls(4, offset_m=0.2)
    context = ControlContext(covariances={p.id: np.eye(3) * 0.01**2 for p in points})

    found = residuals(points, measured, context)

    assert "map and survey differ by more than the map states" in found.verdict.text


def test_a_point_beside_the_end_of_a_wall_is_not_on_it(tmp_path):
    tiles = write_map(tmp_path, wall(np.random.default_rng(1), 40_000, sigma_m=0.001)[0])

    assert nearest_surface(tiles, np.array([0.01, 4.05, 1.0])) is not None
    assert nearest_surface(tiles, np.array([0.01, 4.25, 1.0])) is None


def test_an_edge_measures_no_surface(tmp_path):
    rng = np.random.default_rng(1)
    corner = np.concatenate([wall(rng, 20_000)[0], wall(rng, 20_000)[0][:, [1, 0, 2]]])
    tiles = write_map(tmp_path, corner)

    assert nearest_surface(tiles, np.array([0.0, 0.0, 1.0])) is None
    assert nearest_surface(tiles, np.array([0.02, 2.0, 1.0])) is not None


def test_a_pick_measures_the_plane_of_its_slice_and_the_surface_it_lies_on(tmp_path):
    tiles = write_map(tmp_path, wall(np.random.default_rng(1), 40_000, sigma_m=0.001)[0])
    p = np.array([0.0, 2.0, 1.0])

    plan = orthonormal(measured_directions(tiles, SlicePlane.horizontal(1.0), p))
    section = orthonormal(
        measured_directions(tiles, SlicePlane.vertical((0.0, 0.0), (0.0, 4.0)), p)
    )

    assert MeasuredPosition(p, plan).axes == (True, True, False)  # nothing gives the height
    assert MeasuredPosition(p, section).axes == (True, True, True)
