"""Rigid fit to control points, and what is found wrong with a survey."""

from dataclasses import replace

import numpy as np
import pytest

from recon4.errors import GeoreferenceError
from recon4.geometry.se3 import SE3, so3_exp
from recon4.georeference.control_blunders import (
    Blunder,
    BlunderKind,
    check_outliers,
    common_offset,
    named_blunders,
    with_exchanged_names,
)
from recon4.georeference.control_fit import MeasuredTarget, fit_control, snoop
from recon4.georeference.control_names import unseen_exchanges

PLACES = np.array(
    [
        [0.0, 0.0, 0.0],
        [22.0, 1.0, 1.4],
        [20.0, 15.0, 0.3],
        [-1.0, 13.0, 2.2],
        [11.0, 7.0, 0.1],
        [6.0, 14.0, 1.0],
    ]
)
SITE = np.array([1_021_340.0, 598_210.0, 231.0])
T_SITE_MAP = SE3.from_rpy(0.0, 0.0, 1.1, t=SITE)
SD_M = 0.003


def targets(
    p_map: np.ndarray = PLACES, *, T_site_map: SE3 = T_SITE_MAP, seed: int = 3
) -> list[MeasuredTarget]:
    noise = SD_M * np.random.default_rng(seed).normal(size=p_map.shape)
    return [
        MeasuredTarget(f"C{k + 1}", p_site, p, np.eye(3), SD_M**2 * np.eye(3))
        for k, (p_site, p) in enumerate(zip(T_site_map @ p_map, p_map + noise, strict=True))
    ]


def surveyed(found: list[MeasuredTarget], p_site: np.ndarray) -> list[MeasuredTarget]:
    return [
        MeasuredTarget(one.id, p, one.p_map, one.along, one.cov)
        for one, p in zip(found, p_site, strict=True)
    ]


def sites(found: list[MeasuredTarget]) -> np.ndarray:
    return np.array([one.p_site for one in found])


def test_a_leveled_map_is_turned_about_the_vertical_only() -> None:
    fit = fit_control(targets(PLACES[:3] * [1.0, 1.0, 0.0] * 0.1), leveled=True)
    assert fit.freedom == 4
    assert np.allclose(fit.T_map_site.R[2], [0.0, 0.0, 1.0])


def test_points_that_know_the_tilt_better_than_leveling_give_six_degrees_of_freedom() -> None:
    R_tilt = so3_exp(np.array([0.004, -0.003, 0.0]))
    tilted = SE3(T_SITE_MAP.R @ R_tilt, SITE)
    fit = fit_control(targets(T_site_map=tilted), leveled=True)
    assert fit.freedom == 6
    assert np.abs(fit.T_map_site.inverse().R - tilted.R).max() < 5e-4
    assert fit.rmse_m < 2 * SD_M


def test_scale_is_reported_and_not_applied() -> None:
    found = targets()
    fit = fit_control(surveyed(found, SITE + (sites(found) - SITE) * 1.002), leveled=True)
    assert fit.scale == pytest.approx(1.002, abs=4 * fit.scale_sd)
    assert np.linalg.det(fit.T_map_site.R) == pytest.approx(1.0)


def test_redundancy_numbers_sum_to_the_degrees_of_freedom() -> None:
    fit = fit_control(targets(), leveled=True)
    assert sum(sum(test.redundancy) for test in fit.tests) == pytest.approx(18 - fit.freedom)
    far = fit.tests[0]
    r = far.redundancy[2]
    assert far.least_found_v_m == pytest.approx(4.13 * SD_M * max(fit.sd0, 1.0) / r**0.5, rel=0.15)


def test_one_point_that_is_a_meter_off_is_found_and_named() -> None:
    found = targets()
    p_site = sites(found)
    p_site[2] += [0.6, -0.8, 0.0]
    _, blunders = named_blunders(surveyed(found, p_site), leveled=True)
    (one,) = blunders
    assert (one.kind, one.points) == (BlunderKind.POINT, ("C3",))
    assert one.offset_m == pytest.approx((0.6, -0.8, 0.0), abs=0.02)
    assert "C3 is 0.997 m" in one.text


def test_two_points_off_are_both_found() -> None:
    found = targets()
    p_site = sites(found)
    p_site[1, 0] += 0.1
    p_site[4, 0] -= 0.5
    fit, failed = snoop(surveyed(found, p_site), leveled=True)
    assert failed == ["C5", "C2"]
    assert fit.rmse_m < 2 * SD_M


def test_exact_points_are_not_accused() -> None:
    for seed in range(20):
        assert named_blunders(targets(seed=seed), leveled=True)[1] == ()


def test_exchanged_names_are_found() -> None:
    found = targets()
    p_site = sites(found)
    p_site[[1, 3]] = p_site[[3, 1]]
    fit, (one,) = named_blunders(surveyed(found, p_site), leveled=True)
    assert (one.kind, one.points) == (BlunderKind.NAMES, ("C2", "C4"))
    assert fit.rmse_m < 2 * SD_M


def test_an_exchange_that_places_no_map_is_not_tried_further() -> None:
    p_map = np.array(
        [[8.35, 12.02, 0.1], [11.56, 2.58, 0.3], [6.84, 5.03, 1.2], [16.67, 14.71, 0.0],
         [14.55, 8.37, 1.3]]
    )  # fmt: skip
    east, up = np.eye(3)[[0]], np.eye(3)[[2]]
    offsets = np.array([[8.0, 5.0, 0.0], *[[5.0, 5.0, 0.0]] * 4])
    found = [
        MeasuredTarget(f"P{k}", p + off, p, along, 1e-5 * np.eye(3))
        for k, (p, off, along) in enumerate(
            zip(p_map, offsets, [np.eye(3), up, up, east, up], strict=True)
        )
    ]
    swapped = sites(found)[[0, 1, 3, 2, 4]]
    with pytest.raises(GeoreferenceError):
        fit_control(surveyed(found, swapped), leveled=True)
    _, (one,) = named_blunders(found, leveled=True)
    assert one.kind is BlunderKind.CONTRADICTION, "two exchanges explain it alike"


def test_exchanged_names_of_neighbors_are_found_without_a_large_misfit() -> None:
    near = np.vstack([PLACES, [[11.06, 7.02, 0.1]]])
    found = targets(near)
    p_site = sites(found)
    p_site[[4, 6]] = p_site[[6, 4]]
    exchanged = surveyed(found, p_site)
    assert fit_control(exchanged, leveled=True).rmse_m < 0.05
    fit, (one,) = named_blunders(exchanged, leveled=True)
    assert (one.kind, one.points) == (BlunderKind.NAMES, ("C5", "C7"))
    assert fit.worst is None


def test_a_single_blunder_beside_a_neighbor_is_not_called_an_exchange() -> None:
    found = targets(np.vstack([PLACES, [[11.06, 7.02, 0.1]]]))
    p_site = sites(found)
    p_site[4] += [0.05, 0.0, 0.0]
    _, (one,) = named_blunders(surveyed(found, p_site), leveled=True)
    assert (one.kind, one.points) == (BlunderKind.POINT, ("C5",))


def test_exchanges_that_no_test_sees_are_listed() -> None:
    found = targets(np.vstack([PLACES, [[11.02, 7.015, 0.1]]]))
    assert unseen_exchanges(found, fit_control(found, leveled=True), leveled=True) == [(4, 6)]
    square = targets(np.array([[0.0, 0, 0], [20.0, 0, 0], [20.0, 20.0, 0], [0.0, 20.0, 0]]))
    assert unseen_exchanges(square, fit_control(square, leveled=True), leveled=True) == []


def test_a_check_point_with_the_name_of_a_control_point_is_found() -> None:
    p_site = PLACES + SITE
    off_m = np.full((6, 3), 0.002)
    off_m[1] += p_site[4] - p_site[1]
    off_m[4] += p_site[1] - p_site[4]
    off_m[3] += [0.0, 1.0, 0.0]
    single = [Blunder(kind=BlunderKind.POINT, points=(f"C{k}",)) for k in (1, 3, 4)]
    names = [f"C{k}" for k in range(6)]
    found = with_exchanged_names(single, names, p_site, off_m=off_m)
    assert [(one.kind, one.points) for one in found] == [
        (BlunderKind.NAMES, ("C1", "C4")),
        (BlunderKind.POINT, ("C3",)),
    ]


def test_exchanged_axes_are_found() -> None:
    found = targets()
    _, (one,) = named_blunders(surveyed(found, sites(found)[:, [1, 0, 2]]), leveled=True)
    assert one.kind is BlunderKind.AXES


def test_exchanged_axes_of_a_flat_site_do_not_turn_a_leveled_map_on_its_back() -> None:
    found = targets(PLACES * [1.0, 1.0, 0.0])
    exchanged = surveyed(found, sites(found)[:, [1, 0, 2]])
    fit, (one,) = named_blunders(exchanged, leveled=True)
    assert one.kind is BlunderKind.AXES
    assert fit.T_map_site.R[2, 2] > 0.99
    assert fit_control(exchanged, leveled=True).freedom == 4


@pytest.mark.parametrize("axes", [[0, 1, 2], [1, 0, 2]])
def test_feet_are_found(axes: list[int]) -> None:
    found = targets()
    _, (one,) = named_blunders(surveyed(found, sites(found)[:, axes] / 0.3048), leveled=True)
    assert one.kind is BlunderKind.FEET


def test_a_common_offset_of_the_check_points_is_named() -> None:
    off = np.array([0.0, 0.0, 0.165]) + 0.004 * np.random.default_rng(1).normal(size=(5, 3))
    found = common_offset("ABCDE", off, sd_m=0.005)
    assert found is not None
    assert found.offset_m == pytest.approx((0.0, 0.0, 0.165), abs=0.01)
    assert common_offset("ABCDE", off - off.mean(axis=0), sd_m=0.005) is None


def test_a_check_point_that_is_a_meter_off_is_named() -> None:
    off = 0.004 * np.random.default_rng(1).normal(size=(5, 3))
    assert check_outliers("ABCDE", off) == ()
    off[3] += [0.0, 1.0, 0.0]
    (one,) = check_outliers("ABCDE", off)
    assert one.points == ("D",)
    assert one.offset_m == pytest.approx((0.0, 1.0, 0.0), abs=0.02)


def test_a_point_that_no_other_controls_is_said() -> None:
    one = targets()
    floor = [replace(found, along=np.eye(3)[:2]) for found in one[1:3]]
    fit = fit_control([one[0], *floor], leveled=True)
    assert [test.single_handed for test in fit.tests] == [True, False, False]
    assert np.isinf(fit.tests[0].least_found_v_m)
    assert np.isfinite(fit.tests[0].least_found_h_m)
    assert np.isnan(fit.tests[1].least_found_v_m)


@pytest.mark.parametrize(
    ("points", "words"),
    [
        (targets()[:2], "at least 3 control points .* got 2 .C1, C2."),
        ([], "got 0"),
        (
            [*targets()[:3], *targets(PLACES[:1], seed=9)],
            "C1 and C1 are in one place in the survey",
        ),
    ],
)
def test_too_few_points_and_two_in_one_place_are_refused(
    points: list[MeasuredTarget], words: str
) -> None:
    with pytest.raises(GeoreferenceError, match=words):
        fit_control(points, leveled=True)


def test_points_above_each_other_do_not_say_where_north_is() -> None:
    column = np.array([[1.0, 2.0, 0.0], [1.0, 2.0, 1.0], [1.0, 2.001, 2.5]])
    with pytest.raises(GeoreferenceError, match="where north is"):
        fit_control(targets(column), leveled=True)


def test_points_on_a_line_do_not_level_a_map() -> None:
    line = np.array([[0.0, 0.0, 0.0], [10.0, 0.0, 0.0], [25.0, 0.0, 0.0]])
    assert fit_control(targets(line), leveled=True).freedom == 4
    with pytest.raises(GeoreferenceError, match="on one line"):
        fit_control(targets(line), leveled=False)


def test_heights_in_feet_beside_meters_are_named() -> None:
    found = targets()
    _, (one,) = named_blunders(surveyed(found, sites(found) / [1, 1, 0.3048]), leveled=True)
    assert one.kind is BlunderKind.FEET_UP


@pytest.mark.parametrize("unit", [1000.0, 0.001, [1 / 73_000, 1 / 111_000, 1.0]])
def test_millimeters_kilometers_and_degrees_are_refused(unit) -> None:
    found = targets()
    with pytest.raises(GeoreferenceError, match="expected meters, neither degrees nor another"):
        named_blunders(surveyed(found, sites(found) * unit), leveled=True)


def test_one_point_that_is_far_off_is_no_other_unit() -> None:
    found = targets(PLACES[:4])
    p_site = sites(found)
    p_site[2, 1] += 10_000.0
    _, (one,) = named_blunders(surveyed(found, p_site), leveled=True)
    assert (one.kind, one.points) == (BlunderKind.POINT, ("C3",))
