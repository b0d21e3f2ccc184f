"""Tables of the report: labels and units instead of field names."""

from pathlib import Path

import numpy as np
import pytest

from recon4.findings.walk_record import WalkRecord
from recon4.model.finding import Level
from recon4.model.finding_kinds import FindingKind
from recon4.report.assessment import assess
from recon4.report.figures import broken_at_holes
from recon4.report.html import render
from recon4.report.rows import imported_rows, placed_rows, quantity
from tests.said import found_in
from tests.unit.report.test_report import facts  # noqa: F401

TIME = ("t first", "2014-11-04 02:46:49.554 (sensor's clock, UTC)")


@pytest.mark.parametrize(
    ("name", "value", "row"),
    [
        ("roll_deg", -0.0, ("roll", "0.000 °")),
        ("lat_deg", 49.2265, ("latitude", "49.22650000 °")),
        ("height_m", 276.76837, ("height", "276.768 m")),
        ("rotation_hz", 19.9714, ("rotation", "19.97 Hz")),
        ("rmse_enu_m", [0.28767, 0.2, 0.5], ("rmse", "0.288, 0.200, 0.500 m (east, north, up)")),
        ("spread_deg", None, ("spread", "–")),
        ("points_near", 12_345, ("points near", "12\u202f345")),
        ("usable", True, ("usable", "yes")),
        ("t_first_ns", 1415069209554522896, TIME),
        ("t_last_ns", 2_200_000_000, ("t last", "2.200 s (a clock without a date)")),
    ],
)  # fmt: skip
def test_quantities_have_their_unit(name, value, row):
    assert quantity(name, value) == row


def test_a_map_that_is_not_leveled_has_no_angles():
    placed = {
        "levelling": {"source": "none", "roll_deg": 0.0, "spread_deg": None},
        "georeference": {"georeferenced": False, "reason": "no-gnss", "fixes_usable": None},
    }

    rows = dict(placed_rows(placed))

    assert rows["leveled by"].startswith("not leveled")
    assert rows["georeferenced"] == "no"
    assert rows["reason"] == "there is no GNSS in the recording"
    assert "fixes usable" not in rows
    assert not [name for name in rows if "roll" in name]


def test_loop_closures_that_contradict_gnss_are_counted_and_not_listed(facts):  # noqa: F811
    georeference = {"georeferenced": True, "edges_rejected": [12, 40]}
    nothing = georeference | {"edges_rejected": []}

    rows = dict(placed_rows({"georeference": georeference}))
    found = found_in(WalkRecord(georeference={"georeference": georeference}))
    none = found_in(WalkRecord(georeference={"georeference": nothing}))

    assert rows["loop closures rejected by GNSS priors"] == "2"
    assert "edges rejected" not in rows
    against = [one for one in found if one.kind is FindingKind.LOOPS_AGAINST_GNSS]
    assert [(one.level, one.values["count"]) for one in against] == [(Level.NOTE, 2)]
    assert not [one for one in none if one.kind is FindingKind.LOOPS_AGAINST_GNSS]


def test_import_names_each_sensor_and_what_is_missing():
    report = {
        "sensors": [{"name": "lidar", "model": "VLP-16", "port": 2368, "points": 699_704}],
        "duration_ns": 50_000_000,
        "counts": {"points_near": 696},
        "gaps": [],
        "imu": None,
        "warnings": ["shown elsewhere"],
    }

    rows = imported_rows(report)

    assert rows == [
        ("sensor lidar", "VLP-16, port 2368, 699\u202f704 points"),
        ("length of a multiframe", "50.0 ms"),
        ("count: points: nearer than ingest.min_range_m", "696"),
        ("gaps", "none"),
        ("IMU", "none"),
    ]


def test_a_map_that_is_not_level_is_a_warning_and_not_called_z_up(facts, tmp_path: Path):  # noqa: F811
    unlevel = '{"levelling": {"source": "none"}}'
    (tmp_path / "level" / "georeference.json").write_text(unlevel)

    page = render(assess(facts))
    found = found_in(WalkRecord(georeference={"levelling": {"source": "none"}}))

    assert "local map frame, not leveled (meters)" in page
    assert [(one.kind, one.level) for one in found] == [(FindingKind.NOT_LEVELED, Level.CHECK)]
    assert not found_in(WalkRecord(georeference={"levelling": {"source": "imu"}}))


def test_no_line_is_drawn_over_a_hole_in_a_curve():
    x = np.array([0.0, 1.0, 2.0, 9.0, 10.0])

    at, shown = broken_at_holes(x, np.arange(5))

    assert np.isnan(at).tolist() == [False, False, False, True, False, False]
    assert shown[~np.isnan(at)].tolist() == [0, 1, 2, 3, 4]
