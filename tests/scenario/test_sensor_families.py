"""Walks with one sensor of each family, as in docs/studies/sensor-families.md."""

import pytest

from tests.benchmarks.proving_ground import run_walk


@pytest.mark.study
@pytest.mark.parametrize("lidars", ["OS0-32", "XT32", "Mid-360", "Airy", "VLS-128", "XT32+Avia"])
def test_a_walk_with_a_lidar_of_any_make_is_right_to_millimeters(lidars, tmp_path):
    (run,) = run_walk(f"office/1/{lidars}", ["none"], tmp_path, seconds=10.0)

    assert run.lost == 0
    assert run.errors is not None and run.errors.ate_m < 0.015
    assert run.outcome == "right"
