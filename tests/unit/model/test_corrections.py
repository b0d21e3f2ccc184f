import numpy as np

from recon4.geometry.se3 import SE3
from recon4.model.corrections import apply_corrections
from recon4.model.trajectory import Trajectory

SECOND = 1_000_000_000


def walk(poses: int = 41) -> Trajectory:
    t_s = np.linspace(0.0, 4.0, poses)
    twist = np.array([0.0, 0.05, 0.6, 1.0, 0.0, 0.1])
    return Trajectory((t_s * SECOND).astype(np.int64), SE3.exp(t_s[:, None] * twist))


def test_half_way_between_two_nodes_half_of_the_shift_is_applied() -> None:
    t_ns = np.array([0, 2, 4]) * SECOND
    line = Trajectory(t_ns, SE3(np.tile(np.eye(3), (3, 1, 1)), np.diag([0.0, 2.0, 4.0])[:, :]))
    nodes = np.array([0, 4]) * SECOND
    before = line.at(nodes)
    after = SE3(before.R, before.t + np.array([[0, 0, 0], [0, 1.0, 0]]))

    moved = apply_corrections(line, nodes, T_before=before, T_after=after)

    np.testing.assert_allclose(moved.T_a_b.t - line.T_a_b.t, [[0, 0, 0], [0, 0.5, 0], [0, 1, 0]])


def test_the_nodes_arrive_exactly_where_they_were_moved() -> None:
    dense = walk()
    rows = np.array([0, 13, 25, 40])
    rng = np.random.default_rng(1)
    after = dense.T_a_b[rows] @ SE3.exp(rng.normal(scale=0.05, size=(4, 6)))

    moved = apply_corrections(dense, dense.t_ns[rows], T_before=dense.T_a_b[rows], T_after=after)

    np.testing.assert_allclose(moved.T_a_b[rows].matrix(), after.matrix(), atol=1e-12)


def test_a_rigid_motion_of_all_nodes_moves_everything_rigidly() -> None:
    dense = walk()
    T_c_a = SE3.from_rpy(0.1, -0.4, 2.5, t=[500.0, -80.0, 3.0])
    rows = np.array([5, 20, 30])

    moved = apply_corrections(
        dense, dense.t_ns[rows], T_before=dense.T_a_b[rows], T_after=T_c_a @ dense.T_a_b[rows]
    )

    np.testing.assert_allclose(moved.T_a_b.matrix(), (T_c_a @ dense.T_a_b).matrix(), atol=1e-9)


def test_the_result_does_not_depend_on_where_the_origin_is() -> None:
    dense = walk()
    far = SE3.from_rpy(0.0, 0.0, 1.0, t=[4000.0, 9000.0, 200.0])
    rows = np.array([0, 20, 40])
    turned = dense.T_a_b[rows] @ SE3.exp([[0.0] * 6, [0.0, 0.0, 0.3, 0.1, 0, 0], [0.0] * 6])

    near = apply_corrections(dense, dense.t_ns[rows], T_before=dense.T_a_b[rows], T_after=turned)
    there = apply_corrections(
        Trajectory(dense.t_ns, far @ dense.T_a_b),
        dense.t_ns[rows],
        T_before=far @ dense.T_a_b[rows],
        T_after=far @ turned,
    )

    np.testing.assert_allclose((far @ near.T_a_b).matrix(), there.T_a_b.matrix(), atol=1e-8)


def test_outside_the_nodes_the_nearest_correction_applies() -> None:
    dense = walk()
    rows = np.array([10, 30])
    T_after = SE3(dense.T_a_b[rows].R, dense.T_a_b[rows].t + np.array([[0, 0, 1.0], [0, 0, 2.0]]))

    moved = apply_corrections(dense, dense.t_ns[rows], T_before=dense.T_a_b[rows], T_after=T_after)

    np.testing.assert_allclose(
        moved.T_a_b.t[[0, 40]] - dense.T_a_b.t[[0, 40]], [[0, 0, 1], [0, 0, 2]], atol=1e-12
    )


def test_one_node_moves_all() -> None:
    dense = walk()

    moved = apply_corrections(
        dense,
        dense.t_ns[:1],
        T_before=dense.T_a_b[:1],
        T_after=SE3(np.eye(3)[None], np.ones((1, 3))),
    )

    np.testing.assert_allclose(moved.T_a_b.t, dense.T_a_b.t + 1.0)
