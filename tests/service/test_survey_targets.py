"""Survey targets of a map over HTTP, on a real server with real workers."""

import httpx
import numpy as np
import pytest

from tests.deadlines import HANG_S
from tests.served import served
from tests.survey_targets import SITE, TRUE, build_targets

BASE = "/api/projects/office/slices/control"

server = served(build_targets)


def post(server, path):
    return httpx.post(f"{server.url}{BASE}/targets{path}", timeout=HANG_S).raise_for_status()


def ended(server, search):
    """The search when it is over; the stream of job changes says when."""
    with httpx.stream("GET", f"{server.url}/api/events", timeout=HANG_S) as stream:
        for _ in stream.iter_lines():
            now = server.get(f"{BASE}/targets/{search['id']}").json()
            if now["state"] not in {"queued", "running"}:
                return now
    raise AssertionError("the stream of job changes ended")


def test_targets_are_found_by_a_job_and_named_by_the_survey_that_is_stored(server):
    search = ended(server, post(server, "").json())
    found = server.get(f"{BASE}/targets/{search['id']}/found").json()
    points = [
        {"id": name, "xyz_m": (SITE @ p).tolist(), "role": "control"} for name, p in TRUE.items()
    ]
    httpx.put(f"{server.url}{BASE}", json={"points": points}, timeout=HANG_S).raise_for_status()
    again = post(server, "").json()
    named = server.get(f"{BASE}/targets/{again['id']}/found").json()

    assert search["state"] == "succeeded" and search["kept"] and search["of_this_map"]
    assert again["id"] == search["id"]  # the same search of the same map is made once
    assert [one["id"] for one in server.get(f"{BASE}/targets").json()] == [search["id"]]
    assert len(found["rows"]) == len(TRUE) and not any(row["id"] for row in found["rows"])
    assert [row["id"] for row in named["rows"]] == list(TRUE)
    places = np.array([row["p_map"] for row in named["rows"]])
    assert places == pytest.approx(np.array(list(TRUE.values())), abs=0.006)
    assert named["missing"] == [] and named["rmse_m"] < 0.006


def test_a_search_that_is_cancelled_has_found_nothing(server):
    points = [{"id": "S", "xyz_m": [1.0, 2.0, 3.0], "role": "control", "radius_m": 0.123}]
    httpx.put(f"{server.url}{BASE}", json={"points": points}, timeout=HANG_S).raise_for_status()
    search = post(server, "").json()
    post(server, f"/{search['id']}/cancel")

    assert ended(server, search)["state"] == "cancelled"
    missing = server.get(f"{BASE}/targets/{search['id']}/found")
    assert missing.status_code == 404
    assert missing.json()["code"] == "targets-gone"
