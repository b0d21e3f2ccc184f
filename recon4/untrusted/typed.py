"""Plain values as records, checked by the types of their fields; the one place that makes them.

msgspec 0.22 builds what it knows of a class at its first use, and the process ends with a
segmentation fault if two threads do so at once: here one does, and the others wait.
"""

from __future__ import annotations

import threading
from functools import cache
from typing import Any, TypeVar, overload

import msgspec

_T = TypeVar("_T")
_FIRST_USE = threading.Lock()


@overload
def as_type(value: object, kind: type[_T]) -> _T: ...
@overload
def as_type(value: object, kind: Any) -> Any: ...
def as_type(value: object, kind: Any) -> Any:
    """A value of a type, of plain ones: mappings, sequences, numbers and texts.

    Raises:
        msgspec.ValidationError: If a field is missing or of another type.
    """
    _know(kind)
    return msgspec.convert(value, kind)


@overload
def decoded(data: bytes | str, kind: type[_T]) -> _T: ...
@overload
def decoded(data: bytes | str, kind: Any) -> Any: ...
def decoded(data: bytes | str, kind: Any) -> Any:
    """A value of a type, of JSON.

    Raises:
        msgspec.DecodeError: If it is no JSON.
        msgspec.ValidationError: If a field is missing or of another type.
    """
    return _know(kind).decode(data)


@cache
def _know(kind: Any) -> msgspec.json.Decoder[Any]:
    """What decodes JSON into a type, which then is known to all of msgspec."""
    with _FIRST_USE:
        return msgspec.json.Decoder(kind)
