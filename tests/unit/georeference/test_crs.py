import os
from pathlib import Path

import numpy as np
import pytest

from recon4.errors import GeoreferenceError
from recon4.georeference.crs import CrsTransform, GeodeticOrigin, to_enu, to_geodetic

BRNO = GeodeticOrigin(np.deg2rad(49.2), np.deg2rad(16.6), 250.0)


def test_a_second_of_arc_north_is_30_9_m() -> None:
    p = to_enu(
        BRNO,
        BRNO.lat_rad + np.deg2rad([1 / 3600]),
        np.array([BRNO.lon_rad]),
        ellipsoidal_height_m=np.array([250.0]),
    )

    # Radius of the meridian at 49.2 degrees on WGS 84, plus the height.
    a, e2, s = 6378137.0, 0.00669437999014, np.sin(BRNO.lat_rad)
    meridian = a * (1 - e2) / (1 - e2 * s**2) ** 1.5 + 250.0
    np.testing.assert_allclose(p[0], [0, meridian * np.deg2rad(1 / 3600), 0], atol=1e-4)


def test_geodetic_and_local_are_inverse() -> None:
    p = np.random.default_rng(1).uniform(-3000, 3000, (50, 3))

    lat, lon, height = to_geodetic(BRNO, p)

    np.testing.assert_allclose(to_enu(BRNO, lat, lon, ellipsoidal_height_m=height), p, atol=1e-6)


def test_without_a_choice_the_utm_zone_of_the_place_is_taken() -> None:
    assert CrsTransform(BRNO).crs == "EPSG:32633"
    assert (
        CrsTransform(GeodeticOrigin(np.deg2rad(-33.9), np.deg2rad(18.4), 0.0)).crs == "EPSG:32734"
    )


def test_the_central_meridian_of_utm_is_500_km_and_its_scale_0_9996() -> None:
    on_meridian = GeodeticOrigin(np.deg2rad(49.0), np.deg2rad(15.0), 0.0)
    p = np.array([[0.0, 0, 0], [100.0, 0, 0], [0, 0, 12.0]])

    q = CrsTransform(on_meridian).to_crs(p)

    assert q[0, 0] == pytest.approx(500_000.0, abs=1e-4)
    assert q[1, 0] - q[0, 0] == pytest.approx(99.96, abs=1e-3)
    assert q[2, 2] == pytest.approx(12.0, abs=1e-6)


def test_the_offset_is_a_multiple_of_a_kilometer_near_the_origin() -> None:
    transform = CrsTransform(BRNO)

    assert np.all(transform.storage_offset % 1000.0 == 0.0)
    assert np.all(np.abs(transform.to_crs(np.zeros((1, 3)))[0] - transform.storage_offset) <= 500.0)


def test_krovak_uses_the_operation_of_the_country_not_the_first_in_the_list() -> None:
    transform = CrsTransform(BRNO, "EPSG:5514")

    assert transform.accuracy_m <= 1.0
    assert transform.to_crs(np.zeros((1, 3)))[0, 2] == pytest.approx(250.0)
    assert "S-JTSK" in transform.wkt


@pytest.mark.parametrize("crs", ["EPSG:32633", "EPSG:5514"])
def test_surveyed_coordinates_come_back_as_they_were_given(crs: str) -> None:
    transform = CrsTransform(BRNO, crs)
    p = np.random.default_rng(2).uniform(-500, 500, (20, 3))

    np.testing.assert_allclose(transform.to_map(transform.to_crs(p)), p, atol=1e-6)


def test_a_height_system_without_its_grid_is_refused_by_name() -> None:
    if any((Path(folder) / "cz_cuzk_CR-2005.tif").exists() for folder in data_folders()):
        transform = CrsTransform(BRNO, "EPSG:5514+8357")
        # The quasi-geoid lies some 44 m above the ellipsoid there.
        assert 200.0 < transform.to_crs(np.zeros((1, 3)))[0, 2] < 212.0
        return

    with pytest.raises(GeoreferenceError, match=r"cz_cuzk_CR-2005\.tif"):
        CrsTransform(BRNO, "EPSG:5514+8357")


def data_folders() -> list[str]:
    from pyproj.datadir import get_data_dir, get_user_data_dir

    return [*get_data_dir().split(os.pathsep), get_user_data_dir()]


@pytest.mark.parametrize(
    ("crs", "message"),
    [
        ("EPSG:999999", "no coordinate reference system"),
        ("nonsense", "no coordinate reference system"),
        ("EPSG:4326", "not a map projection in meters"),
        ("EPSG:2229", "not in meters"),
    ],
)
def test_a_crs_that_is_not_in_meters_is_rejected(crs: str, message: str) -> None:
    with pytest.raises(GeoreferenceError, match=message):
        CrsTransform(BRNO, crs)
