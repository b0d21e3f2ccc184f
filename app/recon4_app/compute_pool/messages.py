"""Messages between the server and a child: a pickle to the child, typed JSON back.

The child may have been taken over by the file it read, so the server unpickles nothing from it: a
result is JSON (or bytes) of the type that the function's annotation declares, of bounded size.
"""

from __future__ import annotations

import json
import pickle  # only what the server sends is unpickled, and only in the child
import struct
from collections.abc import Callable, Iterator
from dataclasses import dataclass
from pathlib import Path
from typing import Any, TypeVar, get_type_hints

import msgspec
from pydantic import BaseModel, TypeAdapter

from recon4.errors import ConfigError, Recon4Error, UnknownFormat, WrongSettings
from recon4.locales.coded import CodedText, StoredText, flat_values, stored_text
from recon4.untrusted.names import is_unnameable
from recon4.untrusted.typed import decoded
from recon4_app.compute_pool.model import FileAccess
from recon4_app.compute_pool.tuning import POOL_MESSAGES
from recon4_app.errors import ComputeFailed

R = TypeVar("R")

LENGTH = struct.Struct("<Q")
"""Header of each message to a child: number of bytes that follow."""
HEAD = struct.Struct("<cQ")
"""Header of each response: its kind, number of bytes that follow."""
RESULT, REFUSED, FAILED = b"R", b"E", b"F"
"""A result; an error about the input; a failure of the program."""


@dataclass(frozen=True, slots=True)
class Call:
    """One call of a function of a module."""

    function: Callable[..., Any]
    args: tuple[object, ...]
    kwargs: dict[str, object]


@dataclass(frozen=True, slots=True)
class ChildSetup:
    """The first message to a child."""

    access: FileAccess
    module: str
    """Imported before the child is confined, because it may not be readable afterwards."""


class CallError(BaseModel):
    """An error of the library."""

    name: str
    message: str
    code: str = ""
    """Of the message; empty = it has none."""
    values: dict[str, bool | int | float | str] = {}
    problems: dict[str, StoredText] = {}
    candidates: list[str] = []


def encode_request(request: ChildSetup | Call) -> bytes:
    """Encode a message to a child (server's side)."""
    data = pickle.dumps(request)
    return LENGTH.pack(len(data)) + data


def decode_request(data: bytes) -> Any:
    """Decode a `ChildSetup` or `Call` of the server (child's side)."""
    return pickle.loads(data)


def encode_result(function: Callable[..., Any], result: object) -> bytes:
    """Encode a result as its declared type (child's side)."""
    if isinstance(result, bytes):
        return result
    # `dump_json` writes null for NaN, which no float field accepts.
    plain = _adapter(function).dump_python(result, mode="json")
    return json.dumps(plain, separators=(",", ":")).encode()


def decode_result(function: Callable[..., Any], data: bytes) -> Any:
    """Decode the result of a child (server's side).

    Raises:
        ComputeFailed: If it is not of the declared type.
    """
    if declared(function) is bytes:
        return data
    try:
        return _adapter(function).validate_json(data)
    except ValueError as error:
        raise ComputeFailed(CodedText("helper-bad-result", detail=str(error)[:200])) from error


def decode_record(data: bytes, kind: type[R]) -> R:
    """Decode a record of msgspec, which a function hands back as JSON: pydantic knows none.

    Raises:
        ComputeFailed: If it is not of this type.
    """
    try:
        return decoded(data, kind)
    except (msgspec.DecodeError, ValueError) as error:
        raise ComputeFailed(CodedText("helper-bad-result", detail=str(error)[:200])) from error


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
    """Encode an error of the library (child's side)."""
    found = error.problems if isinstance(error, WrongSettings) else {}
    problems = {field: StoredText.of(text) for field, text in found.items()}
    name = f"{type(error).__module__}.{type(error).__qualname__}"
    message = str(error)[: POOL_MESSAGES.max_message].encode(errors="backslashreplace").decode()
    several = error.candidates if isinstance(error, UnknownFormat) else ()
    candidates = [str(one) for one in several if not is_unnameable(one)]
    reply = CallError(name=name, message=message, problems=problems, candidates=candidates)
    if error.args and isinstance(text := error.args[0], CodedText):
        reply.code, reply.values = text.code, flat_values(text.values)
    return reply.model_dump_json().encode()


def decode_error(data: bytes) -> Exception:
    """Decode an error of a child, as the class of the library that it names if there is one."""
    try:
        error = CallError.model_validate_json(data)
    except ValueError:
        return ComputeFailed(CodedText("helper-bad-error"))
    if error.problems:
        return WrongSettings({field: one.again() for field, one in error.problems.items()})
    if error.candidates:
        return UnknownFormat(error.message, candidates=tuple(map(Path, error.candidates)))
    message = stored_text(error.code, error.values, error.message)
    for known in _subclasses(Recon4Error):
        if f"{known.__module__}.{known.__qualname__}" == error.name:
            return known(message)
    return ConfigError(message)


def _adapter(function: Callable[..., Any]) -> TypeAdapter[Any]:
    return TypeAdapter(declared(function))


def _subclasses(base: type[Recon4Error]) -> Iterator[type[Recon4Error]]:
    yield base
    for one in base.__subclasses__():
        yield from _subclasses(one)
