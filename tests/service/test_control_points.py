"""Control and check points over HTTP, on a real server with real child processes."""

import base64
import json
from concurrent.futures import ThreadPoolExecutor

import httpx
import numpy as np
import pytest

from recon4.store.seal import changing
from tests.deadlines import HANG_S
from tests.served import office, served

BASE = "/api/projects/office/slices"


server = served(office(points=120_000))


def sent(server, path, body):
    return server.post(BASE + path, json=body)


def test_control_points_are_looked_at_kept_and_judged(server):
    text = "\ufeffID;X;Y;Z\nA;0,02;5;1,5\nB;16;5,01;1,5\n"
    file = {"name": "p.csv", "base64": base64.b64encode(text.encode()).decode()}

    preview = sent(server, "/control/preview", file).json()
    degrees = base64.b64encode(b"id,lat,lon,h\nA,49.2,16.6,250\n").decode()
    given = {"name": "d.csv", "base64": degrees}
    projected = sent(server, "/control/preview", given).json()
    state = {"points": preview["points"], "picks": {"A": [0, 5, 1.5], "B": [16, 5, 1.5]}}
    kept = httpx.put(f"{server.url}{BASE}/control", json=state, timeout=HANG_S)
    report = server.get(f"{BASE}/control/report").json()
    near = server.get(f"{BASE}/control/surface", params={"point": "A"}).json()

    assert (preview["crs"], projected["crs"]) == ("", "EPSG:32633")
    assert preview["table"]["question"].startswith("is 0.02 the easting")
    assert (preview["lies"], projected["lies"]) == ("map", "")
    assert kept.status_code == 200
    assert report["rows"][0]["east_m"] == pytest.approx(-0.02)
    assert report["passed"] is None and report["outdated"] == []
    assert "2 points, 3 needed" in report["verdict"]["text"]
    assert report["figures"][0]["role"] == "check"
    assert near["surface"][0] == pytest.approx(0.0, abs=0.01)
    assert np.abs(near["normal"]) == pytest.approx([1.0, 0.0, 0.0], abs=0.01)


def test_the_table_of_control_points_is_downloaded(server):
    state = {"points": [{"id": "A", "xyz_m": [0.02, 5, 1.5]}], "picks": {"A": [0, 5, 1.5]}}
    httpx.put(f"{server.url}{BASE}/control", json=state, timeout=HANG_S)

    table = server.get(f"{BASE}/control/report.csv")
    sheet = server.get(f"{BASE}/control/report.html")

    assert "attachment" in table.headers["Content-Disposition"]
    assert "A,check,-0.0200,0.0000,0.0000" in table.text and "Not approved" in table.text
    assert "No verdict at the check points: horizontal – (1 point, 3 needed)" in sheet.text
    assert "sandbox" in sheet.headers["Content-Security-Policy"]


def put_control(server, state):
    return httpx.put(f"{server.url}{BASE}/control", json=state, timeout=HANG_S)


def test_a_point_on_a_wall_measures_one_component_on_every_route(server):
    points = [{"id": n, "xyz_m": [0.02, y, 1.5]} for n, y in (("A", 3), ("B", 5), ("C", 7))]
    put_control(server, {"points": points})
    feet = {
        one["id"]: server.get(f"{BASE}/control/surface", params={"point": one["id"]}).json()
        for one in points
    }
    picks = {name: foot["surface"] for name, foot in feet.items()}
    along = {name: [foot["normal"]] for name, foot in feet.items()}

    kept = put_control(server, {"points": points, "picks": picks, "along": along}).json()
    report = server.get(f"{BASE}/control/report").json()
    table = server.get(f"{BASE}/control/report.csv").text
    sheet = server.get(f"{BASE}/control/report.html").text

    assert kept["along"]["A"] == along["A"]
    assert [row["east_m"] for row in report["rows"]] == pytest.approx([-0.02] * 3, abs=0.002)
    assert all(row["north_m"] is row["up_m"] is row["d2_m"] is None for row in report["rows"])
    assert [axis["points"] for axis in report["figures"][0]["axes"]] == [3, 0, 0]
    assert report["passed"] is None and "height – (not measured)" in report["verdict"]["text"]
    assert "C,check,-0.0200,–,–,–,–" in table and "RMSE,check,0.0200,–,–,,–" in table
    assert report["verdict"]["text"] in sheet and report["verdict"]["text"] in table


def test_limits_of_the_job_are_kept_named_and_refused_if_they_are_none(server):
    state = {"points": [{"id": "A", "xyz_m": [0, 5, 1.5]}], "picks": {"A": [0, 5, 1.5]}}

    kept = put_control(server, state | {"limits": {"mean_height_m": 0.03, "distances_m": None}})
    report = server.get(f"{BASE}/control/report").json()
    wrong = put_control(server, state | {"limits": {"mean_height_m": 0.0}})
    put_control(server, state)

    assert kept.json()["limits"]["mean_horizontal_m"] == 0.14
    lines = {line["label"]: line["limit_m"] for line in report["figures"][0]["requirements"]}
    assert lines["mean height"] == 0.03 and "distances between points" not in lines
    assert "mean 3 cm" not in server.get(f"{BASE}/control/report.csv").text
    assert wrong.status_code == 422


def test_a_direction_that_is_none_is_refused(server):
    state = {"points": [{"id": "A", "xyz_m": [0, 5, 1.5]}], "picks": {"A": [0, 5, 1.5]}}

    answer = put_control(server, state | {"along": {"A": [[0, 0, 0]]}})

    assert answer.status_code == 422 and "expected one to three directions" in answer.text


def test_a_place_of_an_earlier_version_counts_only_when_it_is_measured_again(server):
    path = server.root / "office" / "slices" / "control.json"
    state = {"points": [{"id": "A", "xyz_m": [0.02, 5, 1.5]}], "picks": {"A": [0, 5, 1.5]}}
    put_control(server, state)
    with changing(server.root / "office", "slices/control.json"):
        stored = json.loads(path.read_text())
        del stored["along"]
        path.write_text(json.dumps(stored))

    before = server.get(f"{BASE}/control/report").json()
    read = server.get(f"{BASE}/control").json()
    put_control(server, read)
    still = server.get(f"{BASE}/control/report").json()
    put_control(server, read | {"along": {"A": [[1, 0, 0]]}, "version": None})
    after = server.get(f"{BASE}/control/report").json()

    assert before["outdated"] == still["outdated"] == ["A"]
    assert after["rows"][0]["east_m"] == pytest.approx(-0.02)


def test_of_two_who_keep_control_points_the_second_does_not_overwrite_the_first(server):
    url = f"{server.url}{BASE}/control"
    state = {"points": [{"id": "A", "xyz_m": [0.02, 5, 1.5]}], "picks": {}}
    read = httpx.put(url, json=state, timeout=HANG_S).json()

    def keep(k):
        return httpx.put(url, json=read | {"picks": {"A": [k / 10, 5, 1.5]}}, timeout=HANG_S)

    with ThreadPoolExecutor(8) as people:
        answers = list(people.map(keep, range(8)))
    now = server.get(f"{BASE}/control").json()

    (first,) = [answer.json() for answer in answers if answer.status_code == 200]
    assert sorted(answer.status_code for answer in answers) == [200] + [409] * 7
    assert now == first and now["version"] == read["version"] + 1


def test_a_point_found_in_an_earlier_map_does_not_count_in_this_one(server):
    path = server.root / "office" / "slices" / "control.json"
    state = {"points": [{"id": "A", "xyz_m": [0.02, 5, 1.5]}], "picks": {"A": [0, 5, 1.5]}}
    url = f"{server.url}{BASE}/control"
    kept = httpx.put(url, json=state | {"found_in": {"A": "of another map"}}, timeout=HANG_S).json()
    with changing(server.root / "office", "slices/control.json"):
        path.write_text(path.read_text().replace(kept["found_in"]["A"], "ab" * 32))

    earlier = server.get(f"{BASE}/control/report").json()
    moved = httpx.put(url, json=state | {"picks": {"A": [0.01, 5, 1.5]}}, timeout=HANG_S).json()
    again = server.get(f"{BASE}/control/report").json()

    assert kept["found_in"]["A"] == server.get(BASE).json()["key"] == moved["found_in"]["A"]
    assert (earlier["outdated"], earlier["rows"], earlier["passed"]) == (["A"], [], None)
    assert again["outdated"] == [] and again["rows"][0]["east_m"] == pytest.approx(-0.01)


def test_a_pick_beside_all_points_of_the_map_is_no_measurement(server):
    points = [
        {"id": n, "xyz_m": [0.0, y, 1.5]} for n, y in (("A", 3), ("B", 5), ("C", 7), ("D", 4))
    ]
    picks = {one["id"]: one["xyz_m"] for one in points} | {"D": [4.0, 4.0, 1.2]}
    put_control(server, {"points": points, "picks": picks})

    report = server.get(f"{BASE}/control/report").json()
    table = server.get(f"{BASE}/control/report.csv").text

    assert [row["id"] for row in report["rows"]] == ["A", "B", "C"]
    assert (report["absent"], report["missing"], report["passed"]) == (["D"], [], True)
    assert report["verdict"]["level"] == "warning"
    assert "⚠ Within the limits" in report["verdict"]["text"]
    assert "has no points: D. Pick" in report["verdict"]["text"]
    assert "D,picked where the map has no points" in table
