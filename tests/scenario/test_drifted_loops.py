"""Loop closures of a walk whose odometry has drifted."""

import pytest

from tests.benchmarks.drifted_loops import loops_found, prepared


@pytest.mark.study
def test_stairs_are_recognized_after_a_drift_of_a_sixth_of_the_path(tmp_path):
    """The flights look alike from above, and a step changes the view more than on a floor."""
    walk = prepared("staircase/3/44", tmp_path)

    result = loops_found(walk, drift_m=6.0, recognition=True)

    assert result.found == result.revisits == 32
    assert result.false == 0
    assert result.ate_m < 0.05
