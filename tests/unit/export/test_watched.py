"""Exports while they are watched: reading a file back is progress, too."""

import numpy as np
import pytest

from recon4.export.map_files import SCANS, cloud_writer
from recon4.export.points import OutputCrs, PointSource
from recon4.export.selection import PointSelection
from tests.unit.delivery.test_delivery_watched import Watched

SHIFT_M = np.array([430_000.0, 5_480_000.0, 250.0])
IN_A_GRID = OutputCrs("EPSG:32633", lambda xyz: xyz + SHIFT_M)
PART = PointSelection(box_m=(430_000.0, 5_480_000.0, 250.0, 430_002.0, 5_480_002.0, 260.0))


@pytest.mark.parametrize("name", ["a.laz", "a.copc.laz", "a.ply", "a.pcd", "a.xyz"])
def test_points_that_are_counted_and_compared_are_progress(made, tmp_path, name):
    watched = Watched()

    count = cloud_writer(tmp_path / name)(
        made[0], tmp_path / name, IN_A_GRID, selection=PART, progress=watched
    )

    assert 0 < watched.units("points")[1] == count < len(made[0])
    expected, compared = watched.units("compare")
    head = 2_000 if name.endswith(("ply", "pcd", "xyz")) else 0  # these count bytes
    assert expected - head <= compared <= expected > 0


@pytest.mark.parametrize("ending", SCANS)
def test_scans_that_are_compared_are_progress(made, tmp_path, ending):
    tiles, nodes = made
    watched = Watched()

    source = PointSource.of(tiles, IN_A_GRID)
    SCANS[ending](source, tmp_path / f"a{ending}", nodes, progress=watched)

    assert watched.units("compare") == (len(tiles), len(tiles))
