"""Tables of survey markers."""

from pathlib import Path

import pytest

from recon4.errors import ConfigError, CorruptFile
from recon4.evaluation.markers import read_markers
from recon4.recording.tables.coordinates import ColumnChoice


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


@pytest.mark.parametrize("again", ["A,1,2,3", "A,1,2,3.5"], ids=["alike", "elsewhere"])
def test_a_marker_in_two_rows_is_named(tmp_path: Path, again: str) -> None:
    file = tmp_path / "markers.csv"
    file.write_text(f"name,x_m,y_m,z_m\nA,1,2,3\nB,4,5,6\n{again}\n")

    with pytest.raises(CorruptFile, match=r"markers\.csv line 4: marker 'A' is in line 2 already"):
        read_markers(file)


@pytest.mark.parametrize("empty", ["", " ", "-", "–"])
def test_a_coordinate_may_be_not_measured_only_where_that_is_expected(
    tmp_path: Path, empty
) -> None:
    file = tmp_path / "markers.csv"
    file.write_text(f"name,x_m,y_m,z_m,role\nA,1,{empty},3,check\n", "utf-8")

    (found,) = read_markers(file, partial=True)

    assert str(found.xyz_m.tolist()) == "[1.0, nan, 3.0]"
    with pytest.raises(CorruptFile, match="line 2"):
        read_markers(file)


def test_columns_of_markers_are_found_by_name_or_asked_for(tmp_path: Path) -> None:
    german, plain = tmp_path / "german.csv", tmp_path / "plain.csv"
    german.write_text("Punkt;Hochwert;Rechtswert;Höhe [mm]\nA;2,5;1,5;3500\n")
    plain.write_text("A,2.5,1.5,3.5\n")

    with pytest.raises(ConfigError, match=r"is 2\.5 the easting .*--columns id,x,y,z"):
        read_markers(plain)
    chosen = read_markers(plain, choice=ColumnChoice(("id", "y", "x", "z")))

    assert read_markers(german)[0].xyz_m.tolist() == [1.5, 2.5, 3.5]
    assert chosen[0].xyz_m.tolist() == [1.5, 2.5, 3.5]
