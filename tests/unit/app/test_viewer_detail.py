"""Which points a camera gets, and how many a browser can take."""

import numpy as np
import pytest

from recon4.mapping.tile_order import progressive
from recon4_app.viewer.client.client_session import PointBudget
from recon4_app.viewer.cloud.lod import Camera, TileBoxes, base_step, choose, chunks_of, in_sight
from recon4_app.viewer.tuning import POINT_BUDGET

AHEAD = np.array([[0.0, 0.0, 1.0], [-1.0, 0.0, 0.0], [0.0, -1.0, 0.0]])
"""Looks along x, z up."""


def street(tiles=40, points=500_000, step=256):
    """Tiles of 5 m in a row along x, from 0 on."""
    low = np.stack([5.0 * np.arange(tiles), np.zeros(tiles), np.zeros(tiles)], axis=1)
    sizes = tuple(np.array([len(rows) for rows in chunks_of(points, step)]) for _ in range(tiles))
    return TileBoxes(low, low + 5.0, np.full(tiles, 50.0), sizes)


def camera(x=0.0, R=AHEAD):
    return Camera(np.array([x, 2.5, 1.5]), R, 1.3, 1440, 900)


@pytest.mark.parametrize("count", [1, 7, 63, 64, 65, 1000, 123_457])
@pytest.mark.parametrize("step", [1, 2, 16, 64, 128, 1024])
def test_the_chunks_of_a_tile_are_all_of_its_points_once(count, step):
    chunks = chunks_of(count, step)

    rows = np.concatenate([np.arange(c.start, c.stop, c.step) for c in chunks])

    np.testing.assert_array_equal(np.sort(rows), np.arange(count))
    assert all(len(chunk) for chunk in chunks[1:])


def test_the_first_chunks_are_an_even_sample_however_small():
    order = progressive(np.arange(64_000))  # place of each stored row along the tile
    chunks = chunks_of(len(order), 1024)

    for shown in range(1, 6):
        rows = np.concatenate([np.arange(c.start, c.stop, c.step) for c in chunks[:shown]])
        gaps = np.diff(np.sort(order[rows]))
        assert gaps.max() <= 1.1 * np.median(gaps)


def test_the_base_of_any_map_is_small():
    for points in (10, 60_000, 60_001, 20_000_000, 10**9):
        step = base_step(points, 60_000)
        assert points / step <= 60_000 < max(points / step * 2.0, 60_001)


def test_the_budget_is_kept_and_used():
    boxes = street()

    chosen = choose(boxes, camera(), 1_000_000)

    sent = sum(int(boxes.sizes[tile][chunk]) for tile, chunk in chosen)
    assert 900_000 < sent <= 1_000_000


def test_every_chunk_comes_after_those_it_builds_on():
    seen = {}
    for tile, chunk in choose(street(), camera(), 2_000_000):
        assert chunk == seen.get(tile, 0) + 1
        seen[tile] = chunk
    assert len(seen) > 5


def test_near_tiles_get_more_than_far_ones_and_those_behind_nothing():
    chosen = choose(street(), camera(x=50.0), 1_500_000)

    finest = dict(chosen)  # the last chunk of each tile
    assert min(finest) >= 9
    assert finest[10] > finest[20] > finest.get(35, 0)


def test_what_one_looks_at_gets_more_than_the_rim():
    low = np.array([[20.0, -2.5, -2.5], [20.0, 13.5, -2.5]])
    boxes = TileBoxes(low, low + 5.0, np.full(2, 50.0), street(tiles=2).sizes)
    at = Camera(np.zeros(3), AHEAD, 1.3, 1440, 900)

    chosen = choose(boxes, at, 300_000)

    assert sum(tile == 0 for tile, _ in chosen) > sum(tile == 1 for tile, _ in chosen) > 0


def test_points_closer_than_a_pixel_are_not_asked_for():
    far_away = choose(street(tiles=1), camera(x=-3000.0), 3_000_000)

    assert far_away == []


@pytest.mark.parametrize(("x", "seen"), [(-1.0, 40), (100.0, 20), (300.0, 0)])
def test_only_what_is_ahead_is_in_sight(x, seen):
    assert abs(int(in_sight(street(), camera(x=x)).sum()) - seen) <= 1


def test_a_quick_browser_gets_twice_as_many_until_it_has_all():
    budget = PointBudget(3_000_000)
    given = [budget.points]
    while not budget.settled:
        budget.record(0.05)
        given.append(budget.points)

    assert given[0] == POINT_BUDGET.first_points
    assert given[-1] == 3_000_000 and len(given) <= 6


def test_a_slow_browser_gets_less_and_stays_there():
    budget = PointBudget(3_000_000)
    budget.record(2.0)
    budget.record(0.05)

    assert budget.points == POINT_BUDGET.first_points // 2 and budget.settled


def test_a_browser_that_does_not_answer_is_never_given_nothing():
    budget = PointBudget(3_000_000)
    for _ in range(9):
        budget.record(None)

    assert budget.points == POINT_BUDGET.fewest_points


def test_a_long_way_there_and_back_is_not_held_against_a_browser():
    budget = PointBudget(3_000_000)
    budget.began(1.5)
    budget.record(1.6)

    assert budget.points == 2 * POINT_BUDGET.first_points
