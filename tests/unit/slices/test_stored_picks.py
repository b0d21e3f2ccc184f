"""Picks are kept in every map that is made of their walk."""

import json

import numpy as np
import pytest

from recon4.geometry.se3 import SE3
from recon4.model.site_control import SeenTarget
from recon4.model.trajectory import Trajectory
from recon4.slices.stored_picks import SEEN_PICKS, add_seen_picks, carried_picks, stored_picks
from recon4.store.arrays import save_trajectory
from recon4.store.checked import Altered

T_NS = np.array([0, 1_000_000_000, 2_000_000_000])
PICK = (3.0, 1.0, 0.5)
UNMOVED = SE3(np.eye(3), np.zeros(3))


def artifacts(tmp_path, T_new_old, t_ns=T_NS):
    """A map whose first version went along x; another version of it is moved."""
    folders = {"map": tmp_path / "new", "level": tmp_path / "level"}
    for folder in folders.values():
        folder.mkdir()
    path = SE3(np.tile(np.eye(3), (3, 1, 1)), np.eye(3)[[0]] * [[0], [1], [2]])
    save_trajectory(folders["level"] / "trajectory.npz", Trajectory(t_ns, T_new_old @ path))
    return folders


def put(tmp_path, *, pick=PICK):
    (tmp_path / "slices").mkdir()
    picks = {"picks": {"A": pick}, "along": {"A": [[0, 1, 0]]}, "found_in": {"A": "old"}}
    (tmp_path / "slices" / "control.json").write_text(json.dumps(picks))
    bodies = tuple((PICK[0] - x, PICK[1], PICK[2]) for x in (0.0, 1.0, 2.0))
    target = SeenTarget(
        id="A",
        xyz_m=(0.0, 0.0, 0.0),
        role="check",
        sd_m=(0.01, 0.01),
        t_ns=tuple(T_NS.tolist()),
        p_body_m=bodies,
        directions_body=(((0.0, 1.0, 0.0),),) * 3,
    )
    add_seen_picks(tmp_path, {"A": target}, {"A": PICK})


def test_a_pick_is_where_those_who_saw_it_are_in_the_new_map(tmp_path):
    put(tmp_path)
    turned = SE3.from_rpy(0.0, 0.0, np.pi / 2, t=[10.0, 20.0, 30.0])

    found = stored_picks(tmp_path, artifacts(tmp_path, turned))

    assert found["A"].xyz_m == pytest.approx([9.0, 23.0, 30.5])
    assert np.abs(found["A"].along) == pytest.approx(np.array([[1.0, 0.0, 0.0]]))


@pytest.mark.parametrize(
    ("pick", "t_ns"), [((3.0, 1.0, 0.6), T_NS), (PICK, T_NS + 10**12)], ids=["moved", "other walk"]
)
def test_another_pick_or_walk_has_none(tmp_path, pick, t_ns):
    put(tmp_path, pick=pick)

    assert stored_picks(tmp_path, artifacts(tmp_path, UNMOVED, t_ns)) == {}


def test_a_changed_file_is_refused(tmp_path):
    put(tmp_path)
    path = tmp_path / SEEN_PICKS
    path.write_text(path.read_text().replace("0.5", "0.7"))

    with pytest.raises(Altered):
        carried_picks(tmp_path, {"A": PICK}, artifacts(tmp_path, UNMOVED)["level"])
