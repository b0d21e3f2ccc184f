"""What scans see through."""

import numpy as np
import pytest

from recon4.kernels.free_space import NO_SURFACE, find_moving_points, nearest_ranges

RULES = np.array([0.3, 0.05, 0.3, 30.0, 2.0, 4.0])
POINT = np.array([[5.0, 0.0, 0.0]])


def is_moving(*seen_m: float) -> bool:
    """Whether a point 5 m away moves, if scans see surfaces at these ranges all around."""
    images = np.stack([np.full((1, 90, 180), range_m, np.float32) for range_m in seen_m])
    R, t = np.tile(np.eye(3), (len(seen_m), 1, 1, 1)), np.zeros((len(seen_m), 1, 3))
    moving = np.zeros(1, np.bool_)
    find_moving_points(POINT, R, t, images, RULES, moving)
    return bool(moving[0])


@pytest.mark.parametrize(
    ("seen_m", "moving"),
    [
        ((9.0,), False),  # one scan is none
        ((9.0, 9.0), True),
        ((9.0, 9.0, 5.0), True),
        ((9.0, 9.0, 5.0, 5.0), False),  # as many meet a surface
        ((2.0, 2.0, 2.0), False),  # something nearer hides it
        ((NO_SURFACE, NO_SURFACE), False),  # nothing came back
        ((5.4, 5.4), False),  # within the margin
    ],
)
def test_a_point_moves_if_most_scans_see_through_it(
    seen_m: tuple[float, ...], moving: bool
) -> None:
    assert is_moving(*seen_m) == moving


def test_an_image_has_the_nearest_range_in_each_direction() -> None:
    image = np.full((90, 180), NO_SURFACE, np.float32)
    points = np.array([[4.0, 0.1, 0.1], [2.0, 0.05, 0.05], [0.0, 0.0, -1.5]])

    nearest_ranges(points, np.eye(3), np.zeros(3), image)

    seen = image[np.isfinite(image)]
    assert sorted(seen.tolist()) == pytest.approx([1.5, 2.0], abs=0.01)
    assert image[0, :].min() == pytest.approx(1.5)  # straight down
