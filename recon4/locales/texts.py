"""Texts by name, from the Fluent files of a language (https://projectfluent.org).

A message has a text and *parts* (attributes in Fluent). Functions that texts call are those of
`recon4.locales.numbers` and what the caller gives.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping
from functools import cache
from pathlib import Path
from typing import Any

from fluent.runtime import FluentBundle
from fluent.syntax import FluentParser, ast
from fluent.syntax.visitor import Visitor

from recon4.locales.languages import ENGLISH, ROOT
from recon4.locales.numbers import ShownText, number_functions, shown

Shown = bool | int | float | str
Functions = Mapping[str, Callable[..., str]]


class Texts:
    """The texts of some files of a language; those that it lacks are English."""

    def __init__(
        self,
        language: str,
        *files: str,
        functions: Callable[[Texts], Functions] | None = None,
        root: Path = ROOT,
    ) -> None:
        """Texts of a language.

        Args:
            language: Its code; there is a folder of this name.
            files: Names of files in it, without ``.ftl``.
            functions: Further functions for these texts.
            root: Has the folders.
        """
        self.language = language
        own = functions(self) if functions is not None else {}
        called: dict[str, Callable[..., Any]] = {
            key: _shown(one) for key, one in {**number_functions(language), **own}.items()
        }
        self._bundle = FluentBundle([language], functions=called, use_isolating=False)
        self._messages: dict[str, ast.Message] = {}
        for file in files:
            found = messages_of(root / language / f"{file}.ftl")
            self._messages |= found
            self._bundle.add_resource(ast.Resource(list(found.values())))
        self._fallback: Texts | None = None
        if language != ENGLISH:
            self._fallback = Texts(ENGLISH, *files, functions=functions, root=root)

    def __call__(self, name: str, /, **values: Shown) -> str:
        """The text of a message with the values that it quotes.

        Raises:
            KeyError: If there is no such message, or it quotes a value that is not given.
        """
        return self.part(name, "", values)

    def __contains__(self, name: str) -> bool:
        return name in self._messages or (self._fallback is not None and name in self._fallback)

    def names(self) -> Iterator[str]:
        """Names of all messages, those of English first."""
        known = self._messages if self._fallback is None else self._fallback._messages
        yield from known
        yield from (one for one in self._messages if one not in known)

    def lacks_some(self) -> bool:
        """Whether some of these texts are only English."""
        fallback = self._fallback
        return fallback is not None and not fallback._messages.keys() <= self._messages.keys()

    def parts(self, name: str) -> dict[str, ast.Pattern]:
        """The parts of a message, in order; the text itself has the empty name."""
        entry = self._entry(name)
        text = {"": entry.value} if entry.value is not None else {}
        return text | {one.id.name: one.value for one in entry.attributes}

    def part(self, name: str, part: str, values: Mapping[str, Shown]) -> str:
        """One part of a message with the values that it quotes.

        Raises:
            KeyError: If there is no such part, or it quotes a value that is not given.
        """
        try:
            return self._formatted(name, part, values)
        except KeyError:
            if self._fallback is None:
                raise
            return self._fallback.part(name, part, values)

    def _formatted(self, name: str, part: str, values: Mapping[str, Shown]) -> str:
        message = self._bundle.get_message(name)
        pattern = message.attributes[part] if part else message.value
        if pattern is None:
            raise KeyError(name)
        given = {key: shown(value) for key, value in values.items()}
        text, errors = self._bundle.format_pattern(pattern, given)
        if errors:
            raise KeyError(f"{name}{f'.{part}' if part else ''}: {errors[0]}")
        return str(text)

    def _entry(self, name: str) -> ast.Message:
        if name not in self._messages and self._fallback is not None:
            return self._fallback._entry(name)
        return self._messages[name]


def _shown(function: Callable[..., str]) -> Callable[..., ShownText]:
    return lambda *args, **kwargs: ShownText(function(*args, **kwargs))


@cache
def texts(language: str, *files: str) -> Texts:
    """The texts of some files of a language, read once."""
    return Texts(language, *files)


@cache
def messages_of(file: Path) -> dict[str, ast.Message]:
    """The messages of a file by their names; none if the language does not have this file."""
    if not file.is_file():
        return {}
    found = FluentParser(with_spans=False).parse(file.read_text("utf-8"))
    return {one.id.name: one for one in found.body if isinstance(one, ast.Message)}


def quoted_by(pattern: ast.Pattern) -> frozenset[str]:
    """Names of the values that a text quotes."""
    visitor = _Quoted()
    visitor.visit(pattern)
    return frozenset(visitor.names)


class _Quoted(Visitor):
    def __init__(self) -> None:
        self.names: set[str] = set()

    def visit_VariableReference(self, node: ast.VariableReference) -> None:  # noqa: N802 (theirs)
        self.names.add(node.id.name)


def readable(pattern: ast.Pattern) -> str:
    """A text with the names of its values in place of them, as ``‹lost›``."""
    return "".join(
        str(one.value)
        if isinstance(one, ast.TextElement)
        else "/".join(f"‹{name}›" for name in sorted(quoted_by(ast.Pattern([one]))))
        for one in pattern.elements
    )
