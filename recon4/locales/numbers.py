"""Numbers in texts: rounded as everywhere in recon4, written as in the language."""

from __future__ import annotations

import math
import sys
from collections.abc import Callable, Mapping

from babel import Locale
from babel.numbers import get_decimal_symbol
from fluent.runtime.types import FluentType, fluent_number

_THIN_SPACE = "\u202f"
"""Between the thousands; it does not break."""

_SIZES = (("GB", 1e9, 1), ("MB", 1e6, 0), ("kB", 1e3, 0))
"""Units of what is stored, their bytes, and digits that are shown."""


class ShownText(FluentType, str):
    """A text as it is, however long."""

    def format(self, locale: Locale) -> str:  # type: ignore[override]
        """Itself, so that no limit for the length of strings holds."""
        return self


def as_float(value: float | str) -> float:
    """A number, also one that `shown` has made a text; infinite if it is too large."""
    try:
        return float(value)
    except OverflowError:
        return math.inf


def shown(value: bool | int | float | str) -> FluentType:
    """A value as a text quotes it."""
    if isinstance(value, bool | str):
        return ShownText(value)
    if abs(value) >= 1e12:  # of a damaged file: Fluent has 28 digits, 15 behind the point
        exact = isinstance(value, int) and abs(value) < 1e18
        return ShownText(str(value) if exact else f"{as_float(value):g}")
    return fluent_number(value, useGrouping=False, maximumFractionDigits=sys.float_info.dig)


def number_functions(language: str) -> Mapping[str, Callable[..., str]]:
    """The functions that texts call for numbers, by their name in texts."""
    decimal = get_decimal_symbol(Locale.parse(language))

    def written(text: str) -> str:
        return text.replace(".", decimal)

    def fixed(value: float, *, digits: int, sign: int = 0) -> str:
        return format(as_float(value), f"{'+' if sign else ''}z.{int(digits)}f")

    def length(value: float) -> str:
        value_m = as_float(value)
        if not math.isfinite(value_m):
            return "–"
        return written(f"{100.0 * value_m:z.1f} cm" if value_m < 1.0 else f"{value_m:.2f} m")

    def mount(value: str) -> str:
        return written(mount_text(value))

    def size(number: float) -> str:
        value = as_float(number)
        unit, bytes_, digits = next((one for one in _SIZES if value >= one[1]), _SIZES[-1])
        return f"{written(fixed(value / bytes_, digits=digits))} {unit}"

    def count(number: int) -> str:
        return f"{as_float(number):,.0f}".replace(",", _THIN_SPACE)

    return {
        "LENGTH": length,
        "DECIMAL": lambda value, **how: written(fixed(value, **how)),
        "EXACT": fixed,
        "PERCENT": lambda ratio, digits: written(
            f"{fixed(100.0 * as_float(ratio), digits=digits)} %"
        ),
        "DEGREES": lambda rad, digits: written(
            f"{fixed(math.degrees(as_float(rad)), digits=digits)}°"
        ),
        "SIGNIFICANT": lambda value, digits: written(format(as_float(value), f".{int(digits)}g")),
        "COUNT": count,
        "SIZE": size,
        "MOUNT": mount,
        "BYTE": lambda value: format(int(value), "#04x"),
    }


def mount_text(value: str) -> str:
    """A mount as people write it, with the names that rig files have.

    Args:
        value: Position [m] and, of what can be turned, roll, pitch and yaw [rad]; a text of an
            earlier version stays as it is.
    """
    try:
        numbers = [float(one) for one in value.split()]
    except ValueError:
        return value
    assert len(numbers) in (3, 6), value
    x, y, z = (_rounded(one, 3) for one in numbers[:3])
    turned = (_rounded(math.degrees(one), 1) for one in numbers[3:])
    names = ("roll", "pitch", "yaw")
    angles = " ".join(f"{name} {angle}" for name, angle in zip(names, turned, strict=False))
    return f"xyz {x} {y} {z} m" + f", {angles}°" * bool(angles)


def _rounded(value: float, digits: int) -> str:
    return f"{round(value, digits) + 0.0:.{digits}f}"


def localized(text: str, language: str) -> str:
    """A number as Python writes it, as ``-12.5``, with the decimal sign of a language."""
    return text.replace(".", get_decimal_symbol(Locale.parse(language)))
