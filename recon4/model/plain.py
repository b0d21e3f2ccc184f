"""Records as plain JSON values; the one place where NaN, which JSON has not, becomes null."""

from __future__ import annotations

import math
from typing import Any

import msgspec


def to_plain(value: object) -> Any:
    """Plain JSON values of records, mappings, sequences, arrays, enums and numbers.

    Fields become keys in the order of the record; numbers that are not finite become null.
    """
    return _without_nan(msgspec.to_builtins(value, str_keys=True, enc_hook=_builtin))


def finite_or_none(number: float, digits: int | None = None) -> float | None:
    """A number, or None if it is not finite.

    Args:
        number: Any float.
        digits: Significant digits to keep; None = all.
    """
    if not math.isfinite(number):
        return None
    return float(number) if digits is None else float(f"{number:.{digits}g}")


def _without_nan(value: Any) -> Any:
    if isinstance(value, dict):
        return {name: _without_nan(item) for name, item in value.items()}
    if isinstance(value, (list, tuple)):
        return [_without_nan(item) for item in value]
    return finite_or_none(value) if isinstance(value, float) else value


def _builtin(value: object) -> object:
    """The built-in value of a type msgspec does not know."""
    if hasattr(value, "tolist"):  # of numpy, which is not imported before it is needed
        return value.tolist()
    if isinstance(value, str):
        return str.__str__(value)
    raise NotImplementedError(f"{type(value).__name__} has no plain JSON value")
