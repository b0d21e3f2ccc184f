import numpy as np
import pytest
from msgspec import structs

from recon4.slices import doubles
from recon4.slices.doubles import DoubleRule, find_double_walls, limit_m
from tests.unit.slices.room_map import T0_NS, wall, write_map

SECOND = 10**9


def visits(rng, places_m, *, count=30_000, sigma_m=0.01):
    """A wall scanned once a place, 20 s apart: points, normals, times, multiframes."""
    walls = [wall(rng, count, x_m=x, sigma_m=sigma_m) for x in places_m]
    t_s = np.concatenate([np.full(count, 20.0 * k + 1.0) for k in range(len(places_m))])
    return {
        "p_map": np.concatenate([p for p, _ in walls]),
        "normal": np.concatenate([n for _, n in walls]),
        "t_ns": T0_NS + (t_s * SECOND).astype(np.int64),
        "frame_id": (t_s * 10).astype(np.uint32),
    }


def checked(folder, **columns):
    return find_double_walls(write_map(folder, **columns))


@pytest.mark.parametrize("x_m", [0.0, 1.23, 2.4])
def test_a_wall_doubled_by_5_cm_is_found_with_its_two_visits(tmp_path, x_m):
    rng = np.random.default_rng(5)

    found = checked(tmp_path, **visits(rng, [x_m, x_m, x_m + 0.05]))

    wall = found.walls[0]
    assert wall.separation_m == pytest.approx(0.05, abs=0.005)
    assert wall.sigma_m == pytest.approx(0.01, abs=0.003)
    assert wall.bimodality > 3.5
    assert wall.share == pytest.approx(1 / 3, abs=0.05)
    assert abs(wall.normal[0]) > 0.99
    assert wall.middle_m[0] == pytest.approx(x_m + 0.017, abs=0.03)
    assert sorted(wall.spans_s) == [(0.0, 25.0), (40.0, 45.0)]
    assert sorted(wall.frames) == [(10, 210), (410, 410)]
    assert found.share > 0.6


def test_a_wall_seen_again_at_its_place_is_not_double(tmp_path):
    rng = np.random.default_rng(6)

    found = checked(tmp_path, **visits(rng, [0.0, 0.008, -0.008]))

    assert found.patches > 300
    assert found.walls == () and found.double_patches < 0.01 * found.patches
    worst = [one.separation_m / one.limit_m for one in found.surfaces]
    assert len(worst) > 3 and worst == sorted(worst, reverse=True) and worst[0] < 1.0
    assert found.surfaces[0].sigma_m == pytest.approx(0.01, abs=0.003)


def test_a_place_is_reported_once_as_double_or_as_single(tmp_path):
    rng = np.random.default_rng(5)
    columns = visits(rng, [0.0, 0.05])
    far = columns["p_map"][:, 1] > 2.5
    columns["p_map"][far & (columns["t_ns"] > T0_NS + 10 * SECOND), 0] -= 0.05

    found = checked(tmp_path, **columns)

    assert found.walls and found.surfaces
    assert max(one.middle_m[1] for one in found.walls) < 3.0
    assert min(one.middle_m[1] for one in found.surfaces) > 2.4


def test_a_thick_surface_is_no_double_wall(tmp_path):
    rng = np.random.default_rng(7)

    found = checked(tmp_path, **visits(rng, [0.0, 0.0], sigma_m=0.03))

    assert found.walls == ()


def test_the_two_faces_of_a_thin_wall_are_two_surfaces(tmp_path):
    rng = np.random.default_rng(8)
    columns = visits(rng, [0.0, 0.06])
    columns["normal"][30_000:] *= -1.0  # the other side looks the other way

    found = checked(tmp_path, **columns)

    assert found.walls == ()


def test_a_step_whose_sides_were_seen_at_different_times_is_not_double(tmp_path):
    rng = np.random.default_rng(9)
    columns = visits(rng, [0.0, 0.05])
    left = columns["p_map"][:, 1] < 2.0
    kept = np.where(columns["t_ns"] < T0_NS + 10 * SECOND, left, ~left)

    found = checked(tmp_path, **{name: values[kept] for name, values in columns.items()})

    assert found.walls == ()


def test_one_visit_says_nothing(tmp_path):
    found = checked(tmp_path, **visits(np.random.default_rng(1), [0.0]))

    assert found.patches == 0 and found.median_separation_m is None


def test_an_empty_map_has_no_double_walls(tmp_path):
    assert checked(tmp_path, p_map=np.empty((0, 3))).walls == ()


def test_the_limit_grows_with_noise_and_shrinks_with_points():
    rule = DoubleRule()
    few, many = (limit_m(np.array([0.01]), *[np.array([n])] * 2, rule=rule)[0] for n in (20, 2000))

    assert many == pytest.approx(rule.z * np.sqrt(2) * rule.pose_sigma_m, rel=0.02)
    assert few == pytest.approx(3 * np.sqrt(1e-4 * 10 * 2 / 20 + 2 * 0.007**2), rel=1e-9)


def test_a_larger_table_gives_the_same_answer(tmp_path, monkeypatch):
    columns = visits(np.random.default_rng(5), [0.0, 0.05])
    tiles = write_map(tmp_path, **columns)
    expected = find_double_walls(tiles)
    monkeypatch.setattr(
        doubles, "DOUBLE_WALLS", structs.replace(doubles.DOUBLE_WALLS, first_table=64)
    )

    assert find_double_walls(tiles) == expected
