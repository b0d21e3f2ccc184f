"""Runs of the proving ground with sensors of all families: world, sensors and error are drawn."""

from __future__ import annotations

from collections.abc import Sequence
from functools import cache

import numpy as np

from recon4.model.rig import Rig, load_rig
from recon4.simulation.families.families import family_of, pattern_of
from recon4.simulation.families.velodyne import VELODYNES
from recon4.simulation.setup import rig_of_lidars
from recon4.simulation.worlds import build_world

WORLDS = (
    "corridor:5", "garage:2", "plaza:6", "storeys:3", "forest:4", "office", "staircase", "street",
    "field", "rooms:5", "rooms:6", "hall",
)  # fmt: skip
SENSORS = (
    "OS0-32", "OS1-64", "XT32", "JT128", "Mid-360", "Airy", "Helios 32", "VLP-32C", "HDL-32E",
    "Mid-360+Mid-360", "JT128+Avia", "XT32+Avia", "OS0-32+VLP-16",
)  # fmt: skip
"""One or two LiDARs, as ``recon4 simulate --lidar`` takes them."""
ONLY_OUTDOORS = {"lever-arm", "gnss-clock", "no-gnss", "vehicles"}


@cache
def is_outdoors(world: str) -> bool:
    """Whether GNSS is received in a world."""
    return build_world(world).outdoors


def rig_of(walk: str) -> Rig:
    """The rig of ``WORLD/SEED`` (4RECON) or ``WORLD/SEED/LIDAR[+LIDAR]``."""
    lidars = walk.split("/")[2:]
    return rig_of_lidars(lidars[0].split("+")) if lidars else load_rig("4recon")


def applies(degradation: str, *, outdoors: bool, rig: Rig) -> bool:
    """Whether a degradation changes anything in a world, and is possible on a rig."""
    last = rig.sensors[-1].model
    impossible = {
        "swap-lidars": len(rig.sensors) < 2,
        "wrong-model": family_of(last) is not VELODYNES or last == "HDL-32E",
        "dead-beams": min(pattern_of(sensor.model).lasers for sensor in rig.sensors) < 16,
    }
    if any(impossible.get(name, False) for name in degradation.split("+")):
        return False
    return outdoors or degradation not in ONLY_OUTDOORS


def drawn_runs(count: int, seed: int, degradations: Sequence[str]) -> list[tuple[str, str]]:
    """Walks with the degradation of each; the sensors come round, the rest is drawn.

    Args:
        count: Number of runs.
        seed: Draws them.
        degradations: To draw from; one that does not apply is drawn again.
    """
    rng, runs = np.random.default_rng(seed), []
    for k in range(count):
        world = str(rng.choice(WORLDS))
        walk = f"{world}/{rng.integers(1000)}/{SENSORS[k % len(SENSORS)]}"
        fitting = [
            d for d in degradations if applies(d, outdoors=is_outdoors(world), rig=rig_of(walk))
        ]
        runs.append((walk, str(rng.choice(fitting))))
    return runs
