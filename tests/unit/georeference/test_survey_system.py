"""A survey that is not in the system that is said: what it would be in place of it."""

import numpy as np
import pytest

from recon4.errors import GeoreferenceError
from recon4.georeference.crs import CrsTransform, origin_near
from recon4.georeference.survey_system import survey_system

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
