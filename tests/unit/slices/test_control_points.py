"""Survey files, and residuals of the map at their points."""

import math
import re

import numpy as np
import pytest

from recon4.errors import ConfigError, CorruptFile, GeoreferenceError
from recon4.recording.tables.coordinates import ColumnChoice
from recon4.recording.tables.spreads import read_covariances
from recon4.slices.acceptance import AcceptanceText, render_acceptance
from recon4.slices.control_limits import ControlLimits
from recon4.slices.control_points import ControlPoint, read_control, with_covariances
from recon4.slices.measured_points import MeasuredPosition
from recon4.slices.residual_table import residual_csv, residual_text
from recon4.slices.residuals import ControlContext, residuals


@pytest.mark.parametrize(
    "text",
    [
        "ID,X,Y,Z\nA,1.5,2.5,3.5\n",
        "\ufeffID;X;Y;Z;Radius\nA;1,5;2,5;3,5;0,1\n",
        "A\t1,5\t2,5\t3,5\n",
        "name,height,north,east\nA,3.5,2.5,1.5\n",
        '"A","1.5","2.5","3.5"\r\n',
    ],
)
def test_surveys_of_all_kinds_are_understood(text):
    found = read_control(text.encode())

    assert found.points[0].xyz_m == (1.5, 2.5, 3.5) and found.skipped == ()
    assert bool(found.table.question) == ("north" not in text)


def test_the_order_is_asked_for_and_can_be_turned():
    data = b"A,5400000.0,600000.0,300\n"

    found, turned = (
        read_control(data),
        read_control(data, choice=ColumnChoice(("id", "y", "x", "z"))),
    )

    assert "is 5400000.0 the easting" in found.table.question
    assert turned.points[0].xyz_m == (600000.0, 5400000.0, 300.0) and turned.table.question == ""


def test_lines_that_say_nothing_are_named_not_dropped():
    found = read_control(b"ID,X,Y,Z\nA,1,2,3\nB,1,x,3\nA,9,9,9\nC,1,inf,3\n")

    assert [point.id for point in found.points] == ["A"]
    assert [words.split(":")[0] for words in found.skipped] == ["line 3", "line 4", "line 5"]


@pytest.mark.parametrize(
    ("head", "row", "expected"),
    [
        ("sE [mm],sN [mm],sH [mm]", "3,4,6", (9e-6, 0.0, 0.0, 1.6e-5, 0.0, 3.6e-5)),
        ("σE,σN,σU", "0.003,0.004,0.006", (9e-6, 0.0, 0.0, 1.6e-5, 0.0, 3.6e-5)),
        ("cEE [mm²],cEN,cEH,cNN,cNH,cHH", "9,2e-6,1e-6,1.6e-5,0,3.6e-5",
         (9e-6, 2e-6, 1e-6, 1.6e-5, 0.0, 3.6e-5)),
        ("SN,note", "77,x", None),  # a serial number
        ("sE,sN,sH", ",,", None),
        ("sE,sN,sH", "3,4,6000", "the standard deviation H is 6000 m: .*check its unit"),
        ("sE,sN,sH", "0,0.01,0.01", "the standard deviation E is 0 m"),
        ("sE,sN,sH", "-0.01,0.01,0.01", "above 0"),
        ("sE,sN,sH", "0.01,,0.01", "expected a number"),
        ("cEE,cEN,cEH,cNN,cNH,cHH", "1e-5,1e-5,0,1e-5,0,1e-5", "not positive definite"),
    ],
)  # fmt: skip
def test_a_survey_states_deviations_or_covariances_of_its_points(head, row, expected):
    found = read_control(f"id,E,N,H,{head}\nA,1,2,3,{row}\nB,2,3,4\n".encode())

    if isinstance(expected, str):
        assert re.search(expected, found.skipped[0])
    else:
        assert found.points[0].covariance_m2 == (expected and pytest.approx(expected))
        assert not found.skipped and not found.table.question
    assert found.points[-1].covariance_m2 is None
    assert ("sn" in found.table.columns) == ("sE" in head or "σE" in head)


def test_a_residual_is_judged_by_the_covariance_of_its_own_point():
    own = (1e-2, 0.0, 0.0, 1e-6, 0.0, 1e-6)
    points = [ControlPoint("A", (0.0, 0.0, 0.0), "check", 0.0, own), ControlPoint("B", (0, 0, 0))]
    at = full({"A": (0.05, 0.0, 0.0), "B": (0.05, 0.0, 0.0)})
    known = ControlContext(covariances={name: 1e-6 * np.eye(3) for name in at})

    a, b = residuals(points, at, known).rows

    assert a.sigmas < 1.0 < b.sigmas
    assert not a.outlier and b.outlier
    assert a.survey.major_m > 10.0 * a.survey.minor_m and b.survey is None


@pytest.mark.parametrize("data", [b"", b"\0\0\0", b"a,b\n", "žluťoučký".encode("utf-16")])
def test_a_file_without_points_is_refused(data):
    with pytest.raises(CorruptFile):
        read_control(data, name="p.csv")


def full(measured):
    return {name: MeasuredPosition.full(xyz) for name, xyz in measured.items()}


def test_control_and_check_points_are_judged_apart():
    points = [
        ControlPoint("A", (0.0, 0.0, 0.0), "control"),
        ControlPoint("B", (10.0, 0.0, 0.0)),
        ControlPoint("C", (0.0, 10.0, 0.0)),
        ControlPoint("D", (5.0, 5.0, 5.0)),
        ControlPoint("E", (5.0, 5.0, 0.0)),
    ]
    measured = {
        "A": [1.0, 0.0, 0.0],
        "B": [10.03, 0.04, 0.0],
        "C": [0.03, 10.04, -0.45],
        "E": [5.03, 5.04, 0.0],
    }

    found = residuals(points, full(measured))

    check, control = found.figures
    assert found.judged_by == "check" and found.missing == ("D",)
    assert (check.role, check.points, control.points) == ("check", 3, 1)
    assert check.mean_2d_m == pytest.approx(0.05) and check.max_up_m == pytest.approx(0.45)
    assert [one.rmse_m for one in check.axes] == pytest.approx((0.03, 0.04, 0.45 / math.sqrt(3)))
    assert [one.mean_m for one in check.axes] == pytest.approx((0.03, 0.04, -0.15))
    assert [(one.label, one.limit_m, one.holds) for one in check.requirements] == [
        ("mean horizontal", 0.14, True),
        ("largest horizontal", 0.28, True),
        ("mean height", 0.12, False),
        ("largest height", 0.24, False),
        ("distances between points", 0.05, True),
    ]
    assert check.relative_m < 0.05 and found.passed is False
    assert found.verdict.level == "bad"
    assert "height ✕ (3 points, mean height 15.0 of 12.0 cm" in found.verdict.text
    assert [one.holds for one in control.requirements] == [None] * 4 + [None] * 1
    assert control.requirements[0].text == "– 1 of 3 points needed, above the limit"


@pytest.mark.parametrize(
    ("up_m", "east_m", "said"),
    [
        ((-44.1, -44.2), 0.1, "All 2 points are 44.15 m too low in the map"),
        ((44.1,), 0.1, "The point is 44.10 m too high in the map"),
        ((-44.1, -40.0), 0.1, ""),
        ((-44.1, -44.2), 3.0, ""),
        ((-0.4, -0.4), 0.1, ""),
        ((-44.1,), 12.0, ""),
    ],
    ids=["geoid", "one point", "unlike heights", "wrong place", "small", "one far"],
)
def test_heights_above_sea_level_are_told_by_the_points(up_m, east_m, said):
    points = [ControlPoint(str(k), (10.0 * k, 0.0, 300.0)) for k in range(len(up_m))]
    measured = {
        point.id: np.add(point.xyz_m, (east_m, 0.0, up))
        for point, up in zip(points, up_m, strict=True)
    }

    found = residuals(points, full(measured))

    assert found.hint.startswith(said) and bool(found.hint) == bool(said)
    assert found.hint in residual_csv(found)
    sheet = AcceptanceText(project="a", frame="b", sources="c", approval="d")
    assert found.hint in render_acceptance(found, sheet)


@pytest.mark.parametrize("count", [1, 3])
def test_of_a_survey_in_another_system_nothing_else_is_said(count):
    points = [ControlPoint(str(k), (10.0 * k, 0.0, 300.0)) for k in range(3)]
    measured = {one.id: np.add(one.xyz_m, (4321.5, 77.0, -44.0)) for one in points[:count]}

    found = residuals(points, full(measured))

    assert found.verdict.text.startswith("– The survey has coordinates of its own")
    assert (found.passed, found.judged_by, found.figures, found.hint) == (None, None, (), "")
    assert [row.id for row in found.rows] == ["0", "1", "2"][:count]
    sheet = AcceptanceText(project="a", frame="b", sources="c", approval="d")
    for text in (residual_csv(found), residual_text(found), render_acceptance(found, sheet)):
        assert found.verdict.text in text
        assert "4321" not in text and "432150" not in text


@pytest.mark.parametrize(
    ("heights_m", "said"),
    [
        ((340.0, 352.0), "All 2 points of the survey are below the map by 36 m and more"),
        ((250.0, 260.0), "All 2 points of the survey are above the map by 40 m and more"),
        ((299.0, 310.0), ""),
        ((600.0, 610.0), ""),
        (None, ""),
    ],
    ids=["below", "above", "in the map", "farther than any geoid", "not known"],
)
def test_a_survey_below_or_above_the_map_has_other_heights(heights_m, said):
    points = [ControlPoint("A", (0.0, 0.0, 300.0)), ControlPoint("B", (9.0, 0.0, 304.0))]

    bounds_m = heights_m and np.array([(-5.0, -5.0, heights_m[0]), (15.0, 5.0, heights_m[1])])
    found = residuals(points, {}, ControlContext(map_bounds_m=bounds_m))

    assert found.hint.startswith(said) and bool(found.hint) == bool(said)


def test_only_places_in_this_map_count():
    points = [ControlPoint("A", (0.0, 0.0, 0.0)), ControlPoint("B", (1.0, 0.0, 0.0))]

    found = residuals(points, {}, ControlContext(outdated=["B"]))

    assert (found.missing, found.outdated, found.passed) == (("A",), ("B",), None)


def test_a_name_that_looks_like_a_formula_is_defused():
    found = residuals([ControlPoint("=1+1", (0.0, 0.0, 0.0))], full({"=1+1": np.zeros(3)}))

    lines = residual_csv(found, comment="of a\nhouse").splitlines()

    assert lines[0] == "# recon4 control and check points of a house"
    assert lines[4].startswith("'=1+1,check,0.0000")
    assert "largest height,check,1,0.0000,0.240,–" in lines


@pytest.mark.parametrize(
    ("up_m", "role", "count", "words"),
    [
        (0.05, "check", 3, "✓ Within the limits at the check points: horizontal ✓ (3 points)"),
        (0.25, "check", 3, "✕ Outside the limits at the check points: horizontal ✓ (3 points)"),
        (0.05, "control", 3, "no independent point was checked: horizontal ✓"),
        (0.05, "check", 2, "– No verdict at the check points: horizontal – (2 points, 3 needed)"),
        (0.25, "check", 2, "height – (2 points, 3 needed, mean height 25.0 of 12.0 cm"),
    ],
)
def test_the_sheet_says_what_was_measured_against_which_limit(up_m, role, count, words):
    points = [ControlPoint(f"<A{k}>", (9.0 * k, 0.0, 0.0), role) for k in range(count)]
    measured = {point.id: np.add(point.xyz_m, (0.0, 0.0, up_m)) for point in points}
    points.append(ControlPoint("B", (1.0, 0.0, 0.0)))
    about = AcceptanceText(project="Dům & dvůr", frame="local", sources="map 12", approval="By Eva")

    sheet = render_acceptance(residuals(points, full(measured)), about)

    assert words in sheet and "&lt;A0&gt;" in sheet and "Dům &amp; dvůr" in sheet
    assert f"<td>mean height</td><td>{count}</td><td>{100 * up_m:.1f}</td><td>12.0</td>" in sheet
    assert "not found in the map" in sheet and "By Eva" in sheet
    assert "1 more not measured" in sheet and "largest 28 cm horizontal, 24 cm height" in sheet


def test_limits_of_the_job_decide_and_are_named():
    points = [ControlPoint(str(k), (9.0 * k, k * k, 0.0)) for k in range(4)]
    measured = full({point.id: np.add(point.xyz_m, (0.03, 0.0, 0.0)) for point in points})
    strict = ControlLimits(mean_horizontal_m=0.02, distances_m=None)

    usual = residuals(points, measured)
    found = residuals(points, measured, ControlContext(limits=strict))

    assert usual.passed is True and "(usual limits)" in residual_csv(usual)
    assert found.passed is False and "mean horizontal 3.0 of 2.0 cm" in found.verdict.text
    assert "mean 2 cm horizontal" in residual_csv(found)
    assert (
        "distances not required; σ of survey and picking 1 cm (limits of this job)"
        in residual_csv(found)
    )
    assert "distances" not in [line.component for line in found.figures[0].requirements]


def test_the_verdict_is_said_in_a_language():
    points = [ControlPoint(str(k), (9.0 * k, k * k, 0.0)) for k in range(4)]
    measured = full({point.id: np.add(point.xyz_m, (0.03, 0.0, 40.0)) for point in points[:3]})
    strict = ControlLimits(mean_horizontal_m=0.025, distances_m=None)

    found = residuals(points, measured, ControlContext(limits=strict, language="de"))

    assert found.verdict.text.startswith(
        "✕ Außerhalb der Grenzen an den Kontrollpunkten: Lage ✕ (3"
    )
    assert "Mittel Lage 3,0 von 2,5 cm" in found.verdict.text
    assert found.verdict.text.endswith("1 weitere nicht gemessen.")
    assert found.limits.startswith("Mittel 2,5 cm Lage, 12 cm Höhe") and "nicht verlangt" in (
        found.limits
    )
    assert found.hint.startswith("Alle 3 Punkte liegen in der Karte 40,00 m zu hoch")
    assert found.figures[0].requirements[0].text == "✕ überschritten"


def test_the_points_of_the_thesis_have_its_figures_and_are_too_few_for_a_verdict():
    """V Table 3.3."""
    points = [ControlPoint("pt1", (100.0, 200.0, 300.0)), ControlPoint("pt2", (0.0, 0.0, 0.0))]
    measured = full({"pt1": [99.941, 199.988, 299.848], "pt2": [-0.056, 0.005, -0.047]})

    found = residuals(points, measured)

    row, (check,) = found.rows[0], found.figures
    assert (row.east_m, row.north_m, row.up_m) == pytest.approx((-0.059, -0.012, -0.152))
    assert row.d2_m == pytest.approx(0.060, abs=5e-4)
    assert row.d3_m == pytest.approx(0.163, abs=5e-4)
    assert check.mean_2d_m == pytest.approx(0.058, abs=5e-4)
    assert (check.mean_up_m, check.max_up_m) == pytest.approx((0.0995, 0.152))
    assert found.passed is None


@pytest.mark.parametrize(
    "text",
    [
        "Punkt;Hochwert;Rechtswert;Höhe\n1;2,5;1,5;3,5\n",
        "Code,Northing,Easting,Elevation,Name\nfence,2.5,1.5,3.5,1\n",
        "//Name X[mm] Y[mm] Z[mm]\n1 1500 2500 3500\n",
        "id\teast\tnorth\tup\tname of photo\n1\t1.5\t2.5\t3.5\tIMG 1\n",
        "EPSG:5514\n;;;\nčíslo bodu;sever;východ;výška\n1;2,5;1,5;3,5\n",
    ],
)
@pytest.mark.parametrize("encoding", ["utf-8", "utf-8-sig", "utf-16", "cp1250"])
def test_surveys_are_read_by_the_names_of_their_columns(text, encoding):
    found = read_control(text.replace("Höhe", "Hohe").encode(encoding, errors="replace"))

    assert [(p.id, p.xyz_m) for p in found.points] == [("1", (1.5, 2.5, 3.5))]
    assert found.skipped == ()


def test_real_tables_of_a_survey_are_asked_for_what_they_have_twice(data):
    file = data("control/mms-road") / "GCPs.csv"

    found = read_control(file.read_bytes(), name=file.name)
    answered = ["id", "y", "x", "-", "z", *["-"] * 14]
    chosen = read_control(file.read_bytes(), choice=ColumnChoice(tuple(answered)))

    assert found.table.question == "several columns have names of one coordinate."
    assert found.table.header[1:5] == (
        *("Northing", "Easting", "Orthometric Height", "Ellipsoidal Height"),
    )
    assert len(chosen.points) == 16 and chosen.points[0].id == "GCP01"
    assert chosen.points[0].xyz_m == (679471.773, 1527234.402, -28.270)


def test_points_of_a_topographic_list_are_asked_for_their_axes(data):
    file = data("control/topo-points") / "Test.txt"

    found = read_control(file.read_bytes())

    assert (len(found.points), len(found.skipped)) == (388, 58)  # numbers of points come twice
    assert "is 507830.722" in found.table.question
    assert found.points[0].xyz_m == (507830.722, 4273070.997, 66.914)


def test_roles_are_read_in_the_words_of_surveyors():
    rows = ["A,1,2,3,Passpunkt", "B,1,2,4,Kontrollpunkt", "C,2,2,3,GCP", "D,2,2,4,check point"]
    found = read_control("\n".join(["ID,X,Y,Z,Rolle", *rows]).encode())

    assert [one.role for one in found.points] == ["control", "check", "control", "check"]


def test_covariances_come_from_a_file_of_their_own_too():
    points = read_control(b"id,E,N,H\nA,1,2,3\nB,2,3,4\n").points
    table = "\ufeffPunkt;E;N;sE [mm];sN [mm];sH [mm]\nB;1,0;2,0;3;4;6,0\n"
    given = with_covariances(points, read_covariances(table.encode(), "k.csv"), "k.csv")

    assert given[0].covariance_m2 is None
    assert given[1].covariance_m2 == pytest.approx((9e-6, 0.0, 0.0, 1.6e-5, 0.0, 3.6e-5))


@pytest.mark.parametrize(
    ("table", "message"),
    [
        ("id,E,N\nA,1,2\n", "expected the columns id, sE, sN, sH"),
        ("id,sE,sN,sH\nA,0.01,0.01,\n", "line 2: 'A': expected a number"),
        ("id,sE,sN,sH\nA,1,1,1\nA,1,1,1\n", "line 3: 'A': is there already"),
        ("id,sE,sN,sH\nZ,1,1,1\n", "not in the survey: Z"),
    ],
)
def test_a_file_of_covariances_that_is_wrong_is_refused(table, message):
    points = read_control(b"id,E,N,H\nA,1,2,3\nB,2,3,4\n").points
    with pytest.raises(ConfigError, match=message):
        with_covariances(points, read_covariances(table.encode(), "k.csv"), "k.csv")


def test_a_row_that_is_no_point_is_listed_before_the_first_that_is_one_too():
    found = read_control(b"ID,X,Y,Z,role\nA,1,x,3,\nB,1,2,3,\nC,1,2,3,boss\n")

    assert [point.id for point in found.points] == ["B"]
    assert found.skipped == (
        "line 2: expected a number, got 'x'",
        "line 4: expected control or check, got 'boss'",
    )


def test_latitude_and_longitude_become_utm_of_the_place_or_the_system_that_is_given():
    text = b"\xef\xbb\xbflocal_id;lon;lat;height\nA;16,6;49,2;250,25\nB;16,601;49,2;251\n"
    found = read_control(text)
    given = read_control(text, crs="EPSG:5514")

    assert (found.crs, given.crs) == ("EPSG:32633", "EPSG:5514")
    assert found.table.question == ""
    assert found.points[0].xyz_m == pytest.approx((616556.553, 5450921.330, 250.25), abs=1e-3)
    east_m = found.points[1].xyz_m[0] - found.points[0].xyz_m[0]
    assert east_m == pytest.approx(72.9, abs=0.1)
    assert -7e5 < given.points[0].xyz_m[0] < -5e5
    with pytest.raises(GeoreferenceError, match="needs the grid us_nga_egm08_25"):
        read_control(text, crs="EPSG:32633+3855")
    with pytest.raises(CorruptFile, match="line 2: expected latitude and longitude in degrees"):
        read_control(b"id,lat,lon,height\nA,616546,5450898,250\n")
