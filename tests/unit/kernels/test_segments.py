import numpy as np
import pytest

from recon4.kernels.segments import _sort_by_cell, draw_pairs, points_of_sensor

BINS, GENERATED, KEPT, LENGTH = 36, 20, 5, 0.34


def rings_of(rings, columns, range_m=5.0):
    """A sphere of points seen by beams 2° apart."""
    azimuth = np.tile(np.linspace(-np.pi, np.pi, columns, endpoint=False) + 1e-4, rings)
    ring = np.repeat(np.arange(rings), columns)
    up = np.deg2rad(2.0) * (ring - rings // 2)
    d = np.stack([np.cos(up) * np.cos(azimuth), np.cos(up) * np.sin(azimuth), np.sin(up)], axis=1)
    return (range_m * d).astype(np.float32), ring.astype(np.uint8)


def draw(xyz, ring, *, rings=None, bins=BINS, generated=GENERATED, kept=KEPT, seed=1):
    rings = int(ring.max()) + 1 if rings is None else rings
    return draw_pairs(xyz, ring, rings, bins, generated, kept, LENGTH, seed)


def cells(xyz, bins=BINS):
    turn = np.arctan2(xyz[:, 1], xyz[:, 0]) + np.pi
    return np.minimum((turn * bins / (2 * np.pi)).astype(int), bins - 1)


def test_a_full_turn_of_sixteen_beams_gives_36_x_15_x_5_segments():
    xyz, ring = rings_of(16, 1800)

    pairs = draw(xyz, ring)

    assert pairs.shape == (36 * 15 * 5, 2)


def test_pairs_join_neighboring_rings_in_one_cell_and_none_comes_twice():
    xyz, ring = rings_of(16, 1800)

    a, b = draw(xyz, ring).T

    np.testing.assert_array_equal(ring[b].astype(int) - ring[a], 1)
    np.testing.assert_array_equal(cells(xyz)[a], cells(xyz)[b])
    assert len(set(zip(a.tolist(), b.tolist(), strict=True))) == len(a)


def test_the_same_seed_draws_the_same_and_another_seed_others():
    xyz, ring = rings_of(16, 1800)

    np.testing.assert_array_equal(draw(xyz, ring), draw(xyz, ring))
    assert (draw(xyz, ring) != draw(xyz, ring, seed=2)).any()


def test_with_enough_draws_the_shortest_of_all_pairs_is_kept_first():
    # One cell, two points below and two above: lengths 1.0, 2.0, sqrt 2 and sqrt 5.
    xyz = np.array([[10, 0.5, 0], [10, 1.5, 0], [10, 0.5, 1.0], [9, 1.5, 2.0]], np.float32)
    ring = np.array([0, 0, 1, 1], np.uint8)

    pairs = draw_pairs(xyz, ring, 2, 4, 4, 1, LENGTH, 3)
    many = [draw_pairs(xyz, ring, 2, 4, 4, 2, LENGTH, seed) for seed in range(40)]

    assert len(pairs) == 1
    shortest = [(0, 2) in {tuple(p) for p in found.tolist()} for found in many]
    assert np.mean(shortest) > 0.5  # four draws of four pairs: 1 - (3/4)^4 = 68 %
    for found in many:
        length = np.linalg.norm(xyz[found[:, 0]] - xyz[found[:, 1]], axis=1)
        assert (np.diff(length) >= 0).all()


def test_keeping_fewer_keeps_the_shortest_of_the_same_draws():
    xyz, ring = rings_of(2, 720)
    one = draw(xyz, ring, kept=1)
    five = draw(xyz, ring, kept=5)
    length = np.linalg.norm(xyz[five[:, 0]] - xyz[five[:, 1]], axis=1).reshape(36, 5)

    np.testing.assert_allclose(
        np.linalg.norm(xyz[one[:, 0]] - xyz[one[:, 1]], axis=1), length.min(axis=1)
    )


@pytest.mark.parametrize(("far_m", "kept"), [(2.6, 36 * KEPT), (2.8, 0)])
def test_a_segment_across_a_depth_edge_is_dropped(far_m, kept):
    # 0.34 of the nearer range of 2 m are 0.68 m.
    near, far = rings_of(2, 720, 2.0), rings_of(2, 720, far_m)
    xyz = np.where(near[1][:, None] == 0, near[0], far[0])

    assert len(draw(xyz, near[1], bins=36, generated=400)) == kept


def test_an_empty_ring_is_skipped():
    xyz, ring = rings_of(3, 1800)
    there = ring != 1

    a, b = draw(xyz[there], ring[there], rings=3).T

    assert len(a) == 36 * 5
    assert (ring[there][a] == 0).all()
    assert (ring[there][b] == 2).all()


@pytest.mark.parametrize(("upper", "joined"), [(3, True), (4, False)])
def test_rings_far_apart_are_not_joined_however_many_between_are_empty(upper, joined):
    xyz, ring = rings_of(5, 1800)
    there = (ring == 0) | (ring == upper)

    assert (len(draw(xyz[there], ring[there], rings=5)) > 0) == joined


def test_empty_cells_give_nothing():
    xyz, ring = rings_of(16, 1800)
    front = np.abs(np.arctan2(xyz[:, 1], xyz[:, 0])) < np.deg2rad(9.9)

    pairs = draw(xyz[front], ring[front])

    assert len(pairs) == 2 * 15 * 5


def test_one_ring_or_no_point_gives_no_segment():
    xyz, ring = rings_of(1, 100)

    assert draw(xyz, ring).shape == (0, 2)
    assert draw(xyz[:0], ring[:0], rings=16).shape == (0, 2)


@pytest.mark.parametrize("kept", [16, 17, 20])
def test_all_that_is_drawn_may_be_kept(kept):
    xyz, ring = rings_of(2, 3600)

    a, b = draw(xyz, ring, kept=kept).T

    assert 36 * (kept - 2) < len(a) <= 36 * kept
    assert (ring[b] == 1).all()


@pytest.mark.parametrize("bins", [2, 36])
def test_a_point_is_in_the_bin_of_its_azimuth_whatever_point_came_before_it(bins):
    rng = np.random.default_rng(7)
    edges = np.linspace(-np.pi, np.pi, bins + 1)
    angle = np.concatenate([rng.choice(edges, 400) + rng.normal(0, 4e-6, 400), edges])
    reach_m = 10.0 ** rng.uniform(-1, 2, len(angle))
    flat = np.stack([np.cos(angle), np.sin(angle), 0.0 * angle], axis=1) * reach_m[:, None]
    xyz, ring = np.float32(flat), np.zeros(len(angle), np.uint8)

    order, start = _sort_by_cell(xyz, ring, 1, bins)
    alone = [_sort_by_cell(p[None], ring[:1], 1, bins)[1] for p in xyz]

    bin_of = np.empty(len(xyz), int)
    bin_of[order] = np.repeat(np.arange(bins), np.diff(start))
    assert bin_of.tolist() == [int(np.argmax(one > 0)) - 1 for one in alone]


def test_the_points_of_a_sensor_keep_their_order():
    sensor = np.array([1, 0, 1, 1, 0], np.uint8)
    xyz = np.arange(15, dtype=np.float32).reshape(5, 3)
    ring, dt_ns = np.arange(5, dtype=np.uint8), np.arange(10, 15, dtype=np.int32)

    found = points_of_sensor(sensor, 1, xyz, ring, dt_ns)

    for got, column in zip(found, (xyz, ring, dt_ns), strict=True):
        assert np.array_equal(got, column[[0, 2, 3]])
