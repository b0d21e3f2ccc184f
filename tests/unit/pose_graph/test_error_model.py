"""What a solved graph shows of the errors of its edges."""

import numpy as np
import pytest

from recon4.geometry.se3 import SE3, Array
from recon4.model.pose_graph import Edge, EdgeKind, PoseGraph
from recon4.pose_graph.carried_motion import CarriedMotion
from recon4.pose_graph.error_model import CALIBRATED, agreement
from recon4.pose_graph.uncertainty import pose_uncertainty
from tests.unit.pose_graph.test_uncertainty import STEP_SD, edge, walk

NODES = 60
PAIRS = [(k, k + 4) for k in range(0, 56, 4)]


def solved(*, pair_m: float, step_m: float = 0.0, sd: Array = STEP_SD) -> PoseGraph:
    """A graph whose registered edges, and one odometry edge, lie beside its poses."""
    t_ns, T = walk(NODES)
    edges = [edge(T, k, k + 1, EdgeKind.ODOMETRY, sd) for k in range(NODES - 1)]
    edges[30] = beside(edges[30], step_m)
    pairs = [edge(T, i, j, EdgeKind.NEIGHBOR, np.full(6, 0.01)) for i, j in PAIRS]
    edges += [beside(pair, pair_m) for pair in pairs]
    return PoseGraph(np.arange(NODES), t_ns, T, tuple(edges))


def beside(wrong: Edge, size_m: float) -> Edge:
    return wrong.evolve(T_i_j=wrong.T_i_j @ SE3.exp([0.5 * size_m, 0, 0, 0, size_m, 0]))


def largest_m(graph: PoseGraph) -> float:
    found = pose_uncertainty(graph)
    assert found is not None
    return float(found.sd_m.max())


def test_errors_are_in_proportion_to_the_residuals_of_pairs() -> None:
    small, large = (agreement(solved(pair_m=m), CALIBRATED).ratio for m in (0.002, 0.02))

    assert large == pytest.approx(10.0 * small, rel=1e-3)
    assert small[1] == pytest.approx(0.002 / CALIBRATED.usual_m, rel=0.02)
    assert largest_m(solved(pair_m=0.02)) > 3.0 * largest_m(solved(pair_m=0.002))


@pytest.mark.parametrize(("pairs", "part"), [(0, 0.0), (2, 0.25), (6, 0.75), (8, 1.0), (12, 1.0)])
def test_few_pairs_show_a_part_of_the_errors(pairs: int, part: float) -> None:
    """Without a step: one pair more or less does not change what is stated by a factor."""
    graph = solved(pair_m=0.02)
    few = graph.with_edges(graph.edges[: NODES - 1 + pairs])

    whole = agreement(graph, CALIBRATED).ratio
    assert agreement(few, CALIBRATED).ratio == pytest.approx(whole**part)


def test_where_the_graph_moves_the_odometry_it_is_wrong() -> None:
    found = agreement(solved(pair_m=0.002, step_m=0.05), CALIBRATED).moved
    size_m = np.sqrt(np.trace(found[:, 3:, 3:], axis1=1, axis2=2))

    assert 0.009 < size_m[30] < 0.05
    assert size_m[25] == pytest.approx(size_m[35], rel=1e-6)
    assert size_m[5] < 1e-9
    assert largest_m(solved(pair_m=0.002, step_m=0.05)) > 2.0 * largest_m(solved(pair_m=0.002))


def test_where_tracking_was_lost_the_graph_may_move_the_odometry() -> None:
    unsure = solved(pair_m=0.002, step_m=0.05, sd=np.full(6, 0.2))

    assert agreement(unsure, CALIBRATED).moved.max() < 1e-12


@pytest.mark.parametrize(("stated_m", "left"), [(0.0, 1.0), (0.03, 0.64), (0.06, 0.0)])
def test_a_motion_that_is_stated_to_be_unsure_may_be_moved_by_as_much(
    stated_m: float, left: float
) -> None:
    graph = solved(pair_m=0.002, step_m=0.05)
    plain = agreement(graph, CALIBRATED).moved[30]
    along = np.linalg.eigh(plain[3:, 3:])[1][:, -1]
    cov = np.tile(stated_m**2 * np.outer(along, along), (NODES, 1, 1))
    observed, sure = np.ones(NODES, bool), np.zeros((NODES, 6, 6))
    alone = np.full((NODES, 3, 3), np.nan)
    carried = CarriedMotion(cov, graph.T_map_body.R, observed, sure, alone)

    known = agreement(graph, CALIBRATED, carried=carried).moved[30]

    part = np.trace(known[3:, 3:]) / np.trace(plain[3:, 3:])
    assert part == pytest.approx(left, abs=0.1)
    np.testing.assert_array_equal(known[:3, :3], plain[:3, :3])
