"""What the registration of single multiframes leaves unknown, and no edge of a graph shows."""

from dataclasses import replace

import numpy as np
import pytest

from recon4.geometry.se3 import SE3
from recon4.pose_graph.carried_motion import CarriedMotion
from recon4.pose_graph.known_errors import KnownErrors
from recon4.pose_graph.uncertainty import pose_uncertainty
from tests.unit.pose_graph.test_uncertainty import NOT_LONE, SURE, chain


@pytest.mark.parametrize(("observed", "shift_m"), [(True, 0.0), (False, 0.3)])
def test_a_turned_multiframe_stays_unknown_however_well_edges_hold_its_node(
    observed: bool, shift_m: float
) -> None:
    """Five of a quick turn without an IMU lay 10° aside; the edges of their node fitted all."""
    graph = chain(14, *((i, i + 2) for i in range(12)))
    points = np.ones(14, bool)
    points[6] = observed
    motion_cov = SURE.copy()
    motion_cov[6] = np.diag([0.0, 0.0, 0.2, 0.3, 0.0, 0.0]) ** 2  # in axes of the odometry
    turned = SE3.from_rpy(0.0, 0.0, 0.5 * np.pi, t=np.zeros(3)).R @ graph.T_map_body.R
    carried = CarriedMotion(np.zeros((14, 3, 3)), turned, points, motion_cov, NOT_LONE)

    sure = replace(carried, motion_cov=SURE)
    plain, known = (
        pose_uncertainty(graph, known=KnownErrors(carried=one)) for one in (sure, carried)
    )

    assert plain is not None and known is not None
    added = known.cov - plain.cov
    sd = np.sqrt(np.maximum(np.diagonal(added[6]), 0.0))
    np.testing.assert_allclose(sd, [0.0, 0.0, 0.2, 0.0, shift_m, 0.0], atol=0.01)
    assert not added[[5, 7]].any()
    shape = known.shape_cov[6] - plain.shape_cov[6]
    assert np.sqrt(shape[1, 1]) == pytest.approx(shift_m, abs=0.03)
