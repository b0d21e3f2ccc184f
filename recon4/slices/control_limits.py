"""Limits that the map has to keep at control and check points."""

from __future__ import annotations

from dataclasses import dataclass

from recon4.errors import ConfigError
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
                    f"{name}: expected more than 0 and at most {CONTROL_LIMITS.most_m:g} m"
                )

    @property
    def text(self) -> str:
        """The limits as one phrase, in centimeters."""
        whose = "usual limits" if self == ControlLimits() else "limits of this job"
        return (
            f"mean {_cm(self.mean_horizontal_m)} horizontal, {_cm(self.mean_height_m)} height; "
            f"largest {_cm(self.max_horizontal_m)} horizontal, {_cm(self.max_height_m)} height; "
            f"distances {_cm(self.distances_m)}; σ of survey and picking {_cm(self.survey_sd_m)} "
            f"({whose})"
        )


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
        raise ConfigError(f"limits: expected five numbers in cm or -, got {text!r}") from error
    return ControlLimits(
        mean_horizontal_m=mean_2d,
        mean_height_m=mean_up,
        max_horizontal_m=max_2d,
        max_height_m=max_up,
        distances_m=distances,
    )


def _cm(limit_m: float | None) -> str:
    return "not required" if limit_m is None else f"{100.0 * limit_m:g} cm"
