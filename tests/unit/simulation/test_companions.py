"""People who walk with the carrier."""

import numpy as np
import pytest

from recon4.errors import ConfigError
from recon4.geometry.raycast import Hits
from recon4.simulation.companions import Companions
from recon4.simulation.crowd import Crowd
from recon4.simulation.setup import prepare
from recon4.simulation.walk import Walk


def straight(seconds: float = 4.0) -> Walk:
    """One meter a second along x, 1.5 m above the floor."""
    t_s = np.arange(0.0, seconds + 0.01, 0.02)
    return Walk.through(np.column_stack([t_s, 0 * t_s, 1.5 + 0 * t_s, 0 * t_s, 0 * t_s, 0 * t_s]))


def ahead(away_m: float) -> Companions:
    """One person in front, without sway at t = 0."""
    return Companions(np.array([[away_m, 0.0]]), np.zeros((1, 2)))


def cast(companions: Companions, rays: list[list[float]], *, t_s: float, wall_m: float) -> Hits:
    count = len(rays)
    wall = Hits(
        np.full(count, wall_m, np.float32),
        np.zeros(count, np.uint32),
        np.tile(np.float32([-1, 0, 0]), (count, 1)),
    )
    return companions.hide(
        wall, np.float32(rays), walk=straight(), t_s=np.full(count, t_s), surface=7
    )


def test_a_person_hides_the_wall_behind_and_nothing_beside() -> None:
    forward, beside, above = [1.0, 0, 0], [0, 1.0, 0], [0.8, 0, 0.6]
    origin = [0.0, 0.0, 1.5]

    hits = cast(ahead(1.5), [origin + d for d in (forward, beside, above)], t_s=0.0, wall_m=9.0)

    assert hits.range_m == pytest.approx([1.5 - 0.27, 9.0, 9.0], abs=1e-5)
    assert hits.triangle.tolist() == [7, 0, 0]
    assert hits.normal[0] == pytest.approx([-1.0, 0.0, 0.0], abs=1e-5)


def test_a_wall_before_the_person_is_seen_first() -> None:
    hits = cast(ahead(1.5), [[0.0, 0.0, 1.5, 1.0, 0.0, 0.0]], t_s=0.0, wall_m=0.5)

    assert hits.range_m == pytest.approx([0.5])


def test_people_walk_with_the_carrier() -> None:
    centers, feet_m = ahead(1.5).centers(straight(), np.array([0.0, 3.0]))

    assert centers[0, :, 0] == pytest.approx([1.5, 4.5], abs=0.09)  # and sway by 8 cm
    assert feet_m == pytest.approx([0.0, 0.0], abs=1e-9)


def test_five_people_hide_a_fifth_of_the_view_or_more() -> None:
    for seed in range(20):
        group = Companions.drawn(5, np.random.default_rng(seed))

        assert 0.2 < group.view_ratio < 0.6


def test_a_crowd_that_does_not_fit_is_refused() -> None:
    with pytest.raises(ConfigError, match="0 to 12 people can walk along, got 13"):
        prepare("tunnel", seconds=5.0, seed=1, crowd=Crowd(people=13))
