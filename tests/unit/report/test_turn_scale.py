"""Turns of the odometry against those of registered pairs."""

import numpy as np
import pytest

from recon4.findings.walk_record import WalkRecord
from recon4.findings.witnesses.turn_scale import turn_scale
from recon4.geometry.se3 import SE3, so3_exp
from recon4.model.pose_graph import EdgeKind, PoseGraph
from recon4.model.trajectory import Trajectory
from tests.said import found_in, texts
from tests.unit.pose_graph.test_uncertainty import edge

NODES = 60


def walk(*, scale: float, turn_rad: float = 0.2) -> tuple[PoseGraph, Trajectory]:
    """A walk that turns left and right, its pairs, and an odometry that turns too far."""
    t_ns = (np.arange(NODES) * 5e8).astype(np.int64)
    yaw = 1.5 * np.sin(turn_rad / 1.5 * np.arange(NODES))
    place = np.cumsum(0.5 * np.stack([np.cos(yaw), np.sin(yaw), np.zeros(NODES)], axis=1), axis=0)
    T = SE3.stack(SE3.from_rpy(0, 0, a, t=p) for a, p in zip(yaw, place, strict=True))
    rng = np.random.default_rng(1)
    pairs = []
    for k in range(0, NODES - 8):
        for apart in (1, 3, 6):
            pair = edge(T, k, k + apart, EdgeKind.NEIGHBOR, np.full(6, 0.01))
            noise = SE3(so3_exp(1e-3 * rng.standard_normal(3)), np.zeros(3))
            # Neighbors share multiframes: they turn as the odometry does.
            of_odometry = SE3.from_rpy(0, 0, scale * (yaw[k + apart] - yaw[k]), t=[0] * 3)
            turned = pair.T_i_j @ noise @ (of_odometry if apart == 1 else SE3.identity())
            pairs.append(pair.evolve(T_i_j=turned))
    wrong = SE3.stack(
        SE3.from_rpy(0, 0, (1.0 + scale) * a, t=p) for a, p in zip(yaw, place, strict=True)
    )
    return PoseGraph(np.arange(NODES), t_ns, T, tuple(pairs)), Trajectory(t_ns, wrong)


@pytest.mark.parametrize("scale", [0.02, -0.01])
def test_a_scale_is_measured_and_announced(scale: float) -> None:
    graph, odometry = walk(scale=scale)

    found = turn_scale(graph, odometry)

    assert found is not None and found.is_off
    assert found.ratio == pytest.approx(scale, abs=0.001)
    said = texts(found_in(WalkRecord(graph=graph, odometry=odometry)))
    assert any(("farther" if scale > 0 else "less far") in text for text in said)


def test_an_odometry_in_order_is_not_contradicted() -> None:
    graph, odometry = walk(scale=0.0)

    found = turn_scale(graph, odometry)

    assert found is not None and not found.is_off
    assert found.sd < 0.001


def test_a_walk_that_hardly_turns_says_nothing() -> None:
    assert turn_scale(*walk(scale=0.02, turn_rad=0.01)) is None
