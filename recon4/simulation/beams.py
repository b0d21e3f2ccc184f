"""Shots of one beam on a walking body, each from the pose of its own time."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from recon4.geometry.se3 import SE3, Array
from recon4.kernels.carrier import carrier_range
from recon4.kernels.simulation import make_rays
from recon4.simulation.lidar import (
    RESOLUTION_M,
    LidarModel,
    RaysAndHits,
    Surroundings,
    hit_noise,
    measure_hits,
)
from recon4.simulation.person import TORSO_WITH_LOAD_CARRIER
from recon4.simulation.walk import Walk


@dataclass(frozen=True, slots=True, eq=False)
class BeamReturns:
    """What the shots of one beam measured."""

    range_m: NDArray[np.float32]
    """Range [m], NaN = no return, (N,)."""
    intensity: NDArray[np.uint8]
    """0..255, (N,)."""


@dataclass(frozen=True, slots=True, eq=False)
class BeamShots:
    """Shots of one beam."""

    t_s: Array
    """Time of each since the start of the walk [s], (N,)."""
    direction: Array
    """Azimuth, counterclockwise about the sensor's z, and elevation [rad], (N, 2)."""
    T_body_sensor: SE3


def shoot(
    shots: BeamShots,
    *,
    walk: Walk,
    surroundings: Surroundings,
    model: LidarModel,
    rng: np.random.Generator,
) -> BeamReturns:
    """Measure from a walking body.

    Args:
        shots: Time and direction of each shot.
        walk: Motion of the body.
        surroundings: What is hit.
        model: Errors; the carrier is hit if it has one.
        rng: Draws the errors.
    """
    count, direction = len(shots.t_s), shots.direction
    half = 0.5 * model.divergence_rad
    shot = np.zeros((count, 7))
    shot[:, 0], shot[:, 1] = -direction[:, 0], direction[:, 1]
    shot[:, 3:5] = rng.uniform(-half, half, (count, 2))
    R, t = shots.T_body_sensor.R, shots.T_body_sensor.t
    rays = np.empty((2 * count, 6), dtype=np.float32)
    make_rays(walk.state(shots.t_s), R, t, shot, rays)
    person_m: Array = np.full(count, np.inf)
    if model.carrier:
        carrier_range(shot, R, t, TORSO_WITH_LOAD_CARRIER.row(), person_m)
    hits = surroundings.cast(rays, walk, np.tile(shots.t_s, 2))
    blocked = person_m < hits.range_m[:count]
    noise = hit_noise(count, rng)
    found = measure_hits(
        RaysAndHits(rays, hits, blocked, noise), np.ones(count),
        surroundings=surroundings, model=model,
    )  # fmt: skip
    range_m = np.where(found.distance > 0, RESOLUTION_M * found.distance, np.nan)
    near = blocked & (person_m > model.min_range_m)
    range_m[near] = person_m[near] + model.range_sd_m * noise[near, 0]
    found.intensity[near] = 40
    return BeamReturns(range_m.astype(np.float32), found.intensity)
