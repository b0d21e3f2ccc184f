"""The class of each point: the one table of their codes, names and defaults.

Codes below 64 are those of LAS 1.4 (ASPRS LAS 1.4 R15, table 17); from 64 on are those that it
leaves to users.
"""

from __future__ import annotations

from dataclasses import dataclass
from enum import IntEnum

import numpy as np
from numpy.typing import NDArray


class PointClass(IntEnum):
    """Class of a point, as it is stored in maps and exports."""

    NEVER_CLASSIFIED = 0
    UNCLASSIFIED = 1
    GROUND = 2
    LOW_VEGETATION = 3
    MEDIUM_VEGETATION = 4
    HIGH_VEGETATION = 5
    BUILDING = 6
    LOW_NOISE = 7
    HIGH_NOISE = 18
    MOVING = 64
    CARRIER = 65
    REFLECTION = 66


@dataclass(frozen=True, slots=True)
class ClassFacts:
    """What people read about a class."""

    title: str
    text: str
    delivered: bool = True
    """Whether it is in the map; others are stored beside it, and can be had."""


CLASSES: dict[PointClass, ClassFacts] = {
    PointClass.NEVER_CLASSIFIED: ClassFacts(
        "never classified", "Every point of a map from before there were classes."
    ),
    PointClass.UNCLASSIFIED: ClassFacts(
        "unclassified", "Furniture, cars that stand, poles, wires, low walls."
    ),
    PointClass.GROUND: ClassFacts(
        "ground", "What was walked on, and what leads on from it: earth, streets, floors, steps."
    ),
    PointClass.LOW_VEGETATION: ClassFacts("low vegetation", "Up to 0.5 m above the ground."),
    PointClass.MEDIUM_VEGETATION: ClassFacts("medium vegetation", "Up to 2 m above the ground."),
    PointClass.HIGH_VEGETATION: ClassFacts("high vegetation", "More than 2 m above the ground."),
    PointClass.BUILDING: ClassFacts(
        "building", "Large flat surfaces that reach 2.2 m: walls, ceilings, facades."
    ),
    PointClass.LOW_NOISE: ClassFacts(
        "low noise", "A stray return beside a surface: a beam met two things.", delivered=False
    ),
    PointClass.HIGH_NOISE: ClassFacts(
        "high noise", "A stray return with too few others around.", delivered=False
    ),
    PointClass.MOVING: ClassFacts(
        "moving", "People and vehicles: other scans see through the place.", delivered=False
    ),
    PointClass.CARRIER: ClassFacts(
        "carrier", "The person with the sensors, and what moves with them.", delivered=False
    ),
    PointClass.REFLECTION: ClassFacts(
        "reflection", "Seen in a mirror or a pane: the room before it.", delivered=False
    ),
}
"""All classes; the documentation's table is made of this one."""


def is_delivered(classification: NDArray[np.uint8]) -> NDArray[np.bool_]:
    """Which points are in the map by default, (N,)."""
    table = np.ones(256, np.bool_)
    table[[code for code, facts in CLASSES.items() if not facts.delivered]] = False
    return np.asarray(table[classification])
