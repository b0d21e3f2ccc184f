"""Settings of the stage `intensity`."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Annotated, Literal

from recon4.settings.require import Checked, ValueRange


@dataclass(frozen=True, slots=True, kw_only=True)
class IntensitySettings(Checked):
    """Intensity normalization (V §2.10, Eq. 2.17, requirements A9)."""

    method: Literal["surfaces", "bins"] = "surfaces"
    """``surfaces`` compares points of the same surface, so that near floors and far walls are not
    mistaken for an effect of range. ``bins``: as in the text, the plain mean of each bin."""
    min_contrast: Annotated[float, ValueRange(0, 1)] = 0.5
    """With ``bins``: lower limit of a bin's deviation as a fraction of the value expected from its
    mean, so that a bin of one material is not stretched to the contrast of all; 0 = plain
    Eq. 2.17."""
