"""Validation of the values of settings."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from functools import cache
from typing import Any, get_type_hints

from recon4.errors import ConfigError
from recon4.locales.coded import CodedText


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

    Args:
        valid: Whether it is valid.
        rule: The message ``setting-RULE``, which quotes the value as ``got``.
        value: What was given.

    Raises:
        ConfigError: Names the rule and the value.
    """
    if not valid:
        raise ConfigError(CodedText(f"setting-{rule}", got=str(value)))


@cache
def _ranges(group: type) -> Mapping[str, ValueRange]:
    """The ranges of the fields that have one; read once, as records are made for every walk."""
    hints = get_type_hints(group, include_extras=True)
    found = {name: range_of(hint) for name, hint in hints.items()}
    return {name: limits for name, limits in found.items() if limits is not None}


class Checked:
    """Base of the groups of settings: every number is within its range."""

    __slots__ = ()

    def __post_init__(self) -> None:
        group: type = type(self)
        for name, limits in _ranges(group).items():
            value = getattr(self, name)
            if not limits.low <= value <= limits.high:
                raise ConfigError(
                    CodedText(
                        "setting-range",
                        setting=name,
                        low=f"{limits.low:g}",
                        high=f"{limits.high:g}",
                        got=value,
                    )
                )
        self.check()

    def check(self) -> None:
        """Rules about several settings."""
