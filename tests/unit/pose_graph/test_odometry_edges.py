"""Odometry edges: their poses and information."""

import numpy as np
import pytest

from recon4.geometry.se3 import SE3
from recon4.model.pose_graph import EdgeKind, Verdict
from recon4.pose_graph.search import odometry_edges
from recon4.pose_graph.tuning import GraphTuning
from tests.unit.pose_graph.graphs import line

ROWS = np.array([2, 7, 12])


def consecutive(T_odom_body, *, lost=(), motion_cov=None, settings=None):
    was_lost = np.isin(np.arange(15), lost)
    cov = np.zeros((15, 6, 6)) if motion_cov is None else np.tile(motion_cov, (15, 1, 1))
    return odometry_edges(
        T_odom_body, ROWS, was_lost, motion_cov=cov, settings=settings or GraphTuning()
    )


def test_odometry_edges_join_consecutive_nodes():
    edges = consecutive(line(3).T_map_body)

    assert [(e.i, e.j) for e in edges] == [(0, 1), (1, 2)]
    assert all(e.kind is EdgeKind.ODOMETRY and e.verdict is Verdict.ACCEPTED for e in edges)
    np.testing.assert_allclose(edges[0].T_i_j.t, [0.5, 0, 0])


def test_an_odometry_edge_is_never_surer_than_its_floor():
    g = GraphTuning()

    sd = np.diag(consecutive(line(3).T_map_body)[0].information) ** -0.5

    np.testing.assert_allclose(sd, np.repeat([g.odometry_sd_rad, g.odometry_sd_m], 3))


def test_deviations_of_the_motion_between_two_nodes_add_up_in_the_axes_of_the_second():
    # A corridor along odom's x leaves 2 cm a frame open; the body looks along odom's y.
    looking_along_y = SE3.from_rpy(0, 0, np.pi / 2, t=[0.0, 0.0, 0.0])
    T = SE3.stack([looking_along_y] * 3)
    cov = np.diag([0, 0, 0, 0.02**2, 0, 0])

    edge = consecutive(T, motion_cov=cov)[0]

    g = GraphTuning()
    sd = np.sqrt(np.diag(np.linalg.inv(edge.information)))
    assert sd[4] == pytest.approx(np.hypot(5 * 0.02, g.odometry_sd_m))
    assert sd[3] == pytest.approx(g.odometry_sd_m)
    assert sd[5] == pytest.approx(g.odometry_sd_m)


def test_an_odometry_edge_is_open_along_what_odometry_left_open():
    askew = SE3.from_rpy(0, 0, 0.5, t=[0.0, 0.0, 0.0])

    edge = consecutive(SE3.stack([askew] * 3), motion_cov=np.diag([0, 0, 0, 0.02**2, 0, 0]))[0]

    _, axes = np.linalg.eigh(np.linalg.inv(edge.information)[3:, 3:])
    assert abs(axes[:, 2] @ askew.R.T @ [1.0, 0.0, 0.0]) > 0.999


def test_an_odometry_edge_counts_the_motion_after_its_first_node_up_to_its_second():
    T, sd_m = line(3).T_map_body, []
    for frame in (ROWS[0], ROWS[0] + 1, ROWS[1], ROWS[1] + 1):
        cov = np.zeros((15, 6, 6))
        cov[frame] = 0.01**2 * np.eye(6)
        edge = odometry_edges(T, ROWS, np.zeros(15, bool), motion_cov=cov, settings=GraphTuning())[
            0
        ]
        sd_m.append(np.sqrt(np.linalg.inv(edge.information)[5, 5]))

    assert [sd > 0.01 for sd in sd_m] == [False, True, True, False]


def test_an_odometry_edge_across_a_lost_multiframe_is_weak():
    whole, broken = consecutive(line(3).T_map_body, lost=[9])

    assert (np.diag(whole.information) > 1e4 * np.diag(broken.information)).all()
    assert np.linalg.eigvalsh(broken.information).min() > 0
