"""Scans of 3DTK: left-handed, in centimeters, each with its pose."""

import numpy as np
import pytest

from recon4.errors import CorruptFile
from recon4.geometry.se3 import SE3
from recon4.progress import Silent
from recon4.recording.formats.poses import read_tum
from recon4.recording.formats.three_dtk import read_pose, read_scan, write_pose, write_scan
from recon4.recording.info.describe import describe
from recon4.recording.ingest import ingest
from recon4.recording.sources import Sources
from recon4.settings import IngestSettings
from recon4.store.frames import FrameStore


def test_a_point_to_the_right_ahead_and_above(tmp_path):
    (tmp_path / "scan000.3d").write_text("100 25 400\n200 50 300\n")

    columns = read_scan(tmp_path / "scan000.3d")

    assert columns["x"] == pytest.approx([4.0, 3.0])
    assert columns["y"] == pytest.approx([-1.0, -2.0])
    assert columns["z"] == pytest.approx([0.25, 0.5])


def test_a_positive_turn_about_their_vertical_axis_is_to_the_right(tmp_path):
    """Left-handed: seen from above, from z (ahead) to x (to the right)."""
    (tmp_path / "scan000.pose").write_text("100 0 200\n0 90 0\n")

    T = read_pose(tmp_path / "scan000.pose")

    assert T @ np.array([[1.0, 0.0, 0.0]]) == pytest.approx(np.array([[2.0, -2.0, 0.0]]))
    assert np.linalg.det(T.R) == pytest.approx(1.0)


def test_what_is_written_is_read_again(tmp_path):
    rng = np.random.default_rng(1)
    p, intensity = rng.uniform(-20.0, 20.0, (500, 3)), rng.integers(0, 255, 500)
    T = SE3.from_rpy(0.3, -0.7, 2.1, t=(1.0, -2.0, 0.5))

    write_scan(tmp_path / "scan000.3d", p, intensity)
    write_pose(tmp_path / "scan000.pose", T)

    columns, found = read_scan(tmp_path / "scan000.3d"), read_pose(tmp_path / "scan000.pose")
    assert np.stack([columns[a] for a in "xyz"], axis=1) == pytest.approx(p, abs=1e-4)
    assert columns["intensity"] == pytest.approx(intensity)
    assert found.matrix() == pytest.approx(T.matrix(), abs=1e-6)
    frame = np.array((tmp_path / "scan000.frames").read_text().split(), float)
    # Column by column, as OpenGL: the translation is the last column but for its end.
    assert frame[12:15] == pytest.approx([200.0, 50.0, 100.0])


@pytest.mark.parametrize("head", ["", "640 x 480\n", "640 480\n"])
def test_the_resolution_in_the_first_line_is_no_point(tmp_path, head):
    (tmp_path / "scan000.3d").write_text(head + "1 2 3\n4 5 6\n")

    assert len(read_scan(tmp_path / "scan000.3d")["x"]) == 2


@pytest.mark.parametrize(
    ("text", "words"),
    [
        ("1 2 3\n4 5\n", "line 2: expected 3 numbers"),
        ("1 2 3\n4 x 5\n", "line 2: expected 3 numbers"),
        ("1 2\n1 2\n", "line 1: expected three to six numbers"),
    ],
)
def test_a_line_that_is_no_point_is_named(tmp_path, text, words):
    (tmp_path / "scan000.3d").write_text(text)

    with pytest.raises(CorruptFile, match=words):
        read_scan(tmp_path / "scan000.3d")


@pytest.mark.parametrize("text", ["1 2 3\n", "1 2 3\n4 5 nan\n", "1 2 3 4 5 6 7"])
def test_a_pose_that_is_none_is_refused(tmp_path, text):
    (tmp_path / "scan000.pose").write_text(text)

    with pytest.raises(CorruptFile, match=r"scan000\.pose"):
        read_pose(tmp_path / "scan000.pose")


def test_a_folder_of_scans_is_read_as_scans_without_motion(tmp_path):
    rng = np.random.default_rng(2)
    (tmp_path / "scans").mkdir()
    for k in range(3):
        path = tmp_path / "scans" / f"scan{k:03d}.3d"
        write_scan(path, rng.uniform(2.0, 9.0, (400, 3)), np.full(400, k))
        write_pose(path.with_suffix(".pose"), SE3.from_rpy(0.0, 0.0, 0.1 * k, t=(k, 0.0, 0.0)))

    text = "\n".join(describe(tmp_path / "scans").lines())
    sources = Sources((tmp_path / "scans",), None)
    ingest(sources, tmp_path / "out", settings=IngestSettings(), progress=Silent())

    store = FrameStore.open(tmp_path / "out")
    assert "3D files" in text
    assert len(store) == 3
    assert all(np.all(frame.dt_ns == 0) for frame in store)
    assert set(store[2].intensity) == {2}
    assert read_tum(tmp_path / "out" / "poses.tum").T_a_b.t[:, 0] == pytest.approx([0.0, 1.0, 2.0])
