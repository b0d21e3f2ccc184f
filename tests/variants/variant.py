"""A drawn recording, with what must come of it."""

from __future__ import annotations

from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import numpy as np

from recon4.model.rig import Rig


@dataclass(slots=True)
class Variant:
    """A recording and what is known of it."""

    kind: str
    """Kind of the recording."""
    path: Path = Path()
    traits: list[str] = field(default_factory=list)
    """What was drawn, in words."""
    rig: Rig | None = None
    imu: Path | None = None
    gnss: Path | None = None
    offset_ns: int = 0
    """Clock of the stamps minus UTC [ns]."""
    points: int = 0
    """Points, or scans of a 2-D laser, that are sound and must be used; 0 = not counted."""
    timed: bool = False
    """Whether each point has a time of its own, which must be used."""
    samples: int = 0
    """IMU samples that are sound and must be used; 0 = none, or they need not be."""
    fixes: int = 0
    """Positions that are sound and must be used; 0 = none, or they need not be."""
    refusal: str = ""
    """Why the recording may be refused; empty = it must be read."""
    remedies: tuple[str, ...] = ()
    """Words that a refusal must contain: what to do."""
    must_say: list[str] = field(default_factory=list)
    """Words that must be among what is said, if the recording is mapped."""
    damaged: bool = False
    """Whether something must be said, however much is left."""
    exact: bool = True
    """Whether the trajectory must be right: nothing that it needs is missing."""

    def say(self, trait: str) -> None:
        """Add a trait."""
        self.traits.append(trait)


class Draw:
    """Random choices, the same for the same seed."""

    def __init__(self, seed: int) -> None:
        self.rng = np.random.default_rng([27, seed])

    def one(self, *choices: Any) -> Any:
        """One of several."""
        return choices[int(self.rng.integers(len(choices)))]

    def chance(self, probability: float) -> bool:
        """Whether something happens."""
        return bool(self.rng.random() < probability)

    def rows(self, count: int, number: int) -> list[int]:
        """Some of ``count`` rows, in order."""
        return sorted(self.rng.choice(count, min(number, count), replace=False).tolist())
