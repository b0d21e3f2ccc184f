"""Validation of the values of settings."""

from __future__ import annotations

from dataclasses import dataclass, fields
from typing import Any, get_type_hints

from recon4.errors import ConfigError


@dataclass(frozen=True, slots=True)
class ValueRange:
    """What a number may be, and its unit; both stand on the page of the settings."""

    low: float
    high: float
    unit: str = ""
    """As ``m``; empty = a number of something, or a ratio."""

    def __str__(self) -> str:
        return f"{self.low:g} to {self.high:g}"


def range_of(hint: Any) -> ValueRange | None:
    """The range of ``Annotated[float, ValueRange(…)]``."""
    found = [one for one in getattr(hint, "__metadata__", ()) if isinstance(one, ValueRange)]
    return found[0] if found else None


def require(valid: bool, rule: str, value: object) -> None:
    """Raise an error for an invalid value.

    Raises:
        ConfigError: Names the rule and the value.
    """
    if not valid:
        raise ConfigError(f"{rule}, got {value}")


class Checked:
    """Base of the groups of settings: every number is within its range."""

    __slots__ = ()

    def __post_init__(self) -> None:
        hints = get_type_hints(type(self), include_extras=True)
        for field in fields(self):  # type: ignore[arg-type]  # every group is a dataclass
            limits, value = range_of(hints[field.name]), getattr(self, field.name)
            if limits is not None:
                inside = limits.low <= value <= limits.high
                require(inside, f"{field.name} must be {limits}", value)
        self.check()

    def check(self) -> None:
        """Rules about several settings."""
