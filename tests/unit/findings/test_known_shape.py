"""How well the shape of a map must be known, and its place on the earth."""

from dataclasses import replace

import numpy as np
import pytest

from recon4.findings.audit import check_walk
from recon4.findings.verdict import verdict_of
from recon4.findings.walk_record import WalkRecord
from recon4.findings.wording import text_of
from recon4.geometry.se3 import SE3
from recon4.model.figures import LevelFigures
from recon4.model.finding_kinds import FindingKind
from recon4.model.site_control import SITE_GRID
from recon4.model.trajectory import Trajectory
from recon4.model.usability import Usability
from recon4.pose_graph.uncertainty import HelpfulPoint, PoseUncertainty


def stated(shape_sd_m, sd_m, *, on_earth):
    """A straight walk of 14.9 m whose positions and shape are uncertain along one axis."""
    t_ns = np.linspace(0, 10**10, 101).astype(np.int64)
    walked = Trajectory(t_ns, SE3.stack(SE3.from_rpy(0, 0, 0, t=[x, 0, 0]) for x in t_ns * 1.49e-9))
    cov, shape = np.zeros((10, 6, 6)), np.zeros((10, 3, 3))
    cov[:, 3, 3], shape[:, 0, 0] = sd_m**2, np.array(shape_sd_m) ** 2
    known = PoseUncertainty(t_ns[::10][:10], cov, on_earth, shape, HelpfulPoint(0, 0, 0.01))
    return WalkRecord(final=walked, uncertainty=known)


FLAT = np.full(10, 0.01)
ONE_PLACE = np.array([0.01] * 9 + [0.1])


@pytest.mark.parametrize(
    ("shape_sd_m", "sd_m", "on_earth", "usability"),
    [
        pytest.param(FLAT, 0.2, False, Usability.GOOD, id="only its heading at the start"),
        pytest.param(4 * FLAT, 0.2, False, Usability.CHECK, id="its shape"),
        pytest.param(0.9 * ONE_PLACE, 0.2, False, Usability.GOOD, id="one place a little less"),
        pytest.param(ONE_PLACE, 0.2, False, Usability.CHECK, id="one place"),
        pytest.param(FLAT, 0.04, True, Usability.GOOD, id="its place on the earth"),
        pytest.param(FLAT, 0.06, True, Usability.CHECK, id="not its place on the earth"),
        pytest.param(FLAT, 0.6, True, Usability.DO_NOT_USE, id="nothing of its place"),
    ],
)
def test_a_local_map_needs_a_known_shape_and_a_georeferenced_one_a_known_place_too(
    shape_sd_m, sd_m, on_earth, usability
):
    (found,) = check_walk(stated(shape_sd_m, sd_m, on_earth=on_earth))

    assert found.kind is FindingKind.UNCERTAINTY
    assert verdict_of([found]).usability is usability


@pytest.mark.parametrize(
    ("crs", "where"), [("EPSG:25832", "on the earth"), (SITE_GRID, "in the grid of the site")]
)
def test_a_place_is_known_in_the_system_of_the_map(crs, where):
    level = LevelFigures(leveled_by="imu", tilt_deg=0.0, crs=crs, local="")
    walk = replace(stated(FLAT, 0.04, on_earth=True), level=level)

    found = next(one for one in check_walk(walk) if one.kind is FindingKind.UNCERTAINTY)

    assert f"(2σ) {where} at worst" in text_of(found)
