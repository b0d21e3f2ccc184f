"""Errors against reference relations."""

import numpy as np
import pytest

from recon4.errors import ConfigError, CorruptFile, EmptyRecording
from recon4.evaluation.relations import read_relations, relation_errors
from recon4.geometry.se2 import between, compose, to_se3
from recon4.model.trajectory import Trajectory


def walk(poses):
    return Trajectory(np.arange(len(poses)) * 1_000_000_000, to_se3(poses))


TRUE = np.array([[0.0, 0.0, 0.0], [1.0, 0.2, 0.3], [2.0, -0.1, 0.9], [2.5, 1.0, 2.0]])


def write(path, pairs, extra=""):
    lines = []
    for i, j in pairs:
        x, y, yaw = between(TRUE[i], TRUE[j])
        lines.append(f"{i}.0 {j}.0 {x} {y} 0 0 0 {yaw}\n")
    path.write_text("".join(lines) + extra, "ascii")
    return path


def test_the_true_trajectory_has_no_error_wherever_it_begins(tmp_path):
    reference = read_relations(write(tmp_path / "a.relations", [(0, 1), (0, 3), (1, 2)]))
    moved = compose(np.array([5.0, -3.0, 1.2]), TRUE)

    found = relation_errors(walk(moved), reference)

    assert found.relations == 3
    assert found.translation_largest_m == pytest.approx(0.0, abs=1e-9)
    assert found.rotation_largest_rad == pytest.approx(0.0, abs=1e-7)


def test_an_error_of_one_pose_is_measured_in_its_relations_only(tmp_path):
    reference = read_relations(write(tmp_path / "a.relations", [(0, 1), (0, 2)]))
    wrong = TRUE.copy()
    wrong[2] = compose(TRUE[2], np.array([0.03, 0.04, 0.1]))

    found = relation_errors(walk(wrong), reference)

    assert found.translation_mean_m == pytest.approx(0.025)
    assert found.translation_largest_m == pytest.approx(0.05)
    assert found.rotation_mean_rad == pytest.approx(0.05)


def test_relations_outside_of_the_trajectory_are_counted(tmp_path):
    reference = read_relations(write(tmp_path / "a.relations", [(0, 1), (2, 3)]))

    found = relation_errors(walk(TRUE[:2]), reference)

    assert (found.relations, found.outside) == (1, 1)
    with pytest.raises(ConfigError, match="covers none of the 2 relations"):
        relation_errors(walk(TRUE[:1]), reference)


def test_damaged_files_are_refused_with_the_line(tmp_path):
    with pytest.raises(CorruptFile, match="line 2: expected 8 finite numbers"):
        read_relations(write(tmp_path / "a.relations", [(0, 1)], "1 2 3\n"))
    with pytest.raises(CorruptFile, match="line 2"):
        read_relations(write(tmp_path / "b.relations", [(0, 1)], "1 2 3 4 5 6 7 x\n"))
    (tmp_path / "c.relations").write_text("# nothing\n", "ascii")
    with pytest.raises(EmptyRecording, match="no relation"):
        read_relations(tmp_path / "c.relations")
