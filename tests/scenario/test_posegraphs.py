"""The well-known pose graphs, and false loops injected into graphs (real data)."""

from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest

from recon4.pose_graph.solve import initialize, optimize
from recon4.settings import VerificationSettings
from tests.benchmarks.false_loops import ATTACKS, office_graph, score
from tests.g2o_reader import read_g2o

Data = Callable[[str], Path]


@pytest.mark.parametrize(
    ("name", "optimum"),
    [
        ("tinyGrid3D.g2o", 9.3139),
        ("smallGrid3D.g2o", 517.93),
        ("parking-garage.g2o", 0.634),
        ("sphere2500.g2o", 675.70),
        pytest.param("torus3D.g2o", 12117.6, marks=pytest.mark.study),
        ("vertigo-ring/originalDataset/ring.g2o", 5.5816),
    ],
)
def test_the_documented_optimum_is_reached_from_the_edges_alone(
    data: Data, name: str, optimum: float
) -> None:
    graph = read_g2o(data("posegraphs") / name)

    solution = optimize(graph.with_poses(initialize(graph)), kernel="none")

    assert solution.converged
    assert 0.5 * solution.chi2 == pytest.approx(optimum, rel=1e-3)


@pytest.mark.parametrize("attack", ["random", "clusters"])
@pytest.mark.parametrize("seed", [0, pytest.param(2, marks=pytest.mark.study)])
def test_the_ring_with_twenty_false_loops_is_the_ring_without(
    data: Data, attack: str, seed: int
) -> None:
    ring = read_g2o(data("posegraphs") / "vertigo-ring" / "originalDataset" / "ring.g2o")
    optimum = optimize(ring, kernel="none").T_map_body
    attacked = ATTACKS[attack](ring, np.random.default_rng(seed))

    # The odometry of the set has errors of 5 cm per step: its triangles close to decimeters only.
    got = score(attacked, 20, settings=VerificationSettings(limit_m=1.0), truth=optimum)

    assert (got.false_rejected, got.good_lost) == (20, 0)
    assert got.largest_error_m < 0.05


@pytest.mark.parametrize("attack", sorted(ATTACKS))
@pytest.mark.parametrize("noise", [pytest.param(1.0, marks=pytest.mark.study), 2.0])
def test_twenty_false_loops_in_an_office_are_all_found(attack: str, noise: float) -> None:
    clean, truth = office_graph(np.random.default_rng(1), noise=noise)
    attacked = ATTACKS[attack](clean, np.random.default_rng(101))

    got = score(attacked, 20, truth=truth)

    assert got.false_rejected == 20
    assert got.good_lost <= 0.02 * got.good_total
    assert got.largest_error_m < 0.05
