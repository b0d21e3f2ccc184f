"""The slices over HTTP, on a real server with real child processes."""

import base64
import io
import json
import shutil
import threading
from pathlib import Path

import ezdxf
import httpx
import laspy
import numpy as np
import pytest
from PIL import Image

from tests.deadlines import HANG_S
from tests.project_builder import (
    ROOM_M,
    approve_project,
    build_project,
    loop_walk,
    write_summary,
)
from tests.served import served
from tests.service.running import server_thread

Z1 = {"kind": "horizontal", "z_m": 1.5, "thickness_m": 0.2}
BASE = "/api/projects/office/slices"


def projects(root):
    build_project(root / "office", points=120_000)
    build_project(root / "other", points=20_000)
    build_project(root / "young", with_map=False)


server = served(projects)


CUT_PLY = (
    b"ply\nformat binary_little_endian 1.0\nelement vertex 1000\nproperty float x\n"
    b"property float y\nproperty float z\nend_header\n"
) + bytes(120)


def ask(**changes):
    return {"plane": Z1, "width": 400, "height": 300} | changes


def sent(server, path, body):
    return server.post(BASE + path, json=body)


def exported(server, ending, **changes):
    asked = json.dumps({"plane": Z1} | changes)
    return server.get(f"{BASE}/export.{ending}", params={"ask": asked})


def test_the_facts_about_the_map(server):
    body = server.get(BASE).json()

    assert body["points"] == 120_000
    assert body["bounds_m"][1] == pytest.approx(ROOM_M, abs=0.35)
    assert body["frame"] == "map frame (local), x y z, z up, meters"
    assert body["approval"]["text"] == "Draft: not approved"
    assert [source["id"] for source in body["sources"]] == ["project:other"]


def test_an_image_shows_the_room_from_all_its_points(server):
    body = sent(server, "/image", ask(color="sensor")).json()

    image = Image.open(io.BytesIO(base64.b64decode(body["png"])))
    assert image.size == (400, 300)
    window = body["window"]
    assert (window["right"] - window["left"]) / body["pixel_m"] == pytest.approx(400)
    assert window["left"] < 0 and window["right"] > ROOM_M[0]
    assert body["points"] > 3000 and body["name"] == "z = 1.500 m"
    assert body["position"]["kind"] == "horizontal" and body["position"]["offset_m"] == 1.5
    assert np.asarray(image)[..., 3].any()


def test_a_window_is_kept_to_and_only_widened_to_the_shape(server):
    window = {"left": 2.0, "bottom": 1.0, "right": 6.0, "top": 2.0}

    body = sent(server, "/image", ask(window=window)).json()

    assert body["window"]["left"] == 2.0 and body["window"]["right"] == 6.0
    assert body["window"]["bottom"] == pytest.approx(0.0)


def test_of_several_image_requests_of_a_page_the_latest_is_answered(server):
    answers = {}

    def one(k):
        body = ask(page="p1", plane=Z1 | {"z_m": 1.0 + k / 10})
        answers[k] = httpx.post(f"{server.url}{BASE}/image", json=body, timeout=HANG_S)

    threads = [threading.Thread(target=one, args=(k,)) for k in range(8)]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()

    codes = sorted(answer.status_code for answer in answers.values())
    assert codes.count(200) >= 1 and set(codes) <= {200, 409}
    assert all(a.json()["error"] == "Superseded" for a in answers.values() if a.status_code == 409)


def test_image_requests_that_arrive_in_another_order(server):
    def one(sequence):
        return httpx.post(
            f"{server.url}{BASE}/image", json=ask(page="p2", sequence=sequence), timeout=60
        )

    late, early, later = one(7), one(6), one(8)

    assert (late.status_code, later.status_code) == (200, 200)
    assert early.status_code == 409 and early.json()["error"] == "Superseded"


def test_a_cut_that_begins_far_away_is_drawn(server):
    far = {"kind": "vertical", "a_m": [0.0, 1e8], "b_m": [1.0, 0.0]}

    body = sent(server, "/image", ask(plane=far)).json()

    assert body["points"] > 0 and max(map(abs, body["window"].values())) > 99_999_900.0
    assert sent(server, "/image", ask(plane=far, window=body["window"])).status_code == 200


def test_a_picked_point_is_one_of_the_map(server):
    found = sent(server, "/pick", {"plane": Z1, "uv": [0.0, 5.0], "radius_m": 0.3}).json()

    assert found["found"] and found["p_map"][0] == pytest.approx(0.0, abs=1e-6)
    assert abs(found["p_map"][2] - 1.5) <= 0.1
    assert found["p_crs"] is None


def test_a_stretch_of_the_walk_has_its_positions_in_the_map(server):
    def walk(**asked):
        return server.get(f"{BASE}/walk", params=asked)

    walked, expected = loop_walk(), loop_walk().T_a_b.t
    found = walk(start_s=2.0, end_s=4.0).json()["positions_m"]
    np.testing.assert_allclose(found, expected[20:41], atol=1e-3)
    assert len(walk(start_s=0.0, end_s=1e9).json()["positions_m"]) <= 502 < len(walked)
    assert walk(start_s=1e6, end_s=1e6).json()["positions_m"] == []
    assert {walk(start_s=a, end_s=1.0).status_code for a in (-1.0, "nan", "x", 1e300)} == {422}


def test_nothing_is_picked_where_nothing_is(server):
    found = sent(server, "/pick", {"plane": Z1, "uv": [100.0, 5.0]}).json()

    assert not found["found"]


def test_the_map_from_above_comes_with_its_window(server):
    image = server.get(f"{BASE}/overview")
    window = server.get(f"{BASE}/overview/window").json()

    shown = Image.open(io.BytesIO(image.content))
    across, up = window["right"] - window["left"], window["top"] - window["bottom"]
    assert shown.width / shown.height == pytest.approx(across / up, rel=0.01)
    assert window["left"] < 0 < ROOM_M[0] < window["right"]


@pytest.mark.study
def test_the_server_may_be_given_a_relative_folder(tmp_path, monkeypatch):
    build_project(tmp_path / "projects" / "office", points=2000)
    monkeypatch.chdir(tmp_path)

    with server_thread(Path("projects")) as running:
        window = running.get(f"{BASE}/overview/window")
        image = running.get(f"{BASE}/overview")
        thumbnail = running.get("/api/projects/office/thumbnail")

    assert (window.status_code, image.status_code, thumbnail.status_code) == (200, 200, 200)


def test_a_reference_is_added_compared_aligned_and_removed(server):
    path = server.root / "walls.xyz"
    y = np.arange(0, 10, 0.05)
    lines = [f"{x} {a:.3f} {z:.2f}" for x in (0.03, 16.03) for a in y for z in np.arange(0, 3, 0.1)]
    path.write_text("\n".join(lines))

    added = sent(server, "/references", {"path": str(path), "name": "Walls"}).json()
    plane = {"kind": "free", "origin_m": [0, 5, 1], "normal": [1, 0, 0], "thickness_m": 0.04}
    table = sent(server, "/compare", {"reference": added["id"], "planes": [plane]}).json()
    seen = sent(
        server, "/image", ask(color="distance", reference=added["id"], width=160, height=100)
    )
    csv = server.get(
        f"{BASE}/compare.csv",
        params={"ask": json.dumps({"reference": added["id"], "planes": [plane]})},
    )
    pairs = {
        "p_map": [[0, 0, 0], [1, 0, 0], [0, 1, 0]],
        "p_reference": [[1, 0, 0], [2, 0, 0], [1, 1, 0]],
    }
    moved = sent(server, f"/references/{added['id']}/align", {"how": "pairs"} | pairs).json()
    gone = httpx.delete(f"{server.url}{BASE}/references/{added['id']}", timeout=HANG_S)

    assert added["points"] == len(lines) and added["name"] == "Walls"
    assert table["point_weighted"]["mean_m"] == pytest.approx(0.034, abs=0.006)
    assert table["point_weighted"]["ratio_within_2cm"] < 0.1
    assert table["point_weighted"]["ratio_within_5cm"] > 0.7
    assert seen.json()["low"] == 0.0 and seen.json()["high"] == 0.1
    assert csv.text.startswith("slice,points,outliers,mean_cm") and "weighted" in csv.text
    assert moved["T_map_reference"][0][3] == pytest.approx(-1.0)
    assert "3 pairs" in moved["alignment"]
    assert gone.status_code == 204 and server.get(BASE).json()["references"] == []
    assert path.exists()


@pytest.mark.parametrize(
    ("name", "content", "words"),
    [
        ("cut.ply", CUT_PLY, "cut: 1000 points"),
        ("nothing.laz", b"LASF" + bytes(300), "expected LAS 1.0 to 1.4, got 0.0"),
        ("words.csv", b"a;b;c\nd;e;f\n", "numbers"),
        ("image.png", b"\x89PNG\r\n\x1a\n" + bytes(200), "expected a PCD, PLY"),
    ],
)
def test_a_damaged_reference_is_refused_in_words(server, name, content, words):
    path = server.root / name
    path.write_bytes(content)

    answer = sent(server, "/references", {"path": str(path)})

    assert answer.status_code == 422 and words in answer.json()["detail"]
    assert server.get(BASE).json()["references"] == []
    assert list((server.root / "office" / "slices" / "references").iterdir()) == []


def test_a_folder_is_no_reference(server):
    answer = sent(server, "/references", {"path": str(server.root)})

    assert answer.status_code == 422 and "got a folder" in answer.json()["detail"]


def test_a_reference_outside_of_the_folders_is_refused(server):
    answer = sent(server, "/references", {"path": "/etc/passwd"})

    assert answer.status_code == 403


def test_exports_open_in_other_programs(server):
    laz = exported(server, "laz")
    with laspy.open(io.BytesIO(laz.content)) as file:
        points = file.read()
    png = Image.open(io.BytesIO(exported(server, "png", size="a4").content))
    svg = exported(server, "svg").text
    csv = exported(server, "csv", count=2, spacing_m=0.5).text.splitlines()

    assert np.abs(points.z - 1.5).max() <= 0.1005 and len(points) > 3000
    assert png.size == (3507, 2480)
    assert svg.startswith("<?xml") and "office" in svg and "Not approved" in svg
    assert csv[0].startswith("# recon4 slice") and len({line[:2] for line in csv[2:]}) == 2
    folder = server.root / ".recon4" / "slices" / "exports"
    assert {".laz", ".png", ".svg", ".csv"} <= {path.suffix for path in folder.iterdir()}


def test_an_export_of_an_approved_map_says_so(server):
    stamp = approve_project(
        server.root / "office", server.root / ".recon4" / "signing.key"
    ).stamp.to_json()

    files = {ending: exported(server, ending).content for ending in ("laz", "csv", "dxf", "tif")}
    shown = server.get(BASE).json()["approval"]
    office = server.root / "office"
    (office / "decisions.sqlite").unlink()
    later = server.get(BASE).json()["approval"]
    shutil.rmtree(office / "versions")  # a draft again, for the other tests
    summary = json.loads((office / "summary.json").read_text())
    write_summary(office, summary | {"approval": None})

    assert shown["text"].startswith("Approved v1 · Eva · ")
    assert later["kind"] == "not valid" and "in no row of the journal" in later["detail"]

    with laspy.open(io.BytesIO(files["laz"])) as laz:
        (record,) = [vlr for vlr in laz.header.vlrs if vlr.user_id == "recon4"]
        assert json.loads(record.record_data_bytes()) == stamp
        assert laz.read().header.point_count > 1000
    assert json.loads(files["csv"].splitlines()[1].removeprefix(b"# recon4 approval ")) == stamp
    assert json.dumps(stamp).encode() in files["dxf"][:400]
    assert ezdxf.read(io.StringIO(files["dxf"].decode())).modelspace().query("POINT").first
    assert b"Approved by Eva (reviewer)" in files["tif"]


def test_an_export_of_nothing_is_refused_in_words(server):
    folder = server.root / ".recon4" / "slices" / "exports"
    before = sorted(folder.iterdir()) if folder.exists() else []

    answer = exported(server, "laz", plane=Z1 | {"z_m": 90.0})

    assert answer.status_code == 422 and "no points" in answer.json()["detail"]
    assert sorted(folder.iterdir()) == before


def test_an_export_that_broke_off_goes_on_where_it_was(server):
    whole = exported(server, "csv", count=2)
    part = server.get(
        whole.request.url.raw_path.decode(),
        headers={"Range": "bytes=1000-", "If-Range": whole.headers["etag"]},
    )

    assert part.status_code == 206
    assert part.content == whole.content[1000:]


def test_double_walls_are_looked_for_once_a_map(server):
    first = server.get(f"{BASE}/doubles").json()
    again = server.get(f"{BASE}/doubles").json()

    assert first == again
    assert first["walls"] == [] and first["points"] == 120_000


def test_a_pick_on_a_slice_comes_with_what_it_measures(server):
    found = sent(server, "/pick", {"plane": Z1, "uv": [0.0, 5.0], "radius_m": 0.3}).json()

    assert len(found["along"]) == 3 and found["along"][:2] == [[1, 0, 0], [0, 1, 0]]
    assert np.linalg.matrix_rank(found["along"], tol=0.1) == 2  # on a wall nothing is the height


def test_another_project_can_be_set_beside(server):
    here = sent(server, "/image", ask()).json()
    there = sent(server, "/image", ask(source="project:other")).json()

    assert there["points"] < here["points"] / 3


@pytest.mark.parametrize(
    ("changes", "status"),
    [
        ({"plane": Z1 | {"thickness_m": 0}}, 422),
        ({"plane": {"kind": "free", "normal": [0, 0, 0]}}, 422),
        ({"plane": {"kind": "vertical", "a_m": [1, 1], "b_m": [1, 1]}}, 422),
        ({"width": 100_000}, 422),
        ({"window": {"left": 0, "right": 0, "bottom": 0, "top": 1}}, 422),
        ({"color": "distance"}, 422),
        ({"reference": "../../etc"}, 404),
        ({"source": "project:../x"}, 404),
        ({"source": "map:0123456789abcdef"}, 404),
        ({"unknown": 1}, 422),
    ],
)
def test_a_request_without_meaning_is_refused(server, changes, status):
    answer = sent(server, "/image", ask(**changes))

    assert answer.status_code == status
    assert answer.json()["detail"]


def test_a_project_without_a_map_says_so(server):
    assert server.get("/api/projects/young/slices").status_code == 404
