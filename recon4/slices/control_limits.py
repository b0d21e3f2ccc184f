"""Limits that the map has to keep at control and check points."""

from __future__ import annotations

from dataclasses import dataclass

from recon4.errors import ConfigError
from recon4.locales.coded import CodedText
from recon4.locales.languages import ENGLISH
from recon4.locales.numbers import localized
from recon4.locales.texts import Texts, texts
from recon4.slices.tuning_files import CONTROL_LIMITS
from recon4.untrusted.bounded import parse_float


@dataclass(frozen=True, slots=True, kw_only=True)
class ControlLimits:
    """Limits of a job; those of V §3.3 unless the job has its own. None = not required."""

    mean_horizontal_m: float | None = 0.14
    """Mean of the horizontal residuals [m]."""
    mean_height_m: float | None = 0.12
    """Mean of ``|dU|`` [m]."""
    max_horizontal_m: float | None = 0.28
    """Largest horizontal residual [m]."""
    max_height_m: float | None = 0.24
    """Largest ``|dU|`` [m]."""
    distances_m: float | None = 0.05
    """Largest error of the distance between two points [m]."""
    survey_sd_m: float = 0.01
    """Standard deviation of a coordinate of the survey, with that of picking the point [m]."""

    def __post_init__(self) -> None:
        for name in self.__dataclass_fields__:
            value = getattr(self, name)
            if value is not None and not 0.0 < value <= CONTROL_LIMITS.most_m:
                raise ConfigError(
                    CodedText("limits-range", name=name, most_m=CONTROL_LIMITS.most_m)
                )

    def text(self, say: Texts) -> str:
        """The limits as one phrase of a language (`control_texts`), in centimeters."""

        def shown(limit_m: float | None) -> str:
            if limit_m is None:
                return say.part("control-limits", "free", {})
            value = localized(f"{100.0 * limit_m:g}", say.language)
            return say.part("control-limits", "cm", {"value": value})

        values = {
            "mean_flat": shown(self.mean_horizontal_m),
            "mean_height": shown(self.mean_height_m),
            "most_flat": shown(self.max_horizontal_m),
            "most_height": shown(self.max_height_m),
            "distances": shown(self.distances_m),
            "sd": shown(self.survey_sd_m),
            "whose": say.part("control-limits", "usual" if self == ControlLimits() else "own", {}),
        }
        return say.part("control-limits", "whole", values)


def control_texts(language: str = ENGLISH) -> Texts:
    """The texts of verdicts on control points in a language."""
    return texts(language, "control")


def parse_limits(text: str) -> ControlLimits:
    """Limits in centimeters as ``14,12,28,24,5``; ``-`` = not required, empty = the usual ones.

    The order is mean horizontal, mean height, largest horizontal, largest height, distances.

    Raises:
        ConfigError: If these are not five limits.
    """
    if not text:
        return ControlLimits()
    try:
        values = [None if cell.strip() == "-" else parse_float(cell) for cell in text.split(",")]
        limits = [None if value is None else value / 100.0 for value in values]
        mean_2d, mean_up, max_2d, max_up, distances = limits
    except ValueError as error:
        raise ConfigError(CodedText("limits-numbers", text=text)) from error
    return ControlLimits(
        mean_horizontal_m=mean_2d,
        mean_height_m=mean_up,
        max_horizontal_m=max_2d,
        max_height_m=max_up,
        distances_m=distances,
    )
