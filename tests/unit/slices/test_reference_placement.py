"""CRS and units of reference files: converted and said, or refused."""

import laspy
import numpy as np
import pytest
from pyproj import CRS, Transformer

from recon4.errors import ConfigError
from recon4.georeference.crs import CrsTransform, GeodeticOrigin
from recon4.recording.formats.cloud_crs import StatedCrs, stated_crs
from recon4.recording.tables.coordinates import ColumnChoice
from recon4.slices.map_crs import LOCAL, MapFrame
from recon4.slices.reference import load_reference
from recon4.slices.reference_import import MapPlace, ReadAs, import_reference
from recon4.slices.reference_placement import check_extent, place_file

US_FOOT_M = 1200.0 / 3937.0
ORIGIN = CrsTransform(GeodeticOrigin(np.deg2rad(49.5), np.deg2rad(14.3), 400.0), "EPSG:32633")
OWN = MapFrame("EPSG:32633", ORIGIN.wkt, ORIGIN.to_crs)
P_MAP = np.array([[10.0, 20.0, 3.0], [12.0, 21.0, 4.0], [-5.0, 2.0, 0.5]])


def write_las(path, points, crs=None, *, step=0.001):
    header = laspy.LasHeader(version="1.4", point_format=6)
    header.scales, header.offsets = np.array([step, step, 0.001]), np.floor(points[0])
    if crs is not None:
        header.add_crs(CRS.from_user_input(crs))
    las = laspy.LasData(header)
    las.x, las.y, las.z = points.T
    las.write(path)
    return path


def from_utm(crs):
    """The points of the map in another CRS."""
    x, y, z = ORIGIN.to_crs(P_MAP).T
    found = Transformer.from_crs("EPSG:32633", crs, always_xy=True).transform(x, y)
    return np.stack([*found, z], axis=-1)


def imported(path, tmp_path, place=None, **what):
    facts = import_reference(
        path, tmp_path / "out", place=place or MapPlace(OWN), read_as=ReadAs(**what)
    )
    tiles = load_reference(tmp_path / "out").tiles
    points = np.concatenate([tile.xyz_m() for tile in tiles])
    return facts, points[np.lexsort(points.T)]


def said(facts):
    return [one.text for one in facts.notes]


EXPECTED = P_MAP[np.lexsort(P_MAP.T)]


@pytest.mark.parametrize(
    ("crs", "step", "note"),
    [
        ("EPSG:32633", 0.001, "In WGS 84 / UTM zone 33N (EPSG:32633), the CRS of the map."),
        ("EPSG:4326", 1e-9, "Transformed from WGS 84 (EPSG:4326) to EPSG:32633."),
        ("EPSG:3857", 0.001, "Transformed from WGS 84 / Pseudo-Mercator"),
        ("EPSG:32634", 0.001, "Transformed from WGS 84 / UTM zone 34N"),
    ],
)
def test_a_file_in_its_own_crs_lies_on_the_map(tmp_path, crs, step, note):
    path = write_las(tmp_path / "a.las", from_utm(crs), crs, step=step)

    facts, points = imported(path, tmp_path)

    assert points == pytest.approx(EXPECTED, abs=0.003)
    assert facts.frame == "crs" and any(note in one for one in said(facts))
    assert any("states no datum of its heights" in one for one in said(facts))


def test_feet_are_converted_heights_too():
    points = ORIGIN.to_crs(P_MAP) / US_FOOT_M

    placed = place_file(StatedCrs(CRS.from_epsg(32633), US_FOOT_M, None), OWN)

    assert placed.to_map(points) == pytest.approx(P_MAP, abs=1e-3)
    assert "Coordinates in US survey feet, converted to meters." in placed.notes
    assert "The unit of its heights is not stated: taken as US survey feet." in placed.notes


def test_a_crs_in_feet_is_used_in_feet_and_on_a_local_map_converted():
    stated = StatedCrs(CRS.from_epsg(2255), US_FOOT_M, None)  # Mississippi West (ftUS)
    shift = np.array([736000.0, 3543000.0, 50.0])
    own = MapFrame("EPSG:26915", CRS.from_epsg(26915).to_wkt(), lambda p: p + shift)
    x, y, z = (P_MAP + shift).T
    feet = Transformer.from_crs("EPSG:26915", "EPSG:2255", always_xy=True).transform(x, y)

    points = np.stack([*feet, z / US_FOOT_M], axis=-1)

    assert place_file(stated, own).to_map(points) == pytest.approx(P_MAP, abs=1e-3)
    assert place_file(stated, LOCAL).to_map(points) == pytest.approx(points * US_FOOT_M)


def test_a_crs_behind_the_points_is_found(tmp_path):
    las = laspy.LasData(laspy.LasHeader(version="1.4", point_format=6))
    las.x, las.y, las.z = P_MAP.T
    wkt = CRS.from_epsg(2255).to_wkt("WKT1_GDAL").encode()
    las.evlrs = laspy.vlrs.vlrlist.VLRList([laspy.VLR("LASF_Projection", 2112, "", wkt)])
    las.write(tmp_path / "a.las")

    stated = stated_crs(tmp_path / "a.las")

    assert "Mississippi West (ftUS)" in stated.name
    assert stated.unit_m == pytest.approx(US_FOOT_M)


def test_degrees_do_not_meet_a_local_map(tmp_path):
    path = write_las(tmp_path / "a.las", from_utm("EPSG:4326"), "EPSG:4326", step=1e-9)

    with pytest.raises(ConfigError, match=r"degrees \(WGS 84 .*the map is local: expected meters"):
        imported(path, tmp_path, place=MapPlace())
    with pytest.raises(ConfigError, match="the map's frame was chosen"):
        imported(path, tmp_path, frame="map")


def test_a_projected_crs_and_a_local_map_are_said(tmp_path):
    path = write_las(tmp_path / "a.las", P_MAP, "EPSG:32633")

    facts, points = imported(path, tmp_path, place=MapPlace())

    assert points == pytest.approx(EXPECTED, abs=0.001)
    assert any(
        "the map is local, so that its coordinates are used unchanged" in n for n in said(facts)
    )


def test_heights_of_another_datum_are_said_not_converted(tmp_path):
    path = write_las(tmp_path / "a.las", ORIGIN.to_crs(P_MAP), "EPSG:32633+5621")

    facts, points = imported(path, tmp_path)

    assert points == pytest.approx(EXPECTED, abs=0.002)
    assert any(
        "Its heights are EVRF2007 height" in one and "tens of meters" in one for one in said(facts)
    )


def test_a_file_without_a_crs_at_the_place_of_the_map_is_taken_there(tmp_path):
    path = tmp_path / "a.csv"
    rows = "\n".join(
        f"{k};{y};{x};{z}" for k, (x, y, z) in enumerate(ORIGIN.to_crs(P_MAP).tolist())
    )
    path.write_text("Punkt;Hochwert;Rechtswert;Höhe\n" + rows)

    facts, points = imported(path, tmp_path)

    assert points == pytest.approx(EXPECTED, abs=0.001) and facts.frame == "crs"
    assert said(facts)[0].startswith("columns: x (east) = Rechtswert")
    assert "No CRS is known of it: its coordinates are taken as those of EPSG:32633." in said(facts)


def test_latitude_and_longitude_of_a_table_are_transformed(tmp_path):
    path = tmp_path / "a.csv"
    rows = "\n".join(f"{lat!r},{lon!r},{h}" for lon, lat, h in from_utm("EPSG:4326").tolist())
    path.write_text("lat,lon,height\n" + rows)

    _, points = imported(path, tmp_path)

    assert points == pytest.approx(EXPECTED, abs=0.001)


@pytest.mark.parametrize("unit", ["mm", "ft", "us-ft"])
def test_a_chosen_unit_is_used_and_said(tmp_path, unit):
    size = {"mm": 0.001, "ft": 0.3048, "us-ft": US_FOOT_M}[unit]
    path = write_las(tmp_path / "a.las", P_MAP / size)

    facts, points = imported(path, tmp_path, choice=ColumnChoice(unit=unit))

    assert points == pytest.approx(EXPECTED, abs=0.001)
    assert facts.unit == unit and any("as chosen" in one for one in said(facts))


ROOM = (np.zeros(3), np.array([12.0, 8.0, 3.0]))


@pytest.mark.parametrize("times", [1000.0, 100.0])
def test_a_model_in_another_unit_is_asked_for_it(times):
    with pytest.raises(ConfigError, match="states no unit: choose one"):
        check_extent((ROOM[0] * times, ROOM[1] * times), ROOM, certain=False)
    assert check_extent((ROOM[0] * times, ROOM[1] * times), ROOM, certain=True) == ()


@pytest.mark.parametrize(
    "high", [[14.0, 9.0, 3.2], [1000.0, 1000.0, 60.0], [0.2, 0.2, 0.2], [12.0, 8.0, 0.0]]
)
def test_a_plausible_extent_is_not_questioned(high):
    assert check_extent((np.zeros(3), np.array(high)), ROOM, certain=False) == ()


def test_a_reference_far_from_the_map_is_said():
    shift = np.array([5.4e6, 0.0, 0.0])

    assert check_extent((ROOM[0] + shift, ROOM[1] + shift), ROOM, certain=True) == (
        "It lies 5400 km beside the map: align it, or choose another frame.",
    )


@pytest.mark.parametrize(
    ("file", "unit_m", "height_unit_m", "name"),
    [
        ("las/mvk-thin.las", US_FOOT_M, US_FOOT_M, "EPSG:26995"),
        ("las/spurious.las", None, None, "EPSG:4326"),
        ("las/1_4_w_evlr.laz", US_FOOT_M, None, "New Mexico Central (ftUS)"),
        ("las/las_with_several_extra_byte_bloc.laz", 1.0, None, "EPSG:2154"),
        ("copc/simple.copc.laz", 1.0, US_FOOT_M, "EPSG:2991"),
        ("las/warsaw_small.las", None, None, ""),
        ("e57/bunnyDouble.e57", 1.0, 1.0, ""),
    ],
)
def test_real_files_state_their_units(data, file, unit_m, height_unit_m, name):
    stated = stated_crs(data(f"clouds/{file}"))

    assert name in stated.name and bool(name) == (stated.crs is not None)
    assert stated.unit_m == (unit_m and pytest.approx(unit_m))
    assert stated.height_unit_m == (height_unit_m and pytest.approx(height_unit_m))
