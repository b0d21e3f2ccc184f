"""Black-white targets are found with their center and its deviation; what looks alike is not."""

import numpy as np
import pytest

from recon4.geometry.se3 import SE3
from recon4.mapping.tile import STORED
from recon4.mapping.tile_writer import TileWriter
from recon4.mapping.tiles import TileSet
from recon4.slices.black_white import black_white_at, find_black_white
from tests.unit.mapping.test_packed_tiles import some_columns, walk_paths

CENTER = np.array([4.0, -2.0, 1.3])


def wall(rng, reflectivity, *, spacing_m=0.012, seen=None):
    """A wall of 60 cm at any turn: points with noise, intensities of what is painted on it."""
    count = round((0.6 / spacing_m) ** 2)
    uv = rng.uniform(-0.3, 0.3, (count, 2))
    if seen is not None:
        uv = uv[seen(uv)]
    blurred = uv + rng.normal(0.0, 0.004, uv.shape)  # by the beam
    intensity = 100.0 * reflectivity(blurred) * rng.normal(1.0, 0.08, len(uv))
    T = SE3.from_rpy(*rng.uniform(-3.0, 3.0, 3), t=CENTER)
    return T @ np.column_stack([uv, rng.normal(0.0, 0.004, len(uv))]), intensity, T


def board(uv, *, at=(0.0, 0.0), turn=0.0, half_m=0.1):
    """Reflectivity of a board with four sectors on a gray wall."""
    c, s = np.cos(turn), np.sin(turn)
    d = (uv - at) @ np.array([[c, -s], [s, c]])
    inside = np.all(np.abs(d) <= half_m, axis=1)
    return np.where(inside, np.where(d[:, 0] * d[:, 1] > 0.0, 0.85, 0.08), 0.5)


def test_centers_are_found_at_any_turn_with_the_deviation_that_is_stated():
    rng = np.random.default_rng(2)
    off, stated = [], []
    for _ in range(8):
        at, turn = rng.uniform(-0.05, 0.05, 2), rng.uniform(0.0, np.pi)
        points, intensity, T = wall(rng, lambda uv, at=at, turn=turn: board(uv, at=at, turn=turn))

        found = black_white_at(points, intensity, CENTER)

        assert found is not None
        off.append(np.linalg.norm((T.inverse() @ found.p_map)[:2] - at))
        stated.append(found.sd_m)
    assert np.max(off) < 0.006
    assert 0.3 < np.mean(off) / np.mean(stated) < 1.5


def test_a_board_is_found_in_the_tiles_of_a_map(tmp_path):
    rng = np.random.default_rng(3)
    points, intensity, T = wall(rng, board)
    columns = some_columns(rng, len(points))
    columns["xyz"] = (points - CENTER + 2.5).astype(np.float32)
    columns["intensity_normalized"] = intensity.astype(np.float32)
    with TileWriter(tmp_path, STORED, tile_m=5.0, paths=walk_paths()) as writer:
        writer.append((0, 0, 0), columns)
    pick = np.full(3, 2.5) + T.R @ [0.04, -0.03, 0.0]

    found = find_black_white(TileSet.open(tmp_path), pick)

    assert found is not None and found.points > 60
    assert np.linalg.norm(found.p_map - 2.5) < 0.006
    assert 0.0 < found.sd_m < 0.005 and 0.0 < found.sd_across_m < 0.01


def test_a_board_of_which_a_corner_is_hidden_still_has_its_center():
    rng = np.random.default_rng(3)
    points, intensity, T = wall(rng, board, seen=lambda uv: uv.min(axis=1) < 0.03)

    found = black_white_at(points, intensity, CENTER)

    assert found is not None
    assert np.linalg.norm((T.inverse() @ found.p_map)[:2]) < 0.006


@pytest.mark.parametrize(
    "painted",
    [
        lambda uv: np.full(len(uv), 0.5),
        lambda uv: np.where(uv[:, 0] > 0.01, 0.85, 0.08),  # a door frame
        lambda uv: np.where(np.abs(uv).max(axis=1) < 0.06, 0.08, 0.85),  # a switch
        lambda uv: np.where(np.abs(uv[:, 0]) < 0.03, 0.08, 0.85),  # a pipe
        lambda uv: np.where((uv[:, 0] > 0.0) & (uv[:, 1] > 0.0), 0.08, 0.85),  # a corner of paint
        lambda uv: np.where(np.sin(uv[:, 0] * 90.0) > 0.0, 0.85, 0.1),  # stripes
        lambda uv: 0.4 + 0.3 * np.sin(uv[:, 0] * 25.0) * np.cos(uv[:, 1] * 9.0),  # a poster
    ],
)
def test_what_has_no_four_sectors_is_no_target(painted):
    rng = np.random.default_rng(4)
    for _ in range(2):
        points, intensity, _ = wall(rng, painted)
        assert black_white_at(points, intensity, CENTER) is None


def test_a_board_of_which_a_sector_is_not_seen_is_no_target():
    rng = np.random.default_rng(5)
    points, intensity, _ = wall(rng, board, seen=lambda uv: uv[:, 0] < 0.0)

    assert black_white_at(points, intensity, CENTER) is None
