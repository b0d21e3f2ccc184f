"""Lists of surveyed points as offices write them: groups of digits, rows of units, roles."""

import pytest

from recon4.errors import CorruptFile
from recon4.slices.control_points import read_control

PLACE = (456_789.123, 5_429_876.543, 112.345)


def first(text: str):
    found = read_control(text.encode())
    assert not found.table.question
    return found.points[0], found.skipped


@pytest.mark.parametrize(
    "row",
    [
        "A1;456.789,123;5.429.876,543;112,345",
        "A1;456'789.123;5'429'876.543;112.345",
        "A1;456’789.123;5’429’876.543;112.345",
        "A1;456 789,123;5 429 876,543;112,345",
        "A1;456,789.123;5,429,876.543;112.345",
        'A1,"456,789.123","5,429,876.543",112.345',
    ],
)
def test_thousands_separators_that_have_one_reading_are_read(row):
    sign = ";" if ";" in row else ","
    point, skipped = first(f"Punkt{sign}E{sign}N{sign}H\n{row}\n{row.replace('A1', 'A2')}\n")
    assert (point.xyz_m, skipped) == (PLACE, ())


@pytest.mark.parametrize(
    ("sure", "doubtful"),
    [("1.234,5;2,5;3,5", "1.234;2,5;3,5"), ("1,234.5;2.5;3.5", "1,234;2.5;3.5")],
)
def test_a_number_that_may_be_a_thousand_is_left_out_by_line(sure, doubtful):
    point, skipped = first(f"id;E;N;H\nA;{sure}\nB;{doubtful}\n")
    assert point.xyz_m == (1234.5, 2.5, 3.5)
    (said,) = skipped
    assert "line 3: expected numbers without thousands separators" in said


def test_three_decimals_are_no_thousands():
    point, skipped = first("id;E;N;H\nA;1.234;2.345;3.456\nB;5.678;6.789;7.891\n")
    assert (point.xyz_m, skipped) == ((1.234, 2.345, 3.456), ())


def test_a_row_of_units_may_begin_with_a_hyphen():
    point, skipped = first("Nr;E;N;H\n-;ft;ft;ft\n1;1000;2000;300\n2;1010;2000;300\n")
    assert point.xyz_m == pytest.approx((304.8, 609.6, 91.44))
    assert skipped == ()


def test_a_line_of_text_below_the_rows_decides_no_separator():
    point, (said,) = first("id;E;N;H\nA;1,5;2,5;3,5\nB;11,5;12,5;13,5\nSumme: 2 Punkte\n")
    assert point.xyz_m == (1.5, 2.5, 3.5)
    assert said.startswith("line 4: ")


def test_roles_are_found_in_a_column_of_another_name():
    text = "Nr;E;N;H;Typ\n1;1;2;3;Passpunkt\n2;4;5;6;Kontrollpunkt\n"
    assert [one.role for one in read_control(text.encode()).points] == ["control", "check"]


def test_a_column_that_is_no_list_of_roles_stays_unused():
    point, skipped = first("Nr;E;N;H;Typ\n1;1;2;3;Bolzen\n2;4;5;6;Passpunkt\n")
    assert (point.role, skipped) == ("check", ())


def test_the_answer_that_is_proposed_for_a_table_without_names_can_be_read():
    rows = "A;1.5;2.5;3.5;control\nB;4.5;5.5;6.5;check\n"
    asked = read_control(rows.encode()).table
    assert asked.question and asked.columns == ("id", "x", "y", "z", "role")
    point, _ = first("id,east,north,height,role\n" + rows)
    assert point.role == "control"


def test_degrees_minutes_seconds_are_refused_by_what_is_expected():
    with pytest.raises(CorruptFile, match="expected degrees with decimals"):
        read_control("id;lat;lon;h\nA;49°01'12.3;8°25'12.5;160\n".encode())
