"""The map in the format that a client takes, made by the server."""

import laspy
import numpy as np
import pye57
import pytest

from tests.project_builder import approve_project, build_project
from tests.service.running import server_thread

BASE = "/api/projects/office"
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
    for ending in BEGINS:
        answer = server.get(f"{BASE}/map.{ending}")
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


def test_an_interrupted_download_continues_with_the_same_file(server, files):
    whole = (files / "map.laz").read_bytes()
    rest = server.get(f"{BASE}/map.laz", headers={"Range": "bytes=1000-"})

    assert rest.status_code == 206
    assert whole[:1000] + rest.content == whole


def test_points_left_out_and_a_draft_are_written_when_they_are_wanted(server, tmp_path):
    query = {"all_points": "true", "draft": "true"}
    (tmp_path / "a.laz").write_bytes(server.get(f"{BASE}/map.copc.laz", params=query).content)

    found = laspy.read(tmp_path / "a.laz")
    strays = np.isin(found.classification, (7, 18))
    assert len(found) - 5_000 == strays.sum() > 0
    assert b"Nov\\u00e1k" not in (tmp_path / "a.laz").read_bytes()


@pytest.mark.parametrize(
    ("ending", "query", "status", "says"),
    [
        ("e57", {"all_points": "true"}, 422, "E57 has no classes"),
        ("laz", {"crs": "EPSG:25832"}, 422, "cannot be put into EPSG:25832"),
        ("las", {}, 422, "copc.laz"),
        ("laz", {"sqeeze": "1"}, 422, "sqeeze"),
    ],
)
def test_what_a_format_cannot_hold_is_said(server, ending, query, status, says):
    answer = server.get(f"{BASE}/map.{ending}", params=query)

    assert (answer.status_code, says in answer.text) == (status, True), answer.text
