"""Distances and levels of detection of M3C2, against what arithmetic says of planes."""

import numpy as np
import pytest

from recon4.comparison.m3c2 import core_points, differences
from recon4.comparison.records import CoreState, DifferenceTally, M3C2Scales
from recon4.comparison.tuning import M3C2
from recon4.errors import ConfigError
from recon4.geometry.se3 import SE3
from tests.unit.slices.room_map import wall, write_map

STATED_M = 0.003, 0.004


def plane_map(folder, rng, *, x_m=0.0, sigma_m=0.01, sd_m=0.0, T=None):
    """A wall across x of 4 x 2 m that is seen from the positive side, moved by a motion."""
    p, normal = wall(rng, 20_000, x_m=x_m, sigma_m=sigma_m)
    T = T or SE3.identity()
    sd = np.full(len(p), sd_m)
    return write_map(folder, T @ p, normal=normal @ T.R.T, position_sd_m=sd)


def compared(first, second, T_a_b=None, **scales):
    """Core points of all tiles together, by name."""
    parts = list(differences(first, second, T_a_b or SE3.identity(), scales=M3C2Scales(**scales)))
    names = "p_map", "normal", "distance_m", "lod_m", "points", "state"
    return {name: np.concatenate([getattr(part, name) for part in parts]) for name in names}


@pytest.mark.parametrize("shift_m", [-0.31, 0.0, 0.004, 0.05, 0.27])
def test_a_shifted_plane_has_its_shift_and_the_level_of_equation_1(tmp_path, shift_m):
    rng = np.random.default_rng(1)
    first = plane_map(tmp_path / "a", rng, sd_m=STATED_M[0])
    second = plane_map(tmp_path / "b", rng, x_m=shift_m, sigma_m=0.005, sd_m=STATED_M[1])

    found = compared(first, second)

    known = found["state"] <= CoreState.SIGNIFICANT
    assert known.mean() > 0.99
    d, lod, n = found["distance_m"][known], found["lod_m"][known], found["points"][known]
    assert d.mean() == pytest.approx(shift_m, abs=3e-4)
    noise_m = np.sqrt(0.01**2 / n[:, 0] + 0.005**2 / n[:, 1])
    assert d.std() == pytest.approx(noise_m.mean(), rel=0.3)
    expected = 1.96 * (noise_m + np.hypot(*STATED_M))
    assert lod.mean() == pytest.approx(expected.mean(), rel=0.02)
    assert (found["state"][known] == CoreState.SIGNIFICANT).mean() == pytest.approx(
        float(abs(shift_m) > 0.015), abs=0.01
    )


def test_a_map_does_not_differ_from_itself(tmp_path):
    rng = np.random.default_rng(2)
    corner = np.concatenate([wall(rng, 8000)[0], wall(rng, 8000)[0][:, [1, 0, 2]]])
    normal = np.repeat([[1.0, 0.0, 0.0], [0.0, 1.0, 0.0]], 8000, axis=0)
    map_ = write_map(tmp_path, corner, normal=normal)

    found = compared(map_, map_)

    known = found["state"] <= CoreState.SIGNIFICANT
    assert known.mean() > 0.9 and np.all(found["distance_m"][known] == 0.0)


@pytest.mark.parametrize("shift_m", [None, 0.004])
def test_figures_of_small_differences_are_those_of_the_points(tmp_path, shift_m):
    rng = np.random.default_rng(1)
    first = second = plane_map(tmp_path / "a", rng)
    if shift_m is not None:
        second = plane_map(tmp_path / "b", rng, x_m=shift_m)
    tally, points = DifferenceTally(), compared(first, second)
    for part in differences(first, second, SE3.identity(), scales=M3C2Scales()):
        tally.add(part)

    found = tally.figures()
    off = np.abs(points["distance_m"][points["state"] <= CoreState.SIGNIFICANT])
    assert found.p50_m == pytest.approx(np.median(off), abs=1e-4)
    assert found.p95_m == pytest.approx(np.percentile(off, 95.0), abs=2e-4)
    assert found.p50_m <= found.p95_m <= found.largest_m


def test_the_noise_of_a_still_plane_exceeds_the_level_in_a_twentieth_of_the_places(tmp_path):
    rng = np.random.default_rng(3)
    first, second = (plane_map(tmp_path / name, rng) for name in "ab")

    found = compared(first, second)  # no uncertainty of the registration is stated

    known = found["state"] <= CoreState.SIGNIFICANT
    assert (found["state"][known] == CoreState.SIGNIFICANT).mean() == pytest.approx(0.05, abs=0.02)


def test_the_distance_is_signed_by_the_side_from_which_the_wall_was_seen(tmp_path):
    rng = np.random.default_rng(4)
    turn = SE3.from_rpy(0.0, 0.0, np.pi, t=[1.0, 2.0, 0.0])
    first = plane_map(tmp_path / "a", rng, T=turn)
    second = plane_map(tmp_path / "b", rng, x_m=0.04, T=turn)  # in front of it

    assert np.nanmedian(compared(first, second)["distance_m"]) == pytest.approx(0.04, abs=1e-3)


def test_a_second_map_in_a_frame_of_its_own_is_moved(tmp_path):
    rng = np.random.default_rng(5)
    T_a_b = SE3.from_rpy(0.1, -0.2, 2.0, t=[30.0, -7.0, 2.0])
    first = plane_map(tmp_path / "a", rng)
    second = plane_map(tmp_path / "b", rng, x_m=0.02, T=T_a_b.inverse())

    found = compared(first, second, T_a_b)

    known = found["state"] <= CoreState.SIGNIFICANT
    assert known.mean() > 0.99
    assert found["distance_m"][known].mean() == pytest.approx(0.02, abs=3e-4)


def test_core_points_without_a_partner_are_counted(tmp_path):
    rng = np.random.default_rng(6)
    first = plane_map(tmp_path / "a", rng)
    p, normal = wall(rng, 10_000, size_m=(2.0, 2.0))  # half of the wall is gone
    second = write_map(tmp_path / "b", p, normal=normal)
    tally = DifferenceTally()

    for part in differences(first, second, SE3.identity(), scales=M3C2Scales()):
        tally.add(part)

    counts, figures = tally.counts(), tally.figures()
    every = sum(len(core_points(tile, 0.1)[0]) for tile in first.as_measured())
    assert counts.core_points == every
    assert every == (
        counts.compared + counts.without_partner + counts.without_normal + counts.sparse
    )
    assert counts.without_partner == pytest.approx(every / 2, rel=0.1)
    assert figures.lod_p50_m < 0.01 and figures.p95_m < 0.006


def test_without_any_partner_there_are_no_figures(tmp_path):
    rng = np.random.default_rng(7)
    first, second = plane_map(tmp_path / "a", rng), plane_map(tmp_path / "b", rng, x_m=2.0)
    tally = DifferenceTally()

    for part in differences(first, second, SE3.identity(), scales=M3C2Scales()):
        tally.add(part)
        assert np.isnan(part.distance_m).all() and np.isnan(part.lod_m).all()

    assert tally.counts().compared == 0 and tally.figures() is None


def test_the_two_faces_of_a_thin_wall_are_not_mixed(tmp_path):
    rng = np.random.default_rng(8)

    def thin(folder, thick_m):
        front, normal = wall(rng, 20_000)
        back, _ = wall(rng, 20_000, x_m=-thick_m)
        return write_map(
            folder, np.concatenate([front, back]), normal=np.concatenate([normal, -normal])
        )

    found = compared(thin(tmp_path / "a", 0.08), thin(tmp_path / "b", 0.11))

    known = found["state"] <= CoreState.SIGNIFICANT
    front = known & (found["p_map"][:, 0] > -0.03)
    assert found["distance_m"][front].mean() == pytest.approx(0.0, abs=1e-3)
    assert found["distance_m"][known & ~front].mean() == pytest.approx(0.03, abs=1e-3)


def test_what_is_placed_before_a_wall_does_not_blur_it(tmp_path):
    rng = np.random.default_rng(9)
    first = plane_map(tmp_path / "a", rng)
    p, normal = wall(rng, 20_000, x_m=0.02)
    board, _ = wall(rng, 20_000, x_m=0.35)
    second = write_map(
        tmp_path / "b", np.concatenate([p, board]), normal=np.concatenate([normal, normal])
    )

    layered = compared(first, second)
    whole = compared(first, second, layer_m=0.5)  # as in the paper

    assert np.nanmedian(layered["distance_m"]) == pytest.approx(0.02, abs=1e-3)
    assert np.nanmedian(layered["lod_m"]) < 0.01
    assert np.nanmedian(whole["lod_m"]) > 0.03


def test_a_surface_too_sparse_to_judge_is_not_taken_for_the_one_behind_it(tmp_path):
    rng = np.random.default_rng(12)
    p, normal = wall(rng, 20_000)
    veil, _ = wall(rng, 1_600, x_m=0.3, sigma_m=0.002)  # 3.5 points a cylinder
    both = np.concatenate([p, veil])
    first = write_map(tmp_path, both, normal=np.concatenate([normal, normal[: len(veil)]]))

    found = compared(first, first)

    before = found["p_map"][:, 0] > 0.2
    assert set(found["state"][before]) >= {CoreState.SPARSE}
    assert np.all(found["points"][before & (found["state"] <= CoreState.SIGNIFICANT)] < 15)


def test_maps_that_state_no_uncertainty_have_the_usual_one(tmp_path):
    rng = np.random.default_rng(10)
    first, second = (plane_map(tmp_path / name, rng, sd_m=np.nan) for name in "ab")

    found = compared(first, second)

    assert np.nanmin(found["lod_m"]) > 1.96 * np.sqrt(2.0) * M3C2.usual_sd_m


def test_scales_without_sense_are_refused(tmp_path):
    map_ = plane_map(tmp_path, np.random.default_rng(11))

    with pytest.raises(ConfigError, match=r"core points: expected 0\.02 to 10 m, got 0\.001"):
        compared(map_, map_, core_spacing_m=0.001)
    with pytest.raises(ConfigError, match="depth_m: expected more than 0 and at most 5 m"):
        compared(map_, map_, depth_m=np.inf)


def test_scales_follow_the_voxels_of_the_coarser_map():
    fine = M3C2Scales.of_maps((0.01, 0.02), core_spacing_m=0.2)
    coarse = M3C2Scales.of_maps((0.01, 0.1), core_spacing_m=0.2)

    assert fine == M3C2Scales(core_spacing_m=0.2)
    assert (coarse.normal_m, coarse.cylinder_m) == pytest.approx((0.8, 0.4))
