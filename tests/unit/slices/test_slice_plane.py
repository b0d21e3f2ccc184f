import numpy as np
import pytest

from recon4.errors import ConfigError
from recon4.geometry.se3 import SE3
from recon4.slices.points import SliceWindow, extent, points_in
from recon4.slices.reference import moved_plane
from recon4.slices.slice_plane import SlicePlane
from tests.unit.slices.room_map import write_map


@pytest.fixture(scope="module")
def cloud():
    return np.random.default_rng(3).uniform([-7, -6, -2], [9, 8, 3], (40_000, 3))


@pytest.fixture(scope="module")
def tiles(cloud, tmp_path_factory):
    return write_map(tmp_path_factory.mktemp("map"), cloud)


PLANES = [
    SlicePlane.horizontal(0.7, thickness_m=0.3),
    SlicePlane.vertical((-3.0, -2.0), (5.0, 4.0), thickness_m=0.2),
    SlicePlane.vertical((1.0, 1.0), (0.66, 0.06), thickness_m=0.05),
    SlicePlane.free((0.5, 0.3, 0.1), (0.3, -0.5, 0.8), thickness_m=0.4),
    SlicePlane.free((0.0, 0.0, 0.5), (0.0, 0.0, 1.0), thickness_m=0.4),
]


@pytest.mark.parametrize("plane", PLANES, ids=lambda plane: plane.kind)
def test_a_cut_holds_exactly_the_points_within_half_its_thickness(cloud, tiles, plane):
    stored = np.concatenate([tile.xyz_m() for tile in tiles])  # in steps of half a millimeter
    expected = np.abs((stored - plane.origin_m) @ plane.normal) <= plane.thickness_m / 2.0

    parts = list(points_in(tiles, plane))

    found = np.concatenate([plane.to_map(part.uvd) for part in parts])
    assert len(found) == expected.sum() > 50
    assert np.abs(sorted_rows(np.round(found, 11)) - sorted_rows(stored[expected])).max() < 1e-9


@pytest.mark.parametrize("plane", PLANES, ids=lambda plane: plane.kind)
def test_the_axes_of_a_cut_are_right_handed_and_its_coordinates_lead_back(plane):
    p = np.random.default_rng(1).uniform(-50, 50, (20, 3))

    back = plane.to_map(plane.to_plane(p))

    assert np.abs(plane.axes @ plane.axes.T - np.eye(3)).max() < 1e-12
    assert np.linalg.det(plane.axes) == pytest.approx(1.0)
    assert np.abs(back - p).max() < 1e-9


def test_a_horizontal_cut_shows_the_coordinates_of_the_map():
    uvd = SlicePlane.horizontal(1.5).to_plane(np.array([[3.0, 4.0, 1.7]]))

    assert uvd[0] == pytest.approx([3.0, 4.0, 0.2])


def test_a_vertical_cut_shows_the_way_from_its_first_point_and_the_height():
    uvd = SlicePlane.vertical((1.0, 1.0), (1.0, 9.0)).to_plane(np.array([[1.25, 4.0, 2.0]]))

    assert uvd[0] == pytest.approx([3.0, 2.0, 0.25])


def test_a_window_leaves_out_what_lies_beside_it(tiles):
    plane = PLANES[1]
    window = SliceWindow(1.0, -1.0, 3.0, 1.0)

    uvd = np.concatenate([part.uvd for part in points_in(tiles, plane, window=window)])

    every = np.concatenate([part.uvd for part in points_in(tiles, plane)])
    inside = (every[:, 0] >= 1) & (every[:, 0] <= 3) & (every[:, 1] >= -1) & (every[:, 1] <= 1)
    assert len(uvd) == inside.sum() > 10


def test_all_of_a_cut_is_inside_its_extent(tiles):
    for plane in PLANES:
        seen = extent(tiles, plane)
        uvd = np.concatenate([part.uvd for part in points_in(tiles, plane)])
        assert seen.left <= uvd[:, 0].min() and uvd[:, 0].max() <= seen.right
        assert seen.bottom <= uvd[:, 1].min() and uvd[:, 1].max() <= seen.top


def test_repeated_cuts_are_equally_far_from_each_other():
    planes = PLANES[3].repeated(4, spacing_m=0.25)

    assert np.diff([plane.offset_m for plane in planes]) == pytest.approx([0.25] * 3)


def test_far_from_the_origin_nothing_is_lost(tmp_path):
    p = np.array([[500_000.123, 5_400_000.456, 300.0], [500_001.0, 5_400_001.0, 300.004]])
    tiles = write_map(tmp_path, p)

    part = next(points_in(tiles, SlicePlane.horizontal(300.0, thickness_m=0.004)))

    assert len(part) == 1
    assert part.uvd[0, :2] == pytest.approx(p[0, :2], abs=2.5e-4)


def test_a_moved_cut_gives_moved_points_the_same_place():
    T = SE3.from_rpy(0.1, -0.2, 2.0, t=[5.0, -3.0, 1.0])
    p = np.random.default_rng(2).uniform(-5, 5, (10, 3))

    moved = moved_plane(PLANES[1], T)

    assert np.abs(moved.to_plane(T @ p) - PLANES[1].to_plane(p)).max() < 1e-9


@pytest.mark.parametrize(
    "make",
    [
        lambda: SlicePlane.free((0, 0, 0), (0, 0, 0)),
        lambda: SlicePlane.free((0, 0, float("nan")), (0, 0, 1)),
        lambda: SlicePlane.vertical((1, 1), (1, 1)),
        lambda: SlicePlane.horizontal(1.0, thickness_m=0.0),
        lambda: SlicePlane.horizontal(1.0).repeated(0, spacing_m=1.0),
        lambda: SlicePlane.horizontal(1.0).repeated(3, spacing_m=0.0),
    ],
)
def test_a_plane_without_meaning_is_refused(make):
    with pytest.raises(ConfigError):
        make()


def test_a_cut_is_a_value():
    assert SlicePlane.horizontal(1.0) == SlicePlane.horizontal(1.0)
    assert isinstance(hash(SlicePlane.horizontal(1.0)), int) and isinstance(
        SlicePlane.horizontal(1.0), SlicePlane
    )


def sorted_rows(p):
    return p[np.lexsort(p.T)]
