"""JSON of unknown condition: an object that can be shown and sent on, or an error in words.

Python's parser takes more than JSON: NaN, halves of characters, nesting until the stack ends. Each
of these would break whoever writes the value out again.
"""

from __future__ import annotations

import json
import math
from pathlib import Path
from typing import Any, NoReturn

from recon4.errors import StoreError

MOST_BYTES = 64 << 20
"""Larger files are not read: none of ours comes near."""
MOST_DEPTH = 64
"""Nesting of lists and objects."""


def read_object(path: Path, *, most_bytes: int = MOST_BYTES) -> dict[str, Any]:
    """The object in a JSON file.

    Raises:
        StoreError: If the file cannot be read, is too large, or is no JSON object in UTF-8.
    """
    try:
        with path.open("rb") as file:
            data = file.read(most_bytes + 1)
    except OSError as error:
        raise StoreError(f"{path} cannot be read: {error.strerror or error}") from error
    if len(data) > most_bytes:
        raise StoreError(f"{path}: expected at most {most_bytes} bytes, got more")
    return parse_object(data, str(path))


def parse_object(data: bytes | str, what: str) -> dict[str, Any]:
    """The object that a JSON text holds.

    Args:
        data: The text; bytes are UTF-8.
        what: What it is, for the error.

    Raises:
        StoreError: If it is no JSON object, nests too deep, or holds what JSON has no word for.
    """
    try:
        text = data.decode("utf-8") if isinstance(data, bytes) else data
        found = json.loads(text, parse_constant=_refuse_constant, parse_float=_finite)
        text.encode()
        if "\\u" in text:
            json.dumps(found, ensure_ascii=False).encode()
        if not isinstance(found, dict):
            raise ValueError(f"expected an object, got {type(found).__name__}")
        _refuse_depth(found)
    except RecursionError as error:
        raise StoreError(f"{what} cannot be read: it nests deeper than {MOST_DEPTH}") from error
    except ValueError as error:
        raise StoreError(f"{what} cannot be read: {_short(error)}") from error
    return found


def _short(error: ValueError) -> str:
    if isinstance(error, UnicodeEncodeError):
        half = error.object[error.start]
        return f"expected characters, got half of one, U+{ord(half):04X}"
    return str(error)[:200]


def _refuse_constant(name: str) -> NoReturn:
    raise ValueError(f"expected a number, got {name}")


def _finite(text: str) -> float:
    value = float(text)
    if not math.isfinite(value):
        raise ValueError(f"expected a number a computer can hold, got {text[:40]}")
    return value


def _refuse_depth(found: dict[str, Any]) -> None:
    level: list[Any] = [found]
    for _ in range(MOST_DEPTH):
        level = [
            item
            for value in level
            for item in (value.values() if isinstance(value, dict) else value)
            if isinstance(item, dict | list)
        ]
        if not level:
            return
    raise RecursionError
