import tracemalloc

import numpy as np

from recon4.geometry.se3 import SE3
from recon4.geometry.tuning import POSE_BLOCK
from recon4.model.pose_graph import Relations
from recon4.pose_graph.relations import squared_residuals


def test_residuals_of_many_edges_are_those_of_each_alone_in_little_memory():
    rng, count = np.random.default_rng(1), 4 * POSE_BLOCK.poses + 1
    T_map_body = SE3.exp(rng.normal(size=(100, 6)))
    root = rng.normal(size=(count, 6, 6))
    of = Relations(
        i=rng.integers(0, 100, count),
        j=rng.integers(0, 100, count),
        T_i_j=SE3.exp(rng.normal(size=(count, 6))),
        information=root @ np.swapaxes(root, 1, 2),
        in_graph=np.ones(count, np.bool_),
        protected=np.zeros(count, np.bool_),
    )

    tracemalloc.start()
    chi2 = squared_residuals(T_map_body, of)
    peak_bytes = tracemalloc.get_traced_memory()[1]
    tracemalloc.stop()

    assert peak_bytes < chi2.nbytes + 700 * POSE_BLOCK.poses
    for row in (0, POSE_BLOCK.poses - 1, POSE_BLOCK.poses, count - 1):
        predicted = T_map_body[of.i[row]].inverse() @ T_map_body[of.j[row]]
        xi = (of.T_i_j[row].inverse() @ predicted).log()
        assert np.isclose(chi2[row], xi @ of.information[row] @ xi, rtol=1e-9)
