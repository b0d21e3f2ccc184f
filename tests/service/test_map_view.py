"""The points of the page *Map* over HTTP, on a real server with real child processes."""

import base64
import io
import json
import zipfile
from itertools import pairwise

import httpx
import numpy as np
import pytest
from PIL import Image

from recon4.archive.verify import verify_project
from recon4.first_view.tuning import MAP_CHUNKS
from recon4.mapping.tiles import TileSet
from recon4.progress import Silent
from recon4.store.project import read_artifacts
from tests.project_builder import ROOM_M, build_project
from tests.served import served

BASE = "/api/projects/office/map"
STORED = ("xyz", "time")
EYE = (9.0, 5.0, 1.5)


def projects(root):
    build_project(root / "office", points=120_000, normals=True)
    build_project(root / "young", with_map=False)


server = served(projects)


@pytest.fixture(scope="module")
def tiles(server):
    return TileSet.open(read_artifacts(server.root / "office")["map"])


def index_of(server):
    return server.get(BASE).json()


def points(server, *parts, **query):
    index = index_of(server)
    wanted = ",".join(":".join(map(str, part)) for part in parts)
    usual = {"stored": "xyz", "version": index["version"], "parts": wanted}
    return server.get(f"{BASE}/{index['key']}/points", params=usual | query)


def places(data, tile):
    n = len(data) // 10
    part = np.frombuffer(data, "<u2", 3 * n).reshape(n, 3) / 65535.0
    low, high = np.array(tile["low_m"]), np.array(tile["high_m"])
    return low + part * (high - low)


def cubes(server, *parts, stored="xyz"):
    index = index_of(server)
    wanted = ",".join(":".join(map(str, part)) for part in parts)
    query = {"stored": stored, "version": index["version"], "parts": wanted}
    return server.get(f"{BASE}/{index['key']}/cubes", params=query)


def in_cube(data, tiles):
    """Positions of a part of a cube that has all tiles, and the tiles."""
    n = len(data) // 11
    part = np.frombuffer(data, "<u2", 3 * n).reshape(n, 3) / 65535.0
    low = np.min([tile["low_m"] for tile in tiles], axis=0)
    high = np.max([tile["high_m"] for tile in tiles], axis=0)
    return low + part * (high - low), np.frombuffer(data, np.uint8, n, 10 * n)


def pick(server, **changes):
    ask = {
        "key": index_of(server)["key"],
        "origin_m": EYE,
        "direction": (1.0, 0.02, 0.01),
        "pixel_rad": 0.001,
        "point_m": 0.05,
    }
    return server.post(f"{BASE}/pick", json=ask | changes)


def test_the_index_says_what_is_in_the_map(server):
    index = index_of(server)

    assert index["points"] == sum(tile["points"] for tile in index["tiles"]) == 120_000
    assert sum(tile["sample"] for tile in index["tiles"]) == pytest.approx(60_000, abs=4)
    assert index["high_m"] == pytest.approx(ROOM_M, abs=0.7)
    assert index["frame"] == "map frame (local), x y z, z up, meters"
    assert index["storeys"][0]["floor_m"] == pytest.approx(0.0, abs=0.1)
    assert {"intensity", "time"} <= {column["name"] for column in index["columns"]}


def test_all_chunks_of_a_tile_are_all_of_its_points_once(server, tiles):
    tile = index_of(server)["tiles"][0]
    ends = [0, 100, tile["points"] // 64 + 7, tile["points"]]

    chunks = [points(server, (0, a, b)).content for a, b in pairwise(ends)]

    found = np.vstack([places(chunk, tile) for chunk in chunks])
    truth = tiles.tiles[0].xyz_m()
    assert len(found) == len(truth)
    assert np.abs(np.sort(found, axis=0) - np.sort(truth, axis=0)).max() < 2e-4


def test_values_lie_beside_their_points(server, tiles):
    index = index_of(server)
    column = next(one for one in index["columns"] if one["name"] == "time")
    start = index["tiles"][0]["points"] // 64  # from here on in the order in which it is stored

    data = points(server, (0, start, start + 500), stored="time").content

    seconds = column["offset"] + column["scale"] * np.frombuffer(data, "<u2")
    truth = tiles.tiles[0].read(["t_ns"], rows=slice(start, start + 500))["t_ns"]
    assert seconds == pytest.approx((truth - tiles.first_ns) / 1e9, abs=column["scale"])


def test_the_sample_is_the_first_points_of_every_tile(server):
    index = index_of(server)
    asked = {"stored": "xyz", "version": index["version"]}
    address = f"{BASE}/{index['key']}/sample"

    answer = server.get(address, params=asked)
    again = server.get(
        address, params=asked, headers={"If-None-Match": answer.headers["ETag"]}
    ).status_code

    found = in_cube(answer.content, index["tiles"])
    for row, tile in enumerate(index["tiles"]):
        truth = places(points(server, (row, 0, tile["sample"])).content, tile)
        own = found[0][found[1] == row]
        assert np.abs(np.sort(own, axis=0) - np.sort(truth, axis=0)).max() < 4e-4
    assert again == 304


def test_a_cube_has_the_coarse_points_of_its_tiles_evenly(server):
    index = index_of(server)
    tiles = index["tiles"]
    many = sum(tile["coarse"] for tile in tiles)
    few = many // 10

    data = {stored: cubes(server, (0, 0, few), (0, few, many), stored=stored) for stored in STORED}

    first = in_cube(data["xyz"].content[: 11 * few], tiles)
    counts = np.bincount(first[1], minlength=len(tiles))
    shares = np.array([tile["coarse"] for tile in tiles]) / many
    assert counts == pytest.approx(few * shares, abs=2)
    assert len(data["xyz"].content) == 11 * many and len(data["time"].content) == 2 * many
    late = cubes(server, (0, few, many + 1))
    assert late.status_code == 422 and "points" in late.json()["detail"]


def test_values_of_a_cube_lie_beside_its_points(server, tiles):
    index = index_of(server)
    few = 50
    column = next(one for one in index["columns"] if one["name"] == "time")

    p_map, slots = in_cube(cubes(server, (0, 0, few)).content, index["tiles"])
    steps = np.frombuffer(cubes(server, (0, 0, few), stored="time").content, "<u2")

    for p, slot, step in zip(p_map, slots, steps, strict=True):
        tile = tiles.tiles[slot]
        known = tile.read(["t_ns"])["t_ns"]
        near = np.linalg.norm(tile.xyz_m() - p, axis=1) < 4e-4
        seconds = (known[near] - tiles.first_ns) / 1e9
        assert np.abs(seconds - column["offset"] - column["scale"] * step).min() < column["scale"]


def test_parts_of_several_tiles_come_one_after_the_other(server):
    parts = [(1, 10, 400), (0, 0, 3), (1, 400, 402)]

    together = [points(server, *parts, stored=stored).content for stored in ("xyz", "time")]

    for stored, data in zip(("xyz", "time"), together, strict=True):
        alone = [points(server, part, stored=stored).content for part in parts]
        assert all(alone) and data == b"".join(alone)


def test_a_chunk_is_kept_for_ever_and_not_sent_again(server):
    answer = points(server, (0, 0, 10))
    tag = answer.headers["ETag"]
    key = index_of(server)["key"]

    again = server.get(
        f"{BASE}/{key}/points",
        params={"stored": "xyz", "version": MAP_CHUNKS.version, "parts": "0:0:10"},
        headers={"If-None-Match": tag},
    )

    assert "immutable" in answer.headers["Cache-Control"]
    assert (again.status_code, again.content, again.headers["ETag"]) == (304, b"", tag)


@pytest.mark.parametrize(
    ("query", "status"),
    [
        ({"parts": "0:5:5"}, 400),
        ({"parts": "0:9:2"}, 400),
        ({"parts": "0:0:2,0:9:2"}, 400),
        ({"parts": f"0:0:{1 << 39}"}, 400),
        ({"parts": "0:0:200000,0:0:100000"}, 400),
        ({"parts": ",".join(["0:0:1"] * 65)}, 400),
        ({"parts": "0:-1:2"}, 422),
        ({"parts": "0:0"}, 422),
        ({"parts": "0:0:2,"}, 422),
        ({"parts": ""}, 422),
        ({"parts": "٠:٠:٢"}, 422),
        ({"parts": f"{1 << 20}:0:2"}, 422),
        ({"parts": "0:119999:120001"}, 422),
        ({"parts": "0:0:2", "stored": "ring"}, 422),
        ({"parts": "0:0:2", "more": 1}, 422),
    ],
)
def test_hostile_parameters_are_refused(server, query, status):
    answer = points(server, **query)

    assert answer.status_code == status and "error" in answer.json()


@pytest.mark.parametrize("key", ["..%2f..", "0" * 64, "x", "map"])
def test_a_map_that_is_none_of_the_project_is_not_found(server, key):
    address = f"{BASE}/{key}/points?stored=xyz&version={MAP_CHUNKS.version}&parts=0:0:1"

    assert server.get(address).status_code == 404
    assert server.get("/api/projects/young/map").status_code == 404


def test_a_ray_hits_the_nearest_point_of_the_first_surface(server, tiles):
    found = pick(server).json()["point"]

    every = np.vstack([tile.xyz_m() for tile in tiles])
    assert np.abs(every - found["p_map"]).max(axis=1).min() < 1e-6
    assert found["p_map"][0] == pytest.approx(11.75, abs=0.15)  # a pillar stands before the wall
    assert found["classification"] == "unclassified" and found["p_crs"] is None


def test_a_ray_goes_through_what_is_clipped(server):
    behind = pick(server, planes=[(1.0, 0.0, 0.0, -13.0)]).json()["point"]
    nothing = pick(server, planes=[(0.0, 0.0, 1.0, -90.0)]).json()["point"]

    assert behind["p_map"][0] == pytest.approx(ROOM_M[0], abs=0.05)
    assert nothing is None


@pytest.mark.parametrize(
    "changes",
    [
        {"direction": (0.0, 0.0, 0.0)},
        {"origin_m": (1e12, 0.0, 0.0)},
        {"pixel_rad": -1.0},
        {"planes": [(0.0, 0.0, 1.0, 0.0)] * 17},
        {"point_m": 1e9},
    ],
)
def test_a_ray_that_is_none_is_refused(server, changes):
    assert pick(server, **changes).status_code == 422


def test_a_map_that_was_made_again_is_not_measured_in(server):
    answer = pick(server, key="0" * 64)

    assert answer.status_code == 409 and "made again" in answer.json()["detail"]


SNAP = {"snap_rad": 0.03}


def test_a_pick_near_a_corner_of_the_room_is_that_corner(server):
    def snapped(target, **changes):
        direction = np.array(target) - EYE
        direction /= np.linalg.norm(direction)
        found = pick(server, direction=direction.tolist(), pixel_rad=0.003, **SNAP | changes)
        return found.json()["snap"]

    corner = snapped((ROOM_M[0], 0.05, 0.06))
    edge = snapped((15.2, 0.05, 0.02))
    wall = snapped((ROOM_M[0], 1.2, 1.0))
    level = snapped((ROOM_M[0], 0.05, 0.06), planes=[(0.0, 0.0, 1.0, -0.3)])

    assert (corner["kind"], edge["kind"], wall["kind"]) == ("corner", "edge", "plane")
    assert corner["p_map"] == pytest.approx([ROOM_M[0], 0.0, 0.0], abs=0.01)
    assert edge["p_map"][1:] == pytest.approx([0.0, 0.0], abs=0.01)
    assert wall["p_map"][0] == pytest.approx(ROOM_M[0], abs=0.01) and wall["sd_m"] < 0.02
    assert level is None or level["kind"] != "corner"  # the floor is clipped
    assert pick(server).json()["snap"] is None


def test_a_volume_is_that_of_what_is_shown(server):
    polygon = [(5.0, 2.0), (7.0, 2.0), (7.0, 4.0), (5.0, 4.0)]
    ask = {"key": index_of(server)["key"], "polygon": polygon, "high_m": 1.0}

    over = server.post(f"{BASE}/volume", json=ask | {"base_m": -0.5}).json()
    fitted = server.post(f"{BASE}/volume", json=ask).json()
    nothing = server.post(f"{BASE}/volume", json=ask | {"low_m": 0.5})

    assert (over["area_m2"], over["below_m3"]) == (pytest.approx(4.0), 0.0)
    assert over["above_m3"] == pytest.approx(2.0, rel=0.02)
    assert fitted["above_m3"] < 0.1 and abs(fitted["base_m"]) < 0.05
    assert nothing.status_code == 422 and "nothing was seen" in nothing.json()["detail"]
    assert server.post(f"{BASE}/volume", json=ask | {"key": "0" * 64}).status_code == 409
    assert server.post(f"{BASE}/volume", json=ask | {"polygon": polygon[:2]}).status_code == 422


def test_a_page_of_another_layout_receives_no_points(server):
    key = index_of(server)["key"]

    for what in ("sample", "points", "cubes"):
        address = f"{BASE}/{key}/{what}?stored=xyz"
        more = "" if what == "sample" else "&parts=0:0:2"
        answer = server.get(f"{address}{more}&version=0")
        assert answer.status_code == 409 and "reload the page" in answer.json()["detail"]
        assert server.get(address + more).status_code == 422


def test_marks_of_the_operator_are_on_the_walk(server):
    marks = server.root / "office/recordings/marks.jsonl"
    marks.parent.mkdir()
    began_ns = 1_700_000_000_000_000_000
    lines = [
        {"t_ns": began_ns + 10_000_000_000, "what": "point", "text": "door", "who": "otto"},
        {"t_ns": began_ns + 11_000_000_000, "what": "pause"},
        {"t_ns": began_ns - 90_000_000_000, "what": "place", "text": "before"},
        {"t_ns": "now", "what": "point"},
    ]
    marks.write_text("\n".join([*map(json.dumps, lines), "{", ""]))

    walk = server.get(f"{BASE}/walk").json()
    marks.unlink()

    (mark,) = walk["marks"]
    at = walk["t_s"].index(mark["t_s"])
    assert (mark["text"], mark["who"], mark["t_s"]) == ("door", "otto", 10.0)
    assert mark["p_map"] == pytest.approx(walk["positions_m"][at], abs=1e-3)
    assert walk["marks_left_out"] == 3
    assert server.get(f"{BASE}/walk").json()["marks"] == []


def test_a_note_is_kept_changed_listed_and_exported(server):
    notes = "/api/projects/office/notes"
    place = [1.5, 2.5, 0.25]
    key = index_of(server)["key"]

    note = server.post(notes, json={"p_map": place, "text": "a crack", "key": key}).json()
    change = {"revision": note["revision"], "status": "done"}
    with httpx.Client(base_url=server.url) as client:
        done = client.patch(f"{notes}/{note['id']}", json=change)
        late = client.patch(f"{notes}/{note['id']}", json=change | {"status": "open"})
        listed = client.get(notes).json()
        (feature,) = client.get(f"{notes}.geojson").json()["features"]
        png = io.BytesIO()
        Image.new("RGB", (30, 20), "red").save(png, "PNG")
        sent = {"revision": 2, "base64": base64.b64encode(png.getvalue()).decode()}
        pinned = client.put(f"{notes}/{note['id']}/photo", json=sent)
        fake = {"revision": 3, "base64": base64.b64encode(b"<html>").decode()}
        refused = client.put(f"{notes}/{note['id']}/photo", json=fake)
        photo = client.get(f"{notes}/{note['id']}/photo")
        bcf = client.get(f"{notes}.bcf")
        gone = [client.delete(f"{notes}/{note['id']}").status_code for _ in range(2)]

    assert pinned.json()["revision"] == 3 and refused.status_code == 422
    assert photo.headers["content-type"] == "image/jpeg"
    assert photo.headers["x-content-type-options"] == "nosniff"
    assert "sandbox" in photo.headers["content-security-policy"]
    with zipfile.ZipFile(io.BytesIO(bcf.content)) as archive:
        (shot,) = [name for name in archive.namelist() if name.endswith("snapshot.jpg")]
        assert archive.read(shot) == photo.content
    assert listed == {"may_change": True, "notes": [done.json()]}
    assert late.status_code == 409 and "meanwhile" in late.json()["detail"]
    assert feature["geometry"] == {"type": "Point", "coordinates": place}
    about = feature["properties"]
    assert (about["text"], about["status"], about["who"]) == ("a crack", "done", "local")
    assert "not georeferenced" in about["coordinates"]
    assert server.post(notes, json={"p_map": place, "text": "", "key": key}).status_code == 422
    assert (gone, server.get(notes).json()["notes"]) == ([204, 404], [])
    assert verify_project(server.root / "office", Silent()).damaged == ()


def test_the_walk_has_times_positions_and_nodes(server):
    walk = server.get(f"{BASE}/walk").json()

    assert len(walk["t_s"]) == len(walk["positions_m"]) == 600
    assert walk["t_s"][-1] == pytest.approx(59.9)
    assert walk["positions_m"][0] == pytest.approx([14.0, 5.0, 1.2])
    assert len(walk["nodes_m"]) == 60
