"""Control and check points (V Table 3.3)."""

from pathlib import Path

import numpy as np
import pytest

from recon4.errors import CorruptFile
from recon4.evaluation.markers import SurveyMarker, compare_markers, read_markers
from recon4.evaluation.text import marker_text


def test_the_first_row_of_the_thesis_table() -> None:
    reference = (SurveyMarker("pt1", np.array([100.0, 200.0, 300.0])),)

    table = compare_markers({"pt1": np.array([99.941, 199.988, 299.848])}, reference)

    row = table.rows[0]
    assert (row.dx_m, row.dy_m, row.dz_m) == pytest.approx((-0.059, -0.012, -0.152))
    assert row.horizontal_m == pytest.approx(0.060, abs=5e-4)
    assert row.total_m == pytest.approx(0.163, abs=5e-4)
    assert not table.within_limits
    assert "NOT within" in marker_text(table)


def test_both_points_of_the_thesis_are_within_its_limits() -> None:
    reference = (SurveyMarker("pt1", np.zeros(3)), SurveyMarker("pt2", np.zeros(3)))
    measured = {
        "pt1": np.array([-0.059, -0.012, -0.152]),
        "pt2": np.array([-0.056, 0.005, -0.047]),
    }

    table = compare_markers(measured, reference)

    assert table.mean_horizontal_m == pytest.approx(0.058, abs=5e-4)
    assert table.mean_vertical_m == pytest.approx(0.0995)
    assert table.max_vertical_m == pytest.approx(0.152)
    assert table.within_limits


def test_control_points_do_not_judge_when_there_are_check_points() -> None:
    reference = (SurveyMarker("a", np.zeros(3), "control"), SurveyMarker("b", np.zeros(3), "check"))

    table = compare_markers({"a": np.zeros(3), "b": np.array([0.3, 0, 0])}, reference)

    assert table.judged_by == "check"
    assert table.mean_horizontal_m == pytest.approx(0.3)


def test_a_marker_not_found_is_named_and_none_found_is_not_within_limits() -> None:
    table = compare_markers({}, (SurveyMarker("lost", np.zeros(3)),))

    assert table.missing == ("lost",)
    assert not table.within_limits


def test_markers_are_read_from_csv(tmp_path: Path) -> None:
    file = tmp_path / "markers.csv"
    file.write_text("name,x_m,y_m,z_m,role\nA,1,2,3,control\nB,4,5,6,\n")

    markers = read_markers(file)

    assert [(m.name, m.role, m.xyz_m.tolist()) for m in markers] == [
        ("A", "control", [1, 2, 3]),
        ("B", "check", [4, 5, 6]),
    ]


@pytest.mark.parametrize("line", ["A,1,2", "A,1,2,x,check", "A,1,2,nan,check", "A,1,2,3,boss"])
def test_a_bad_line_is_refused_by_number(tmp_path: Path, line: str) -> None:
    file = tmp_path / "markers.csv"
    file.write_text(f"name,x_m,y_m,z_m,role\n{line}\n")

    with pytest.raises(CorruptFile, match=r"markers\.csv line 2: expected"):
        read_markers(file)
