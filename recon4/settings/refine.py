"""Settings of the stage `refine`."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Annotated

from recon4.settings.require import Checked, ValueRange


@dataclass(frozen=True, slots=True, kw_only=True)
class RefineSettings(Checked):
    """Semi-rigid refinement of every multiframe (requirements A12 L-4; mode ``beyond`` only)."""

    rounds: Annotated[int, ValueRange(0, 20)] = 3
    """Largest number of rounds; each builds the map and corrects all multiframes."""
