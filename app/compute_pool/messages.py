"""What goes between the server and a child: a pickle to the child, typed JSON back.

The child may have been taken over by the file it read. So the server unpickles nothing from it:
a result is JSON (or bytes) of the type that the function's annotation declares, of bounded size.
"""

from __future__ import annotations

import json
import pickle  # only what the server sends is unpickled, and only in the child
import struct
from collections.abc import Callable, Iterator
from dataclasses import dataclass
from typing import Any, get_type_hints

from pydantic import BaseModel, TypeAdapter

from app.compute_pool.model import FileAccess
from app.errors import ComputeFailed
from recon4.errors import ConfigError, Recon4Error, WrongSettings

LENGTH = struct.Struct("<Q")
"""Before each message to a child: bytes that follow."""
HEAD = struct.Struct("<cQ")
"""Before each answer: its kind, bytes that follow."""
RESULT, REFUSED, FAILED = b"R", b"E", b"F"
"""A result; an error that says what is wrong with the input; a failure of the program."""
MOST_RESULT_BYTES = 256 << 20
MOST_WORDS = 20_000


@dataclass(frozen=True, slots=True)
class Call:
    """One call of a function of a module."""

    function: Callable[..., Any]
    args: tuple[object, ...]
    kwargs: dict[str, object]


@dataclass(frozen=True, slots=True)
class ChildSetup:
    """What a child receives before its first call."""

    access: FileAccess
    module: str
    """Imported before the child is confined: it may lie where it cannot read afterwards."""


class CallError(BaseModel):
    """An error of the library, or a failure, in words."""

    name: str
    words: str
    problems: dict[str, str] = {}


def encode_request(request: ChildSetup | Call) -> bytes:
    """What the server sends to a child (server's side)."""
    data = pickle.dumps(request)
    return LENGTH.pack(len(data)) + data


def decode_request(data: bytes) -> Any:
    """The `ChildSetup` or `Call` that the server sent (child's side)."""
    return pickle.loads(data)


def encode_result(function: Callable[..., Any], result: object) -> bytes:
    """A result as the bytes of its declared type (child's side)."""
    if isinstance(result, bytes):
        return result
    # `dump_json` writes null for NaN, which no float field accepts.
    plain = _adapter(function).dump_python(result, mode="json")
    return json.dumps(plain, separators=(",", ":")).encode()


def decode_result(function: Callable[..., Any], data: bytes) -> Any:
    """The result that a child sent (server's side).

    Raises:
        ComputeFailed: If it is not of the declared type.
    """
    if declared(function) is bytes:
        return data
    try:
        return _adapter(function).validate_json(data)
    except ValueError as error:
        raise ComputeFailed(f"the helper process answered nonsense: {str(error)[:200]}") from error


def declared(function: Callable[..., Any]) -> Any:
    """The annotated type of a function's result.

    Raises:
        TypeError: If there is no annotation.
    """
    hints = get_type_hints(function)
    if "return" not in hints:
        raise TypeError(f"{function.__qualname__} must declare what it returns")
    return hints["return"]


def encode_error(error: Exception) -> bytes:
    """An error of the library (child's side)."""
    problems = error.problems if isinstance(error, WrongSettings) else {}
    name, words = f"{type(error).__module__}.{type(error).__qualname__}", str(error)[:MOST_WORDS]
    return CallError(name=name, words=words, problems=problems).model_dump_json().encode()


def decode_error(data: bytes) -> Exception:
    """The error that a child sent, as the class of the library it names if there is one."""
    try:
        refusal = CallError.model_validate_json(data)
    except ValueError:
        return ComputeFailed("the helper process answered nonsense")
    if refusal.problems:
        return WrongSettings(refusal.problems)
    for known in _subclasses(Recon4Error):
        if f"{known.__module__}.{known.__qualname__}" == refusal.name:
            return known(refusal.words)
    return ConfigError(refusal.words)


def _adapter(function: Callable[..., Any]) -> TypeAdapter[Any]:
    return TypeAdapter(declared(function))


def _subclasses(base: type[Recon4Error]) -> Iterator[type[Recon4Error]]:
    yield base
    for one in base.__subclasses__():
        yield from _subclasses(one)
