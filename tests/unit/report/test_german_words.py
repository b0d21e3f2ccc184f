"""What files have in English stands in German in the report for the client."""

import re

import msgspec
import pytest

from recon4.evaluation.site_control import ControlOutcome, ControlRow
from recon4.georeference.control_blunders import Blunder, BlunderKind
from recon4.report.client_control import control_section
from recon4.report.client_words import words
from recon4.report.rows import placed_rows

SAY = words("de")
NAMES = {
    BlunderKind.FEET: (),
    BlunderKind.FEET_UP: (),
    BlunderKind.AXES: (),
    BlunderKind.NAMES: ("P1", "P2"),
    BlunderKind.POINT: ("P1",),
    BlunderKind.OFFSET: ("P1", "P2", "P3"),
    BlunderKind.CONTRADICTION: (),
}
"""All but those of a trial: a map is not put on points with other names."""


@pytest.mark.parametrize("kind", NAMES)
def test_accuracy_and_blunders_at_control_points_are_german(kind):
    known = Blunder(kind=kind, points=NAMES[kind], offset_m=(0.1, 0.2, -0.3))
    rows = (ControlRow("P1", "check", (0.01, 0.01), (0.0, 0.0, 0.0), (0.03, 0.04, 0.02), None),)
    outcome = ControlOutcome(
        crs="site grid", freedom=4, scale=1.0, points=rows, blunders=(known.text,)
    )

    section = control_section({"control": msgspec.to_builtins(outcome)}, SAY)
    said = " ".join(f"{row.label} {row.value}" for row in section.rows)
    labels = [row.label for row in section.rows if row.label]

    assert "RMSE_H = 5,2 cm an Kontrollpunkten (Anzahl: 1)" in said and "Lage 1 und Höhe 1" in said
    assert not re.search(r"\b(the|and|of|is|are|have)\b", said), said
    assert len({*labels}) == len(labels), "each label once"
    assert known.said("de") in said, "read from the file as it is said at once"
    if kind in {BlunderKind.POINT, BlunderKind.OFFSET}:
        assert "0,374 m (+0,100 E, +0,200 N, -0,300 H)" in said


def test_the_place_of_a_map_is_german():
    record = {
        "georeference": {
            "georeferenced": False,
            "frame": "x east, y north, z up; WGS 84, ellipsoidal height",
            "origin": {"lat_deg": 49.1, "height_m": 100.0},
            "rmse_enu_m": [0.01, 0.02, 0.03],
        },
        "crs": {"name": "site grid", "operation": "adjusted to control points"},
    }

    found = {SAY.label(name): SAY.value(text) for name, text in placed_rows(record, "de")}

    assert found == {
        "georeferenziert": "nein: allein Passpunkte haben sie platziert",
        "Achsen": "x Ost, y Nord, z nach oben; WGS 84, ellipsoidische Höhe",
        "Ursprung: Breite": "49,10000000 °",
        "Ursprung: Höhe": "100,000 m",
        "RMSE": "0,010, 0,020, 0,030 m (Ost, Nord, Höhe)",
        "Koordinatensystem: Name": "Baustellennetz",
        "Koordinatensystem: Transformation": "auf Passpunkte ausgeglichen",
    }
    assert SAY.value("no positions") == "no positions", "no half of a sentence is translated"


@pytest.mark.parametrize("fixes", [0, 90])
def test_a_map_on_control_points_has_their_heights_and_no_empty_rows_of_gnss(fixes):
    stated = {
        "georeferenced": True,
        "frame": "x east, y north, z up; WGS 84, ellipsoidal height",
        "fixes": fixes,
        "fixes_used": fixes,
        "rmse_enu_m": [None, None, None],
        "edges_rejected": [],
    }
    crs = {"name": "EPSG:25832", "operation": "UTM zone 32N", "accuracy_m": 1.0}
    outcome = ControlOutcome(crs="EPSG:25832", freedom=4, scale=1.0, points=())
    record = {"georeference": stated, "crs": crs, "control": msgspec.to_builtins(outcome)}

    found = {SAY.label(a): SAY.value(b) for a, b in placed_rows(record, "de", points=False)}

    assert found["Achsen"] == "x Ost, y Nord, z nach oben; Höhen der Passpunkte"
    assert not [name for name in found if "Genauigkeit" in name]
    assert ("RMSE" in found, "GNSS-Positionen" in found) == (fixes > 0, fixes > 0)
    with_heights = record | {"crs": crs | {"name": "EPSG:5514+8357"}}
    assert dict(placed_rows(with_heights))["frame"].endswith("WGS 84, ellipsoidal height")
