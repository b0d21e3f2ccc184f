"""The findings of a map as CSV and GeoJSON."""

import csv
import json

import numpy as np
import pytest
from typer.testing import CliRunner

from recon4.cli.main import app
from recon4.errors import ConfigError, StoreError
from recon4.export.findings import export_findings, findings_file
from recon4.findings.wording import said, text_of
from recon4.model.finding import Finding, Level
from recon4.model.finding_kinds import FindingKind
from recon4.store.project import read_artifacts
from recon4.store.seal import changing
from tests.project_builder import build_project, loop_walk, write_summary

WALK = loop_walk()
WEAK = Finding(
    kind=FindingKind.WEAK_DIRECTION,
    level=Level.CHECK,
    span_s=(40.0, 44.0),
    direction="horizontal",
    values={"known": True, "sd_m": 0.4},
)
LOST_ONCE = Finding(kind=FindingKind.TOO_FAST, level=Level.NOTE, span_s=(7.0, 7.0))
REMARK = Finding(
    kind=FindingKind.IMPORT_REMARK, level=Level.NOTE, values={"text": '=HYPERLINK(1), "x"'}
)
ORIGIN = {"lat_deg": 49.5, "lon_deg": 15.5, "height_m": 400.0}


@pytest.fixture
def project(tmp_path):
    """A map that is not georeferenced, with three findings."""
    root = tmp_path / "office"
    build_project(root, points=1000)
    with changing(root, "summary.json", compared=False):
        summary = json.loads((root / "summary.json").read_text())
        findings = [said(one) for one in (WEAK, LOST_ONCE, REMARK)]
        write_summary(root, summary | {"findings": findings})
    return root


@pytest.fixture
def georeferenced(project):
    """The same map with a place on earth."""
    file = read_artifacts(project)["level"] / "georeference.json"
    record = {"georeference": {"origin": ORIGIN}, "crs": {"name": "EPSG:32633"}}
    file.write_text(json.dumps(record))
    return project


def features_of(project):
    return json.loads(findings_file(project, ".geojson")[1])["features"]


def rows_of(project):
    text = findings_file(project, ".csv")[1]
    comment, table = text.split("\n", 1)
    return comment, list(csv.DictReader(table.splitlines()))


def test_a_stretch_is_the_line_of_the_walk_a_moment_a_point_and_the_rest_has_no_place(project):
    stretch, moment, whole = (feature["geometry"] for feature in features_of(project))

    assert stretch["type"] == "LineString"
    np.testing.assert_allclose(stretch["coordinates"], WALK.T_a_b.t[400:441], atol=1e-3)
    assert moment["type"] == "Point"
    np.testing.assert_allclose(moment["coordinates"], WALK.T_a_b.t[70], atol=1e-3)
    assert whole is None


def test_a_feature_says_what_was_found_and_in_which_coordinates(project):
    properties = features_of(project)[0]["properties"]

    assert properties["kind"] == "WEAK-DIRECTION"
    assert properties["level"] == "check"
    assert properties["text"] == text_of(WEAK)
    assert properties["values"] == {"known": True, "sd_m": 0.4}
    assert "not georeferenced" in properties["coordinates"]


def test_of_a_georeferenced_map_lines_are_in_longitude_and_latitude(georeferenced):
    feature = features_of(georeferenced)[0]
    lon, lat, height = np.array(feature["geometry"]["coordinates"]).T
    east_m, north_m, up_m = WALK.T_a_b.t[400:441].T

    meters_per_deg = 111_240.0  # of latitude at 49.5 degrees, within 0.1 %
    np.testing.assert_allclose((lat - 49.5) * meters_per_deg, north_m, rtol=2e-3)
    east = (lon - 15.5) * 111_320.0 * np.cos(np.deg2rad(49.5))
    np.testing.assert_allclose(east, east_m, rtol=5e-3)
    np.testing.assert_allclose(height - 400.0, up_m, atol=1e-2)
    assert "WGS 84" in feature["properties"]["coordinates"]


def test_a_gis_takes_a_map_without_a_place_for_local_coordinates(project, tmp_path):
    import pyogrio

    path = tmp_path / "findings.geojson"
    export_findings(project, path)

    assert pyogrio.read_info(path)["crs"].startswith('LOCAL_CS["map frame: not georeferenced"')


def test_in_longitude_and_latitude_the_file_is_that_of_rfc_7946(georeferenced):
    record = json.loads(findings_file(georeferenced, ".geojson")[1])

    assert record.keys() == {"type", "features"}


def test_the_table_has_both_ends_in_the_crs_of_the_map(project, georeferenced):
    comment, rows = rows_of(georeferenced)

    assert "EPSG:32633" in comment
    assert [row["kind"] for row in rows] == ["WEAK-DIRECTION", "TOO-FAST", "IMPORT-REMARK"]
    assert (rows[0]["start_s"], rows[0]["end_s"]) == ("40.0", "44.0")
    assert float(rows[0]["from_northing_m"]) == pytest.approx(5_483_000, abs=5000)
    assert rows[2]["from_easting_m"] in (None, "")


def test_a_cell_is_no_formula_and_quotes_are_kept(project):
    comment, rows = rows_of(project)

    assert "map frame" in comment
    assert rows[2]["text"] == '\'=HYPERLINK(1), "x"'
    assert float(rows[0]["from_x_m"]) == pytest.approx(WALK.T_a_b.t[400, 0], abs=1e-3)


def test_the_command_writes_the_file_that_its_ending_names(project, tmp_path):
    for name in ("findings.csv", "findings.geojson"):
        done = CliRunner().invoke(app, ["export", str(project), str(tmp_path / name)])
        assert "3 findings" in done.output, done.output
        assert done.exit_code == 0
        assert (tmp_path / name).stat().st_size > 200


def test_a_map_of_an_earlier_version_and_another_ending_are_refused(tmp_path, project):
    build_project(tmp_path / "old", points=1000)
    with pytest.raises(StoreError, match="recon4 audit"):
        export_findings(tmp_path / "old", tmp_path / "findings.csv")
    assert not (tmp_path / "findings.csv").exists()
    with pytest.raises(ConfigError, match=r"\.csv or \.geojson"):
        export_findings(project, tmp_path / "findings.shp")
