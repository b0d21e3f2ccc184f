"""References that do not lie on the map: found, aligned by pairs, undone, over HTTP."""

import base64

import numpy as np
import pytest

from recon4.geometry.se3 import SE3
from tests.project_builder import build_project, room_points
from tests.served import served

BASE = "/api/projects/office/slices"
TURNED = SE3.from_rpy(0.0, 0.0, np.pi / 2, t=[13.0, -3.0, 0.8])
"""The room beside itself: turned by 90°, higher, but over it."""
CORNERS_M = np.array([[0.0, 0.0, 1.0], [16.0, 0.0, 1.0], [16.0, 10.0, 1.0]])


def projects(root):
    build_project(root / "office", points=60_000, normals=True)
    np.savetxt(root / "turned.xyz", TURNED @ room_points(np.random.default_rng(5), 30_000))


server = served(projects)


@pytest.fixture(scope="module")
def reference(server):
    """Added once; what tests lay elsewhere they undo, or begin from there."""
    path = str(server.root / "turned.xyz")
    return server.post(BASE + "/references", json={"path": path}).json()["id"]


def aligned(server, reference, **how):
    return server.post(f"{BASE}/references/{reference}/align", json=how)


def compared(server, reference):
    return server.post(BASE + "/compare", json={"reference": reference}).json()


@pytest.mark.study
def test_a_turned_reference_does_not_fit_and_icp_names_a_way_that_there_is(server, reference):
    found = compared(server, reference)
    answer = aligned(server, reference, how="icp")

    assert found["fit"]["fits"] is False and "does not fit" in found["fit"]["text"]
    assert answer.status_code == 422 and "use Align by pairs" in answer.json()["detail"]


def test_three_pairs_and_icp_lay_it_on_the_map_and_can_be_undone(server, reference):
    p_map = np.add(CORNERS_M, [[0.1, 0.05, 0.7], [-0.1, 0.0, -0.5], [0.0, -0.1, 0.0]])
    pairs = {"p_map": p_map.tolist(), "p_reference": (TURNED @ CORNERS_M).tolist()}

    found = aligned(server, reference, how="pairs", level=True, refine=True, **pairs).json()
    table = compared(server, reference)
    undone = aligned(server, reference, how="undo").json()

    assert np.array(found["T_map_reference"]) == pytest.approx(TURNED.inverse().matrix(), abs=0.01)
    assert "3 pairs, largest residual" in found["alignment"] and "; ICP" in found["alignment"]
    assert found["fit"].startswith("✓ The reference fits") and found["can_undo"]
    assert table["fit"]["fits"] and table["point_weighted"]["mean_m"] < 0.02
    assert undone["alignment"] == "none" and undone["can_undo"]
    german = server.get(BASE, headers={"Accept-Language": "de"}).json()["references"]
    assert [one["alignment"] for one in german] == ["keine"]
    assert compared(server, reference)["fit"]["fits"] is False


@pytest.mark.study
def test_pairs_that_are_not_refined_say_so(server, reference):
    p_map = np.add(CORNERS_M, [3.0, 0.0, 0.0])
    pairs = {"p_map": p_map.tolist(), "p_reference": (TURNED @ CORNERS_M).tolist()}

    found = aligned(server, reference, how="pairs", level=True, refine=True, **pairs).json()

    assert "not refined; ICP" in found["alignment"] and found["fits"] is False


@pytest.mark.study
def test_a_reference_moved_by_hand_is_refined_from_there(server, reference):
    T = TURNED.inverse()
    pose = [*np.add(T.t, [0.1, -0.1, 0.05]).tolist(), *T.quat_xyzw().tolist()]

    found = aligned(server, reference, how="icp", pose=pose).json()
    wrong = aligned(server, reference, how="icp", pose=[0.0] * 7)

    assert found["alignment"].startswith("moved by hand; ICP")
    assert np.array(found["T_map_reference"]) == pytest.approx(T.matrix(), abs=0.01)
    assert wrong.status_code == 422 and "unit quaternion" in wrong.json()["detail"]


def test_points_of_both_come_about_their_middles(server, reference):
    found = server.get(f"{BASE}/references/{reference}/points").json()

    p = np.frombuffer(base64.b64decode(found["p_map"]), "<f4").reshape(-1, 3)
    q = np.frombuffer(base64.b64decode(found["p_reference"]), "<f4").reshape(-1, 3)
    assert found["middle_map"] == pytest.approx([8.0, 5.0, 1.5], abs=0.1)
    assert np.abs(p).max(axis=0) == pytest.approx([8.0, 5.0, 1.5], abs=0.2)
    assert np.abs(q).max(axis=0) == pytest.approx([5.0, 8.0, 1.5], abs=0.2)
    assert len(found["pose"]) == 7
