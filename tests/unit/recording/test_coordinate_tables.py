"""Columns of tables that people wrote: by name in several languages, else asked for."""

from pathlib import Path

import numpy as np
import pytest

from recon4.errors import ConfigError, CorruptFile, UnknownFormat
from recon4.recording.formats.reference_clouds import read_points
from recon4.recording.tables.clouds import preview_cloud
from recon4.recording.tables.column_names import column_name, parse_meanings
from recon4.recording.tables.coordinates import ColumnChoice

XYZ = np.array([[1.37, -2.302, -3.59], [-4.835, 3.133, 5.128], [1.066, 2.295, 1.436]])


def lines(template: str, points=XYZ) -> str:
    return "".join(
        template.format(k=k, x=x, y=y, z=z) + "\n" for k, (x, y, z) in enumerate(points.tolist())
    )


def written(folder: Path, text: str, *, encoding: str = "utf-8", name: str = "cloud.csv") -> Path:
    path = folder / name
    path.write_bytes(text.encode(encoding))
    return path


def read(path: Path, columns: str = "", unit=None) -> np.ndarray:
    choice = ColumnChoice(parse_meanings(columns), unit)
    return np.concatenate(list(read_points(path, choice)))


NAMED = {
    "id first": "id;x;y;z\n" + lines("{k};{x};{y};{z}"),
    "y x z": "y,x,z\n" + lines("{y},{x},{z}"),
    "German": "Punkt;Hochwert;Rechtswert;Höhe\n" + lines("{k};{y};{x};{z}"),
    "German, east first": "PktNr\tOstwert\tNordwert\tHöhe [m]\n" + lines("{k}\t{x}\t{y}\t{z}"),
    "Czech": "číslo bodu;sever;východ;výška\n" + lines("{k};{y};{x};{z}"),
    "French": "nom,Nord,Est,altitude\n" + lines("{k},{y},{x},{z}"),
    "Italian": "punto;Nord;Est;Quota\n" + lines("{k};{y};{x};{z}"),
    "Spanish": "punto;Norte;Este;Cota\n" + lines("{k};{y};{x};{z}"),
    "Polish": "nr;północ;wschód;wysokość\n" + lines("{k};{y};{x};{z}"),
    "English words": "Name,Northing,Easting,Elevation\n" + lines("P{k},{y},{x},{z}"),
    "letters": "No E N H\n" + lines("P{k} {x} {y} {z}"),
    "CloudCompare": "//X Y Z R G B\n" + lines("{x} {y} {z} 1 2 3"),
    "CloudCompare, counted": "//X,Y,Z,Rf,Gf,Bf\n3\n" + lines("{x},{y},{z},1,2,3"),
    "PDAL": '"X","Y","Z","Intensity"\n' + lines("{x},{y},{z},9"),
    "time first": "GpsTime,Intensity,X,Y,Z\n" + lines("1.5,9,{x},{y},{z}"),
    "ParaView": "Normals:0,Points:0,Points:1,Points:2\n" + lines("0.5,{x},{y},{z}"),
    "comment": "# made by a program\n# id x y z\n" + lines("{k} {x} {y} {z}"),
    "quoted cells": '"id";"x";"y";"z"\n' + lines('"{k}";"{x}";"{y}";"{z}"'),
    "quoted text with a separator": "id,x,y,z\n" + lines('"a, b",{x},{y},{z}'),
    "Excel": "sep=;\nid;x;y;z\n" + lines("{k};{x};{y};{z}"),
    "millimeters": "id;x [mm];y [mm];z [mm]\n" + lines("{k};{x};{y};{z}", XYZ * 1000),
    "feet": "z_ft,y_ft,x_ft\n" + lines("{z:.9f},{y:.9f},{x:.9f}", XYZ / 0.3048),
    "blank columns at the end": "id;x;y;z;;\n" + lines("{k};{x};{y};{z};;"),
    "other normals": "nx,ny,nz,x,y,z\n" + lines("0,0,1,{x},{y},{z}"),
}


@pytest.mark.parametrize("kind", NAMED)
def test_columns_are_found_by_their_names(tmp_path, kind):
    assert read(written(tmp_path, NAMED[kind])) == pytest.approx(XYZ)


@pytest.mark.parametrize("kind", ["German", "id first", "quoted cells"])
def test_decimal_commas_are_read_between_other_separators(tmp_path, kind):
    path = written(tmp_path, NAMED[kind].replace(".", ","))

    assert read(path) == pytest.approx(XYZ)


def test_quoted_decimal_commas_are_read_between_commas(tmp_path):
    body = lines('{k},"{x}","{y}","{z}"').replace(".", ",")

    assert read(written(tmp_path, "id,x,y,z\n" + body)) == pytest.approx(XYZ)


@pytest.mark.parametrize("encoding", ["utf-8-sig", "utf-16", "utf-16-le", "cp1252", "cp1250"])
@pytest.mark.parametrize("end", ["\n", "\r\n", "\r"])
def test_any_usual_encoding_and_line_end_is_read(tmp_path, encoding, end):
    text = NAMED["German"].replace("\n", end)

    assert read(written(tmp_path, text, encoding=encoding)) == pytest.approx(XYZ)


@pytest.mark.parametrize(
    ("text", "question"),
    [
        (lines("{k} {x} {y} {z}"), "the first one is like a point number"),
        (lines("P{k} {x} {y} {z}"), "the first one is like a point number"),
        (lines("{k};{x};{y};{z};code"), "the first one is like a point number"),
        ("a;b;c;d\n" + lines("{k};{x};{y};{z}"), "no column is named as x"),
        ("id;x;y\n" + lines("{k};{x};{y};{z}"), "does not name each column"),
        ("id;x;y;h1\n" + lines("{k};{x};{y};{z}"), "no column is named as z"),
        ("E,N,H,height\n" + lines("{x},{y},{z},9.5"), "several columns have names"),
        ("x,y,z,easting,northing\n" + lines("{x},{y},{z},1.5,2.5"), "columns x, y and columns"),
        ("x [furlong],y,z\n" + lines("{x},{y},{z}"), "the unit 'furlong'"),
        ("1,5,2,5,3,5\n2,5,2,5,3,5\n", "all numbers are whole"),
        ("y,x,z\n" + lines("{y},{x},{z}", XYZ + 5.4e6), "x may point north"),
        ("Y X Z\n600000.1 1100000.2 300.5\n600001.1 1100001.2 300.5\n", "S-JTSK"),
        ("600000.1 1100000.2 300.5\n600001.1 1100001.2 300.5\n", "S-JTSK"),
    ],
)
def test_what_is_not_certain_is_asked_with_the_first_row(tmp_path, text, question):
    path = written(tmp_path, text)

    with pytest.raises(ConfigError, match=r"--columns .*first row is") as caught:
        read(path)
    preview = preview_cloud(path)

    assert question in str(caught.value) and question in preview.question
    assert preview.rows[0] and len(preview.columns) >= 3


def test_an_answer_settles_the_columns_and_the_unit(tmp_path):
    path = written(tmp_path, lines("{k} {y} {x} {z} 7", XYZ * 1000))

    assert read(path, "id,y,x,z", "mm") == pytest.approx(XYZ)
    assert read(path, "-,n,e,h", "mm") == pytest.approx(XYZ)


def test_axes_of_s_jtsk_are_turned_as_proposed(tmp_path):
    path = written(tmp_path, "bod Y X Z\n1 600000.5 1100000.25 300.5\n2 600001.5 1100001 300.5\n")

    preview = preview_cloud(path)
    found = np.concatenate(list(read_points(path, ColumnChoice(preview.columns))))

    assert preview.columns == ("id", "-x", "-y", "z")
    assert found[0].tolist() == [-600000.5, -1100000.25, 300.5]


@pytest.mark.parametrize(
    ("header", "columns"),
    [("x,y,z", ("y", "x", "z")), ("y,x,z", ("x", "y", "z"))],
)
def test_the_place_of_the_map_tells_which_axis_is_north(tmp_path, header, columns):
    path = written(tmp_path, f"{header}\n5479997.1,3450001.2,3.5\n5479998.1,3450002.2,3.5\n")
    if header == "y,x,z":
        path = written(tmp_path, f"{header}\n3450001.2,5479997.1,3.5\n3450002.2,5479998.1,3.5\n")

    preview = preview_cloud(path, place=np.array([3450100.0, 5480100.0]))

    assert preview.columns == columns and not preview.question


def test_columns_of_a_plain_list_are_those_of_the_format_and_said(tmp_path):
    path = written(tmp_path, lines("{x} {y} {z} 200"), name="cloud.xyz")

    assert read(path) == pytest.approx(XYZ)
    assert preview_cloud(path).description == (
        "columns: x (east) = column 1, y (north) = column 2, z (height) = column 3; meters"
    )


def test_a_preview_says_how_a_named_table_is_read(tmp_path):
    preview = preview_cloud(written(tmp_path, NAMED["German"].replace(".", ",")))

    assert preview.question == "" and preview.columns == ("id", "y", "x", "z")
    assert preview.header == ("Punkt", "Hochwert", "Rechtswert", "Höhe")
    assert preview.rows[0] == ("0", "-2.302", "1.37", "-3.59")
    assert (preview.delimiter, preview.decimal) == (";", ",")
    assert "x (east) = Rechtswert, y (north) = Hochwert, z (height) = Höhe" in preview.description


@pytest.mark.parametrize("cell", ["1.234,567", "1'234.567", "1,234,567.5", "1 234,5", "1,234.5"])
def test_thousands_separators_are_refused_by_line(tmp_path, cell):
    text = f"id;x;y;z\n1;1,5;2,5;3,5\n2;{cell};2,5;3,5\n"

    with pytest.raises(CorruptFile, match=r"line 3: expected numbers without thousands"):
        read(written(tmp_path, text))


@pytest.mark.parametrize(
    ("text", "words"),
    [
        ("id x y z\nA1 1.5 2.5 3.5\nA 2 1.5 2.5 3.5\n", "line 3: expected 4 cells, got 5"),
        ("id;x;y;z\n1;1.5;2.5;3.5\n2;1.5;2.5\n", "line 3: expected 4 cells, got 3"),
        ("id;x;y;z\n1;1.5;2.5;3.5\n2;1.5;two;3.5\n", "line 3: expected a number, got 'two'"),
        ("5\n1.5 2.5 3.5 4\n1.5 2.5 3.5 4\n", "cut: 5 points promised, got 2"),
        ("dear all,\nno numbers here\n", "three numbers or more, got 'dear all,'"),
    ],
)
def test_rows_that_do_not_fit_are_named_not_moved(tmp_path, text, words):
    with pytest.raises(CorruptFile, match=words):
        read(written(tmp_path, text))


def test_an_empty_file_is_called_empty(tmp_path):
    with pytest.raises(UnknownFormat, match="empty"):
        read(written(tmp_path, ""))


def test_rows_may_differ_behind_the_coordinates(tmp_path):
    path = written(tmp_path, "1.5 2.5 3.5 corner of house\n1.5 2.5 4.5\n", name="a.xyz")

    assert read(path)[:, 2].tolist() == [3.5, 4.5]


@pytest.mark.parametrize(
    ("name", "meaning", "unit"),
    [
        ("Souřadnice Y [m]", "y", "m"),
        ("X(ftUS)", "x", "us-ft"),
        ("y_us_ft", "y", "us-ft"),
        ("Easting m", "x", "m"),
        ("Ellipsoidal Height", "z", None),
        ("nx", "-", None),
        ("sd_e_m", "se", "m"),
        ("Latitude", "lat", None),
        ("Číslo bodu", "id", None),
    ],
)
def test_names_are_compared_without_accents_case_and_units(name, meaning, unit):
    found = column_name(name)

    assert (found.meaning, found.unit) == (meaning, unit)


@pytest.mark.parametrize("text", ["x,y", "x,x,y,z", "x,y,z,what", "id,lat,lon"])
def test_columns_that_name_no_place_are_refused(text):
    with pytest.raises(ConfigError, match="columns: expected"):
        parse_meanings(text)
