"""Segments of sensors with many rings, and of those without."""

from dataclasses import replace

import numpy as np
import pytest

from recon4.geometry.se3 import SE3
from recon4.model.lidars import lidar_model
from recon4.model.multiframe import Multiframe
from recon4.model.rig import Rig, Sensor, load_rig
from recon4.registration.segments import sample_segments

POINTS = 20_000


def rig_of(model) -> Rig:
    sensor = Sensor(name="lidar", model=model, T_body_sensor=SE3.identity())
    return replace(load_rig("single-vlp16"), sensors=(sensor,))


def room(model, *, rings=0, azimuth_deg=360.0, seed=3):
    """A frame in a room of 8 x 6 x 3 m: directions at random, or on rings."""
    rng = np.random.default_rng(seed)
    low, high = np.deg2rad(lidar_model(model).elevation_deg)
    ring = rng.integers(0, max(rings, 1), POINTS)
    elevation = low + (high - low) * ring / (rings - 1) if rings else rng.uniform(low, high, POINTS)
    azimuth = np.deg2rad(rng.uniform(-azimuth_deg / 2, azimuth_deg / 2, POINTS))
    flat = np.cos(elevation)
    rays = np.stack([flat * np.cos(azimuth), flat * np.sin(azimuth), np.sin(elevation)], axis=1)
    depth = (np.array([4.0, 3.0, 1.5]) / np.maximum(np.abs(rays), 1e-9)).min(axis=1)
    nothing = np.zeros(POINTS, np.uint8)
    return Multiframe(
        0,
        0,
        100_000_000,
        xyz=(rays * depth[:, None]).astype(np.float32),
        intensity=nothing.astype(np.uint16),
        ring=ring.astype(np.uint8),
        sensor=nothing,
        echo=nothing,
        dt_ns=np.linspace(0, 99_999_999, POINTS).astype(np.int32),
    )


@pytest.mark.parametrize(("model", "azimuth_deg"), [("Mid-360", 360.0), ("Avia", 70.0)])
def test_a_sensor_without_rings_has_segments_in_all_its_field_of_view(model, azimuth_deg):
    frame = room(model, azimuth_deg=azimuth_deg)

    found = sample_segments(frame, rig_of(model))

    low, high = np.deg2rad(lidar_model(model).elevation_deg)
    elevation = np.arcsin(found.a_body[:, 2] / np.linalg.norm(found.a_body, axis=1))
    counts, _ = np.histogram(elevation, 8, (low, high))
    assert len(found) > 1000
    assert counts.min() > 0.5 * counts.mean()
    length = np.linalg.norm(found.a_body - found.b_body, axis=1)
    assert np.median(length / found.range_m) < np.deg2rad(4.0)


def test_segments_do_not_grow_with_the_rings():
    count = {
        rings: len(sample_segments(room(model, rings=rings), rig_of(model)))
        for model, rings in (("VLP-16", 16), ("VLP-32C", 32), ("OS1-64", 64), ("OS1-128", 128))
    }

    assert count[16] < count[32]
    assert count[128] < 1.3 * count[32]
    assert count[64] < 1.3 * count[32]
