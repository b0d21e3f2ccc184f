"""Reading trajectories and the whole evaluation."""

import json
from pathlib import Path

import numpy as np
import pytest
import trimesh

from recon4.errors import CorruptFile, EmptyRecording, UnknownFormat
from recon4.evaluation.evaluate import MapChunks, at_frames, evaluate
from recon4.evaluation.reference_mesh import TriangleMesh, read_mesh, sample_mesh
from recon4.evaluation.trajectories import find_trajectory
from recon4.geometry.se3 import SE3
from recon4.model.trajectory import Trajectory
from recon4.recording.formats.poses import read_tum
from recon4.store.arrays import save_trajectory

START_NS = 1_750_000_000_123_456_789


def walk(seconds: float, rate_hz: float, *, scale: float = 1.0) -> Trajectory:
    n = round(seconds * rate_hz) + 1
    s = np.arange(n) / rate_hz
    places = scale * np.stack([4 * np.cos(s / 4), 3 * np.sin(s / 4), 1.5 + 0 * s], axis=1)
    twists = np.zeros((n, 6))
    twists[:, 2] = s / 4
    t_ns = START_NS + np.round(s * 1e9).astype(np.int64)
    return Trajectory(t_ns, SE3(SE3.exp(twists).R, places))


def write_tum(path: Path, trajectory: Trajectory) -> None:
    rows = np.concatenate([trajectory.T_a_b.t, trajectory.T_a_b.quat_xyzw()], axis=1)
    lines = [
        f"{t // 10**9}.{t % 10**9:09d} " + " ".join(f"{v:.9f}" for v in row)
        for t, row in zip(trajectory.t_ns.tolist(), rows, strict=True)
    ]
    path.write_text("# t x y z qx qy qz qw\n" + "\n".join(lines) + "\n")


def box() -> TriangleMesh:
    mesh = trimesh.creation.box((12.0, 10.0, 3.0))
    return TriangleMesh(
        np.asarray(mesh.vertices) + np.array([0, 0, 1.5]), np.asarray(mesh.faces, dtype=np.int64)
    )


def test_tum_times_keep_their_nanoseconds(tmp_path: Path) -> None:
    file = tmp_path / "a.tum"
    file.write_text("1750000000.123456789 0 0 0 0 0 0 1\n1750000000.123456790 1 0 0 0 0 0 1\n")

    assert read_tum(file).t_ns.tolist() == [1_750_000_000_123_456_789, 1_750_000_000_123_456_790]


def test_times_before_the_epoch_and_in_powers_are_read(tmp_path: Path) -> None:
    file = tmp_path / "a.tum"
    file.write_text("-1.5 0 0 0 0 0 0 1\n1e1 0 0 0 0 0 0 1\n")

    assert read_tum(file).t_ns.tolist() == [-1_500_000_000, 10_000_000_000]


@pytest.mark.parametrize(
    "line", ["1 2 3", "1 0 0 0 0 0 0 x", "1 0 0 0 0 0 0 nan", "x 0 0 0 0 0 0 1"]
)
def test_a_bad_line_is_refused_by_number(tmp_path: Path, line: str) -> None:
    file = tmp_path / "bad.tum"
    file.write_text(f"# head\n0 0 0 0 0 0 0 1\n{line}\n")

    with pytest.raises(CorruptFile, match=r"bad\.tum: line 3: expected"):
        read_tum(file)


def test_times_that_go_back_are_refused(tmp_path: Path) -> None:
    file = tmp_path / "bad.tum"
    file.write_text("1 0 0 0 0 0 0 1\n1 0 0 0 0 0 0 1\n")

    with pytest.raises(CorruptFile, match="line 2: times must increase"):
        read_tum(file)


def test_an_empty_file_and_another_kind_are_refused(tmp_path: Path) -> None:
    (tmp_path / "empty.tum").write_text("# nothing\n")
    (tmp_path / "a.csv").write_text("")

    with pytest.raises(EmptyRecording):
        find_trajectory(tmp_path / "empty.tum")
    with pytest.raises(UnknownFormat, match=r"a\.csv"):
        find_trajectory(tmp_path / "a.csv")
    with pytest.raises(UnknownFormat, match=tmp_path.name):
        find_trajectory(tmp_path)


def test_a_project_folder_and_an_npz_give_the_same_trajectory(tmp_path: Path) -> None:
    write_tum(tmp_path / "trajectory.tum", walk(5, 10))
    save_trajectory(tmp_path / "t.npz", walk(5, 10))

    from_folder, from_npz = find_trajectory(tmp_path), find_trajectory(tmp_path / "t.npz")

    assert from_folder.t_ns.tolist() == from_npz.t_ns.tolist()
    assert from_folder.T_a_b.t == pytest.approx(from_npz.T_a_b.t, abs=1e-8)


def test_a_dense_trajectory_is_judged_at_one_pose_a_frame() -> None:
    assert len(at_frames(walk(20, 200))) == 201
    assert len(at_frames(walk(20, 10))) == 201
    assert len(at_frames(walk(20, 5))) == 101


def test_a_scaled_walk_has_the_errors_worked_out_on_paper(tmp_path: Path) -> None:
    write_tum(tmp_path / "estimate.tum", walk(120, 10, scale=1.01))
    write_tum(tmp_path / "truth.tum", walk(120, 200))

    found = evaluate(tmp_path / "estimate.tum", truth=tmp_path / "truth.tum")

    assert found.coverage_ratio == 1.0
    assert found.duration_s == pytest.approx(120.0)
    assert found.unaligned.position_m.maximum == pytest.approx(0.01 * np.hypot(4, 1.5), abs=1e-4)
    assert found.first_pose.position_m.maximum == pytest.approx(0.08, abs=1e-3)
    assert found.drift[2].rows[0].translation == pytest.approx(0.01, rel=0.15)


def test_everything_at_once_with_model_and_map(tmp_path: Path) -> None:
    write_tum(tmp_path / "estimate.tum", walk(30, 10))
    write_tum(tmp_path / "truth.tum", walk(30, 200))
    mesh = box()
    trimesh.Trimesh(mesh.vertices_m, mesh.triangles).export(tmp_path / "model.ply")
    points, normals = sample_mesh(mesh, spacing_m=0.03, rng=np.random.default_rng(0))
    points += 0.01 * np.random.default_rng(1).normal(size=(len(points), 1)) * normals
    rough = np.random.default_rng(2).normal(size=(len(points), 1))

    found = evaluate(
        tmp_path / "estimate.tum",
        truth=tmp_path / "truth.tum",
        model=read_mesh(tmp_path / "model.ply"),
        chunks=MapChunks(
            lambda: np.array_split(points, 7),
            lambda: np.array_split(points + 0.01 * rough * normals, 7),
        ),
    )

    assert found.relative is not None
    assert found.measured is not None
    assert found.measured.point_weighted.mean_m > 1.2 * found.relative.point_weighted.mean_m
    assert "as measured" in found.table()
    assert found.relative.alignment == "ICP"
    assert found.relative.point_weighted.mean_m == pytest.approx(0.008, rel=0.15)
    assert found.quality is not None
    assert found.quality.sharpness.plane_thickness_m == pytest.approx(0.01, rel=0.15)
    text = found.table()
    for words in ("SVD-aligned: position [cm]", "V Eq. 3.1", "mean of slices", "points/cm²"):
        assert words in text
    german = found.table("de")
    for words in ("nicht ausgerichtet: Position [cm]", "Mittel der Schnitte", "> 0,5 m"):
        assert words in german
    again = json.loads(json.dumps(found.to_json(), allow_nan=False))
    assert again["relative"]["point_weighted"]["mean_m"] == found.relative.point_weighted.mean_m
    assert "position_errors_m" not in again["aligned"]
