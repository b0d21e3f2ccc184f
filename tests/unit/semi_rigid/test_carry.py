"""Decisions that hardly move the graph carry the refined trajectory along."""

from dataclasses import replace

import numpy as np
import pytest

from recon4.geometry.se3 import SE3, so3_exp
from recon4.model.figures import RefineFigures
from recon4.model.trajectory import Trajectory
from recon4.progress import Silent
from recon4.semi_rigid.carry import carry
from recon4.semi_rigid.graph_nodes import GraphNodes, Undecided
from recon4.semi_rigid.refine import Refinement, refine
from recon4.semi_rigid.tuning import RefineTuning
from recon4.settings import Settings, override
from recon4.settings.reads import ReadsNothing
from recon4.store.arrays import load_trajectory, save_trajectory
from recon4.store.project import Project
from recon4.store.stage import Input, Stage, StageRunner
from tests.scanned_room import strolling, walk

SETTINGS = replace(override(Settings(), ["graph.workers=1"]), refine=RefineTuning())
LIMIT_M = SETTINGS.refine.converged_step_m


@pytest.fixture(scope="module")
def stroll():
    return walk(strolling, 30)


@pytest.fixture(scope="module")
def odometry(stroll, tmp_path_factory):
    """Odometry that drifts."""
    folder = tmp_path_factory.mktemp("odometry")
    drift = SE3.exp(np.linspace(0, 1, len(stroll.truth))[:, None] * [0, 0, 0.02, 0.1, 0.05, 0.0])
    off = Trajectory(stroll.truth.t_ns, drift @ stroll.truth.T_a_b)
    save_trajectory(folder / "trajectory.npz", off)
    np.savez(folder / "steps.npz", lost=np.zeros(len(stroll), bool))
    return folder


@pytest.fixture(scope="module")
def nodes(stroll):
    t_ns = stroll.t_mid_ns[2::5]
    return Trajectory(t_ns, stroll.truth.at(t_ns))


def refined(stroll, odometry, nodes):
    return refine(stroll, odometry, nodes, settings=SETTINGS, progress=Silent())


@pytest.fixture(scope="module")
def before(stroll, odometry, nodes):
    """The refinement without decisions."""
    return refined(stroll, odometry, nodes)


@pytest.fixture(scope="module")
def saved(tmp_path_factory):
    """Makes the artifact of a refinement."""

    def save(one: Refinement):
        with Project.open(tmp_path_factory.mktemp("carry") / "office") as project:
            runner = StageRunner(project, Settings(), Silent())
            stage = Stage(
                "refine", 1, ReadsNothing, lambda context, one: one.save(context.out), RefineFigures
            )
            return runner.run(stage, one=Input("one", one)).folder

    return save


@pytest.fixture(scope="module")
def undecided(before, nodes, saved):
    return Undecided(nodes, saved(before))


def bent(nodes, by_m=0.0, by_rad=0.0):
    """The nodes with one of them off."""
    R, t = nodes.T_a_b.R.copy(), nodes.T_a_b.t.copy()
    t[3, 1] += by_m
    R[3] = R[3] @ so3_exp(np.array([0.0, 0.0, by_rad]))
    return Trajectory(nodes.t_ns, SE3(R, t))


def carried(undecided, nodes):
    return carry(GraphNodes(nodes, undecided), settings=SETTINGS)


def test_it_ends_within_two_millimeters_of_a_refinement_from_the_graph(
    stroll, odometry, nodes, undecided, before
):
    after = bent(nodes, 0.95 * LIMIT_M, 3e-4)

    found = carried(undecided, after)

    whole = refined(stroll, odometry, after).trajectory
    apart_m = np.linalg.norm(found.trajectory.T_a_b.t - whole.T_a_b.t, axis=1)
    moved_m = np.linalg.norm(found.trajectory.T_a_b.t - before.trajectory.T_a_b.t, axis=1)
    assert apart_m.max() < 0.002
    assert 0.003 < moved_m.max() < LIMIT_M
    assert (moved_m < 1e-9).sum() > 10
    assert found.rounds == ()


def test_nodes_that_move_together_move_the_whole_trajectory(nodes, undecided, before):
    T = SE3.exp(np.array([0.0, 0.0, 2e-4, 0.001, -0.002, 0.0005]))

    found = carried(undecided, Trajectory(nodes.t_ns, T @ nodes.T_a_b)).trajectory

    expected = T @ before.trajectory.T_a_b
    np.testing.assert_allclose(found.T_a_b.t, expected.t, atol=1e-9)
    np.testing.assert_allclose(found.T_a_b.R, expected.R, atol=1e-9)


def test_the_figures_say_how_far_the_nodes_moved(nodes, undecided, tmp_path):
    figures = carried(undecided, bent(nodes, 0.003, 2e-4)).save(tmp_path)

    assert figures.rounds == ()
    assert figures.carried.moved_m == pytest.approx(0.003)
    assert figures.carried.turned_rad == pytest.approx(2e-4, rel=1e-3)
    assert '"carried"' in (tmp_path / "refine.json").read_text()
    load_trajectory(tmp_path / "trajectory.npz")


def test_a_trajectory_that_was_refined_by_itself_has_the_file_it_always_had(before, tmp_path):
    before.save(tmp_path)

    assert "carried" not in (tmp_path / "refine.json").read_text()


@pytest.mark.parametrize(
    ("by_m", "by_rad", "goes"),
    [(0.0039, 0.0, True), (0.0041, 0.0, False), (0.0, 3.9e-4, True), (0.0, 4.1e-4, False)],
)
def test_nodes_that_move_farther_are_refined(by_m, by_rad, goes, nodes, undecided):
    assert (carried(undecided, bent(nodes, by_m, by_rad)) is not None) == goes


@pytest.mark.parametrize("rounds", [0, 1])
def test_a_refinement_that_did_not_converge_is_not_carried(rounds, before, nodes, saved):
    far = tuple(replace_step(one) for one in before.rounds[:rounds])

    found = carried(Undecided(nodes, saved(replace(before, rounds=far))), bent(nodes, 0.001))

    assert found is None


def replace_step(one):
    return type(one)(mean_m=one.mean_m, match_ratio=one.match_ratio, largest_step_m=LIMIT_M)


def test_without_decisions_and_with_other_nodes_everything_is_refined(nodes, undecided):
    fewer = Trajectory(nodes.t_ns[:-1], nodes.T_a_b[:-1])

    assert carry(GraphNodes(nodes), settings=SETTINGS) is None
    assert carried(undecided, fewer) is None
