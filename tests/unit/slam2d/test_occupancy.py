"""Occupancy grids: beams, growth, and the files that nav2 reads."""

import struct

import numpy as np
import pytest
from msgspec import structs
from PIL import Image
from ruamel.yaml import YAML

from recon4.errors import MapTooLarge, StoreError
from recon4.progress import Silent
from recon4.settings import Settings
from recon4.slam2d import occupancy
from recon4.slam2d.grid_files import read_overview, trinary_image, write_map
from recon4.slam2d.occupancy import OccupancyGrid, crossing_ratio, fitting_cell_m
from recon4.slam2d.slam import make_grid
from recon4.slam2d.tuning import Grid2dTuning
from recon4.slam2d.tuning_graph import MAP_FILES_2D, OCCUPANCY
from tests.planar_walks import furnished_room, scanned


def grid_of(*scans, cell_m=0.1):
    grid = OccupancyGrid(cell_m, 0.4, 0.9)
    for p_map, laser in scans:
        grid.add_scan(np.array(p_map, float), np.array(laser, float))
    return grid


def at(grid, x, y):
    row, column = np.floor((np.array([x, y]) - grid.origin) / grid.cell_m).astype(int)
    return float(grid.probability[row, column])


def test_a_beam_frees_the_cells_before_its_return():
    grid = grid_of(([[2.05, 0.05]], [0.05, 0.05]))

    assert at(grid, 2.05, 0.05) == pytest.approx(0.9)
    for x in np.arange(0.05, 1.99, 0.1):
        assert at(grid, x, 0.05) == pytest.approx(0.4)
    assert at(grid, 2.15, 0.05) == pytest.approx(0.5)
    assert at(grid, 1.05, 0.15) == pytest.approx(0.5)


def test_a_scan_changes_each_cell_once_and_returns_count_more():
    # The second beam passes the cell of the first return; three beams leave through one cell.
    grid = grid_of(([[1.05, 0.05], [2.05, 0.05], [2.05, 0.06]], [0.05, 0.05]))

    assert at(grid, 1.05, 0.05) == pytest.approx(0.9)
    assert at(grid, 0.15, 0.05) == pytest.approx(0.4)
    assert at(grid, 2.05, 0.05) == pytest.approx(0.9)


def test_a_grid_that_grows_keeps_what_it_has():
    near = ([[1.05, 0.05]], [0.05, 0.05])
    far = ([[-31.05, 40.05]], [-30.05, 40.05])

    grown, alone = grid_of(near, far), grid_of(near)

    assert grown.log_odds.shape > alone.log_odds.shape
    assert at(grown, 1.05, 0.05) == at(alone, 1.05, 0.05)
    assert at(grown, -31.05, 40.05) == pytest.approx(0.9)


def test_a_grid_grows_only_where_the_walk_leaves_it():
    walk = [([[6.0 * k + 2.0, 0.0]], [6.0 * k, 0.0]) for k in range(200)]

    grid = grid_of(*walk)

    width_m, height_m = np.array(grid.log_odds.shape) * grid.cell_m
    assert 1196.0 < width_m < 1196.0 + 25.0
    assert height_m < 11.0


def test_a_position_far_away_is_a_clear_error_where_a_grid_grows():
    grid = grid_of(([[2.05, 0.05]], [0.05, 0.05]))

    with pytest.raises(MapTooLarge, match=r"would be 1000010 x 1000010 m.* wrong\?"):
        grid.add_scan(np.array([[1e6, 1e6]]), np.zeros(2))


def test_a_map_with_a_position_far_away_is_bounded(monkeypatch):
    monkeypatch.setattr(
        occupancy, "OCCUPANCY", structs.replace(occupancy.OCCUPANCY, max_cells=100_000)
    )
    scans = scanned(furnished_room(), np.zeros((3, 3)), odometry=False).scans
    poses = np.array([[0.0, 0.0, 0.0], [1e6, -1e6, 0.5], [0.1, 0.0, 0.0]])

    grid = make_grid(scans, poses, attitude=None, settings=Settings(), progress=Silent())

    assert grid.log_odds.size <= 101_000
    assert grid.cell_m == 0.05 * 2**16
    assert np.count_nonzero(grid.log_odds) >= 2


def test_a_map_that_would_be_too_large_gets_larger_cells():
    small = fitting_cell_m(np.zeros(2), np.array([50.0, 50.0]), 0.05)
    large_m = fitting_cell_m(np.zeros(2), np.array([3000.0, 3000.0]), 0.05)

    assert small == 0.05
    assert (3010.0 / large_m) ** 2 <= OCCUPANCY.max_cells < (3010.0 / large_m * 2.0) ** 2


def test_beams_through_walls_are_counted():
    wall = [[2.05, y] for y in np.arange(-1.05, 1.1, 0.1)]
    grid = grid_of(*[(wall, [0.05, 0.05])] * 4)

    fits = [(np.array(wall), np.array([0.05, 0.05]))]
    through = [(np.array([[3.5, 0.05], [1.5, 0.05]]), np.array([0.05, 0.05]))]

    assert crossing_ratio(grid, fits) == 0.0
    assert crossing_ratio(grid, through) == pytest.approx(0.5)


def test_the_files_have_walls_where_they_are(tmp_path):
    # Three scans from one place: a wall at x = 2, y from 1 to 1.4.
    grid = grid_of(*[([[2.05, 1.0 + 0.1 * k + 0.05] for k in range(4)], [0.05, 0.05])] * 3)

    write_map(tmp_path, grid, Grid2dTuning())

    described = YAML(typ="safe").load((tmp_path / "map.yaml").read_text("ascii"))
    image = np.asarray(Image.open(tmp_path / described["image"]))
    assert described["mode"] == "trinary"
    # As map_server: the origin is the lower left corner, rows count downwards.
    height = image.shape[0]
    column = int((2.05 - described["origin"][0]) / described["resolution"])
    row = height - 1 - int((1.15 - described["origin"][1]) / described["resolution"])
    assert image[row, column] == 0
    unknown, free, occupied = (_meaning(v, described) for v in (205, 254, 0))
    assert (unknown, free, occupied) == (-1, 0, 100)
    assert set(np.unique(image)) <= {0, 205, 254}
    np.testing.assert_array_equal(image, trinary_image(grid, Grid2dTuning()))


def _meaning(value, described):
    """Interpretation of a gray value by nav2's map_server."""
    occupancy = (255 - value) / 255.0
    if occupancy > described["occupied_thresh"]:
        return 100
    return 0 if occupancy < described["free_thresh"] else -1


def far_apart():
    """A grid of 202 million cells with two walls of one cell, far apart."""
    grid = OccupancyGrid(0.05, 0.4, 0.9)
    grid.origin = np.array([-100.0, -50.0])
    grid.log_odds = np.zeros((15_000, 13_500), np.float32)
    grid.log_odds[2, 5] = grid.log_odds[14_998, 13_497] = 5.0
    grid.log_odds[3, 5] = -5.0
    return grid


@pytest.fixture(scope="module")
def large(tmp_path_factory):
    folder = tmp_path_factory.mktemp("large")
    return folder, write_map(folder, far_apart(), Grid2dTuning())


@pytest.mark.study
def test_a_map_of_202_million_cells_is_written_in_full(large):
    folder, written = large

    with open(folder / "map.png", "rb") as file:
        width, height = struct.unpack(">II", file.read(24)[16:])
    assert (width, height) == (15_000, 13_500)
    assert (folder / "map.png").stat().st_size < 2_000_000
    rows, columns = np.nonzero(written.occupied)
    assert sorted(zip(rows.tolist(), columns.tolist(), strict=True)) == [(2, 14_998), (13_494, 2)]


@pytest.mark.study
def test_pages_show_an_overview_of_a_large_map_with_the_same_places(large):
    shown = read_overview(large[0])

    assert max(shown.gray.shape) <= MAP_FILES_2D.overview_cells
    assert shown.cell_m == pytest.approx(0.2)
    assert shown.origin_m == (-100.0, -50.0)
    rows, columns = np.nonzero(shown.occupied)
    up = len(shown.gray) - 1 - rows
    found = np.stack([columns, up], axis=1) * shown.cell_m + shown.origin_m
    walls = np.array([[14_998, 13_497], [2, 5]]) * 0.05 + [-100.0, -50.0]
    assert np.all((walls - found >= 0.0) & (walls - found < shown.cell_m))
    assert not shown.free.any()


def test_an_image_too_large_to_decode_is_an_error_of_the_store(large, tmp_path):
    for name in ("map.png", "map.yaml"):  # without the overview, which is read otherwise
        (tmp_path / name).symlink_to(large[0] / name)
    with pytest.raises(StoreError, match="cannot be read: Image size"):
        read_overview(tmp_path)


def test_a_small_map_is_its_own_overview(tmp_path):
    grid = grid_of(*[([[2.05, 1.05]], [0.05, 0.05])] * 3)

    write_map(tmp_path, grid, Grid2dTuning())

    assert (tmp_path / "overview.png").read_bytes() == (tmp_path / "map.png").read_bytes()
    shown = read_overview(tmp_path).gray
    (tmp_path / "overview.png").unlink()
    np.testing.assert_array_equal(shown, read_overview(tmp_path).gray)
