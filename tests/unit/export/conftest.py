"""A small map with the nodes of its pose graph."""

import numpy as np
import pytest

from recon4.export.node_scans import ScanPoses
from recon4.mapping.tiles import TileSet
from tests.room_walks import room_walk
from tests.unit.export.test_point_clouds import make


@pytest.fixture(scope="session")
def made(tmp_path_factory):
    """A map, and every third of its multiframes as a node."""
    folder = tmp_path_factory.mktemp("scans") / "map"
    walk = room_walk(frames=10)
    make(folder, walk=walk)
    nodes = np.arange(1, 10, 3)
    frame_ids = np.array([frame.frame_id for frame in walk.frames])[nodes]
    t_ns = np.array([frame.t_mid_ns for frame in walk.frames])[nodes]
    return TileSet.open(folder), ScanPoses(frame_ids, t_ns, walk.trajectory.at(t_ns), "a note")
