"""A drifting walk is bent to its control points; check points judge it."""

import json
from dataclasses import replace

import msgspec
import numpy as np
import pytest

from recon4.errors import GeoreferenceError
from recon4.geometry.se3 import SE3, Array
from recon4.georeference.control_adjustment import ToAdjust
from recon4.georeference.control_stage import OnControl, put_on_control
from recon4.georeference.crs import CrsTransform
from recon4.model.plain import to_plain
from recon4.model.site_control import SITE_GRID, SeenTarget, SiteControl
from recon4.model.trajectory import Trajectory
from tests.unit.georeference.test_gnss import PLACE, slam, track

PICK_SD_M = 0.003
SITE = SE3.from_rpy(0.0, 0.0, -0.7, t=[601_234.5, 1_160_321.2, 241.3])
"""T_site_enu."""


def walk() -> tuple[Trajectory, ToAdjust]:
    true = track(120.0)
    graph, dense = slam(true, np.random.default_rng(1))
    return true, ToAdjust(trajectory=dense, graph=graph, leveled=True, tilt_sd_rad=0.005)


def seen(
    true: Trajectory, name: str, second: int, *, role: str, place: Array, xyz: Array
) -> SeenTarget:
    """A target beside the path, picked where the nodes of three seconds saw it."""
    rng = np.random.default_rng(second)
    t_ns = true.t_ns[[10 * second - 10, 10 * second, 10 * second + 10]]
    p_body = true.at(t_ns).inverse() @ np.tile(place, (3, 1)) + PICK_SD_M * rng.normal(size=3)
    return SeenTarget(
        id=name,
        xyz_m=tuple(xyz.tolist()),
        role=role,
        sd_m=(0.005, 0.005),
        t_ns=tuple(t_ns.tolist()),
        p_body_m=tuple(map(tuple, p_body.tolist())),
        directions_body=tuple(tuple(map(tuple, R.T.tolist())) for R in true.at(t_ns).R),
    )


def control(true: Trajectory, *, crs: str = "", blunder: str = "") -> SiteControl:
    targets = []
    for k, second in enumerate(range(6, 116, 5)):
        role = "control" if k % 3 == 0 else "check"
        place = true.at(true.t_ns[[10 * second]]).t[0] + [2.0 * (-1) ** k, 3.0, 0.5]
        name = f"{role[:2]}{k}"
        xyz = SITE @ place[None] if not crs else CrsTransform(PLACE, crs).to_crs(place[None])
        off = [1.0, 0.0, 0.0] if name == blunder else [0.0, 0.0, 0.0]
        targets.append(seen(true, name, second, role=role, place=place, xyz=xyz[0] + off))
    return SiteControl(targets=tuple(targets), crs=crs)


def worst_m(found: OnControl, role: str, which: str = "adjusted_m") -> float:
    off = [getattr(one, which) for one in found.record.points if one.role == role]
    return float(np.linalg.norm(np.array(off), axis=1).max())


def test_a_drifting_walk_is_bent_to_its_control_points_and_check_points_agree() -> None:
    true, given = walk()
    found = put_on_control(given, control(true), origin=None)
    assert worst_m(found, "check", "rigid_m") > 0.04
    assert worst_m(found, "control") < 0.015
    assert worst_m(found, "check") < 0.03
    assert found.record.crs == SITE_GRID
    assert found.record.blunders == ()


def test_the_map_has_small_numbers_and_its_grid_the_coordinates_of_the_site() -> None:
    true, given = walk()
    points = control(true)
    found = put_on_control(given, points, origin=None)
    assert np.abs(found.trajectory.T_a_b.t).max() < 500.0
    at = found.system.to_crs(points.targets[0].place_in(found.trajectory)[None])[0]
    assert at == pytest.approx(points.targets[0].xyz_m, abs=0.015)


def test_a_code_puts_the_map_on_earth() -> None:
    true, given = walk()
    found = put_on_control(given, control(true, crs="EPSG:32633"), origin=None)
    assert isinstance(found.system, CrsTransform)
    assert found.system.crs == "EPSG:32633"
    assert worst_m(found, "check") < 0.03
    # The projection's scale of 0.9996 is in the system, not in the map.
    local = put_on_control(given, control(true), origin=None)
    assert found.record.scale == pytest.approx(local.record.scale, abs=5e-5)


def test_a_code_of_another_place_is_refused() -> None:
    true, given = walk()
    points = control(true)
    with pytest.raises(GeoreferenceError, match="EPSG:32633"):
        far = [one.__class__(**_fields(one) | {"xyz_m": (9e9, 9e9, 0.0)}) for one in points.targets]
        put_on_control(given, SiteControl(targets=tuple(far), crs="EPSG:32633"), origin=None)


def test_points_on_walls_pull_across_their_wall_also_where_gnss_has_turned_the_map() -> None:
    true, given = walk()
    turn = SE3.from_rpy(0.0, 0.0, 1.3, t=[10.0, -4.0, 2.0])
    turned = replace(given, start=turn @ given.trajectory.at(given.graph.t_ns))
    targets = [
        on_wall(true, one) if k % 6 == 3 else one for k, one in enumerate(control(true).targets)
    ]
    assert sum(len(one.directions_body[0]) == 1 for one in targets) >= 3
    given_walls = SiteControl(targets=tuple(targets), crs="")
    before = put_on_control(given, given_walls, origin=None)
    after = put_on_control(turned, given_walls, origin=None)
    assert worst_m(before, "check") < 0.1
    moved = after.trajectory.T_a_b.t - before.trajectory.T_a_b.t
    assert np.abs(moved).max() < 1e-4


def on_wall(true: Trajectory, target: SeenTarget) -> SeenTarget:
    """A point of a wall across x; the survey has another point of that wall."""
    R = true.at(np.array(target.t_ns)).R
    along = SITE.R @ [0.0, 0.5, 0.0]
    return msgspec.structs.replace(
        target,
        directions_body=tuple((tuple(one[0].tolist()),) for one in R),
        xyz_m=tuple((np.array(target.xyz_m) + along).tolist()),
    )


def test_an_error_along_the_long_axis_of_a_survey_is_no_blunder_and_pulls_little() -> None:
    true, given = walk()
    plain = control(true).targets
    k = next(k for k, one in enumerate(plain) if one.id == "co6")
    e, n, h = plain[k].xyz_m
    off = msgspec.structs.replace(plain[k], xyz_m=(e + 0.07, n + 0.07, h))
    # 7 cm to the north-east, 5 mm across and in height.
    long = msgspec.structs.replace(off, covariance_m2=(2.5e-3, 2.475e-3, 0.0, 2.5e-3, 0.0, 2.5e-5))

    def put(target: SeenTarget) -> OnControl:
        targets = (*plain[:k], target, *plain[k + 1 :])
        return put_on_control(given, SiteControl(targets=targets, crs=""), origin=None)

    as_all, as_stated, right = put(off), put(long), put(plain[k])

    w = [
        next(p.test.w for p in found.record.points if p.id == "co6")
        for found in (as_all, as_stated)
    ]
    assert w[0] > 1.5 * w[1]
    moved = [
        np.linalg.norm(found.trajectory.T_a_b.t - right.trajectory.T_a_b.t, axis=1).max()
        for found in (as_all, as_stated)
    ]
    assert moved[0] > 3.0 * moved[1]


def test_without_a_covariance_a_target_has_the_hash_of_before() -> None:
    true, _ = walk()
    one = control(true).targets[0]
    assert "covariance_m2" not in to_plain(one)
    with_it = msgspec.structs.replace(one, covariance_m2=(1e-4, 0.0, 0.0, 1e-4, 0.0, 1e-4))
    assert msgspec.convert(to_plain(with_it), SeenTarget) == with_it


def test_check_points_move_nothing() -> None:
    true, given = walk()
    points = control(true)
    alone = SiteControl(targets=tuple(t for t in points.targets if t.role == "control"), crs="")
    a, b = (put_on_control(given, one, origin=None) for one in (points, alone))
    assert np.array_equal(a.trajectory.T_a_b.t, b.trajectory.T_a_b.t)


def test_a_point_that_is_a_meter_off_is_named_in_the_record() -> None:
    true, given = walk()
    found = put_on_control(given, control(true, blunder="co6"), origin=None)
    assert [text.split()[0] for text in found.record.blunders] == ["co6"]


def test_the_record_is_plain_json() -> None:
    true, given = walk()
    found = put_on_control(given, control(true), origin=None)
    record = json.loads(json.dumps(to_plain(found.record), allow_nan=False))
    (first, second) = record["points"][:2]
    assert first["test"]["redundancy"][0] > 0.0
    assert second["test"] is None


def _fields(one: SeenTarget) -> dict[str, object]:
    return {name: getattr(one, name) for name in SeenTarget.__struct_fields__}
