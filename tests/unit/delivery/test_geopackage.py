"""A GeoPackage of a map, opened with GDAL."""

import json
import sqlite3
from contextlib import closing

import numpy as np
import pytest

from recon4.delivery.exports import export_file
from recon4.errors import NoSpace, StoreError
from recon4.export.geopackage import Feature, FeatureLayer, write_geopackage
from recon4.export.options import ExportOptions
from recon4.findings.wording import said
from recon4.georeference.crs import CrsTransform, GeodeticOrigin
from recon4.georeference.site_grid import SiteGrid
from recon4.locales.coded import said as in_language
from recon4.model.finding import Finding, Level
from recon4.model.finding_kinds import FindingKind
from recon4.model.site_control import SITE_GRID, SeenTarget, SiteControl
from recon4.progress import Silent
from recon4.review.decisions import Decision, DecisionKind
from recon4.review.journal import append
from recon4.store.project import read_artifacts
from recon4.store.seal import changing
from recon4_app.annotations.model import NewNote
from recon4_app.annotations.store import add_note
from tests.full_disk import files_end_at
from tests.project_builder import build_project, loop_walk, write_summary

WALK = loop_walk()
ORIGIN = {"lat_deg": 49.5, "lon_deg": 15.5, "height_m": 400.0}
WEAK = Finding(kind=FindingKind.WEAK_DIRECTION, level=Level.CHECK, span_s=(40.0, 44.0))
WHOLE = Finding(kind=FindingKind.FOLDER_DESCRIPTION, level=Level.NOTE)
RESIDUAL = {"id": "P1", "role": "control", "sd_m": [0.01, 0.02], "rigid_m": [0.0, 0.0, 0.0],
            "adjusted_m": [0.003, -0.004, None]}  # fmt: skip


def _layer(*places, kind="POINT", name="spots"):
    features = [
        Feature(np.array(p, float), {"k": k, "text": "ä", "size": float("nan")})
        for k, p in enumerate(places)
    ]
    return FeatureLayer(name, "Spots", kind, {"k": int, "text": str, "size": float}, features)


def _write(tmp_path, place, *places, kind="POINT"):
    path = tmp_path / "50% a#b?.gpkg"  # no name is an address
    write_geopackage(path, [_layer(*places, kind=kind)], place, changed="2026-01-02T03:04:05Z")
    return path


def _read(path, layer):
    """Name of the system, kind of geometry, WKB and columns, as GDAL reads them."""
    import pyogrio

    about, _, wkb, columns = pyogrio.raw.read(path, layer=layer)
    return about, wkb, dict(zip(about["fields"].tolist(), columns, strict=True))


def _points(wkb):
    """Coordinates of a point or a line in ISO or extended WKB with z."""
    at = 5 if len(wkb) == 5 + 24 else 9
    return np.frombuffer(wkb, "<f8", offset=at).reshape(-1, 3)


@pytest.fixture
def project(tmp_path):
    """A map in a grid of the site, with findings, a note and a control point."""
    root = tmp_path / "office"
    build_project(root, points=1000)
    with changing(root, "summary.json", compared=False):
        summary = json.loads((root / "summary.json").read_text())
        write_summary(root, summary | {"findings": [said(one) for one in (WEAK, WHOLE)]})
    _place(root, {"name": SITE_GRID, "origin_m": [1000.0, 2000.0, 30.0]})
    add_note(root, NewNote(p_map=(1.0, 2.0, 0.5), text="crack", key="a" * 16), "Eva")
    seen = SeenTarget(id="P1", xyz_m=(1003.0, 2004.0, 31.0), role="control", sd_m=(0.01, 0.02),
                      t_ns=(1,), p_body_m=((0.0, 0.0, 0.0),),
                      directions_body=(((1.0, 0.0, 0.0),),))  # fmt: skip
    control = SiteControl(targets=(seen,), crs="")
    append(root, Decision(kind=DecisionKind.CONTROL, who="Eva", control=control))
    return root


def _place(root, crs):
    record = {"georeference": {"origin": ORIGIN}, "crs": crs, "control": {
        "crs": crs["name"], "freedom": 1, "scale": 1.0, "points": [RESIDUAL]}}  # fmt: skip
    (read_artifacts(root)["level"] / "georeference.json").write_text(json.dumps(record))


def _export(root, tmp_path, **options):
    made = export_file(
        root, "layers.gpkg", tmp_path, options=ExportOptions(**options), progress=Silent()
    )
    return tmp_path / made.name, made


def test_gdal_reads_every_layer_of_a_map_in_a_site_grid(project, tmp_path):
    import pyogrio

    path, made = _export(project, tmp_path)
    shift = np.array([1000.0, 2000.0, 30.0])

    points = ("control_points", "findings", "notes", "double_walls")
    lines = ("trajectory", "finding_stretches")
    assert dict(pyogrio.list_layers(path).tolist()) == {
        **dict.fromkeys(points, "Point Z"),
        **dict.fromkeys(lines, "LineString Z"),
    }
    about, wkb, columns = _read(path, "trajectory")
    assert _points(wkb[0]) == pytest.approx(WALK.T_a_b.t + shift)
    assert columns["poses"].tolist() == [len(WALK)]
    assert "EPSG" not in about["crs"]
    assert "site grid" in about["crs"]
    _, wkb, columns = _read(path, "control_points")
    assert _points(wkb[0]).tolist() == [[1003.0, 2004.0, 31.0]]
    assert columns["east_off_m"].tolist() == [0.003]
    assert np.isnan(columns["up_off_m"]).all()
    _, wkb, columns = _read(path, "notes")
    assert (_points(wkb[0]) - shift).tolist() == [[1.0, 2.0, 0.5]]
    assert (columns["who"][0], columns["text"][0]) == ("Eva", "crack")
    _, wkb, columns = _read(path, "findings")
    assert columns["kind"].tolist() == [str(WEAK.kind), str(WHOLE.kind)]
    assert [one is None for one in wkb] == [False, True]
    assert len(_points(_read(path, "finding_stretches")[1][0])) > 2
    assert made.text.startswith("trajectory (1), control and check points (1), findings (2)")
    assert in_language(made.text, "de").startswith("Trajektorie (1), Pass- und Kontrollpunkte (1)")


def test_the_same_map_gives_the_same_bytes_and_another_system_other_ones(project, tmp_path):
    _place(project, {"name": "EPSG:32633"})
    utm, other = tmp_path / "utm", tmp_path / "other"
    utm.mkdir()
    other.mkdir()
    path, made = _export(project, utm)
    assert _export(project, utm)[1].sha256 == made.sha256
    assert _read(path, "trajectory")[0]["crs"] == "EPSG:32633"
    moved, _ = _export(project, other, crs="EPSG:25833")
    assert _read(moved, "trajectory")[0]["crs"] == "EPSG:25833"
    assert np.linalg.norm(
        _points(_read(moved, "trajectory")[1][0]) - _points(_read(path, "trajectory")[1][0]), axis=1
    ).max() < 0.01  # fmt: skip


def test_a_system_without_a_code_of_its_own_is_no_epsg_code(tmp_path):
    path = _write(tmp_path, SiteGrid((1.0, 2.0, 3.0)), [[0, 0, 0]])
    about, wkb, columns = _read(path, "spots")
    assert "site grid" in about["crs"]
    assert "EPSG" not in about["crs"]
    assert _points(wkb[0]).tolist() == [[1.0, 2.0, 3.0]]
    assert (columns["text"][0], np.isnan(columns["size"][0])) == ("ä", True)
    own = "+proj=tmerc +lat_0=49.5 +lon_0=15.5 +ellps=GRS80 +towgs84=0,0,0 +units=m"
    place = CrsTransform(GeodeticOrigin(*np.deg2rad([49.5, 15.5]).tolist(), 400.0), own)
    about, wkb, _ = _read(_write(tmp_path, place, [[1, 2, 3]]), "spots")
    assert "Transverse_Mercator" in about["crs"]
    assert _points(wkb[0])[0, :2] == pytest.approx([1.0, 2.0], abs=1e-3)


def test_a_local_map_has_no_system(tmp_path):
    lines = ([[1, 2, 3], [1, 1, 3]], [[0, 0, 0], [1, 1, 1]])
    path = _write(tmp_path, None, *lines, kind="LINESTRING")
    with closing(sqlite3.connect(path)) as file:
        kinds = file.execute("SELECT geometry_type_name, srs_id FROM gpkg_geometry_columns")
        assert kinds.fetchall() == [("LINESTRING", -1)]
        assert file.execute("PRAGMA application_id").fetchone() == (0x47504B47,)
        bounds = file.execute("SELECT min_x, min_y, max_x, max_y FROM gpkg_contents").fetchone()
        assert bounds == (0.0, 0.0, 1.0, 2.0)


def test_a_full_disk_is_named_and_leaves_nothing(tmp_path):
    path = tmp_path / "a.gpkg"
    with files_end_at(40_000), pytest.raises(NoSpace, match=f"writing {path};"):
        write_geopackage(path, [_layer([[0, 0, 0]])], None, changed="2026-01-02T03:04:05Z")
    assert list(tmp_path.iterdir()) == []


def test_nothing_is_left_of_a_file_that_cannot_be_written(tmp_path):
    odd = FeatureLayer(
        "spots", "Spots", "POINT", {"k": int}, [Feature(np.zeros((1, 3)), {"k": object()})]
    )
    with pytest.raises(StoreError, match=r"a\.gpkg cannot be written"):
        write_geopackage(tmp_path / "a.gpkg", [odd], None, changed="2026-01-02T03:04:05Z")
    assert list(tmp_path.iterdir()) == []
