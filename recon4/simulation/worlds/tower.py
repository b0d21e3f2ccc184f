"""A stairwell tower: the staircase with eight storeys, every floor furnished in another way."""

from __future__ import annotations

import numpy as np

from recon4.simulation.world import World
from recon4.simulation.worlds.staircase import StaircasePlan, stack


def build(variant: int = 0) -> World:
    """A tower of eight storeys; other variants have six to ten."""
    floors = 8 if variant == 0 else int(np.random.default_rng([88, variant]).integers(6, 11))
    return stack("tower", StaircasePlan(floors=floors))
