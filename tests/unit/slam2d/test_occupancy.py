"""Occupancy grids: beams, growth, and the files that nav2 reads."""

import numpy as np
import pytest
from PIL import Image
from ruamel.yaml import YAML

from recon4.settings import Grid2dSettings
from recon4.slam2d.map_files import trinary_image, write_map
from recon4.slam2d.occupancy import MAX_CELLS, OccupancyGrid, crossing_ratio, fitting_cell_m


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


def test_a_map_that_would_be_too_large_gets_larger_cells():
    small = fitting_cell_m(np.zeros(2), np.array([50.0, 50.0]), 0.05)
    large_m = fitting_cell_m(np.zeros(2), np.array([3000.0, 3000.0]), 0.05)

    assert small == 0.05
    assert (3010.0 / large_m) ** 2 <= MAX_CELLS < (3010.0 / large_m * 2.0) ** 2


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

    write_map(tmp_path, grid, Grid2dSettings())

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
    np.testing.assert_array_equal(image, trinary_image(grid, Grid2dSettings()))


def _meaning(value, described):
    """Interpretation of a gray value by nav2's map_server."""
    occupancy = (255 - value) / 255.0
    if occupancy > described["occupied_thresh"]:
        return 100
    return 0 if occupancy < described["free_thresh"] else -1
