"""Double walls in a map of the pipeline: none in a good one, found after one wrong decision."""

from dataclasses import replace

import numpy as np
import pytest

from recon4.cli.main import main
from recon4.geometry.se3 import SE3
from recon4.mapping.tiles import TileSet
from recon4.model.pose_graph import EdgeKind, Verdict
from recon4.model.rig import load_rig
from recon4.pose_graph.files import load_graph
from recon4.progress import Silent
from recon4.review.decisions import Decision, DecisionKind
from recon4.review.journal import append
from recon4.review.row_contents import Measurement
from recon4.simulation.setup import prepare
from recon4.simulation.simulate import simulate
from recon4.simulation.world import Waypoint
from recon4.simulation.worlds import build_world
from recon4.slices.doubles import find_double_walls
from recon4.store.project import read_artifacts

OFF_M = np.array([0.0, 0.05, 0.0])
"""In the map: across the corridor, which runs along x between walls 0.8 m to the left and right."""
SECONDS = 14.0
BACK_S = 8.0
"""From here on the walk goes back through the corridor, to where it began."""
FEW = ["map.voxel_m=0.02", "graph.node_stride=10", "refine.rounds=0", "calibration.mode=off"]
"""Refinement would lay the two layers onto each other again."""


@pytest.fixture(scope="module")
def process(tmp_path_factory):
    walk = tmp_path_factory.mktemp("recording") / "walk"
    rig = load_rig("4recon")
    horizontal = replace(rig, sensors=rig.sensors[:1])  # it sees the walls
    office = replace(build_world("office"), route=there_and_back, stops=1)
    simulate(
        prepare(office, seconds=SECONDS, seed=2, rig=horizontal), walk, bag=False, progress=Silent()
    )
    root = tmp_path_factory.mktemp("project") / "office"
    more = [word for setting in FEW for word in ("--set", setting)]
    recording = [str(walk / "recording.pcap"), "--imu", str(walk / "imu.csv")]
    recording += ["--rig", str(walk / "rig.toml")]

    def run():
        assert main(["process", *recording, "--out", str(root), *more]) == 0
        return root

    return run


def there_and_back(rng, stops):
    ends = Waypoint(0.9, 0.8), Waypoint(7.4, 0.8, stop=True)
    return [*ends, ends[0]]


def doubles(root):
    return find_double_walls(TileSet.open(read_artifacts(root)["map"]))


def accept_one_loop_off(root):
    """Offset the widest loop by 5 cm with a high information; reject the others of the corridor."""
    graph = load_graph(read_artifacts(root)["verification"])
    t_s = 1e-9 * (graph.t_ns - graph.t_ns[0])
    over = [
        edge
        for edge in graph.edges
        if edge.kind is not EdgeKind.ODOMETRY
        and edge.verdict is Verdict.ACCEPTED
        and t_s[edge.i] < SECONDS - BACK_S
        and t_s[edge.j] > BACK_S
    ]
    wrong = max(over, key=lambda edge: edge.j - edge.i)
    for edge in over:
        pair = (int(graph.frame_ids[edge.i]), int(graph.frame_ids[edge.j]))
        if edge is wrong:
            measured = _off(edge, graph.T_map_body)
            decision = Decision(
                kind=DecisionKind.REPLACE, who="Eva", pair=pair, measurement=measured
            )
        else:
            decision = Decision(kind=DecisionKind.REJECT, who="Eva", pair=pair)
        append(root, decision)
    return len(over)


def _off(edge, T_map_body):
    R_i = T_map_body.R[edge.i]
    T = SE3(edge.T_i_j.R, edge.T_i_j.t + R_i.T @ OFF_M)
    sure = np.diag(1.0 / np.repeat([0.0003, 0.001], 3) ** 2)
    return Measurement(
        T_i_j=(*T.t.tolist(), *T.quat_xyzw().tolist()),
        information=tuple(sure.ravel().tolist()),
        overlap=0.8,
        error_m=0.01,
        limit_m=0.07,
        degeneracy=0.1,
        iterations=8,
    )


@pytest.mark.study
def test_a_wall_doubled_by_one_wrong_loop_is_found_and_a_good_map_has_none(process):
    root = process()
    good = doubles(root)
    assert accept_one_loop_off(root) > 3

    process()
    found = doubles(root)

    assert good.walls == () and good.patches > 1000
    assert "review" in read_artifacts(root)
    widest = found.walls[0]
    assert widest.separation_m == pytest.approx(0.05, abs=0.01)
    assert abs(widest.normal[1]) > 0.9
    on_corridor = [wall for wall in found.walls if abs(abs(wall.middle_m[1]) - 0.8) < 0.1]
    assert len(on_corridor) > 3 and -1.0 < widest.middle_m[0] < 6.0
    for wall in found.walls:  # seen while walking out and while walking back
        (_, out_s), (_, back_s) = sorted(wall.spans_s)
        assert out_s <= SECONDS - BACK_S and back_s > BACK_S
