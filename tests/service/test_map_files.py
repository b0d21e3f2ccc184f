"""The map in the format that a client takes, made by the server."""

import laspy
import numpy as np
import pye57
import pytest

from tests.project_builder import approve_project, build_project
from tests.service.running import server_thread

BASE = "/api/projects/office"
EXPORTS = f"{BASE}/exports"
BEGINS = {
    "copc.laz": b"LASF",
    "laz": b"LASF",
    "e57": b"ASTM-E57",
    "ply": b"ply\n",
    "pcd": b"# .PCD v0.7",
    "xyz": b"//X Y Z Intensity",
}


@pytest.fixture(scope="module")
def server(tmp_path_factory):
    root = tmp_path_factory.mktemp("files") / "maps"
    build_project(root / "office", points=5_000, strays=3)
    approve_project(root / "office", root / ".recon4/signing.key", who="J. Novák")
    with server_thread(root) as running:
        yield running


@pytest.fixture(scope="module")
def files(server, tmp_path_factory):
    """Ending -> the file as it is downloaded."""
    folder = tmp_path_factory.mktemp("downloads")
    made = {ending: server.post(EXPORTS, json={"file": f"map.{ending}"}) for ending in BEGINS}
    assert {answer.status_code for answer in made.values()} == {201}
    for ending, ordered in made.items():
        ended = server.wait(ordered.json()["id"], lambda view: view["job"]["finished"])
        assert ended["job"]["state"] == "succeeded", ended["job"]["note"]
        answer = followed(server, f"map.{ending}")
        assert answer.status_code == 200, answer.text
        assert f'filename="office-map.{ending}"' in answer.headers["content-disposition"]
        (folder / f"map.{ending}").write_bytes(answer.content)
    return folder


def test_each_format_holds_every_point_and_the_approval(files):
    for ending, begins in BEGINS.items():
        data = (files / f"map.{ending}").read_bytes()
        assert data.startswith(begins)
        assert b"J. Nov\\u00e1k" in data, ending
    with laspy.CopcReader.open(str(files / "map.copc.laz")) as copc:
        points = len(copc.query())
    with pye57.E57(str(files / "map.e57")) as e57:
        assert sum(e57.get_header(k).point_count for k in range(e57.scan_count)) == points
    assert len(laspy.read(files / "map.laz")) == points == 5_000
    assert f"POINTS {points}\n".encode() in (files / "map.pcd").read_bytes()[:1000]
    assert len((files / "map.xyz").read_text().splitlines()) == points + 2


def followed(server, name, **how):
    """What a client gets that follows the address which it is led to."""
    led = server.get(f"{BASE}/{name}", **how)
    if led.status_code != 307:
        return led
    return server.get(led.headers["location"], headers=how.get("headers"))


def test_an_interrupted_download_continues_with_the_same_file(server, files):
    whole = (files / "map.laz").read_bytes()
    rest = followed(server, "map.laz", headers={"Range": "bytes=1000-"})

    assert rest.status_code == 206
    assert whole[:1000] + rest.content == whole


def test_the_same_file_of_the_same_map_is_made_once(server, files):
    again = server.post(EXPORTS, json={"file": "map.laz"})
    (listed,) = [one for one in server.get(EXPORTS).json() if one["file"] == "map.laz"]

    assert (again.status_code, again.json()["id"]) == (200, listed["id"])
    changed = server.post(EXPORTS, json={"file": "map.laz", "options": {"draft": True}})
    assert changed.status_code == 201
    assert changed.json()["id"] != listed["id"]


def test_points_left_out_and_a_draft_are_written_when_they_are_wanted(server, tmp_path):
    query = {"all_points": "true", "draft": "true"}
    ask = {"file": "map.copc.laz", "options": {"all_points": True, "draft": True}}
    missing = server.get(f"{BASE}/map.copc.laz", params=query)
    server.wait_state(server.post(EXPORTS, json=ask).json()["id"], "succeeded")
    found = followed(server, "map.copc.laz", params=query)
    (tmp_path / "a.laz").write_bytes(found.content)

    assert (missing.status_code, "POST" in missing.text) == (404, True)
    found = laspy.read(tmp_path / "a.laz")
    strays = np.isin(found.classification, (7, 18))
    assert len(found) - 5_000 == strays.sum() > 0
    assert b"Nov\\u00e1k" not in (tmp_path / "a.laz").read_bytes()


@pytest.mark.parametrize(
    ("name", "query", "says"),
    [("map.las", {}, "copc.laz"), ("map.laz", {"sqeeze": "1"}, "sqeeze")],
)
def test_an_unknown_format_or_option_is_said(server, name, query, says):
    answer = server.get(f"{BASE}/{name}", params=query)

    assert (answer.status_code, says in answer.text) == (422, True), answer.text
