"""What the phone is shown: new points only, and where something was not seen."""

import numpy as np
import pytest

from recon4.live.preview.cloud import PreviewCloud
from recon4.live.preview.coverage import Coverage, CoverageClass, Floors
from recon4.live.preview.tiles import Tiles
from recon4.live.preview.tuning import PLAN_TILES


def values(count):
    return (np.arange(count) % 251).astype(np.uint8)


def test_only_voxels_that_were_not_there_are_new():
    preview = PreviewCloud(voxel_m=0.1)

    first = preview.add(
        np.array([[0.01, 0.02, 0.03], [0.05, 0.05, 0.05], [-0.01, 0, 0]]), values(3)
    )
    second = preview.add(np.array([[0.09, 0.0, 0.0], [0.11, 0.0, 0.0]]), values(2))

    assert first.voxels.tolist() == [[0, 0, 0], [-1, 0, 0]]
    assert first.values.tolist() == [0, 2]
    assert (second.start, second.voxels.tolist()) == (2, [[1, 0, 0]])
    assert preview.add(np.array([[0.15, 0.0, 0.0]]), values(1)) is None


def test_growing_forgets_nothing():
    p = np.random.default_rng(1).uniform(-20, 20, (200_000, 3))
    preview = PreviewCloud(voxel_m=0.5, most=10**6)

    for part in np.array_split(p, 37):
        preview.add(part, values(len(part)))

    expected = np.unique(np.floor(p / 0.5).astype(np.int64), axis=0)
    got = preview.since(0).voxels
    assert len(got) == len(expected)
    np.testing.assert_array_equal(np.unique(got, axis=0), expected)


def test_too_many_points_double_the_voxels_and_everything_is_sent_again():
    p = np.random.default_rng(2).uniform(-10, 10, (20_000, 3))
    preview = PreviewCloud(voxel_m=0.1, most=5000)

    chunk = preview.add(p, values(len(p)))

    assert (chunk.generation, chunk.start) == (preview.generation, 0)
    assert len(chunk.voxels) == len(preview) <= 5000
    expected = np.unique(np.floor(p / chunk.voxel_m).astype(np.int64), axis=0)
    np.testing.assert_array_equal(np.unique(chunk.voxels, axis=0), expected)


def test_larger_voxels_keep_the_value_that_was_there_first():
    preview = PreviewCloud(voxel_m=0.1, most=2)

    chunk = preview.add(
        np.array([[0.01, 0, 0], [0.11, 0, 0], [5.01, 0, 0]]), np.array([7, 8, 9], np.uint8)
    )

    assert chunk.voxels.tolist() == [[0, 0, 0], [25, 0, 0]]
    assert chunk.values.tolist() == [7, 9]


def test_points_beyond_the_reach_of_the_numbers_are_left_out():
    preview = PreviewCloud(voxel_m=0.1)

    chunk = preview.add(np.array([[4000.0, 0, 0], [1.0, 0, 0]]), values(2))

    assert chunk.voxels.tolist() == [[10, 0, 0]]


def room(x0, x1, y0, y1, *, door=None, step=0.05):
    """Points on the walls of a room, without those in a door (a span of y in the wall x = x1)."""
    ys, xs = np.arange(y0, y1, step), np.arange(x0, x1, step)
    walls = [
        np.column_stack([np.full_like(ys, x0), ys]),
        np.column_stack([np.full_like(ys, x1), ys]),
        np.column_stack([xs, np.full_like(xs, y0)]),
        np.column_stack([xs, np.full_like(xs, y1)]),
    ]
    p = np.concatenate(walls)
    if door:
        p = p[~((np.abs(p[:, 0] - x1) < 1e-6) & (p[:, 1] > door[0]) & (p[:, 1] < door[1]))]
    return np.column_stack([p, np.zeros(len(p))])


def look(coverage, at, p, times=20, z_m=0.0):
    for _ in range(times):
        coverage.add(np.array([*at, z_m]), np.add(p, [0.0, 0.0, z_m]))
    coverage.refresh()


def seen_at(coverage, x_m, y_m):
    first, seen = coverage.seen()
    return seen[tuple((np.array([x_m, y_m]) / PLAN_TILES.cell_m - first).astype(int))]


def test_a_closed_room_has_no_gap_and_its_walls_are_seen_well():
    coverage = Coverage()

    look(coverage, (0.0, 0.0), room(-3, 3, -2, 2))

    assert coverage.gaps() == []
    assert coverage.well_seen_ratio() > 0.95


def test_an_open_door_is_a_gap_until_somebody_goes_in():
    coverage = Coverage()
    outer = room(-3, 3, -2, 2, door=(-0.6, 0.6))
    inside = np.array([[4.5, y, 0.0] for y in np.arange(-0.7, 0.7, 0.05)])
    look(coverage, (0.0, 0.0), np.concatenate([outer, inside]))

    (gap,) = coverage.gaps()[:1]

    assert gap.p_map[0] > 2.7
    assert abs(gap.p_map[1]) < 1.6
    assert gap.width_m >= 0.75
    look(coverage, (4.0, 0.0), room(3.02, 6, -2, 2))
    assert coverage.gaps() == []


def test_a_wall_far_away_is_seen_poorly():
    coverage = Coverage()
    wall = np.column_stack([np.full(41, 20.0), np.linspace(-2, 2, 41), np.zeros(41)])

    look(coverage, (0.0, 0.0), wall)

    assert seen_at(coverage, 20.1, 0.1) == CoverageClass.POOR


def test_the_floor_and_the_ceiling_stand_in_nobodys_way():
    coverage = Coverage()
    floor = np.array([[2.0, 0.0, -1.3], [2.0, 1.0, 1.5]])

    look(coverage, (0.0, 0.0), floor)

    assert seen_at(coverage, 2.1, 0.1) == CoverageClass.FREE
    assert not (coverage.seen()[1] >= CoverageClass.POOR).any()


def test_the_plan_grows_where_the_walk_goes():
    coverage = Coverage()
    look(coverage, (0.0, 0.0), room(-3, 3, -2, 2), times=2)
    before = coverage.seen()[1].sum()

    look(coverage, (-60.0, 45.0), room(-63, -57, 43, 47), times=2)

    _, seen = coverage.seen()
    assert seen.sum() == pytest.approx(2 * before, rel=0.05)
    assert seen_at(coverage, 2.9, 0.1) == seen_at(coverage, -57.1, 45.1) == CoverageClass.FREE


def test_a_wall_is_seen_well_after_twelve_rays():
    coverage, wall = Coverage(), np.array([[3.1, 0.1, 0.0]])

    look(coverage, (0.0, 0.0), wall, times=11)
    before = seen_at(coverage, 3.1, 0.1)
    look(coverage, (0.0, 0.0), wall, times=1)

    assert (before, seen_at(coverage, 3.1, 0.1)) == (CoverageClass.POOR, CoverageClass.WELL)


def test_somebody_who_stood_there_for_a_moment_is_no_wall():
    coverage = Coverage()

    look(coverage, (0.0, 0.1), np.array([[2.1, 0.1, 0.0]]), times=3)
    look(coverage, (0.0, 0.1), np.array([[6.1, 0.1, 0.0]]), times=40)

    assert seen_at(coverage, 2.1, 0.1) == CoverageClass.FREE


def test_an_open_door_far_from_the_way_is_no_gap():
    coverage = Coverage()
    outer = room(-3, 12, -2, 2, door=(-0.6, 0.6), step=0.02)
    inside = np.array([[13.5, y, 0.0] for y in np.arange(-0.7, 0.7, 0.02)])
    rays = np.concatenate([outer, inside])

    look(coverage, (0.0, 0.0), rays)
    from_afar = coverage.gaps()
    look(coverage, (8.0, 0.0), rays)

    assert from_afar == []
    assert any(gap.p_map[0] > 11.7 for gap in coverage.gaps())


def test_the_widest_gap_comes_first_and_a_crack_is_none():
    coverage = Coverage()
    walls = room(-3, 3, -4, 4, step=0.02)
    right = np.abs(walls[:, 0] - 3) < 1e-6
    rays = walls.copy()
    for low, high, reach in [(-3.5, -1.7, 1.3), (0.0, 0.2, 1.1), (2.0, 3.2, 1.3)]:
        beyond = right & (walls[:, 1] > low) & (walls[:, 1] < high)
        rays[beyond] = rays[beyond] * [reach, reach, 0.0] + [0.0, 0.0, -1.2]  # on the floor

    look(coverage, (0.0, 0.0), rays)

    gaps = coverage.gaps()
    assert len(gaps) == 2
    assert gaps[0].width_m > gaps[1].width_m
    assert gaps[0].p_map[1] < 0 < gaps[1].p_map[1]


def test_only_surfaces_near_the_way_count_as_seen_well():
    coverage = Coverage()
    look(coverage, (0.0, 0.0), np.array([[3.1, 0.1, 0.0]]), times=5)
    look(coverage, (0.0, 0.0), np.array([[0.1, 10.1, 0.0]]), times=20)

    assert seen_at(coverage, 0.1, 10.1) == CoverageClass.WELL
    assert coverage.well_seen_ratio() == 0.0


def test_cells_between_two_rays_are_no_gap():
    coverage = Coverage()

    look(coverage, (0.0, 0.0), room(-6, 6, -4, 4, step=0.3))

    assert coverage.gaps() == []


def test_gaps_far_behind_are_kept_and_filled_when_somebody_goes_back():
    coverage = Coverage()
    outer = room(-3, 3, -2, 2, door=(-0.6, 0.6))
    inside = np.array([[4.5, y, 0.0] for y in np.arange(-0.7, 0.7, 0.05)])
    look(coverage, (0.0, 0.0), np.concatenate([outer, inside]))
    before = coverage.gaps()

    look(coverage, (200.0, -150.0), room(197, 203, -152, -148))
    far_away = coverage.gaps()
    look(coverage, (4.0, 0.0), room(3.02, 6, -2, 2))

    assert len(before) >= 1
    assert far_away == before
    assert coverage.gaps() == []
    assert seen_at(coverage, 1.1, 1.1) == CoverageClass.FREE


def test_a_gap_across_the_border_of_two_tiles_is_one():
    coverage = Coverage()
    edge_m = PLAN_TILES.tile * PLAN_TILES.cell_m
    outer = room(edge_m - 3, edge_m + 3, -2, 2)
    top = np.abs(outer[:, 1] - 2) > 0.2
    hole = (outer[:, 0] > edge_m - 1) & (outer[:, 0] < edge_m + 1) & ~top
    rays = outer.copy()
    rays[hole] += [0.0, 1.0, -1.2]  # seen through, to the floor behind

    look(coverage, (edge_m + 0.1, 0.0), rays)

    (gap,) = coverage.gaps()
    assert gap.width_m >= 1.5
    assert abs(gap.p_map[0] - edge_m) < 1.0


def test_what_was_seen_downstairs_says_nothing_of_the_floor_above():
    coverage = Coverage()
    outer = room(-3, 3, -2, 2, door=(-0.6, 0.6))
    inside = np.array([[4.5, y, 0.0] for y in np.arange(-0.7, 0.7, 0.05)])
    look(coverage, (0.0, 0.0), room(-3, 3, -2, 2))

    look(coverage, (0.0, 0.0), np.concatenate([outer, inside]), z_m=3.0)
    upstairs = coverage.floor, len(coverage.gaps()), coverage.gaps_elsewhere()
    look(coverage, (0.0, 0.0), room(-3, 3, -2, 2), times=1)
    downstairs = coverage.floor, len(coverage.gaps()), coverage.gaps_elsewhere()

    assert upstairs[0] == 1
    assert upstairs[1] >= 1
    assert upstairs[2] == 0
    assert downstairs == (0, 0, upstairs[1])


def test_rays_are_followed_for_thirty_meters():
    coverage = Coverage()

    look(coverage, (0.0, 0.0), np.array([[80.0, 0.1, 0.0]]))

    assert seen_at(coverage, 29.0, 0.1) == CoverageClass.FREE
    assert not (coverage.seen()[1] >= CoverageClass.POOR).any()


def climbed(floors, *heights_m, seconds=30):
    """Stairs at 0.3 m/s from one height to the next, and a while on each."""
    found, z_m = [], heights_m[0]
    for height_m in heights_m:
        while abs(height_m - z_m) > 1e-6:
            z_m += np.clip(height_m - z_m, -0.03, 0.03)
            floors.at(z_m)
        found += [floors.at(z_m) for _ in range(10 * seconds)][-1:]
    return found


@pytest.mark.parametrize("storey_m", [2.7, 3.3, 4.5])
def test_floors_are_found_again_by_their_height(storey_m):
    found = climbed(Floors(), *(storey_m * np.array([0, 1, 2, 1, 0, 2])))

    assert len(set(found)) == 3
    assert found[3] == found[1]
    assert found[4] == found[0]
    assert found[5] == found[2]


def test_a_street_that_rises_gently_is_one_floor():
    floors = Floors()

    for step in range(6000):  # 10 minutes at 1 m/s, 5 %
        floors.at(0.005 * step)

    assert len(floors) == 1


def test_a_jump_far_away_does_not_make_the_plan_larger_than_a_phone_can_draw():
    tiles = Tiles({"seen": ("u1", 0)})
    for at in (0, 3000, 4_000_000):  # 0, 750 m and 1000 km away
        tiles.move_to(np.array([at, -at]))
        tiles.window["seen"][PLAN_TILES.window // 2, PLAN_TILES.window // 2] = 1

    _, far = tiles.whole("seen")
    tiles.move_to(np.array([3000, -3000]))
    _, near = tiles.whole("seen")

    assert far.sum() == 1 and max(far.shape) <= PLAN_TILES.window
    assert near.sum() == 2 and max(near.shape) <= (2 * PLAN_TILES.shown + 1) * PLAN_TILES.tile


def test_the_work_of_a_second_and_the_memory_of_a_plan_follow_what_was_seen():
    tiles = Tiles({"seen": ("u1", 0)})

    for x in range(0, 100_000, 64):
        tiles.move_to(np.array([x, x]))
        if x < 640:
            tiles.window["seen"][PLAN_TILES.window // 2, PLAN_TILES.window // 2] = 1

    assert tiles.window["seen"].shape == (PLAN_TILES.window, PLAN_TILES.window)
    tiles.move_to(np.zeros(2, np.int64))
    _, cells = tiles.whole("seen")
    assert cells.sum() == 10
    assert max(cells.shape) <= 12 * PLAN_TILES.tile


def test_free_space_stays_free_however_long_one_stands_before_it():
    """The ratio of rays that end to those that pass counts, after minutes too."""
    coverage = Coverage()
    beyond, here = np.array([[4.1, 0.1, 0.0]]), np.array([[2.1, 0.1, 0.0]])

    look(coverage, (0.1, 0.1), np.repeat(beyond, 20_000, axis=0), times=10)
    look(coverage, (0.1, 0.1), np.repeat(here, 9000, axis=0), times=1)

    assert seen_at(coverage, 2.1, 0.1) == CoverageClass.FREE
