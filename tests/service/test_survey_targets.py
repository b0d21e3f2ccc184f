"""Survey targets of a map over HTTP, on a real server with real child processes."""

import httpx
import numpy as np
import pytest

from tests.deadlines import HANG_S
from tests.served import served
from tests.survey_targets import SITE, TRUE, build_targets

BASE = "/api/projects/office/slices/control"

server = served(build_targets)


def test_targets_are_named_by_the_survey_that_is_stored(server):
    found = server.get(f"{BASE}/targets").json()
    points = [
        {"id": name, "xyz_m": (SITE @ p).tolist(), "role": "control"} for name, p in TRUE.items()
    ]
    httpx.put(f"{server.url}{BASE}", json={"points": points}, timeout=HANG_S).raise_for_status()
    named = server.get(f"{BASE}/targets").json()

    assert len(found["rows"]) == len(TRUE) and not any(row["id"] for row in found["rows"])
    assert [row["id"] for row in named["rows"]] == list(TRUE)
    places = np.array([row["p_map"] for row in named["rows"]])
    assert places == pytest.approx(np.array(list(TRUE.values())), abs=0.006)
    assert named["missing"] == [] and named["rmse_m"] < 0.006
