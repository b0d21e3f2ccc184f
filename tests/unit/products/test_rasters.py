"""Orthophotos, terrain, contours and volumes of maps whose every measure is known."""

import json
import resource
from functools import partial

import numpy as np
import pytest
import rasterio

from recon4.errors import ConfigError, NoSpace
from recon4.locales.coded import said
from recon4.mapping.map_notes import MapNotes
from recon4.mapping.tile import FIELDS
from recon4.mapping.tile_writer import TileWriter
from recon4.mapping.tiles import TileSet
from recon4.products.contours import contours
from recon4.products.terrain import TerrainPart, terrain
from recon4.products.volume import volume
from recon4.products.write import ProductOptions, ProductSource, write_product
from recon4.slices.map_crs import LOCAL
from recon4.slices.points import SliceWindow
from tests.unit.products.made_buildings import FLOOR_M, MOUND_M, SLOPE, slope, two_rooms
from tests.unit.products.test_plans import PLACED, UTM_M

RNG = partial(np.random.default_rng, 1)
FLOOR = np.array([[0.2, 0.2], [3.0, 0.2], [3.0, 3.0], [0.2, 3.0]])
BELOW_CEILING = TerrainPart(SliceWindow(-0.5, -0.5, 4.0, 4.0), high_m=0.5)
MOUND = np.array([[5.0, 7.0], [11.0, 7.0], [11.0, 13.0], [5.0, 13.0]])


@pytest.fixture(scope="module")
def meadow(tmp_path_factory):
    return slope(tmp_path_factory.mktemp("meadow") / "map")


@pytest.fixture(scope="module")
def ground(meadow):
    return terrain(meadow, "dtm", cell_m=0.25)


def at(made, x, y):
    window = made.grid.window
    return made.height_m[int((window.top - y) / 0.25), int((x - window.left) / 0.25)]


def test_an_orthophoto_shows_the_floor_and_lies_where_it_is(tmp_path):
    tiles = two_rooms(tmp_path / "map")
    path = tmp_path / "floor.tif"
    write_product(
        "orthophoto", ProductSource(tiles, PLACED, None), path, options=ProductOptions(pixel_m=0.02)
    )

    with rasterio.open(path) as read:
        assert read.crs.to_epsg() == 32633
        gray, seen = read.read()
        low, high = read.bounds[:2], read.bounds[2:]
        row, column = read.index(UTM_M[0] + 8.5, UTM_M[1] + 1.0)
        edge = read.index(UTM_M[0] + 7.2, UTM_M[1] + 2.0)
    np.testing.assert_allclose(low, [UTM_M[0] - 0.02, UTM_M[1] - 0.12], atol=0.05)
    np.testing.assert_allclose(high, [UTM_M[0] + 10.14, UTM_M[1] + 4.02], atol=0.05)
    assert seen[row, column] == 255
    assert gray[edge[0] - 1 : edge[0] + 2, edge[1]].max() > gray[row, column] + 100
    numbers = [float(x) for x in path.with_suffix(".tfw").read_text().split()]
    np.testing.assert_allclose(numbers[:4], [0.02, 0.0, 0.0, -0.02], atol=1e-9)
    np.testing.assert_allclose(numbers[4:], [low[0] + 0.01, high[1] - 0.01], atol=1e-6)


def test_an_elevation_shows_the_wall_from_the_left_to_the_right(tmp_path):
    tiles = two_rooms(tmp_path / "map")
    options = ProductOptions(line=(5.0, 0.1, 0.0, 0.1), depth_m=0.5, pixel_m=0.02)
    source = ProductSource(tiles, LOCAL, None)
    write_product("orthophoto", source, tmp_path / "wall.tif", options=options)

    with rasterio.open(tmp_path / "wall.tif") as read:
        gray, _ = read.read()
        assert read.bounds.left == pytest.approx(0.0)
        assert read.bounds.right == pytest.approx(5.0)  # not the eastern room
        pane = read.index(2.3, -0.1)  # u of the window: 5 - 3.4 to 5 - 2.0
        plaster = read.index(4.0, -0.1)
    assert gray[plaster] > gray[pane] + 50


def test_the_ground_is_without_car_and_tree_and_empty_where_nothing_was_seen(ground, meadow):
    assert at(ground, 3.1, 3.1) == pytest.approx(3.1 * SLOPE, abs=0.02)
    assert np.isnan(at(ground, 22.0, 6.0))
    assert at(ground, 15.0, 15.0) == pytest.approx(15.0 * SLOPE, abs=0.03)
    assert np.isnan(at(ground, 25.0, 16.0))

    highest = terrain(meadow, "dsm", cell_m=0.25)
    assert at(highest, 22.0, 6.0) == pytest.approx(22.0 * SLOPE + 1.5, abs=0.05)
    assert at(highest, 15.0, 15.0) > 4.0


def test_heights_are_read_by_gdal_in_the_crs(meadow, tmp_path):
    path = tmp_path / "dtm.tif"
    text = write_product(
        "terrain", ProductSource(meadow, PLACED, None), path, options=ProductOptions(cell_m=0.5)
    )

    assert " cells of 0.5 m, " in text and " Zellen von 0,5 m, " in said(text, "de")
    with rasterio.open(path) as read:
        heights = read.read(1, masked=True)
        place = read.index(UTM_M[0] + 3.2, UTM_M[1] + 3.2)
        hole = read.index(UTM_M[0] + 25.0, UTM_M[1] + 16.0)
        assert read.dtypes == ("float32",)
        assert read.nodata == -9999.0
    assert heights[place] == pytest.approx(300.0 + 3.25 * SLOPE, abs=0.03)
    assert heights.mask[hole]


def test_a_raster_on_a_full_disk_says_so_and_leaves_nothing(meadow, tmp_path):
    path = tmp_path / "dtm.tif"
    limits = resource.getrlimit(resource.RLIMIT_FSIZE)
    resource.setrlimit(resource.RLIMIT_FSIZE, (256, limits[1]))
    try:
        with pytest.raises(NoSpace, match=r"no space left .*dtm\.tif"):
            write_product(
                "terrain", ProductSource(meadow, PLACED, None), path, options=ProductOptions()
            )
    finally:
        resource.setrlimit(resource.RLIMIT_FSIZE, limits)

    assert list(tmp_path.iterdir()) == []


def test_contours_follow_the_slope(ground):
    lines = contours(ground, interval_m=0.25, up_m=100.0)

    assert {round(line.height_m, 2) for line in lines} >= {100.25, 100.5, 100.75, 101.0}
    assert {line.height_m for line in lines if line.index} <= {100.0, 101.25, 102.5}
    straight = [line.p for line in lines if line.height_m == 101.0 and line.p[:, 1].max() < 5.0]
    for p in straight:
        np.testing.assert_allclose(p[:, 0], 1.0 / SLOPE, atol=0.5)
    with pytest.raises(ConfigError, match="larger interval"):
        contours(ground, interval_m=0.0001)


def test_contours_are_written_at_their_heights(meadow, tmp_path):
    options = ProductOptions(interval_m=0.5)
    source = ProductSource(meadow, PLACED, None)
    write_product("terrain", source, tmp_path / "c.geojson", options=options)

    features = json.loads((tmp_path / "c.geojson").read_text())["features"]
    for one in features:
        z = [point[2] for point in one["geometry"]["coordinates"]]
        assert z == pytest.approx([one["properties"]["height_m"]] * len(z))
        assert one["properties"]["height_m"] % 0.5 == pytest.approx(0.0)


def test_the_volume_of_a_mound_over_the_ground_around_it(meadow):
    found = volume(terrain(meadow, "dsm", cell_m=0.25), MOUND, rng=RNG())

    assert found.above_m3 - found.below_m3 == pytest.approx(16.0 * MOUND_M, abs=0.3)
    assert found.area_m2 == pytest.approx(36.0)
    assert found.unseen_m2 < 1.5
    assert 0.0 < found.sd_m3 < 0.3


def test_walls_beside_a_floor_do_not_lift_its_base(tmp_path):
    heights = terrain(two_rooms(tmp_path / "map"), "dsm", cell_m=0.05, part=BELOW_CEILING)
    found = volume(heights, FLOOR, rng=RNG())

    assert found.base_m == pytest.approx(FLOOR_M, abs=0.001)
    assert found.above_m3 == pytest.approx(0.0, abs=0.005)
    assert found.below_m3 == pytest.approx(0.0, abs=0.005)
    assert 0.6 < found.fitted < 0.95  # two walls are near its border


def test_a_volume_over_a_given_height_and_its_refusals(ground, meadow):
    flat = volume(terrain(meadow, "dsm", cell_m=0.25), MOUND, base_m=0.0, rng=RNG())

    assert flat.above_m3 == pytest.approx(16.0 * MOUND_M + 36.0 * 8.0 * SLOPE, abs=0.6)
    assert flat.base_sd_m == 0.0
    with pytest.raises(ConfigError, match="encloses no area"):
        volume(ground, MOUND[[0, 2, 1, 3]], rng=RNG())
    with pytest.raises(ConfigError, match="nothing was seen"):
        volume(ground, MOUND + 100.0, rng=RNG())


def two_levels(folder, *, counts):
    """A square of ground (class 2) half a meter over a level of class 1."""
    folder.mkdir()
    xy = np.random.default_rng(2).uniform(0.0, 4.0, (4000, 2))
    high = np.arange(len(xy)) % 2 == 0
    columns = {
        name: np.zeros((len(xy), width) if width > 1 else len(xy), dtype)
        for name, (dtype, width) in FIELDS.items()
    }
    columns["xyz"] = np.column_stack([xy, np.where(high, 0.5, 0.0)]).astype(np.float32)
    columns["normal"][:, 2] = 1.0
    columns["classification"] = np.where(high, 2, 1).astype(np.uint8)
    fields = ["xyz", "normal", "classification", "frame_id", "t_ns"]
    with TileWriter(folder, fields, tile_m=5.0) as writer:
        writer.notes = MapNotes(classes=counts)
        writer.append((0, 0, 0), columns)
    return TileSet.open(folder)


def test_heights_of_the_ground_are_those_of_its_class_where_a_map_has_it(tmp_path):
    classified = two_levels(tmp_path / "a", counts={1: 2000, 2: 2000})
    earlier = two_levels(tmp_path / "b", counts={})

    heights = [
        np.nanmedian(terrain(one, "dtm", cell_m=0.5).height_m) for one in (classified, earlier)
    ]

    assert heights == pytest.approx([0.5, 0.0], abs=0.002)


def test_classes_of_an_earlier_map_are_counted_by_reading_it(tmp_path):
    assert two_levels(tmp_path / "a", counts={}).class_counts() == {1: 2000, 2: 2000}
