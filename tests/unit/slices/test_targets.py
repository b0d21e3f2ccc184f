"""Targets are found in a whole map, what looks alike is not, and a survey names them."""

import numpy as np
import pytest

from recon4.geometry.se3 import SE3
from recon4.model.targets import TargetKind
from recon4.progress import Silent
from recon4.slices.control_points import ControlPoint
from recon4.slices.targets.candidate import TargetCandidate
from recon4.slices.targets.matching import SurveyedPlace, match_targets
from recon4.slices.targets.named import listed, named
from recon4.slices.targets.plates import plate_at
from recon4.slices.targets.search import find_targets
from tests.unit.slices.room_map import write_map

SPACING_M = 0.012
RADIUS_M = 0.1
# Across the border between two tiles, which are 5 m long.
PLATE, BOARD, SPHERE = (np.array(p) for p in ([0.0, 1.0, 1.2], [0.0, 4.98, 1.3], [0.8, 3.0, 1.2]))


def wall(rng):
    """A wall with a plate, a board, a lamp twice as long as wide, a stripe and a poster."""
    y, z = np.meshgrid(np.arange(0.0, 7.0, SPACING_M), np.arange(0.5, 2.0, SPACING_M))
    p = np.column_stack([np.zeros(y.size), y.ravel(), z.ravel()])
    p += rng.normal(0.0, 0.003, p.shape)
    value = np.full(len(p), 50.0)

    def within(middle, half):
        return np.all(np.abs(p[:, 1:] - middle[1:]) <= half, axis=1)

    value[within(PLATE, 0.075)] = 200.0
    d = p[:, 1:] - BOARD[1:]
    on_board = within(BOARD, 0.15)
    value[on_board] = np.where((d[:, 0] * d[:, 1] > 0.0)[on_board], 85.0, 8.0)
    value[within([0, 2.0, 1.2], 0.1) & (p[:, 1] < 2.0)] = 10.0  # an edge
    value[within([0, 6.0, 1.2], 0.02)] = 10.0
    value[within([0, 3.0, 1.8], 0.1)] = 75.0
    return p, value * rng.normal(1.0, 0.06, len(p)), np.tile([1.0, 0.0, 0.0], (len(p), 1))


def other_face():
    """A part of the other face of the thin wall behind the board, as seen from the next room."""
    y, z = (part.ravel() for part in np.meshgrid(*[np.arange(-0.05, 0.051, 0.01)] * 2))
    p = BOARD + np.column_stack([np.full(len(y), -0.085), y, z])
    return p, np.full(len(p), 50.0), np.tile([-1.0, 0.0, 0.0], (len(p), 1))


def round_thing(rng, middle, *, cylinder=False):
    """Half of a sphere, or of a pole, as seen from the side of the path."""
    n = rng.normal(size=(1200, 3))
    if cylinder:
        n[:, 2] = 0.0
    n /= np.linalg.norm(n, axis=1)[:, None]
    n[:, 0] = np.abs(n[:, 0])
    p = middle + RADIUS_M * n
    if cylinder:
        p[:, 2] = rng.uniform(0.6, 1.8, len(p))
    return p + rng.normal(0.0, 0.004, p.shape), np.full(len(p), 60.0), n


@pytest.fixture(scope="module")
def found(tmp_path_factory):
    rng = np.random.default_rng(5)
    pole = round_thing(rng, np.array([1.0, 6.0, 1.0]), cylinder=True)
    parts = [wall(rng), other_face(), round_thing(rng, SPHERE), pole]
    p, value, normal = (np.concatenate([one[k] for one in parts]) for k in range(3))
    out = tmp_path_factory.mktemp("map")
    tiles = write_map(out, p, intensity_normalized=value.astype(np.float32), normal=normal)
    return find_targets(tiles, progress=Silent())


@pytest.mark.parametrize(
    ("kind", "true"),
    [(TargetKind.PLATE, PLATE), (TargetKind.BOARD, BOARD), (TargetKind.SPHERE, SPHERE)],
)
def test_one_target_of_each_kind_is_found_where_it_is_and_nothing_else(found, kind, true):
    mine = [one for one in found if one.kind is kind]

    assert len(mine) == 1
    off = mine[0].p_map - true
    assert np.linalg.norm(off) < 0.004
    assert off @ np.linalg.solve(mine[0].cov, off) < 16.0


def test_a_plate_with_hardly_a_point_around_it_is_that_of_its_outline():
    rng = np.random.default_rng(3)
    plate, far = rng.uniform(-0.075, 0.075, (1000, 2)), rng.uniform(-0.2, 0.2, (200, 2))
    far = far[np.abs(far).max(axis=1) > 0.18][:50]
    far[:, 0] = np.abs(far[:, 0])
    uv = np.concatenate([plate, far])
    points = np.column_stack([rng.normal(0.0, 0.004, len(uv)), uv])
    one = plate_at(points, np.r_[np.full(1000, 170.0), np.full(len(far), 165.0 / 2.0)], 60.0)

    assert one is not None
    assert np.linalg.norm(one.p_map[1:]) < 0.003


def test_the_radius_of_a_sphere_and_the_edge_of_a_plate_are_found(found):
    sizes = {one.kind: one.size_m for one in found}

    assert sizes[TargetKind.SPHERE] == pytest.approx(RADIUS_M, abs=0.002)
    assert sizes[TargetKind.PLATE] == pytest.approx(0.15, abs=0.01)


SITE = SE3.from_rpy(0.0, 0.0, 2.1, t=[51_000.0, 8_000.0, 200.0])


def candidates(places):
    return [
        TargetCandidate(
            kind=TargetKind.PLATE,
            p_map=p,
            cov=1e-6 * np.eye(3),
            size_m=0.1,
            points=50,
            agreement=0.9,
        )
        for p in places
    ]


def test_a_survey_names_targets_among_others_and_says_what_is_missing():
    rng = np.random.default_rng(3)
    true = rng.uniform([0, 0, 0], [30, 20, 3], (9, 3))
    others = rng.uniform([0, 0, 0], [30, 20, 3], (12, 3))
    seen = true[:7] + rng.normal(0.0, 0.003, (7, 3))
    surveyed = SITE @ true
    points = [ControlPoint(f"P{k}", tuple(p)) for k, p in enumerate(surveyed.tolist())]
    order = rng.permutation(19)

    got = named(listed(candidates(np.vstack([seen, others])[order])), points)

    assert [one.id for one in got.rows[:7]] == [f"P{k}" for k in range(7)]
    assert np.allclose([one.p_map for one in got.rows[:7]], seen, atol=1e-5)
    assert got.missing == ("P7", "P8")
    assert got.rmse_m < 0.008
    assert not any(one.ambiguous for one in got.rows)


def test_targets_of_a_map_that_is_tilted_a_little_are_named():
    rng = np.random.default_rng(8)
    true = rng.uniform([0, 0, 0], [60, 20, 3], (10, 3))
    tilted = SE3.from_rpy(0.002, 0.003, 0.0, t=[0.0, 0.0, 0.0]) @ true
    survey = [SurveyedPlace(f"P{k}", p) for k, p in enumerate(SITE @ true - SITE.t)]

    match = match_targets(survey, candidates(tilted))

    assert match is not None
    assert dict(match.row_of) == {f"P{k}": k for k in range(10)}
    assert match.rmse_m < 0.001


def test_names_that_may_be_exchanged_are_reported():
    # A rectangle fits itself after half a turn; the fifth point on its axis fits, too.
    square = np.array([[0, 0, 1], [8, 0, 1], [8, 3, 1], [0, 3, 1], [4.0, 1.5, 1.0]])
    survey = [SurveyedPlace(f"P{k}", p) for k, p in enumerate(SITE @ square - SITE.t)]

    match = match_targets(survey, candidates(square))

    assert match is not None
    assert match.ambiguous == ("P0", "P1", "P2", "P3")


def test_two_targets_that_agree_name_nothing():
    rng = np.random.default_rng(4)
    places = rng.uniform([0, 0, 0], [30, 20, 3], (5, 3))
    other = rng.uniform([0, 0, 0], [30, 20, 3], (5, 3))
    survey = [SurveyedPlace(f"P{k}", p) for k, p in enumerate([*places[:2], *other[:3]])]

    assert match_targets(survey, candidates(places)) is None


def test_a_point_with_a_radius_is_only_a_sphere_of_this_radius():
    places = np.array([[0.0, 0, 1], [5, 0, 1.2], [2, 4, 1.5], [9, 3, 0.7]])
    radii = [0.0, 0.1, 0.0, 0.0]
    survey = [
        SurveyedPlace(f"P{k}", p, r) for k, (p, r) in enumerate(zip(places, radii, strict=True))
    ]

    match = match_targets(survey, candidates(places))

    assert match is not None
    assert set(match.row_of) == {"P0", "P2", "P3"}
