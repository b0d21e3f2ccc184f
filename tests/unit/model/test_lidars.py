"""The facts of models of LiDAR."""

import pytest

from recon4.model.lidars import CHECKED, LIDARS, lidar_model


def test_facts_are_possible():
    for model in LIDARS.values():
        low, high = model.elevation_deg
        assert -90.0 <= low < high <= 90.0 and 0.0 < model.azimuth_deg <= 360.0
        assert 0.0 < model.min_range_m < model.range_m
        assert 0.0 < model.range_sd_m < 0.1
        assert 0.0 < model.divergence_rad < 0.02


def test_only_models_that_exist_were_compared():
    assert set(CHECKED) <= set(LIDARS)
    assert all(CHECKED.values())


@pytest.mark.parametrize(
    ("model", "step_deg"),
    [("VLP-16", 2.0), ("OS0-32", 90.0 / 31.0), ("XT32", 1.0), ("Mid-360", 0.0), ("generic", 0.0)],
)
def test_rings_are_as_far_apart_as_view_and_beams_say(model, step_deg):
    assert lidar_model(model).ring_step_deg == pytest.approx(step_deg)
