"""Edges, covariances and corrections of 2-D graphs."""

import numpy as np
import pytest

from recon4.geometry.se2 import between, compose, from_se3, inverse, to_se3, transform
from recon4.model.pose_graph import Edge, EdgeKind, PoseGraph, Verdict, known_history
from recon4.pose_graph.solve import optimize
from recon4.slam2d.edges import plane_information, space_information
from recon4.slam2d.keyframes import Keyframes
from recon4.slam2d.prediction import Predicted, VarianceGrowth
from recon4.slam2d.slam import corrected_poses, node_covariances


def graph_of(poses, pairs, *, sd_m=0.1, sd_rad=0.01):
    information = np.diag([sd_rad**-2, sd_m**-2, sd_m**-2])
    edges = tuple(
        Edge(
            i=i,
            j=j,
            T_i_j=to_se3(between(poses[i], poses[j])),
            kind=EdgeKind.ODOMETRY if j == i + 1 else EdgeKind.LOOP,
            information=space_information(information, sd_m=1e-6, sd_rad=1e-6),
            judgments=known_history(Verdict.ACCEPTED),
        )
        for i, j in pairs
    )
    count = len(poses)
    return PoseGraph(np.arange(count), np.arange(count), to_se3(poses), edges)


def test_motions_of_the_plane_are_those_of_space():
    rng = np.random.default_rng(3)
    a, b = rng.uniform(-3.0, 3.0, (2, 20, 3))
    p = rng.uniform(-5.0, 5.0, (20, 2))

    both = to_se3(a) @ to_se3(b)
    p_space = to_se3(a) @ np.concatenate([p, np.zeros((20, 1))], axis=1)

    np.testing.assert_allclose(to_se3(compose(a, b)).R, both.R, atol=1e-12)
    np.testing.assert_allclose(to_se3(compose(a, b)).t, both.t, atol=1e-12)
    np.testing.assert_allclose(to_se3(inverse(a)).t, to_se3(a).inverse().t, atol=1e-12)
    np.testing.assert_allclose(transform(a, p), p_space[:, :2], atol=1e-12)
    np.testing.assert_allclose(from_se3(to_se3(a)), a, atol=1e-12)


def test_an_edge_keeps_its_covariance_in_the_plane():
    covariance = np.array([[4e-4, 1e-4, 0.0], [1e-4, 9e-3, 2e-3], [0.0, 2e-3, 4e-3]])

    found = space_information(np.linalg.inv(covariance), sd_m=0.0, sd_rad=0.0)

    in_plane = np.linalg.inv(plane_information(found))  # nothing else of it is coupled
    np.testing.assert_allclose(in_plane, covariance, rtol=1e-4, atol=1e-9)
    assert np.linalg.eigvalsh(found)[0] > 0.0


def test_the_uncertainty_of_a_chain_grows_with_its_heading():
    # N steps of 1 m straight ahead: the heading error of each step is a lever for those behind.
    poses = np.stack([np.arange(11.0), np.zeros(11), np.zeros(11)], axis=1)

    found = node_covariances(graph_of(poses, [(k, k + 1) for k in range(10)]))

    levers = np.arange(10)
    assert found[10, 0, 0] == pytest.approx(10 * 1e-4, rel=1e-3)
    assert found[10, 1, 1] == pytest.approx(10 * 1e-2, rel=1e-3)
    assert found[10, 2, 2] == pytest.approx(10 * 1e-2 + 1e-4 * (levers**2).sum(), rel=1e-3)
    assert np.abs(found[0]).max() < 1e-8


def test_a_loop_closure_makes_positions_more_certain():
    poses = np.array([[0.0, 0.0, 0.0], [4.0, 0.0, 1.57], [4.0, 4.0, 3.14], [0.0, 4.0, -1.57]])
    chain = [(0, 1), (1, 2), (2, 3)]

    open_end = node_covariances(graph_of(poses, chain))
    closed = node_covariances(graph_of(poses, [*chain, (0, 3)]))

    assert np.trace(closed[3]) < 0.6 * np.trace(open_end[3])
    assert np.trace(closed[2]) < np.trace(open_end[2])


def test_a_solved_graph_stays_in_the_plane():
    poses = np.array([[0.0, 0.0, 0.0], [1.0, 0.0, 0.5], [2.0, 1.0, 1.0], [0.1, 0.2, 1.5]])
    graph = graph_of(poses, [(0, 1), (1, 2), (2, 3), (0, 3)])
    bent = graph.with_poses(to_se3(poses + np.array([[0, 0, 0], [0.2, 0.1, 0.1]] * 2)))

    solved = optimize(bent, kernel="none").T_map_body

    assert np.abs(solved.t[:, 2]).max() < 1e-9
    assert np.abs(solved.R[:, 2, :2]).max() < 1e-9
    np.testing.assert_allclose(from_se3(solved), poses, atol=1e-5)


def test_scans_between_keyframes_follow_the_corrected_ones():
    pose = np.stack([np.arange(9.0), np.zeros(9), np.zeros(9)], axis=1)
    rows = np.array([0, 4, 8])
    keyframes = Keyframes(
        rows=rows,
        t_ns=rows,
        pose=pose[rows],
        information=np.zeros((3, 3, 3)),
        scans=(),
        run=np.zeros(3, np.intp),
        path_m=np.array([0.0, 4.0, 8.0]),
    )
    solved = pose[rows] + np.array([[0.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 1.0, 0.0]])

    found = corrected_poses(pose, keyframes, solved)

    np.testing.assert_allclose(found[:, 1], [0.0, 0.25, 0.5, 0.75, 1.0, 1.0, 1.0, 1.0, 1.0])
    np.testing.assert_allclose(found[:, 0], pose[:, 0], atol=1e-9)


def test_unobserved_motion_becomes_uncertain_with_time_not_with_its_root():
    growth, total = VarianceGrowth(), 0.0
    step = Predicted(np.zeros(3), 0.0, 0.0, drift_m=0.1, drift_rad=0.0)
    for k in range(100):
        growth.add(step)
        if k % 10 == 9:  # a keyframe: the variances of the edges add up
            total += growth.variance[1]
            growth.restart()

    assert np.sqrt(total) == pytest.approx(100 * 0.1)
    growth.observed(position=True)
    growth.add(step)
    assert growth.sd_m == pytest.approx(0.1)
