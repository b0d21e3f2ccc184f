"""Storeys and floor plans of buildings whose every measure is known."""

import json
from dataclasses import replace

import ezdxf
import numpy as np
import pytest
from pyproj import CRS

from recon4.errors import ConfigError
from recon4.locales.coded import said
from recon4.products import floor_plan
from recon4.products.drawing import DrawingLayer, DrawingNotes, DrawnShape, write_drawing
from recon4.products.floor_plan import draw_plan
from recon4.products.storeys import Levels, find_storeys, level_surfaces, storey_named
from recon4.products.write import ProductOptions, ProductSource, write_product
from recon4.review.stamp import Stamp
from recon4.slices.map_crs import LOCAL, MapFrame
from tests.unit.products.made_buildings import (
    CEILING_M,
    DOOR,
    FLOOR_M,
    WINDOW,
    round_room,
    slope,
    two_rooms,
)

UTM_M = np.array([500_000.0, 5_400_000.0, 300.0])
PLACED = MapFrame("EPSG:32633", "", lambda p: np.asarray(p) + UTM_M)
TRUE_LINES = [
    *([(0, 0), (2, 0)], [(3.4, 0), (5, 0)], [(0, 4), (5, 4)], [(0, 0), (0, 4)]),
    *([(5, 0), (5, 1)], [(5, 1.9), (5, 4)], [(5.12, 0), (5.12, 1)], [(5.12, 1.9), (5.12, 4)]),
    *([(5.12, 0), (10.12, 0)], [(5.12, 4), (10.12, 4)], [(10.12, 0), (10.12, 4)]),
    *([(5, 1), (5.12, 1)], [(5, 1.9), (5.12, 1.9)]),
]
SIGNED = Stamp(version=1, who="Eva", role="reviewer", time="2026-01-01T00:00:00Z", hash="ab")


@pytest.fixture(scope="module")
def rooms(tmp_path_factory):
    return two_rooms(tmp_path_factory.mktemp("rooms") / "map")


@pytest.fixture(scope="module")
def plan(rooms):
    levels = level_surfaces(rooms)
    return draw_plan(rooms, find_storeys(rooms, levels)[0], levels)


def off(points, lines):
    """Distance of points to the nearest line."""
    best = np.full(len(points), np.inf)
    for a, b in np.array(lines, float):
        along = np.clip((points - a) @ (b - a) / ((b - a) @ (b - a)), 0.0, 1.0)
        best = np.minimum(best, np.linalg.norm(points - a - along[:, None] * (b - a), axis=1))
    return best


def along(lines):
    return np.concatenate([a + np.linspace(0, 1, 200)[:, None] * (b - a)
                           for a, b in np.array(lines, float)])  # fmt: skip


def test_one_storey_is_found_with_floor_and_ceiling(rooms):
    (storey,) = find_storeys(rooms, level_surfaces(rooms))

    assert storey.name == "0"
    assert storey.floor_m == pytest.approx(FLOOR_M, abs=0.026)
    assert storey.ceiling_m == pytest.approx(CEILING_M, abs=0.026)
    assert storey.area_m2 == pytest.approx(40.0, rel=0.05)


@pytest.mark.parametrize("radius_m", [2.0, 5.0])
def test_a_curved_wall_is_an_arc_that_ends_at_its_door(radius_m, tmp_path):
    door_rad = 1.0 / radius_m
    tiles = round_room(tmp_path / "map", radius_m, door_rad=door_rad)
    levels = level_surfaces(tiles)
    found = draw_plan(tiles, find_storeys(tiles, levels)[0], levels)

    arc = max(found.walls, key=len)
    distance = np.linalg.norm(arc, axis=1)
    np.testing.assert_allclose(distance, radius_m, atol=0.004)
    middles = np.linalg.norm((arc[1:] + arc[:-1]) / 2.0, axis=1)
    assert (radius_m - middles).max() < 0.005
    length = np.linalg.norm(np.diff(arc, axis=0), axis=1).sum()
    assert length == pytest.approx(radius_m * (2.0 * np.pi - door_rad), abs=0.1)
    ends = np.arctan2(arc[[0, -1], 1], arc[[0, -1], 0])
    np.testing.assert_allclose(np.sort(np.abs(ends)), door_rad / 2.0, atol=0.05)
    assert not any(len(wall) > 2 for wall in found.walls if wall is not arc)
    assert found.wall_length_m < length + 0.3


def test_a_meadow_has_no_storeys(tmp_path):
    tiles = slope(tmp_path / "map")

    assert find_storeys(tiles, level_surfaces(tiles)) == ()
    with pytest.raises(ConfigError, match="no storeys"):
        storey_named((), "0")


def stack(rooms, heights_m):
    """The levels of the rooms at several heights, as of one building."""
    one = level_surfaces(rooms)
    steps = [round(z / 0.05) for z in heights_m]
    return Levels(
        np.tile(one.column, (len(steps), 1)),
        np.concatenate([one.level + k for k in steps]),
        np.tile(one.up, len(steps)),
        np.tile(one.area_m2, len(steps)),
    )


class Walked:
    """A map of which only the paths are asked for."""

    def __init__(self, rooms, heights_m):
        paths = rooms.columns.paths
        p = np.concatenate([paths.p_map[0] + [0, 0, z] for z in heights_m])
        t_ns = np.arange(len(p), dtype=np.int64) * 100_000_000
        self.columns = self
        self.paths = type(paths)(t_ns, t_ns, p[None])


def test_storeys_count_from_where_the_walk_begins(rooms):
    found = find_storeys(Walked(rooms, [0.0, 3.0, -3.0]), stack(rooms, [0.0, 3.0, -3.0]))

    assert [one.name for one in found] == ["-1", "0", "1"]
    assert np.diff([one.floor_m for one in found]) == pytest.approx([3.0, 3.0], abs=0.06)
    assert storey_named(found, "-1").floor_m == pytest.approx(FLOOR_M - 3.0, abs=0.03)


def test_a_storey_that_was_only_seen_is_none(rooms):
    found = find_storeys(Walked(rooms, [0.0]), stack(rooms, [0.0, 3.0]))

    assert [one.name for one in found] == ["0"]


def test_a_half_landing_is_no_storey(rooms):
    levels, landing = stack(rooms, [0.0]), stack(rooms, [1.65])
    few = landing.only((landing.column[:, 0] < 4) & landing.up)
    both = Levels(*(np.concatenate([getattr(levels, name), getattr(few, name)])
                    for name in ("column", "level", "up", "area_m2")))  # fmt: skip

    assert len(find_storeys(Walked(rooms, [0.0, 1.65]), both)) == 1


def test_walls_lie_where_they_are(plan):
    drawn, true = along(plan.walls), along(TRUE_LINES)

    assert np.mean(off(true, plan.walls) < 0.01) > 0.97
    assert np.mean(off(drawn, TRUE_LINES) < 0.01) > 0.97
    assert plan.rms_m < 0.005


def test_stray_points_inside_of_a_wall_are_no_wall(plan, tmp_path):
    tiles = two_rooms(tmp_path / "map", scraps_m=3.0)
    levels = level_surfaces(tiles)
    found = draw_plan(tiles, find_storeys(tiles, levels)[0], levels)

    assert found.wall_length_m == pytest.approx(plan.wall_length_m, abs=0.02)
    assert len(found.walls) == len(plan.walls)


def test_door_window_and_column_are_found(plan):
    doors = [hole for hole in plan.openings if hole.kind == "door"]
    windows = [hole for hole in plan.openings if hole.kind == "window"]

    assert sorted(round(float(hole.line[0, 0]), 1) for hole in doors) == [5.0, 5.1]
    for door in doors:
        np.testing.assert_allclose(np.sort(door.line[:, 1]), DOOR, atol=0.01)
        assert door.head_m == pytest.approx(2.1, abs=0.06)
    (window,) = windows
    np.testing.assert_allclose(np.sort(window.line[:, 0]), WINDOW, atol=0.03)
    assert (window.sill_m, window.head_m) == pytest.approx((0.9, 2.1), abs=0.06)
    (column,) = plan.columns
    np.testing.assert_allclose(column.bounds, (7.0, 2.0, 7.4, 2.4), atol=0.01)


def test_a_cupboard_is_furniture(plan):
    outline = max(plan.furniture, key=lambda one: one.area)
    np.testing.assert_allclose(outline.bounds, (1.0, 3.4, 2.0, 4.0), atol=0.06)


def test_the_fill_is_the_wall_between_the_rooms_without_its_door(plan):
    fill = [one for one in plan.sections if one.bounds[0] < 5.05]

    assert sum(one.area for one in fill) == pytest.approx(0.12 * (4.0 - 0.9), rel=0.05)


@pytest.mark.parametrize("stamp", [None, SIGNED])
def test_a_dxf_has_layers_by_meaning_and_coordinates_of_the_crs(rooms, tmp_path, stamp):
    path = tmp_path / "plan.dxf"
    write_product("plan", ProductSource(rooms, PLACED, stamp), path, options=ProductOptions())

    drawing = ezdxf.readfile(path)
    assert drawing.audit().errors == []
    assert drawing.units == ezdxf.units.M
    said = dict(drawing.header.custom_vars.properties)["coordinates"]
    assert said == f"easting, northing, height in {PLACED.crs}, meters"
    space = drawing.modelspace()
    walls = space.query('LWPOLYLINE[layer=="S0_WALLS"]')
    p = np.array([point[:2] for line in walls for point in line.get_points()])
    assert np.mean(off(p - UTM_M[:2], TRUE_LINES) < 0.01) > 0.9
    heights = [line.dxf.elevation for line in walls]
    np.testing.assert_allclose(heights, 300.0 + FLOOR_M, atol=0.03)
    assert len(space.query('HATCH[layer=="S0_WALLS_FILL"]')) >= 2
    assert len(space.query('LWPOLYLINE[layer=="S0_DOORS"]')) == 2
    assert len(space.query('LWPOLYLINE[layer=="S0_COLUMNS"]')) == 1
    assert ("Eva" in path.read_text()) == bool(stamp)
    assert [one.name for one in tmp_path.iterdir()] == ["plan.dxf"]


def test_files_of_one_map_draw_plans_that_were_fitted_once(rooms, tmp_path, monkeypatch):
    fitted = []

    def counted(tiles, storey, levels):
        fitted.append(storey.name)
        return draw_plan(tiles, storey, levels)

    monkeypatch.setattr(floor_plan, "draw_plan", counted)
    source = ProductSource(rooms, PLACED, None)
    said = [
        write_product("plan", source, tmp_path / name, options=ProductOptions())
        for name in ("plan.dxf", "plan.geojson")
    ]

    assert fitted == ["0"] and said[0] == said[1]
    assert len(json.loads((tmp_path / "plan.geojson").read_text())["features"]) > 5


@pytest.mark.parametrize(("start", "sweep"), [(0.4, 2.0), (5.5, -2.0), (0.0, 2.0 * np.pi)])
def test_a_curved_wall_is_an_arc_in_a_dxf(start, sweep, tmp_path):
    turn = start + np.linspace(0.0, sweep, 60)
    line = np.column_stack([3.0 * np.cos(turn), 3.0 * np.sin(turn), np.full(60, FLOOR_M)])
    shape = DrawnShape(DrawingLayer("S0_WALLS", 7), line, arc=True)
    write_drawing([shape], tmp_path / "a.dxf", DrawingNotes(frame=PLACED))

    (drawn,) = ezdxf.readfile(tmp_path / "a.dxf").modelspace()
    assert drawn.dxftype() == ("CIRCLE" if abs(sweep) > 6.0 else "ARC")
    assert drawn.dxf.radius == pytest.approx(3.0, abs=1e-3)
    np.testing.assert_allclose(np.array(drawn.dxf.center)[:2], UTM_M[:2], atol=1e-3)
    if drawn.dxftype() == "ARC":
        middle = UTM_M[:2] + 3.0 * np.array([np.cos(start + sweep / 2), np.sin(start + sweep / 2)])
        ends = np.deg2rad([drawn.dxf.start_angle, drawn.dxf.end_angle])
        along = ends[0] + ((ends[1] - ends[0]) % (2 * np.pi)) / 2
        at = np.array(drawn.dxf.center)[:2] + 3.0 * np.array([np.cos(along), np.sin(along)])
        np.testing.assert_allclose(at, middle, atol=2e-3)


def test_geojson_says_what_each_line_is(rooms, tmp_path):
    path = tmp_path / "plan.geojson"
    text = write_product(
        "plan", ProductSource(rooms, PLACED, None), path, options=ProductOptions(storey="0")
    )

    assert "2 doors and 1 window in them, 1 column" in text
    assert ", darin 2 Türen und 1 Fenster, 1 Stütze" in said(text, "de")
    record = json.loads(path.read_text())
    assert record["crs"]["properties"]["name"] == "urn:ogc:def:crs:EPSG::32633"
    layers = [one["properties"]["layer"] for one in record["features"]]
    assert layers.count("S0_WINDOWS") == 1
    door = next(one for one in record["features"] if one["properties"]["layer"] == "S0_DOORS")
    assert door["properties"]["width_m"] == pytest.approx(0.9, abs=0.02)


@pytest.mark.parametrize(
    ("frame", "starts"),
    [
        (LOCAL, 'LOCAL_CS["map frame: not georeferenced"'),
        (MapFrame("its CRS", CRS.from_epsg(32633).to_wkt("WKT1_GDAL"), np.array), "EPSG:32633"),
        (replace(PLACED, crs="EPSG:32633+5773"), 'COMPD_CS["WGS 84 / UTM zone 33N + EGM96'),
    ],
    ids=["local", "wkt", "heights"],
)
def test_a_gis_knows_the_system_of_a_geojson(frame, starts, tmp_path):
    import pyogrio

    path = tmp_path / "plan.geojson"
    line = DrawnShape(DrawingLayer("S0_WALLS", 7), np.eye(3))
    write_drawing([line], path, DrawingNotes(frame=frame))

    assert pyogrio.read_info(path)["crs"].startswith(starts)


def test_wrong_storeys_and_names_are_refused_and_nothing_is_written(rooms, tmp_path):
    source = ProductSource(rooms, LOCAL, None)
    with pytest.raises(ConfigError, match="no storey named 4; there are: 0"):
        write_product("plan", source, tmp_path / "a.dxf", options=ProductOptions(storey="4"))
    with pytest.raises(ConfigError, match=r"written as \.dxf \.geojson \.png, got a\.dwg"):
        write_product("plan", source, tmp_path / "a.dwg", options=ProductOptions())
    with pytest.raises(ConfigError, match="pixel_m: expected a number above 0"):
        ProductOptions(pixel_m=0.0)
    assert list(tmp_path.iterdir()) == []
