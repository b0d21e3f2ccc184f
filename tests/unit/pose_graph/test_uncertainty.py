"""Covariances of a graph's poses against errors drawn at random."""

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from msgspec import structs

from recon4.errors import StoreError
from recon4.evaluation.ate import PosePairs, absolute_error
from recon4.geometry.se3 import SE3, TRANSLATION, Array, so3_log
from recon4.model.pose_graph import Edge, EdgeKind, PoseGraph, Verdict, known_history
from recon4.model.trajectory import Trajectory
from recon4.pose_graph import uncertainty
from recon4.pose_graph.carried_motion import CarriedMotion, load_carried_motion
from recon4.pose_graph.error_model import ErrorModel
from recon4.pose_graph.free_network import aligned_cov
from recon4.pose_graph.known_errors import KnownErrors
from recon4.pose_graph.priors import PositionPriors
from recon4.pose_graph.uncertainty import pose_uncertainty
from recon4.pose_graph.uncertainty_files import (
    load_uncertainty,
    save_uncertainty,
    uncertainty_figures,
    write_covariances,
)

STEP_SD = np.array([1e-3, 1e-3, 2e-3, 0.004, 0.006, 0.005])
EXACT = ErrorModel(
    observed=1.0, weak=0.0, observed_m=1.0, observed_rad=1.0, turn_s=2.0, shift_s=2.0,
    anchor_rad=1e-6, anchor_m=1e-5, anchor_ratio=0.0,
)  # fmt: skip
"""The stated deviations are true, and correlated over 2 s."""
SURE = np.zeros((14, 6, 6))
"""What the filter states of multiframes about which nothing is left to know."""
NOT_LONE = np.full((14, 3, 3), np.nan)


def walk(nodes: int) -> tuple[np.ndarray, SE3]:
    """Times and true poses of a walk around a square, a node each half second."""
    t_ns = (np.arange(nodes) * 5e8).astype(np.int64)
    yaw = np.cumsum(np.where(np.arange(nodes) % 15 == 14, 0.5 * np.pi, 0.0))
    step = 0.6 * np.stack([np.cos(yaw), np.sin(yaw), np.zeros(nodes)], axis=1)
    poses = (
        SE3.from_rpy(0.02, -0.03, angle, t=place)
        for angle, place in zip(yaw, np.cumsum(step, axis=0), strict=True)
    )
    return t_ns, SE3.stack(poses)


def edge(T: SE3, i: int, j: int, kind: EdgeKind, sd: Array) -> Edge:
    return Edge(
        i=i,
        j=j,
        T_i_j=T[i].inverse() @ T[j],
        kind=kind,
        information=np.diag(sd**-2.0),
        judgments=known_history(Verdict.ACCEPTED),
    )


def chain(nodes: int = 60, *loops: tuple[int, int], sd: Array = STEP_SD) -> PoseGraph:
    t_ns, T = walk(nodes)
    edges = [edge(T, k, k + 1, EdgeKind.ODOMETRY, sd) for k in range(nodes - 1)]
    edges += [edge(T, i, j, EdgeKind.LOOP, np.full(6, 0.002)) for i, j in loops]
    return PoseGraph(np.arange(nodes), t_ns, T, tuple(edges))


def drawn(graph: PoseGraph, rng: np.random.Generator, *, tau_s: float) -> SE3:
    """Poses that accumulate errors of the stated deviations, correlated in time."""
    T = graph.T_map_body
    rho = np.exp(-0.5 / tau_s)
    # In axes of the map, as errors of one map are.
    poses, error = [T[0]], rng.standard_normal(6)
    for k in range(len(graph) - 1):
        body = np.kron(np.eye(2), T.R[k + 1].T)
        xi = STEP_SD * (body @ error)
        poses.append(poses[-1] @ (T[k].inverse() @ T[k + 1]) @ SE3.exp(xi))
        error = rho * error + np.sqrt(1.0 - rho**2) * rng.standard_normal(6)
    return SE3.stack(poses)


def nees(graph: PoseGraph, cov: Array, seeds: int = 60) -> float:
    """Mean squared error over the stated covariance and degrees of freedom, of the last pose."""
    found = []
    for seed in range(seeds):
        wrong = drawn(graph, np.random.default_rng(seed), tau_s=2.0)[-1]
        T = graph.T_map_body[-1]
        e = np.concatenate([so3_log(T.R @ wrong.R.T), T.t - wrong.t])
        found.append(e @ np.linalg.solve(cov, e) / 6.0)
    return float(np.mean(found))


def stated(graph: PoseGraph, model: ErrorModel = EXACT) -> uncertainty.PoseUncertainty:
    found = pose_uncertainty(graph, model=model)
    assert found is not None
    return found


def test_errors_of_a_chain_have_the_stated_covariance() -> None:
    graph = chain()

    assert nees(graph, stated(graph).cov[-1]) == pytest.approx(1.0, abs=0.25)


def test_the_shape_is_as_wrong_as_stated_after_the_best_alignment() -> None:
    graph = chain()

    found = stated(graph)

    drawn_m = [
        absolute_error(
            PosePairs(
                graph.t_ns,
                drawn(graph, np.random.default_rng(seed), tau_s=2.0),
                graph.T_map_body,
                coverage_ratio=1.0,
            )
        ).position_m.rmse
        for seed in range(60)
    ]
    assert np.sqrt(np.mean(np.square(drawn_m))) == pytest.approx(found.shape_rms_m, rel=0.2)
    assert found.shape_rms_m < 0.5 * found.rms_m


def test_a_wrong_heading_at_the_start_bends_nothing() -> None:
    graph = chain()
    _, T = walk(60)
    turn = np.zeros((60, 3))
    turn[:, :2] = 0.05 * np.stack([-T.t[:, 1], T.t[:, 0]], axis=1)
    bent = np.zeros((60, 3))
    bent[30:, 0] = 0.05
    error = (turn + np.array([0.3, 0.2, 0.1])).ravel(), bent.ravel()

    of_turn, of_bend = (aligned_cov(np.outer(e, e), graph.T_map_body.t) for e in error)

    np.testing.assert_allclose(of_turn, 0.0, atol=1e-12)
    assert np.trace(of_bend, axis1=1, axis2=2).mean() > 0.01**2


def test_a_straight_walk_has_a_shape_although_a_turn_about_its_axis_moves_nothing() -> None:
    p = np.outer(np.arange(10.0), [1.0, 0.0, 0.0])

    cov = aligned_cov(1e-4 * np.eye(30), p)

    # Of ten positions a shift and two turns are free: 30 - 5 of 30 degrees of freedom are left.
    assert np.trace(cov, axis1=1, axis2=2).sum() == pytest.approx(25e-4)


def test_joined_nodes_state_the_same(monkeypatch: pytest.MonkeyPatch) -> None:
    graph = chain(400)
    joined = stated(graph)
    monkeypatch.setattr(
        uncertainty, "UNCERTAINTY", structs.replace(uncertainty.UNCERTAINTY, max_knots=1000)
    )

    each = stated(graph)

    assert len(joined.t_ns) < len(each.t_ns) == 400
    assert joined.sd_m[-1] == pytest.approx(each.sd_m[-1], rel=0.05)


def test_a_loop_closure_makes_the_end_known() -> None:
    open_end, closed = stated(chain()), stated(chain(60, (0, 59)))

    assert closed.sd_m[-1] < 0.01 < 0.2 * open_end.sd_m[-1]
    assert closed.sd_m.max() > 3.0 * closed.sd_m[-1]  # the middle is known less


def test_many_edges_of_one_place_count_as_few() -> None:
    one = stated(chain(60, (0, 59)))
    many = stated(chain(60, (0, 58), (1, 58), (0, 59), (1, 59)))

    assert many.sd_m[-1] > 0.6 * one.sd_m[-1]


def test_a_direction_that_is_not_observed_is_unknown_for_long() -> None:
    weak = STEP_SD.copy()
    weak[3] = 0.25  # forward, half a meter a second
    graph = chain(60, sd=weak)

    sd_m = stated(graph, ErrorModel()).sd_m

    assert sd_m[-1] > 0.25 * np.sqrt(59)
    assert stated(chain(), ErrorModel()).sd_m[-1] < 0.05 * sd_m[-1]


def test_a_walk_that_was_lost_leaves_finite_numbers() -> None:
    found = stated(chain(60, sd=np.repeat([2.0, 600.0], 3)), ErrorModel())

    assert np.isfinite(found.cov).all()
    assert found.sd_m[-1] > 1.0


def test_positions_keep_the_walk_on_earth() -> None:
    graph = chain()
    every = np.arange(0, 60, 5)
    arm = np.tile([0.1, 0.0, 0.5], (12, 1))
    priors = PositionPriors(every, graph.T_map_body.t[every], arm, np.full((12, 3), 0.05))

    found = pose_uncertainty(graph, positions=priors, model=ErrorModel(gnss_m=0.03))

    assert found is not None and found.on_earth
    assert np.all(found.sd_m > 0.03)
    assert np.all(found.sd_m < 0.08)


def test_fixes_that_turn_the_map_move_its_ends_most() -> None:
    graph = chain()
    arm = np.zeros((60, 3))
    priors = PositionPriors(np.arange(60), graph.T_map_body.t, arm, np.full((60, 3), 0.01))

    straight, turned = (
        pose_uncertainty(graph, positions=priors, model=ErrorModel(gnss_turn_rad=turn))
        for turn in (0.0, 0.02)
    )

    assert straight is not None and turned is not None
    added = turned.cov - straight.cov
    np.testing.assert_allclose(added[:, 2, 2], 4e-4, atol=1e-9)
    far_m = np.linalg.norm((graph.T_map_body.t - graph.T_map_body.t.mean(axis=0))[:, :2], axis=1)
    moved_m = np.sqrt(np.linalg.eigvalsh(added[:, TRANSLATION, TRANSLATION])[:, -1])
    np.testing.assert_allclose(moved_m, 0.02 * far_m, atol=1e-6)
    np.testing.assert_allclose(added[:, 5, :], 0.0, atol=1e-9)  # no height


def test_a_control_point_helps_most_where_least_is_known() -> None:
    graph = chain()
    found = stated(graph)

    figures = uncertainty_figures(found, Trajectory(graph.t_ns, graph.T_map_body))

    assert figures.at_s == pytest.approx(29.5, abs=1.0)
    assert 10.0 < figures.point_from_s <= figures.point_to_s <= 29.5
    assert figures.point_sd_m < 0.6 * figures.largest_sd_m


def test_files_keep_what_is_stated(tmp_path: Path) -> None:
    graph = chain(10)
    found = stated(graph)
    save_uncertainty(tmp_path, found)

    again = load_uncertainty(tmp_path)

    assert again is not None
    np.testing.assert_array_equal(again.cov, found.cov)
    np.testing.assert_array_equal(again.shape_cov, found.shape_cov)
    assert again.helpful == found.helpful
    path = tmp_path / "poses_covariance.csv"
    write_covariances(path, Trajectory(graph.t_ns, graph.T_map_body), again)
    rows = np.loadtxt(path, delimiter=",", skiprows=1)
    assert rows.shape == (10, 1 + 7 + 21)
    np.testing.assert_allclose(rows[:, 8 + 20], found.cov[:, 5, 5], rtol=1e-3)  # cov_z_z, the last


def test_a_file_of_an_earlier_version_states_the_shape_by_its_positions(tmp_path: Path) -> None:
    found = stated(chain(10))
    save_uncertainty(tmp_path, found)
    with np.load(tmp_path / "uncertainty.npz") as file:
        arrays = {name: file[name] for name in file.files if name != "shape_cov"}
    np.savez(tmp_path / "uncertainty.npz", **arrays)

    again = load_uncertainty(tmp_path)

    assert again is not None
    np.testing.assert_array_equal(again.shape_cov, found.cov[:, TRANSLATION, TRANSLATION])
    del arrays["point_ns"]
    np.savez(tmp_path / "uncertainty.npz", **arrays)
    with pytest.raises(StoreError, match="point_ns"):
        load_uncertainty(tmp_path)


def test_a_graph_of_one_node_states_nothing(tmp_path: Path) -> None:
    path = tmp_path / "poses_covariance.csv"
    graph = chain(1)

    write_covariances(path, Trajectory(graph.t_ns, graph.T_map_body), pose_uncertainty(graph))

    assert load_uncertainty(tmp_path) is None
    (header,) = path.read_text().splitlines()
    assert header.startswith("t_ns,x_m")


def test_standard_deviations_of_carried_motions_add_up() -> None:
    along = np.outer([0.0, 0.6, 0.8], [0.0, 0.6, 0.8])
    sd_m = np.array([0.5, 0.01, 0.04, 0.001])
    carried = CarriedMotion(
        sd_m[:, None, None] ** 2 * along,
        np.tile(np.eye(3), (4, 1, 1)),
        sd_m > 0,
        SURE[:4],
        NOT_LONE[:4],
    )

    np.testing.assert_allclose(carried.between(np.array([0, 3]))[0], 0.051**2 * along, atol=1e-15)


def test_a_motion_that_an_accelerometer_carries_is_as_wrong_as_it_states() -> None:
    """Without that the model takes it for the covariance of an observed step, far too large."""
    graph = chain(14)
    R = graph.T_map_body.R
    shift = np.zeros((14, 3, 3))
    shift[6:11, 0, 0] = 0.005**2
    carried = CarriedMotion(shift, R, np.ones(14, bool), SURE, NOT_LONE)
    cov = np.diag(STEP_SD**2)
    with_shift = np.tile(cov, (13, 1, 1))
    with_shift[:, TRANSLATION, TRANSLATION] += carried.between(graph.frame_ids)
    edges = [e.evolve(information=np.linalg.inv(with_shift[e.i])) for e in graph.edges]
    graph = replace(graph, edges=tuple(edges))

    plain = pose_uncertainty(graph)
    known = pose_uncertainty(graph, known=KnownErrors(carried=carried))

    assert plain is not None and known is not None
    grown = np.sqrt(known.cov[10, 3, 3] - known.cov[5, 3, 3])
    assert grown == pytest.approx(5 * 0.005, rel=0.35)
    assert np.sqrt(plain.cov[10, 3, 3] - plain.cov[5, 3, 3]) < 0.3 * grown
    assert known.cov[10, 4, 4] == pytest.approx(plain.cov[10, 4, 4], rel=0.2)


@pytest.mark.parametrize(
    ("observed", "least_m", "most_m"), [(True, 0.0, 0.004), (False, 0.03, 0.3)]
)
def test_a_step_that_points_observe_is_known_however_large_its_covariance(
    observed: bool, least_m: float, most_m: float
) -> None:
    """As through a door without an IMU: 16 cm were stated, 2 cm are usual, and it was right."""
    graph = chain(14, sd=np.repeat([1e-3, 0.02], 3))
    wide = np.diag(np.repeat([1e3, 0.16], 3) ** np.repeat([2.0, -2.0], 3))
    edges = [e.evolve(information=wide) if e.i == 8 else e for e in graph.edges]
    points = np.ones(14, bool)
    points[9] = observed
    carried = CarriedMotion(np.zeros((14, 3, 3)), graph.T_map_body.R, points, SURE, NOT_LONE)

    found = pose_uncertainty(replace(graph, edges=tuple(edges)), known=KnownErrors(carried=carried))

    assert found is not None
    assert least_m <= np.sqrt(found.cov[9, 3, 3] - found.cov[8, 3, 3]) <= most_m


def test_points_observe_what_is_tracked_converged_and_not_weak(tmp_path: Path) -> None:
    columns = {
        name: np.zeros(8, bool) for name in ("lost", "bridged", "stationary")
    } | {"converged": np.ones(8, bool), "weak_sd_m": np.full(8, 0.004)}  # fmt: skip
    columns["weak_sd_m"][[0, 1]] = np.nan, 0.021
    columns["stationary"][1], columns["converged"][3] = True, False
    columns["lost"][4] = columns["bridged"][5] = True
    columns |= {"piece": np.array([0] * 7 + [1]), "weak_motion_sd_m": np.zeros(8)}
    columns |= {"weak_direction": np.zeros((8, 3)), "quat_xyzw": np.tile([0.0, 0, 0, 1], (8, 1))}
    columns |= {"motion_cov": np.tile(np.eye(6), (8, 1, 1))}
    columns |= {"t_mid_ns": 100_000_000 * np.arange(8), "t_m": np.zeros((8, 3))}
    np.savez(tmp_path / "steps.npz", **columns)

    found = load_carried_motion(tmp_path)

    assert found.observed.tolist() == [False, True, True, False, False, False, True, False]
    assert found.observed_between(np.array([0, 2, 3, 6, 7])).tolist() == [True, False, False, False]
    assert found.motion_cov.any(axis=(1, 2)).tolist() == [False, False, *[True] * 5, False]


def test_single_poses_are_as_wrong_as_the_worst_axis_of_the_odometry_states() -> None:
    """Without an IMU the motion within a multiframe is known least along it."""
    ahead = np.array([1e-3, 1e-3, 1e-3, 0.07, 0.02, 0.02])

    even, along = (
        stated(chain(14, sd=sd), ErrorModel()) for sd in (ahead[[0, 1, 2, 4, 4, 4]], ahead)
    )

    sideways_m = np.sqrt([even.cov[1, 4, 4], along.cov[1, 4, 4]])
    np.testing.assert_allclose(sideways_m, [0.0027, 0.0062], rtol=0.1)


def test_the_turn_of_the_first_pose_is_more_wrong_than_that_of_another() -> None:
    model = replace(EXACT, anchor_rad=0.01)
    tilts = []
    for factor in (1.0, 2.0):
        found = pose_uncertainty(chain(6), model=replace(model, first_turn=factor))
        assert found is not None
        tilts.append(found.cov[:, 0, 0])

    assert tilts[1] - tilts[0] == pytest.approx(np.full(6, 3.0 * 0.01**2), rel=1e-6)
