"""The pipeline as published: ICP of sweeps, all sweeps at once, pairs of line scans."""

from dataclasses import replace

import numpy as np
import pytest

from recon4.evaluation.ate import absolute_error, pair_poses
from recon4.geometry.se3 import SE3
from recon4.kernels.pairs import accumulate_pairs
from recon4.model.trajectory import Trajectory
from recon4.profiler.global_icp import preregister, register_all
from recon4.profiler.published_refine import PublishedRefiner
from recon4.profiler.sweep_graph import published_graph
from recon4.profiler.sweeps import Sweep, Sweeps
from recon4.profiler.tuning import LineTuning
from recon4.progress import Silent
from recon4.settings import Settings
from recon4.store.line_store import load_lines

SETTINGS = LineTuning(link_distance_m=0.4)


def room(rng, *, count=4000):
    """Points on the walls and the floor of a room of 6 m x 4 m x 3 m."""
    p = rng.uniform([0, 0, 0], [6.0, 4.0, 3.0], (count, 3))
    side = rng.integers(0, 4, count)
    p[side == 0, 2] = 0.0
    p[side == 1, 0] = 0.0
    p[side == 2, 1] = 0.0
    p[side == 3, 0] = 6.0
    return p


def sweeps_of(T_map_node, rng):
    """Sweeps that all see the same room, each from its own node."""
    p = room(rng)
    sweeps = tuple(Sweep((T.inverse() @ p).astype(np.float32), 100) for T in T_map_node)
    t_ns = np.arange(len(sweeps), dtype=np.int64) * 6_000_000_000
    return Sweeps(t_ns, np.append(t_ns, t_ns[-1] + 1), np.arange(len(sweeps)), sweeps)


@pytest.fixture
def poses():
    return SE3.stack(
        SE3.from_rpy(0.02 * k, -0.01 * k, 0.4 * k, t=[1.0 + 0.5 * k, 1.0, 1.5]) for k in range(4)
    )


def disturbed(T, rng, *, sd_m, sd_rad):
    noise = rng.standard_normal((len(T), 6)) * np.repeat([sd_rad, sd_m], 3)
    noise[0] = 0.0
    return T @ SE3.exp(noise)


def test_all_turns_are_registered_at_once(poses):
    rng = np.random.default_rng(1)
    sweeps = sweeps_of([poses[k] for k in range(4)], rng)
    links = [(i, j, 1.0) for j in range(4) for i in range(j)]

    found = register_all(
        sweeps, disturbed(poses, rng, sd_m=0.08, sd_rad=0.02), links, settings=SETTINGS
    )

    assert np.abs(found.t - poses.t).max() < 2e-3
    assert np.degrees((poses.inverse() @ found).angle()).max() < 0.05


def test_a_turn_without_links_stays(poses):
    sweeps = sweeps_of([poses[k] for k in range(4)], np.random.default_rng(1))
    start = disturbed(poses, np.random.default_rng(2), sd_m=0.05, sd_rad=0.01)

    found = register_all(sweeps, start, [(0, 1, 1.0)], settings=SETTINGS)

    assert np.allclose(found.t[2:], start.t[2:], atol=1e-6)
    assert np.linalg.norm(found.t[1] - start.t[1]) > 0.01


def test_preregistration_reaches_farther_and_moves_later_turns_along(poses):
    rng = np.random.default_rng(3)
    sweeps = sweeps_of([poses[k] for k in range(4)], rng)
    shift = SE3.from_rpy(0.0, 0.0, 0.03, t=[0.35, 0.25, 0.0])
    start = SE3.stack([poses[0], *((poses[k] @ shift) for k in range(1, 4))])
    settings = replace(SETTINGS, slam_rounds=60)

    found = preregister(sweeps, start, settings)

    before = np.linalg.norm(start.t - poses.t, axis=1)
    after = np.linalg.norm(found.t - poses.t, axis=1)
    assert before[1:].min() > 0.4
    assert after.max() < 0.05


def test_turns_are_registered_to_the_one_before_only_on_request(poses):
    rng = np.random.default_rng(3)
    sweeps = sweeps_of([poses[k] for k in range(4)], rng)
    shift = SE3.from_rpy(0.0, 0.0, 0.03, t=[0.35, 0.25, 0.0])
    start = SE3.stack([poses[0], *((poses[k] @ shift) for k in range(1, 4))])
    off_m = []
    for first in (False, True):
        lines = LineTuning(preregister=first, link_distance_m=0.1, slam_rounds=60)
        graph = published_graph(
            sweeps,
            Trajectory(sweeps.t_ns, start),
            np.zeros(4, bool),
            settings=Settings(lines=lines),
            progress=Silent(),
        )
        off_m.append(np.linalg.norm(graph.T_map_body.t - poses.t, axis=1).max())

    assert off_m[1] < 0.05 < off_m[0]


def test_pairs_pull_a_shifted_point_to_its_partner():
    H, g = np.zeros((1, 12, 12)), np.zeros((1, 12))
    rng = np.random.default_rng(4)
    q = rng.uniform(-3.0, 3.0, (50, 3))
    turn = SE3.from_rpy(0.002, -0.001, 0.003, t=[0.02, -0.01, 0.03])
    p = turn @ q

    accumulate_pairs(p, q, np.zeros(50, np.int64), np.zeros(50), np.zeros((1, 3)), H, g)

    step = -np.linalg.solve(H[0, :6, :6], g[0, :6])
    assert np.allclose(step[3:], [-0.02, 0.01, -0.03], atol=3e-4)
    assert np.allclose(step[:3], [-0.002, 0.001, -0.003], atol=1e-4)
    assert not H[0, 6:].any()


def test_published_refinement_brings_turns_together(frames, truth, settings):
    lines = load_lines(frames.folder)
    published = replace(
        settings.lines, method="published", pair_every=2, group_lines=60, outer_rounds=5
    )
    # A drift of 15 cm over the walk.
    s = (truth.t_ns - truth.t_ns[0]) / (truth.t_ns[-1] - truth.t_ns[0])
    drift = np.stack([0.15 * s, -0.1 * s, 0.05 * s], axis=1)
    start = Trajectory(truth.t_ns, SE3(truth.T_a_b.R, truth.T_a_b.t + drift))

    found, rounds = PublishedRefiner(frames, lines, published, Silent()).refine(start)

    before = absolute_error(pair_poses(start, truth)).position_m.rmse
    after = absolute_error(pair_poses(found, truth)).position_m.rmse
    assert before > 0.035
    assert after < 0.8 * before
    assert rounds[-1].mean_m < rounds[0].mean_m
