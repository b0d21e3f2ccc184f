"""Files of a map as jobs: ordered, made in a confined process, listed, downloaded, removed."""

import hashlib
import time
from collections import namedtuple

import laspy
import numpy as np
import pytest

from recon4_app.exports import routes
from recon4_app.exports.tuning import KEPT_EXPORTS
from recon4_app.jobs.model import JobKind
from tests.project_builder import approve_project, build_project
from tests.service.running import server_thread

BASE = "/api/projects/office/exports"
DiskUsage = namedtuple("DiskUsage", "total used free")


@pytest.fixture(scope="module")
def server(tmp_path_factory):
    root = tmp_path_factory.mktemp("files") / "maps"
    build_project(root / "office", points=5_000, strays=3)
    approve_project(root / "office", root / ".recon4/signing.key", who="J. Novák")
    with server_thread(root) as running:
        yield running


def order(server, file, **options):
    answer = server.post(BASE, json={"file": file, "options": options})
    assert answer.status_code == 201, answer.text
    return answer.json()["id"]


@pytest.fixture(scope="module")
def made(server):
    """A part of the map as COPC, and its row."""
    export = order(server, "map.copc.laz", classes=[1, 18, 7], thin_m=0.001)
    view = server.wait(export, lambda view: view["job"]["finished"])
    assert view["job"]["state"] == "succeeded", view["job"]["note"]
    return next(row for row in server.get(BASE).json() if row["id"] == export)


def test_a_row_says_what_was_exported_by_whom_and_with_which_hash(server, made, tmp_path):
    answer = server.get(f"{BASE}/{made['id']}/file")

    assert (made["person"], made["kept"], made["of_this_map"]) == ("local", True, True)
    assert 'filename="office-map.copc.laz"' in answer.headers["content-disposition"]
    assert hashlib.sha256(answer.content).hexdigest() == made["made"]["sha256"]
    assert len(answer.content) == made["made"]["bytes"]
    assert b"Nov\\u00e1k" in answer.content
    (tmp_path / "a.laz").write_bytes(answer.content)
    found = laspy.read(tmp_path / "a.laz")
    assert len(found) == made["made"]["points"] > 5_000
    assert np.isin(found.classification, (7, 18)).any()


def test_an_interrupted_download_goes_on_with_the_same_file_only(server, made):
    url, tag = f"{BASE}/{made['id']}/file", f'"{made["made"]["sha256"]}"'
    whole = server.get(url)
    ranges = {"Range": "bytes=1000-", "If-Range": tag}

    rest = server.get(url, headers=ranges)
    other = server.get(url, headers=ranges | {"If-Range": '"another"'})

    assert whole.headers["etag"] == tag
    assert (rest.status_code, whole.content[:1000] + rest.content) == (206, whole.content)
    assert (other.status_code, other.content) == (200, whole.content)


def test_the_estimate_is_the_number_of_points_of_a_small_map(server, made):
    ask = {"file": "map.copc.laz", "options": {"classes": [1, 18, 7], "thin_m": 0.001}}

    found = server.post(f"{BASE}/estimate", json=ask).json()

    assert found["points"] == made["made"]["points"]
    assert found["bytes"] > 0 and not found["is_most"]


@pytest.mark.parametrize(
    ("ask", "says"),
    [
        ({"file": "map.e57", "options": {"all_points": True}}, "takes no all_points"),
        ({"file": "map.laz", "options": {"crs": "EPSG:25832"}}, "cannot be put into EPSG:25832"),
        ({"file": "plan.dxf", "options": {"crs": "EPSG:25832"}}, "cannot be put into EPSG:25832"),
        ({"file": "map.las"}, "map.copc.laz"),
        ({"file": "map.laz", "options": {"sqeeze": 1}}, "sqeeze"),
        ({"file": "map.laz", "options": {"storey": "7"}}, "storey"),
        ({"file": "map.laz", "options": {"box_m": [1, 0, 0, 0, 1, 1]}}, "expected the smallest"),
    ],
)
def test_what_cannot_be_made_is_refused_before_it_waits(server, ask, says):
    answer = server.post(BASE, json=ask)

    assert (answer.status_code, says in answer.text) == (422, True), answer.text


@pytest.mark.parametrize(
    ("file", "draft", "beside"),
    [
        ("map.laz", True, 0.0),
        ("map.laz", False, 1.0),
        ("map.e57", True, 16.0 / 16.2),
        ("map.copc.laz", False, 20.0 / 10.5),
    ],
)
def test_an_export_needs_room_for_its_file_and_what_lies_beside_it(
    server, monkeypatch, file, draft, beside
):
    ask = {"file": file, "options": {"draft": draft}}
    size = server.post(f"{BASE}/estimate", json=ask).json()["bytes"]
    reserve = server.app.state.parts.settings.free_disk_reserve_bytes
    room = DiskUsage(total=1 << 60, used=0, free=round(size * (1.0 + beside)) + reserve - 2)
    monkeypatch.setattr(routes.shutil, "disk_usage", lambda _: room)

    refused = server.post(BASE, json=ask)

    assert (refused.status_code, refused.json()["code"]) == (507, "export-no-room")
    monkeypatch.setattr(routes.shutil, "disk_usage", lambda _: room._replace(free=room.free + 4))
    taken = server.post(BASE, json=ask)
    assert taken.status_code == 201, taken.text
    server.wait(taken.json()["id"], lambda view: view["job"]["finished"])


def test_exports_are_no_jobs_of_the_project_and_hold_none_up(server, made):
    assert server.get("/api/projects/office/jobs").json() == []
    assert all(view["job"]["inputs"]["export"] is None for view in server.get("/api/jobs").json())
    assert server.post(f"/api/jobs/{made['id']}/retry").status_code == 409


def test_rows_stay_when_files_go_and_follow_the_project_through_the_trash(server, made):
    parts = server.app.state.parts
    url = f"{BASE}/{made['id']}/file"
    exported = server.get(BASE).json()
    deleted = server._ask("DELETE", "/api/projects/office").json()
    build_project(server.root / "office", points=100)
    others = server.get(BASE).json()
    server._ask("DELETE", "/api/projects/office")
    server.post(f"/api/trash/{deleted['id']}/restore")

    assert others == []
    assert server.get(url).status_code == 200
    assert parts.exports.sweep(time.time()) == 0
    assert parts.exports.sweep(time.time() + KEPT_EXPORTS.kept_s + 1.0) == len(exported)
    (row,) = (row for row in server.get(BASE).json() if row["id"] == made["id"])
    assert (row["kept"], row["made"]) == (False, made["made"])
    assert server.get(url).status_code == 404
    jobs = {job.id for job in parts.jobs.of_kind(JobKind.EXPORT)}
    assert made["id"] in jobs and jobs == {row["id"] for row in exported}
