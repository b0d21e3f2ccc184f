"""Read JSON objects of untrusted files of a project within limits.

Python's parser accepts more than JSON: NaN, lone surrogates, nesting until the stack overflows.
Writing such a value as JSON again would fail, so it is rejected here.
"""

from __future__ import annotations

from pathlib import Path
from typing import Any

from recon4.errors import StoreError
from recon4.locales.coded import CodedText
from recon4.untrusted.bounded import parse_json, read_bytes_limited
from recon4.untrusted.limits import LIMITS


def read_object(path: Path, *, max_bytes: int = LIMITS.json_bytes) -> dict[str, Any]:
    """Read the object in a JSON file.

    Raises:
        StoreError: If the file cannot be read, is too large, or is no JSON object in UTF-8.
    """
    try:
        data = read_bytes_limited(path, max_bytes, failure=StoreError)
    except StoreError as error:
        raise StoreError(f"{path.parent}/{error}") from error
    return parse_object(data, str(path))


def parse_object(data: bytes | str, what: str) -> dict[str, Any]:
    """Parse a JSON object.

    Args:
        data: The text; bytes are UTF-8.
        what: Name of the data for error messages.

    Raises:
        StoreError: If it is not a JSON object, is nested too deeply, or has values that JSON does
            not define.
    """
    found = parse_json(data, f"{what} cannot be read", failure=StoreError, finite=True)
    if not isinstance(found, dict):
        raise StoreError(CodedText("json-not-object", what=what, kind=type(found).__name__))
    return found
