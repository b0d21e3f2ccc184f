"""JSON objects of unknown condition in files of a project: read within limits, or refused in words.

Python's parser takes more than JSON: NaN, lone surrogates, nesting until the stack ends. Each of
these would break whoever writes the value out again.
"""

from __future__ import annotations

from pathlib import Path
from typing import Any

from recon4.bounded import parse_json, read_bytes_limited
from recon4.errors import StoreError

MOST_BYTES = 64 << 20
"""Larger files are not read: none of ours comes near."""


def read_object(path: Path, *, most_bytes: int = MOST_BYTES) -> dict[str, Any]:
    """The object in a JSON file.

    Raises:
        StoreError: If the file cannot be read, is too large, or is no JSON object in UTF-8.
    """
    try:
        data = read_bytes_limited(path, most_bytes, failure=StoreError)
    except StoreError as error:
        raise StoreError(f"{path.parent}/{error}") from error
    return parse_object(data, str(path))


def parse_object(data: bytes | str, what: str) -> dict[str, Any]:
    """The object that a JSON text holds.

    Args:
        data: The text; bytes are UTF-8.
        what: What it is, for the error.

    Raises:
        StoreError: If it is no JSON object, nests too deep, or holds what JSON has no word for.
    """
    found = parse_json(data, f"{what} cannot be read", failure=StoreError, finite=True)
    if not isinstance(found, dict):
        raise StoreError(f"{what} cannot be read: expected an object, got {type(found).__name__}")
    return found
