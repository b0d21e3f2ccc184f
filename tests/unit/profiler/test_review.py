"""Review of a walk with a profiler: a node is a whole turn of the head."""

import numpy as np
import pytest

from recon4.geometry.se3 import SE3
from recon4.model.pose_graph import EdgeKind
from recon4.pose_graph.files import load_graph
from recon4.profiler.stage_odometry import run_line_odometry
from recon4.profiler.sweep_graph import build_sweep_graph
from recon4.progress import Silent
from recon4.review.pairs import LAYOUT, align, pair_points
from recon4.review.row_contents import numbers_of, pose_of
from recon4.review.source import Source


@pytest.fixture(scope="module")
def source(frames, settings, tmp_path_factory):
    odometry, graph = tmp_path_factory.mktemp("odometry"), tmp_path_factory.mktemp("graph")
    run_line_odometry(frames, odometry, settings=settings, progress=Silent())
    build_sweep_graph(frames, odometry, graph, settings=settings, progress=Silent())
    made = Source({"frames": frames.folder, "odometry": odometry, "verification": graph})
    made.__dict__["settings"] = settings  # as if the recipes said so
    return made


@pytest.fixture(scope="module")
def edge(source):
    graph = load_graph(source.artifacts["verification"])
    measured = [e for e in graph.edges if e.kind is not EdgeKind.ODOMETRY and e.in_graph]
    return max(measured, key=lambda edge: edge.overlap)


def pair_of(source, edge):
    frames = source.verified.frame_ids
    return int(frames[edge.i]), int(frames[edge.j])


@pytest.mark.study
def test_the_points_of_a_node_are_those_of_its_turn(source, edge):
    data = pair_points(source, pair_of(source, edge), 0)

    counts = LAYOUT.unpack_from(data)[2:]
    xyz = np.frombuffer(data, "<f4", offset=LAYOUT.size).reshape(-1, 3)
    assert len(xyz) == sum(counts)
    for cloud in np.split(xyz, [counts[0]]):
        # One multiframe lasts a tenth of a second, in which the head turns by a few degrees.
        bearing = np.unique(np.degrees(np.arctan2(cloud[:, 1], cloud[:, 0])).round(-1))
        assert len(bearing) > 15


def test_turns_are_registered_from_a_rough_pose(source, edge):
    shifted = edge.T_i_j @ SE3.from_rpy(0.0, 0.0, np.radians(2.0), t=(0.15, -0.1, 0.0))

    found = align(source, pair_of(source, edge), numbers_of(shifted))

    off = edge.T_i_j.inverse() @ pose_of(found.measurement.T_i_j)
    assert found.converged
    assert found.reason == ""
    assert np.linalg.norm(off.t) < 0.03  # few shots: the planes are coarse
    assert off.angle() < np.radians(0.5)
    assert found.measurement.overlap == pytest.approx(edge.overlap, abs=0.05)
