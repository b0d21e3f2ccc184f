"""Two maps compared by a job: ordered, made in a confined process, its figures and points."""

import laspy
import numpy as np
import pytest

from recon4.comparison.write import POINT
from tests.project_builder import ROOM_M, build_project
from tests.service.running import server_thread

BASE = "/api/projects/office/comparisons"
MOVED_M = 0.05


@pytest.fixture(scope="module")
def server(tmp_path_factory):
    root = tmp_path_factory.mktemp("files") / "maps"
    build_project(root / "office", points=150_000, normals=True)
    build_project(root / "office", points=150_000, normals=True, moved_m=MOVED_M)
    build_project(root / "other", points=3_000)
    with server_thread(root) as running:
        yield running


def finished(server, **ask):
    """The view of a comparison that has ended."""
    answer = server.post(BASE, json=ask)
    assert answer.status_code == 201, answer.text
    server.wait(answer.json()["id"], lambda view: view["job"]["finished"])
    return server.get(f"{BASE}/{answer.json()['id']}").json()


@pytest.fixture(scope="module")
def made(server):
    """The map against the one of the run before."""
    earlier = server.get(BASE).json()["others"][0]
    assert earlier["id"].startswith("map:")
    return finished(server, against=earlier["id"])


def test_the_figures_of_a_comparison_count_every_core_point(server, made):
    assert made["state"] == "succeeded", made["note"]
    assert made["kept"] and made["of_this_map"]
    found = made["found"]
    counts = found["counts"]
    assert counts["core_points"] == sum(counts.values()) / 2 > 1000
    assert counts["significant"] > 1000
    assert found["distances"]["p95_m"] == pytest.approx(MOVED_M, abs=2e-3)
    assert np.array_equal(found["T_a_b"], np.eye(4))
    assert server.get(BASE).json()["comparisons"][0]["id"] == made["id"]


def test_the_points_of_a_comparison_are_those_of_its_laz_file(server, made, tmp_path):
    answer = server.get(f"{BASE}/{made['id']}/points")
    points = np.frombuffer(answer.content, POINT)
    (tmp_path / "a.laz").write_bytes(server.get(f"{BASE}/{made['id']}/file").content)
    las = laspy.read(tmp_path / "a.laz")

    assert "immutable" in answer.headers["cache-control"]
    assert len(points) == len(las) == made["found"]["counts"]["core_points"]
    assert np.allclose(points["p_m"], las.xyz, atol=1e-4)
    normal = points["normal"][points["state"] < 2] / 127.0
    assert np.allclose(np.linalg.norm(normal, axis=1), 1.0, atol=0.02)
    step_m = server.get(BASE).json()["step_m"]
    known = points["state"] < 2
    off = points["distance"][known] * step_m - np.asarray(las["distance_m"])[known]
    assert np.abs(off).max() <= 0.5001 * step_m
    on_wall = (points["p_m"][:, 0] > ROOM_M[0] - 0.01) & (points["state"] == 1)
    # The earlier wall lies in front of the one that has moved out.
    assert np.median(points["distance"][on_wall]) * step_m == pytest.approx(MOVED_M, abs=1e-3)


@pytest.mark.study
def test_maps_without_a_common_frame_fail_with_what_to_do(server):
    view = finished(server, against="project:other")

    assert view["state"] == "failed" and view["found"] is None and not view["kept"]
    assert "have no common frame" in view["note"] and "align them first" in view["note"]


@pytest.mark.parametrize(
    ("ask", "status"),
    [
        ({"against": "project:nothing"}, 404),
        ({"against": "map:" + 64 * "0"}, 404),
        ({"against": "project:../other"}, 404),
        ({"against": ""}, 404),
        ({"against": "project:other", "core_spacing_m": 0.001}, 422),
    ],
)
def test_a_map_that_is_not_there_is_refused_before_it_waits(server, ask, status):
    assert server.post(BASE, json=ask).status_code == status


def test_comparisons_are_no_jobs_of_the_project(server, made):
    assert server.get("/api/projects/office/jobs").json() == []
    assert server.post(f"/api/jobs/{made['id']}/retry").status_code == 409
    assert server.get(f"/api/projects/other/comparisons/{made['id']}").status_code == 404


def test_the_index_of_an_earlier_map_is_read_by_its_key(server, made):
    key = made["found"]["second"]["key"]

    index = server.get(f"/api/projects/office/map?key={key}").json()

    assert index["key"] == key and index["high_m"][0] < ROOM_M[0] + 0.5
    assert server.get(f"/api/projects/office/map?key={64 * '0'}").status_code == 404
