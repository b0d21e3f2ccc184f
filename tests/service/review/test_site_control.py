"""The map is put on control points: tried, decided, made again, taken off."""

from __future__ import annotations

import json

import httpx
import numpy as np
import pytest

from recon4.geometry.se3 import so3_exp
from recon4.mapping.tiles import TileSet
from recon4.review.journal import read_decided
from recon4.store.arrays import load_trajectory
from recon4.store.project import read_artifacts
from tests.deadlines import HANG_S
from tests.review_project import make
from tests.service.review.reviewing import WRONG, decide

R_site_map = so3_exp(np.array([0.0, 0.0, 0.5]))
T_SITE_M = np.array([4_321.0, 8_765.0, 210.0])
CORNERS = np.array([[-1, -1, -1], [1, -1, 1], [1, 1, -1], [-1, 1, 1], [0, 0, 1]])


def seen_places(root):
    """Five points of the map, far from each other (5, 3)."""
    tiles = TileSet.open(read_artifacts(root)["map"])
    p_map = np.concatenate([tile.xyz_m() for tile in tiles])
    middle, half = p_map.mean(axis=0), p_map.std(axis=0)
    wanted = middle + CORNERS * half
    return np.array([p_map[np.argmin(np.linalg.norm(p_map - one, axis=1))] for one in wanted])


def surveyed(p_map):
    return p_map @ R_site_map.T + T_SITE_M


def store(server, root, p_map, p_site):
    names = [f"T{k}" for k in range(len(p_map))]
    points = [
        {"id": name, "xyz_m": at, "role": "check" if name == "T4" else "control"}
        for name, at in zip(names, p_site.tolist(), strict=True)
    ]
    state = {"points": points, "picks": dict(zip(names, p_map.tolist(), strict=True))}
    return httpx.put(url(server, root, "control"), json=state, timeout=HANG_S).raise_for_status()


def url(server, root, what):
    return f"{server.running.url}/api/projects/{root.name}/slices/{what}"


@pytest.mark.study
def test_the_map_is_put_on_control_points_and_taken_off_them(server, root):
    before = read_decided(root).key
    p_map = seen_places(root)
    store(server, root, p_map, surveyed(p_map))

    trial = httpx.get(url(server, root, "control/site"), timeout=HANG_S).json()
    put = httpx.post(url(server, root, "control/site"), json={}, timeout=HANG_S)
    make(root)
    residuals = httpx.get(url(server, root, "control/report"), timeout=HANG_S).json()
    surface = httpx.get(url(server, root, "control/surface"), params={"point": "T4"})
    record = json.loads((read_artifacts(root)["level"] / "georeference.json").read_text("utf-8"))
    stored = httpx.get(url(server, root, "control"), timeout=HANG_S).json()
    kept = httpx.put(url(server, root, "control"), json=stored, timeout=HANG_S).json()
    off = httpx.delete(url(server, root, "control/site"), timeout=HANG_S)
    make(root)
    again = httpx.get(url(server, root, "control"), timeout=HANG_S).json()

    assert trial["forbidden"] == [] and trial["unseen"] == []
    assert "T4 (check)" in trial["text"] and "not applied" in trial["text"]
    assert (put.status_code, off.status_code) == (204, 204)
    rows = record["control"]["points"]
    assert [one["id"] for one in rows] == ["T0", "T1", "T2", "T3", "T4"]
    assert np.abs([one["adjusted_m"] for one in rows]).max() < 0.03
    assert [one["id"] for one in residuals["rows"]] == ["T0", "T1", "T2", "T3", "T4"]
    assert max(one["d3_m"] for one in residuals["rows"]) < 0.03
    assert residuals["outdated"] == [] and residuals["judged_by"] == "check"
    assert kept["picks"] == stored["picks"] and kept["along"] == stored["along"]
    assert np.abs(np.array([*again["picks"].values()]) - p_map).max() < 0.001
    assert read_decided(root).key == before
    assert surface.json()["surface"] is not None  # the survey is where the map is now


def test_picks_that_were_never_put_are_in_the_map_of_a_later_decision(server, root):
    p_map = seen_places(root)
    before = load_trajectory(read_artifacts(root)["level"] / "trajectory.npz")
    store(server, root, p_map, surveyed(p_map))

    decide(server, "accept", WRONG)
    make(root)
    stored = httpx.get(url(server, root, "control"), timeout=HANG_S).json()
    after = load_trajectory(read_artifacts(root)["level"] / "trajectory.npz")

    assert stored["found_in"] == dict.fromkeys(stored["picks"], read_artifacts(root)["map"].name)
    moved_m = np.linalg.norm(np.array([*stored["picks"].values()]) - p_map, axis=1)
    most_m = np.linalg.norm(after.T_a_b.t - before.T_a_b.t, axis=1).max()
    assert 0.003 < moved_m.max() < 2.0 * most_m


@pytest.mark.study
def test_a_point_that_is_a_meter_off_is_named_and_nothing_is_decided(server, root):
    p_map = seen_places(root)
    p_site = surveyed(p_map)
    p_site[2, 0] += 1.0
    store(server, root, p_map, p_site)

    trial = httpx.get(url(server, root, "control/site"), timeout=HANG_S).json()
    put = httpx.post(url(server, root, "control/site"), json={}, timeout=HANG_S)

    assert "T2" in trial["forbidden"][0]
    assert put.status_code == 422
    assert "T2" in put.json()["detail"]
    assert not read_decided(root)


def test_two_points_place_no_map(server, root):
    p_map = seen_places(root)[:2]
    store(server, root, p_map, surveyed(p_map))

    put = httpx.post(url(server, root, "control/site"), json={}, timeout=HANG_S)

    assert put.status_code == 422
    assert not read_decided(root)


def test_a_crs_that_nobody_knows_is_refused(server, root):
    p_map = seen_places(root)
    store(server, root, p_map, surveyed(p_map))

    put = httpx.post(url(server, root, "control/site"), json={"crs": "EPSG:1"}, timeout=HANG_S)

    assert put.status_code == 422
    assert "EPSG:1" in put.json()["detail"]
