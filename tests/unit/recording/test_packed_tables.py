"""Lists of points whose rows or coordinates stand in one cell."""

import pytest

from recon4.recording.tables.coordinates import ColumnChoice
from recon4.recording.tables.points import read_point_table, unpacked

POINTS = {"A1": (678411.56, 1527288.55, -29.36), "A2": (678679.559, 1527097.68, -28.81)}


def row(name, sign):
    return sign.join(map(str, POINTS[name]))


def table(head, *, sign=";", outer=",", decimal="."):
    """Points with their coordinates in parentheses."""
    body = [f"{n}{outer}({row(n, sign).replace('.', decimal)})" for n in POINTS]
    return "\n".join([head, *body, ""])


WRITTEN = {
    "whole rows": f'"Name;E;N;h"\n"A1;{row("A1", ";")}"\n"A2;{row("A2", ";")}"\n',
    "whole rows, commas": f'"Name,E,N,h"\n"A1,{row("A1", ",")}"\n"A2,{row("A2", ",")}"\n',
    "empty cells behind": f'"Name,E,N,h",,\n"A1,{row("A1", ",")}",,\n"A2,{row("A2", ",")}",,\n',
    "a group": table("Name,(E;N;h)"),
    "a group with a name": table("Name,Position (E;N;h)"),
    "commas in the group": table("Name;(E,N,h)", sign=",", outer=";"),
    "commas all over": table("Name,(E,N,h)", sign=","),
    "decimal commas": table("Name,(E;N;h)", decimal=","),
}


@pytest.mark.parametrize("text", WRITTEN.values(), ids=WRITTEN)
def test_rows_and_coordinates_in_one_cell_are_read(text):
    found = read_point_table(text.encode(), "gcp.csv")

    assert (found.preview.question, found.skipped) == ("", ())
    assert {point.name: point.xyz_m for point in found.points} == POINTS


def test_groups_without_names_of_their_values_are_asked_for_and_can_be_chosen():
    head = "NO,Strip,MMS_measure,RTK_measure"
    body = [f"{n},strip_{n}.las,(1.5;2.5;3.5),({row(n, ';')})" for n in POINTS]
    data = "\r\n".join([head, *body, ""]).encode()

    asked = read_point_table(data, "gcp.csv")
    choice = ColumnChoice(("id", "-", "-", "-", "-", "x", "y", "z"))
    found = read_point_table(data, "gcp.csv", choice=choice)

    assert "no column is named" in asked.preview.question
    assert asked.preview.header[2:6] == (*[f"MMS_measure {k}" for k in (1, 2, 3)], "RTK_measure 1")
    assert {point.name: point.xyz_m for point in found.points} == POINTS


@pytest.mark.parametrize(
    "text",
    [
        "Name;E;N;h\nA1;1.5;2.5;3.5\n",
        "x [m],y (m),z (m)\n1.5,2.5,3.5\n",
        '"A 1","1,5","2,5","3,5"\n',
        "Pole (left; old);1.5;2.5;3.5\nPole (12; 14);4.5;2.5;3.5\nA;1;2;3\nB;1;2;3\n",
    ],
)
def test_other_tables_stay_as_they_are(text):
    assert unpacked(text) == text
