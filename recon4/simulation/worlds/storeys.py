"""Storeys that look alike: the staircase with the same hall, furniture and signs on every floor.

Only the height tells two floors apart: a loop closure between them is false.
"""

from __future__ import annotations

import numpy as np

from recon4.simulation.world import World
from recon4.simulation.worlds.staircase import StaircasePlan, stack


def build(variant: int = 0) -> World:
    """A staircase of four storeys; other variants have three to six."""
    floors = 4 if variant == 0 else int(np.random.default_rng([33, variant]).integers(3, 7))
    return stack("storeys", StaircasePlan(floors=floors, alike=True))
