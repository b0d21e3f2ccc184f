"""Review of a 2-D map: scans of a laser as nodes, decisions, a new map, approval."""

import json

import numpy as np
import pytest

from recon4.archive.verify import verify
from recon4.geometry.se3 import SE3
from recon4.model.pose_graph import EdgeKind
from recon4.pipeline import process
from recon4.progress import Silent
from recon4.recording.sources import Sources
from recon4.review.pairs import LAYOUT
from recon4.review.row_contents import numbers_of, pose_of
from recon4.review.source import Source
from tests.planar_walks import ring_corridor, ring_walk, scanned, write_carmen
from tests.service.review.reviewing import Reviewing, decide, keys_of, make_a_new_map
from tests.service.running import server_thread


@pytest.fixture(scope="module")
def planar(tmp_path_factory):
    """A round through a corridor and a bit more, on a server of its own."""
    root = tmp_path_factory.mktemp("planar")
    walk = scanned(ring_corridor(), ring_walk(), rate_hz=10)
    write_carmen(root / "walk.log", walk.scans)
    process(Sources((root / "walk.log",)), root / "ring")
    with server_thread(root) as running:
        yield Reviewing(running, root / "ring")


@pytest.fixture(scope="module")
def loop(planar):
    graph = Source.of(planar.root).verified
    loops = [e for e in graph.edges if e.kind is EdgeKind.LOOP and e.in_graph]
    edge = max(loops, key=lambda e: e.j - e.i)
    return edge, {"frame_i": int(graph.frame_ids[edge.i]), "frame_j": int(graph.frame_ids[edge.j])}


def test_the_scans_of_both_nodes_are_shown_and_registered(planar, loop):
    edge, pair = loop
    alone = planar.get("/points", params=pair).content
    more = planar.get("/points", params=pair | {"reach": 2}).content
    start = edge.T_i_j @ SE3.from_rpy(0.0, 0.0, 0.05, t=(0.2, -0.1, 0.0))
    found = planar.post("/align", json=pair | {"T_i_j": numbers_of(start)}).json()

    points = np.frombuffer(alone, "<f4", offset=LAYOUT.size).reshape(-1, 3)
    assert len(points) > 200
    assert np.all(points[:, 2] == 0.0)
    assert len(more) > 1.5 * len(alone)
    off = edge.T_i_j.inverse() @ pose_of(tuple(found["T_i_j"]))
    assert found["converged"]
    assert np.linalg.norm(off.t) < 0.02
    assert off.angle() < np.deg2rad(0.3)


@pytest.mark.study
def test_a_rejected_loop_is_left_out_of_the_new_map_which_is_approved(planar, loop):
    _, pair = loop
    before = keys_of(planar.root)

    assert decide(planar, "reject", pair, why="glass").status_code == 201
    assert planar.get().json()["in_map"] is False
    assert planar.get("/effect").json()["missing"] == []
    make_a_new_map(planar, planar.root)
    after = keys_of(planar.root)
    edges = json.loads((planar.root / "edges.json").read_text())["edges"]
    approved = planar.post("/approve", json={"why": "checked against the plan"})

    assert planar.get().json()["in_map"] is True
    assert after["map_2d"] != before["map_2d"]
    assert after["odometry_2d"] == before["odometry_2d"]
    (rejected,) = [e for e in edges if e["frames"] == list(pair.values())]
    assert (rejected["verdict"], rejected["decided_by"]) == ("rejected", "local")
    assert approved.status_code == 201, approved.text
    assert verify(planar.root, Silent()).damaged == ()
