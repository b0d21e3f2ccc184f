"""Targets stand free and are seen from the path; their survey is theirs in the grid of the site."""

import csv

import numpy as np
import pytest

from recon4.errors import ConfigError
from recon4.geometry.raycast import Scene
from recon4.geometry.se3 import SE3
from recon4.model.targets import TargetKind
from recon4.simulation.setup import prepare
from recon4.simulation.targets import TARGETS, with_targets, write_targets


@pytest.fixture(scope="module")
def office():
    return prepare("office", seconds=60.0, seed=2)


@pytest.fixture(scope="module")
def targeted(office):
    return with_targets(office, 7)


def test_targets_of_all_kinds_are_seen_from_the_path(targeted):
    world = targeted.world
    path = targeted.walk.poses(np.arange(0.0, 60.0, 0.5)).t
    scene = Scene(world.mesh)

    assert [one.kind for one in world.targets[:3]] == list(TargetKind)
    for one in world.targets:
        toward = np.array(one.p_map) - path
        reach = np.linalg.norm(toward, axis=1)
        rays = np.hstack([path, toward / reach[:, None]]).astype(np.float32)
        seen = np.abs(scene.cast(rays).range_m - (reach - one.radius_m)) < 0.01
        assert seen.any(), one.name
        assert np.hypot(*toward[:, :2].T).min() > 0.55, one.name


def test_targets_keep_the_walk_and_the_rest_of_the_world(office, targeted):
    before, after = office.world.mesh, targeted.world.mesh

    assert np.array_equal(after.triangles[: len(before.triangles)], before.triangles)
    assert np.array_equal(office.walk.coefficients, targeted.walk.coefficients)
    assert after.reflectivity.max() >= 2.0
    assert with_targets(office, 0) is office


def test_more_targets_than_there_is_room_for_are_refused(office):
    with pytest.raises(ConfigError, match=r"room for \d+ of 600 along this walk"):
        with_targets(office, 600)


def test_the_survey_is_that_of_the_targets_with_small_errors(targeted, tmp_path):
    write_targets(tmp_path, targeted.world.targets, seed=2)

    with (tmp_path / "survey.csv").open() as file:
        rows = list(csv.DictReader(file))
    survey = np.array(
        [[float(row[k]) for k in ("easting_m", "northing_m", "height_m")] for row in rows]
    )
    T_site_map = SE3.from_rpy(0.0, 0.0, TARGETS.turn_rad, t=list(TARGETS.origin_m))
    off = survey - T_site_map @ np.array([one.p_map for one in targeted.world.targets])
    assert 0.0 < np.abs(off).max() < 5.0 * TARGETS.survey_sd_m
    assert [row["role"] for row in rows].count("control") == TARGETS.control
    assert [float(row["radius_m"]) > 0.0 for row in rows] == [
        one.kind is TargetKind.SPHERE for one in targeted.world.targets
    ]
