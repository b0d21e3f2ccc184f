"""e_r in slices, the alignment to the model, and the floor the sensor sets."""

from pathlib import Path

import numpy as np
import pytest

from recon4.errors import CorruptFile, OutOfRange, RecordingError
from recon4.evaluation.floor import map_onto_model, relative_error_floor
from recon4.evaluation.reference_mesh import (
    TriangleMesh,
    align_to_mesh,
    distance_to,
    read_mesh,
    sample_mesh,
)
from recon4.evaluation.slices import Slice, relative_error, spread_slices
from recon4.geometry.se3 import SE3, Array
from recon4.model.multiframe import Multiframe
from recon4.model.rig import Rig, load_rig
from recon4.model.trajectory import Trajectory

SIZE = np.array([8.0, 6.0, 3.0])


def room() -> TriangleMesh:
    """The inside of an 8 x 6 x 3 m box with its corner at the origin."""
    corners = np.array([[x, y, z] for x in (0, 1) for y in (0, 1) for z in (0, 1)]) * SIZE
    quads = [(0, 1, 3, 2), (4, 5, 7, 6), (0, 1, 5, 4), (2, 3, 7, 6), (0, 2, 6, 4), (1, 3, 7, 5)]
    triangles = [t for a, b, c, d in quads for t in ((a, b, c), (a, c, d))]
    return TriangleMesh(corners, np.array(triangles))


def on_walls(n: int = 60_000, *, noise_m: float = 0.0) -> Array:
    rng = np.random.default_rng(5)
    points, normals = sample_mesh(room(), spacing_m=np.sqrt(180.0 / n), rng=rng)
    return points + noise_m * rng.normal(size=(len(points), 1)) * normals


def height_above_floor(p: Array) -> Array:
    return np.abs(p[:, 2])


def test_a_slice_row_worked_out_on_paper() -> None:
    floor = Slice("x = 0", np.array([1.0, 0, 0]), 0.0, 0.02)
    heights = np.array([0.0, 0.01, 0.03, 0.08, 0.6])
    points = np.stack([np.full(5, 0.005), np.zeros(5), heights], axis=1)
    beside = points + np.array([0.02, 0, 0])

    found = relative_error(
        [points, beside], [floor], T_model_map=SE3.identity(), distance=height_above_floor
    )

    row = found.slices[0]
    assert (row.points, row.outliers) == (4, 1)
    assert row.mean_m == pytest.approx(0.03)
    assert (row.ratio_within_2cm, row.ratio_within_5cm) == pytest.approx((0.5, 0.75))
    assert found.histogram.sum() == 4
    assert found.histogram[30] == 1


def test_point_weighted_and_plain_average_differ_as_they_should() -> None:
    near = Slice("near", np.array([1.0, 0, 0]), 0.0)
    far = Slice("far", np.array([1.0, 0, 0]), 5.0)
    points = np.array([[0.0, 0, 0.01]] * 9 + [[5.0, 0, 0.11]])

    found = relative_error(
        [points], [near, far], T_model_map=SE3.identity(), distance=height_above_floor
    )

    assert found.point_weighted.mean_m == pytest.approx(0.02)
    assert found.plain_mean_m == pytest.approx(0.06)


def test_the_result_does_not_depend_on_how_the_points_are_cut_into_chunks() -> None:
    points, distance = on_walls(noise_m=0.01), distance_to(room())
    slices = spread_slices(room())

    whole = relative_error([points], slices, T_model_map=SE3.identity(), distance=distance)
    parts = relative_error(
        np.array_split(points, 17), slices, T_model_map=SE3.identity(), distance=distance
    )

    assert parts.slices == whole.slices


def test_a_slice_without_points_has_no_figure_and_does_not_spoil_the_others() -> None:
    slices = (Slice("here", np.array([1.0, 0, 0]), 0.0), Slice("empty", np.array([1.0, 0, 0]), 9.0))

    found = relative_error(
        [np.array([[0.0, 0, 0.01]])],
        slices,
        T_model_map=SE3.identity(),
        distance=height_above_floor,
    )

    assert np.isnan(found.slices[1].mean_m)
    assert found.plain_mean_m == pytest.approx(0.01)
    assert found.point_weighted.mean_m == pytest.approx(0.01)


def test_four_horizontal_and_four_vertical_slices_are_spread_through_the_model() -> None:
    slices = spread_slices(room())

    horizontal = [s.offset_m for s in slices if s.normal[2] == 1.0]
    assert horizontal == pytest.approx([0.375, 1.125, 1.875, 2.625])
    assert [s.offset_m for s in slices if s.normal[0] == 1.0] == pytest.approx([2.0, 6.0])
    assert [s.offset_m for s in slices if s.normal[1] == 1.0] == pytest.approx([1.5, 4.5])
    assert all(s.width_m == 0.02 for s in slices)


def test_gaussian_noise_gives_its_mean_absolute_deviation() -> None:
    found = relative_error(
        [on_walls(400_000, noise_m=0.015)],
        spread_slices(room()),
        T_model_map=SE3.identity(),
        distance=distance_to(room()),
    )

    assert found.point_weighted.mean_m == pytest.approx(0.015 * np.sqrt(2 / np.pi), rel=0.05)


def test_icp_brings_a_displaced_map_back_onto_the_model() -> None:
    T_map_model = SE3.from_rpy(0.01, -0.02, 0.03, t=[0.15, -0.1, 0.12])
    p_map = T_map_model @ on_walls(noise_m=0.01)

    T_model_map = align_to_mesh(
        p_map, room(), T_model_map=SE3.identity(), rng=np.random.default_rng(0)
    )

    left = T_model_map @ T_map_model
    assert np.linalg.norm(left.t) < 1e-3
    assert left.angle() < 3e-4


def test_people_in_the_map_do_not_pull_the_alignment() -> None:
    rng = np.random.default_rng(1)
    people = rng.uniform([2, 2, 0.2], [2.6, 2.6, 1.8], (3000, 3))
    p_map = np.concatenate([on_walls(noise_m=0.01), people])

    T_model_map = align_to_mesh(
        p_map, room(), T_model_map=SE3.identity(), rng=np.random.default_rng(0)
    )

    assert np.linalg.norm(T_model_map.t) < 2e-3


def test_a_map_far_from_the_model_keeps_the_start() -> None:
    start = SE3.from_rpy(0, 0, 0, t=[500.0, 0, 0])

    assert map_onto_model([on_walls()], room(), start=start, rng=np.random.default_rng(0)) is start


def test_a_mesh_survives_the_way_through_a_file(tmp_path: Path) -> None:
    import trimesh

    mesh = room()
    trimesh.Trimesh(mesh.vertices_m, mesh.triangles, process=False).export(tmp_path / "m.ply")

    again = read_mesh(tmp_path / "m.ply")

    assert again.corners == pytest.approx(mesh.corners)


def test_the_simulators_model_is_read(tmp_path: Path) -> None:
    from recon4.geometry.mesh import MeshBuilder, write_ply

    builder = MeshBuilder()
    builder.box([0, 0, 0], [1, 2, 3], 0.5)
    write_ply(tmp_path / "model.ply", builder.mesh())

    mesh = read_mesh(tmp_path / "model.ply")

    assert len(mesh.triangles) == 12
    assert mesh.bounds()[1] == pytest.approx([1, 2, 3])


@pytest.mark.parametrize(
    "content", [b"", b"not a mesh", b"ply\nformat ascii 1.0\nelement vertex 1\nend_header\n"]
)
def test_a_file_that_is_no_mesh_is_refused_by_name(tmp_path: Path, content: bytes) -> None:
    (tmp_path / "model.ply").write_bytes(content)

    with pytest.raises(CorruptFile, match=r"model\.ply: .*(a triangle mesh|a PLY header needs)"):
        read_mesh(tmp_path / "model.ply")


def test_a_missing_model_is_refused_by_name(tmp_path: Path) -> None:
    with pytest.raises(RecordingError, match=r"no model file gone\.ply"):
        read_mesh(tmp_path / "gone.ply")


# -- the floor


def seen_from(T_map_body: SE3, k: int, rig: Rig) -> Multiframe:
    """What the first sensor of the rig would measure of the room, with 1 cm noise."""
    p_map = on_walls(40_000, noise_m=0.01)
    p = (T_map_body @ rig.sensors[0].T_body_sensor).inverse() @ p_map
    n = len(p)
    zeros = np.zeros(n, dtype=np.uint8)
    return Multiframe(
        frame_id=k,
        t_ns=k * 100_000_000,
        duration_ns=100_000_000,
        xyz=p.astype(np.float32),
        intensity=np.zeros(n, dtype=np.uint16),
        ring=zeros,
        sensor=zeros,
        echo=zeros,
        dt_ns=np.full(n, 50_000_000, dtype=np.int32),
    )


def walk(n: int = 30) -> Trajectory:
    x = np.linspace(2.0, 6.0, n)
    places = np.stack([x, 3.0 + np.sin(x), np.full(n, 1.5)], axis=1)
    t_ns = np.arange(n, dtype=np.int64) * 100_000_000 + 50_000_000
    return Trajectory(t_ns, SE3(np.broadcast_to(np.eye(3), (n, 3, 3)).copy(), places))


def test_true_poses_are_their_own_floor() -> None:
    rig, truth = load_rig("single-vlp16"), walk()
    frames = [seen_from(truth.T_a_b[k], k, rig) for k in range(len(truth))]

    floor = relative_error_floor(frames[::10], rig, room(), estimate=truth, truth=truth)

    assert floor.ratio == pytest.approx(1.0, abs=1e-6)
    assert floor.frames == 3
    assert floor.true.point_weighted.mean_m == pytest.approx(0.01 * np.sqrt(2 / np.pi), rel=0.1)


def test_wrong_poses_raise_e_r_above_the_floor_but_another_frame_does_not() -> None:
    rig, truth = load_rig("single-vlp16"), walk()
    frames = [seen_from(truth.T_a_b[k], k, rig) for k in range(len(truth))]
    rng = np.random.default_rng(3)
    shaken = SE3(truth.T_a_b.R, truth.T_a_b.t + rng.normal(0, 0.05, (len(truth), 3)))
    elsewhere = SE3.from_rpy(0.1, 0.2, 2.0, t=[30, 40, 5]) @ truth.T_a_b

    bad = relative_error_floor(
        frames[::5], rig, room(), estimate=Trajectory(truth.t_ns, shaken), truth=truth
    )
    same = relative_error_floor(
        frames[::5], rig, room(), estimate=Trajectory(truth.t_ns, elsewhere), truth=truth
    )

    assert bad.ratio > 1.5
    assert same.ratio == pytest.approx(1.0, abs=0.01)


def test_frames_outside_the_trajectories_are_counted_or_refused() -> None:
    rig, truth = load_rig("single-vlp16"), walk()
    frames = [seen_from(truth.T_a_b[k], k, rig) for k in range(len(truth))]

    floor = relative_error_floor(frames[::10], rig, room(), estimate=truth[:15], truth=truth)

    assert (floor.frames, floor.skipped) == (2, 1)
    late = Trajectory(truth.t_ns + 10**12, truth.T_a_b)
    with pytest.raises(OutOfRange, match="none of 3 multiframes"):
        relative_error_floor(frames[::10], rig, room(), estimate=late, truth=late)
