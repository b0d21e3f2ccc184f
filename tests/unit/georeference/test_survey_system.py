"""A survey that is not in the system that is said: what it would be in place of it."""

import numpy as np
import pytest

from recon4.errors import GeoreferenceError
from recon4.georeference.crs import CrsTransform, origin_near
from recon4.georeference.crs_file import read_crs
from recon4.georeference.survey_system import survey_system
from recon4.store.atomic import write_json

AT = np.array([456_789.123, 5_429_876.543, 112.3])
FOOT_M = 0.3048
ZONE = np.array([32e6, 0.0, 0.0])
GNSS = origin_near("EPSG:25832", AT)


@pytest.mark.parametrize("origin", [None, GNSS])
def test_a_right_survey_is_where_it_says(origin):
    there = survey_system("EPSG:25832", AT, origin=origin)
    assert np.abs(there.to_crs(there.to_map(AT[None])) - AT).max() < 1e-3


@pytest.mark.parametrize("origin", [None, GNSS])
@pytest.mark.parametrize(
    ("p_crs", "words"),
    [
        (AT[[1, 0, 2]], "with easting and northing exchanged they are there"),
        (AT / FOOT_M, "as feet they are there"),
        (AT[[1, 0, 2]] / FOOT_M, "as feet with easting and northing exchanged they are there"),
        (AT + ZONE, "without the number of the zone before the easting they are there"),
    ],
)
def test_another_reading_that_lies_there_is_named(p_crs, words, origin):
    with pytest.raises(GeoreferenceError, match=words):
        survey_system("EPSG:25832", p_crs, origin=origin)


def test_another_zone_than_that_of_gnss_is_named():
    with pytest.raises(GeoreferenceError, match=r"are 439 km from .* GNSS .*; in EPSG:25832 they"):
        survey_system("EPSG:25833", AT, origin=GNSS)


def test_a_place_outside_of_the_area_of_a_system_is_said():
    with pytest.raises(GeoreferenceError, match=r"latitude 42\.56°, longitude -28\.00°, where"):
        survey_system("EPSG:31467", AT)


def test_a_grid_that_is_missing_is_still_named():
    with pytest.raises(GeoreferenceError, match=r"needs the grid .*\.tif"):
        survey_system("EPSG:25832+7837", AT)


GAUSS_KRUEGER = np.array([3_564_800.12, 5_519_300.45, 180.0])
"""In EPSG:31467, whose grid (BETA2007) is not installed where tests run."""


def test_points_that_place_a_map_alone_need_no_grid_of_a_datum(tmp_path):
    placed = survey_system("EPSG:31467", GAUSS_KRUEGER)

    assert placed.missing_grids == ("de_adv_BETA2007.tif",) and placed.accuracy_m == 3.0
    around = GAUSS_KRUEGER + np.array([[0.0, 0.0, 0.0], [300.0, 200.0, 5.0]])
    p_map = placed.to_map(around)
    assert np.abs(placed.to_crs(p_map) - around).max() < 1e-3
    span_m = np.linalg.norm(p_map[1] - p_map[0])
    assert abs(span_m / np.linalg.norm(around[1] - around[0]) - 1.0) < 2e-4, "scale of the grid"

    origin = {
        "lat_deg": np.rad2deg(placed.origin.lat_rad),
        "lon_deg": np.rad2deg(placed.origin.lon_rad),
        "height_m": placed.origin.ellipsoidal_height_m,
    }
    own = {"name": "EPSG:31467", "operation": placed.operation}
    write_json(tmp_path / "georeference.json", {"crs": own, "georeference": {"origin": origin}})
    again = read_crs(tmp_path)
    assert np.allclose(again.to_crs(p_map), around, atol=1e-3), "read as it was put there"
    with pytest.raises(GeoreferenceError, match=r"EPSG:31467 needs the grid de_adv_BETA2007"):
        read_crs(tmp_path, "EPSG:25832")


def test_fixes_that_place_a_map_need_the_grid_of_a_datum():
    with pytest.raises(GeoreferenceError, match=r"EPSG:31467 needs the grid de_adv_BETA2007"):
        survey_system("EPSG:31467", GAUSS_KRUEGER, origin=origin_near("EPSG:31467", GAUSS_KRUEGER))


def test_a_grid_that_is_missing_does_not_hide_exchanged_axes():
    said = "latitude .* longitude .* exchanged they are there"
    with pytest.raises(GeoreferenceError, match=said):
        survey_system("EPSG:25832+7837", AT[[1, 0, 2]])
    with pytest.raises(GeoreferenceError, match=r"needs the grid [^;]*\.tif; .* --file \S+\.tif$"):
        survey_system("EPSG:25833+7837", AT)


@pytest.mark.parametrize(("crs", "zone"), [("EPSG:31467", 3), ("EPSG:4647", 32)])
def test_a_zone_number_that_is_missing_is_named(crs, zone):
    said = f"with the number of the zone, {zone}, before the easting they are there"
    with pytest.raises(GeoreferenceError, match=said):
        survey_system(crs, AT)


def test_a_bare_number_is_a_code():
    assert CrsTransform(GNSS, "25832").crs == "EPSG:25832"
