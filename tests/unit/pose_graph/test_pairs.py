from dataclasses import replace
from pathlib import Path
from tempfile import gettempdir

import numpy as np
import pytest

from recon4.geometry.se3 import SE3
from recon4.model.pose_graph import EdgeKind, Measure, Reason, Verdict
from recon4.pose_graph.node_views import NodeRangeImages
from recon4.pose_graph.pair import Pair
from recon4.pose_graph.pairs import PairRegistrar
from recon4.pose_graph.tuning import GraphTuning, graph_tuning
from recon4.progress import Silent
from recon4.registration.collar_lines import register_lines
from recon4.registration.overlap import RangeImage, overlap
from recon4.registration.submap import Submaps, TrackedFrames, median_range_m, node_rows
from recon4.registration.tuning import OVERLAP, OdometryTuning, OverlapTuning
from recon4.settings import Settings
from tests.scanned_room import strolling, walk
from tests.tuned import with_tuning

NOTHING_LOST = np.zeros(21, bool)


@pytest.fixture(scope="module")
def stroll():
    return walk(strolling, 21)


def submaps_of(stroll, rows, settings=None, *, skip=NOTHING_LOST, trajectory=None):
    tracked = TrackedFrames(stroll, trajectory or stroll.truth, skip)
    scratch = Path(gettempdir())
    return Submaps(tracked, np.array(rows), scratch=scratch)


def registrar(stroll, *assignments, lost=NOTHING_LOST, trajectory=None, overlaps=OVERLAP):
    settings = with_tuning(Settings(), "graph.workers=1", *assignments)
    rows = node_rows(stroll.t_mid_ns, settings.graph.node_stride, lost)
    views = NodeRangeImages(
        len(rows),
        graph_tuning(settings.graph),
        overlap=overlaps,
        scratch=Path(gettempdir()),
    )
    submaps = submaps_of(stroll, rows, settings, skip=lost, trajectory=trajectory)
    made = PairRegistrar(submaps, views, settings, overlap=overlaps)
    made.prepare(len(rows), Silent())
    return made


def true_motion(stroll, i, j):
    T = stroll.truth.at(stroll.t_mid_ns[[2 + 5 * i, 2 + 5 * j]])
    return T[0].inverse() @ T[1]


def pair(stroll, i, j, *, wrong=None):
    T = true_motion(stroll, i, j)
    return Pair(i, j, EdgeKind.LOOP, T if wrong is None else T @ wrong)


def try_one(stroll, *assignments, i=0, j=3, wrong=None, **options):
    made = registrar(stroll, *assignments, **options)
    return made.register([pair(stroll, i, j, wrong=wrong)], Silent())[0]


def test_a_good_pair_is_accepted_with_all_its_figures(stroll):
    wrong = SE3.from_rpy(0.01, 0.0, 0.03, t=[0.15, -0.10, 0.05])

    edge = try_one(stroll, wrong=wrong)

    assert (edge.verdict, edge.reason) == (Verdict.ACCEPTED, Reason.NONE)
    assert edge.overlap > 0.7
    assert 0.0 < edge.error_m < 0.02
    assert edge.converged
    assert edge.iterations > 1
    assert edge.degeneracy > 0.05
    off = true_motion(stroll, 0, 3).inverse() @ edge.T_i_j
    assert np.linalg.norm(off.t) < 0.005
    assert off.angle() < 0.002


def test_the_limit_is_a_hundredth_of_the_median_range_and_five_centimeters(stroll):
    edge = try_one(stroll)

    submaps = submaps_of(stroll, [2])
    range_m = median_range_m(submaps.around(0, GraphTuning().source_reach))
    assert 2.0 < range_m < 5.0
    assert edge.limit_m == pytest.approx(0.01 * range_m + 0.05, abs=2e-4)


@pytest.mark.parametrize(("assignments", "wrong", "reason"), [
    ([], SE3.from_rpy(0, 0, 0, t=[40.0, 0, 0]), Reason.OVERLAP),
    (["registration.max_iterations=2"], None, Reason.NOT_CONVERGED),
    (["graph.error_relative=0.0", "graph.error_absolute_m=0.001"], None, Reason.ERROR),
    (["graph.min_match_ratio=1.01"], None, Reason.FEW_MATCHES),
    (["graph.min_degeneracy=0.34"], None, Reason.DEGENERATE),
    (["graph.max_seen_through=-0.1"], None, Reason.SEEN_THROUGH),
])  # fmt: skip
def test_each_reason_to_reject_a_pair(stroll, assignments, wrong, reason):
    edge = try_one(stroll, *assignments, wrong=wrong)

    assert (edge.verdict, edge.reason) == (Verdict.REJECTED, reason)
    assert not edge.in_graph
    assert np.isfinite(edge.overlap)
    last = edge.judgments[-1]
    if reason is Reason.NOT_CONVERGED:
        assert last.value is None
    else:
        above = last.measure in (Measure.ERROR, Measure.SEEN_THROUGH)
        assert (last.value > last.limit) is above


def test_a_wrong_pose_has_points_where_the_other_visit_saw_through(stroll):
    made = registrar(stroll)
    edge = made.register([pair(stroll, 0, 3)], Silent())[0]
    elsewhere = edge.evolve(T_i_j=edge.T_i_j @ SE3.from_rpy(0, 0, 0, t=[1.5, 0, 0]))
    most = GraphTuning().max_seen_through

    assert made.seen_through(edge) < 0.1 * most
    assert made.seen_through(elsewhere) > most


def test_recognized_pairs_have_a_limit_of_their_own(stroll):
    made = registrar(stroll, "recognition.max_seen_through=-0.1")
    predicted = pair(stroll, 0, 3)

    first, second = made.register([predicted, replace(predicted, recognized=True)], Silent())

    assert first.reason is Reason.NONE
    assert second.reason is Reason.SEEN_THROUGH


def test_a_pair_without_overlap_keeps_its_initial_pose(stroll):
    wrong = SE3.from_rpy(0, 0, 0, t=[40.0, 0, 0])

    edge = try_one(stroll, wrong=wrong)

    np.testing.assert_array_equal(edge.T_i_j.t, (true_motion(stroll, 0, 3) @ wrong).t)
    assert np.isnan(edge.error_m)
    assert edge.iterations == 0


def test_a_pair_below_the_threshold_of_the_overlap_is_rejected(stroll):
    edge = try_one(stroll, overlaps=OverlapTuning(threshold=1.01))

    assert edge.reason is Reason.OVERLAP


def test_the_mode_of_overlap_counts(stroll):
    # From outside the room all walls of the other are behind the nearest one.
    wrong = SE3.from_rpy(0, 0, 0, t=[3.0, 0, 0])
    found = {
        mode: try_one(
            stroll, overlaps=OverlapTuning(mode=mode, threshold=1.01), wrong=wrong
        ).overlap
        for mode in ("target", "source", "min", "harmonic")
    }

    submaps = submaps_of(stroll, [2, 17])
    views = NodeRangeImages(2, graph_tuning(Settings().graph), scratch=Path(gettempdir()))
    views.fill(submaps, [0, 1])
    first, second = (RangeImage(views.ends(k).reshape(-1, 3), views.nearest_m(k)) for k in (0, 1))
    asked = true_motion(stroll, 0, 3) @ wrong
    assert found["target"] == overlap(first, second, asked)
    assert found["target"] != found["source"]
    assert found["min"] == min(found["target"], found["source"])
    a, b = found["target"], found["source"]
    assert found["harmonic"] == pytest.approx(2 * a * b / (a + b))


def test_edges_are_in_the_order_of_the_pairs(stroll):
    asked = [pair(stroll, *ends) for ends in [(2, 3), (0, 2), (1, 3), (0, 1)]]

    edges = registrar(stroll).register(asked, Silent())

    assert [(e.i, e.j) for e in edges] == [(2, 3), (0, 2), (1, 3), (0, 1)]
    for edge in edges:
        off = true_motion(stroll, edge.i, edge.j).inverse() @ edge.T_i_j
        assert np.linalg.norm(off.t) < 0.01


def test_a_pair_alone_and_among_others_is_the_same(stroll):
    alone = try_one(stroll)
    others = [pair(stroll, 0, 1), pair(stroll, 0, 3), pair(stroll, 1, 2)]

    among = registrar(stroll).register(others, Silent())[1]

    np.testing.assert_array_equal(alone.T_i_j.t, among.T_i_j.t)
    np.testing.assert_array_equal(alone.information, among.information)


@pytest.mark.parametrize("solver", ["common_normal", "svd"])
def test_the_solvers_of_lines_try_pairs_too(stroll, solver):
    edge = try_one(
        stroll,
        f"registration.solver={solver}",
        "registration.max_iterations=60",
        wrong=SE3.from_rpy(0, 0, 0.01, t=[0.05, -0.03, 0.02]),
    )

    off = true_motion(stroll, 0, 3).inverse() @ edge.T_i_j
    assert np.linalg.norm(off.t) < 0.05
    g = GraphTuning()
    np.testing.assert_allclose(
        np.diag(edge.information) ** -0.5, np.repeat([g.loop_sd_rad, g.loop_sd_m], 3)
    )


def test_single_multiframes_overlap_by_all_their_points(stroll):
    dense = walk(strolling, 8, columns=1800)
    made = registrar(dense, "graph.target_reach=0", "graph.source_reach=0", lost=np.zeros(8, bool))
    T = dense.truth.at(dense.t_mid_ns[[2, 7]])
    asked = Pair(0, 1, EdgeKind.NEIGHBOR, T[0].inverse() @ T[1])

    edge = made.register([asked], Silent())[0]

    # By the ends of their segments alone it would be a tenth of this.
    assert edge.overlap > 0.5
    assert edge.verdict is Verdict.ACCEPTED


def test_lines_keep_the_overlapping_fraction_of_matches(stroll, monkeypatch):
    portions = []

    def register(*args, portion, **more):
        portions.append(portion)
        return register_lines(*args, portion=portion, **more)

    monkeypatch.setattr("recon4.pose_graph.pairs.register_lines", register)

    edge = try_one(stroll, "registration.solver=svd", "registration.max_iterations=20")

    assert portions == [edge.overlap]
    assert 0.5 < edge.overlap < 1.0


# -- how certain an edge is


def test_the_information_is_positive_definite_and_within_its_limit(stroll):
    edge = try_one(stroll)

    g = GraphTuning()
    assert np.linalg.eigvalsh(edge.information).min() > 0.0
    np.testing.assert_array_equal(edge.information, edge.information.T)
    sd = np.sqrt(np.diag(np.linalg.inv(edge.information)))
    assert (sd >= np.repeat([g.loop_sd_rad, g.loop_sd_m], 3) * 0.999).all()
    assert (sd < 8 * np.repeat([g.loop_sd_rad, g.loop_sd_m], 3)).all()


def test_the_information_scale_sets_the_fraction_of_independent_matches(stroll):
    g = GraphTuning()
    floor = np.repeat([g.loop_sd_rad, g.loop_sd_m], 3) ** 2
    usual, naive = (
        np.diag(np.linalg.inv(edge.information)) - floor
        for edge in (try_one(stroll), try_one(stroll, "odometry.information_scale=1.0"))
    )

    np.testing.assert_allclose(usual, naive / OdometryTuning().information_scale, rtol=0.05)


def test_the_information_is_in_the_axes_of_the_second_node(stroll):
    """Without walls across x the room is a tunnel along x, wherever the second node looks."""
    tunnel = []
    for frame in stroll.frames:
        T = stroll.truth.at(frame.t_ns + frame.dt_ns.astype(np.int64))
        p_map = T @ (stroll.rig.T_body_sensor[frame.sensor] @ frame.xyz.astype(np.float64))
        _, y, z = p_map.T
        sides = (y < -2.97) | (y > 3.47) | (z < -1.17) | (z > 1.67)
        tunnel.append(frame.take(np.flatnonzero(sides)))

    edge = try_one(replace(stroll, frames=tunnel), "graph.min_degeneracy=0.0")

    assert edge.converged
    assert edge.degeneracy < 0.005
    spread, axes = np.linalg.eigh(np.linalg.inv(edge.information)[3:, 3:])
    x_of_map_in_j = stroll.truth.at(stroll.t_mid_ns[[17]])[0].R.T @ [1.0, 0.0, 0.0]
    assert abs(x_of_map_in_j[1]) > 0.4
    assert abs(axes[:, 2] @ x_of_map_in_j) > 0.99
    assert np.sqrt(spread[2]) > 2 * np.sqrt(spread[1])


# -- submaps


def test_a_submap_holds_its_multiframes_in_the_axes_of_the_node(stroll):
    submaps = submaps_of(stroll, [10])

    ends = submaps.around(0, 2)
    alone = submaps.around(0, 0)

    assert 4 * len(alone) < len(ends) < 6 * len(alone)
    p_map = stroll.truth.at(stroll.t_mid_ns[[10]])[0] @ ends.reshape(-1, 3)
    assert p_map[:, 0].max() == pytest.approx(5.0, abs=0.05)
    assert p_map[:, 0].min() == pytest.approx(-4.0, abs=0.05)


def test_lost_multiframes_have_no_segments(stroll):
    lost = NOTHING_LOST.copy()
    lost[[9, 11]] = True
    whole, holed = (
        submaps_of(stroll, [10], skip=skip).around(0, 1) for skip in (NOTHING_LOST, lost)
    )

    assert 0 < len(holed) < 0.5 * len(whole)
    everything = np.ones(21, bool)
    none = submaps_of(stroll, [10], skip=everything).around(0, 5)
    assert none.shape == (0, 2, 3)
    assert median_range_m(none) == 0.0


def test_a_submap_at_the_start_takes_what_there_is(stroll):
    submaps = submaps_of(stroll, [0, 20])

    first, last = submaps.around(0, 3), submaps.around(1, 3)

    assert 0.7 < len(first) / len(last) < 1.4


def test_nodes_keep_a_limited_number_of_segments_spread_over_all(stroll, tmp_path):
    settings = with_tuning(Settings(), "graph.source_segments=500")
    views = NodeRangeImages(1, graph_tuning(settings.graph), scratch=tmp_path)
    views.fill(submaps_of(stroll, [10], settings), [0])

    ends = views.ends(0)

    assert ends.shape == (500, 2, 3)
    assert ends[..., 0].max() > 3.0
    assert ends[..., 0].min() < -3.0
    assert np.count_nonzero(views.nearest_m(0)) > 500
