"""Texts by name, from the Fluent files of a language (https://projectfluent.org).

A message has a text and *parts* (attributes in Fluent). Functions that texts call are those of
`recon4.locales.numbers` and what the caller gives.
"""

from __future__ import annotations

import re
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
_BEGIN = re.compile(r"^([a-zA-Z][\w-]*) *=", re.MULTILINE)
"""Where a message begins; what belongs to it is indented."""
_VALUE = re.compile("‹(.+?)›")
"""Of a readable text."""


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
        self._in_bundle: set[str] = set()
        self._messages = {
            name: messages
            for file in files
            for messages in [messages_of(root / language / f"{file}.ftl")]
            for name in messages
        }
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
        if name not in self._in_bundle:
            self._load(name)
        message = self._bundle.get_message(name)
        pattern = message.attributes[part] if part else message.value
        if pattern is None:
            raise KeyError(name)
        given = {key: shown(value) for key, value in values.items()}
        text, errors = self._bundle.format_pattern(pattern, given)
        if errors:
            raise KeyError(f"{name}{f'.{part}' if part else ''}: {errors[0]}")
        return str(text)

    def _load(self, name: str) -> None:
        """Give a message to the bundle, and those that it refers to.

        Raises:
            KeyError: If there is no such message.
        """
        message = self._messages[name][name]
        self._bundle.add_resource(ast.Resource([message]))
        self._in_bundle.add(name)
        for other in _names_in(message, ast.MessageReference) & self._messages.keys():
            if other not in self._in_bundle:
                self._load(other)

    def _entry(self, name: str) -> ast.Message:
        if name not in self._messages and self._fallback is not None:
            return self._fallback._entry(name)
        return self._messages[name][name]


def _shown(function: Callable[..., str]) -> Callable[..., ShownText]:
    return lambda *args, **kwargs: ShownText(function(*args, **kwargs))


@cache
def texts(language: str, *files: str) -> Texts:
    """The texts of some files of a language, read once."""
    return Texts(language, *files)


class Messages(Mapping[str, ast.Message]):
    """The messages of a file by their names, each parsed when it is asked for.

    A program says few of two thousand texts, and many of our processes live for a second.
    """

    def __init__(self, text: str) -> None:
        """Find where the messages begin.

        Args:
            text: The file.
        """
        begins = [*_BEGIN.finditer(text)]
        ends = [*(one.start() for one in begins), len(text)][1:]
        self._sources = {
            begin[1]: text[begin.start() : end] for begin, end in zip(begins, ends, strict=True)
        }
        self._parsed: dict[str, ast.Message] = {}

    def __getitem__(self, name: str) -> ast.Message:
        if name not in self._parsed:
            (self._parsed[name],) = (
                one
                for one in FluentParser(with_spans=False).parse(self._sources[name]).body
                if isinstance(one, ast.Message)
            )
        return self._parsed[name]

    def __iter__(self) -> Iterator[str]:
        return iter(self._sources)

    def __len__(self) -> int:
        return len(self._sources)


@cache
def messages_of(file: Path) -> Messages:
    """The messages of a file by their names; none if the language does not have this file."""
    return Messages(file.read_text("utf-8") if file.is_file() else "")


def quoted_by(pattern: ast.Pattern) -> frozenset[str]:
    """Names of the values that a text quotes."""
    return _names_in(pattern, ast.VariableReference)


def _names_in(
    node: ast.BaseNode, kind: type[ast.VariableReference | ast.MessageReference]
) -> frozenset[str]:
    """Names of all nodes of a kind below a node."""
    visitor = _Names(kind)
    visitor.visit(node)
    return frozenset(visitor.names)


class _Names(Visitor):
    def __init__(self, kind: type[ast.VariableReference | ast.MessageReference]) -> None:
        self._kind = kind
        self.names: set[str] = set()

    def generic_visit(self, node: ast.BaseNode) -> None:
        if isinstance(node, self._kind):
            self.names.add(node.id.name)
        super().generic_visit(node)


def readable(pattern: ast.Pattern) -> str:
    """A text with the names of its values in place of them, as ``‹lost›``; the usual variant."""
    return "".join(map(_readable, pattern.elements))


def _readable(element: ast.TextElement | ast.Placeable) -> str:
    if isinstance(element, ast.TextElement):
        return str(element.value)
    if isinstance(element.expression, ast.SelectExpression):
        usual = next(one for one in element.expression.variants if one.default)
        return readable(usual.value)
    if isinstance(element.expression, ast.StringLiteral):
        return str(element.expression.parse()["value"])
    return "/".join(f"‹{name}›" for name in sorted(quoted_by(ast.Pattern([element]))))


def pattern_of(pattern: ast.Pattern) -> re.Pattern[str]:
    """What recognizes a text and the values that it quotes, each a group."""
    parts = _VALUE.split(readable(pattern))
    written = (f"(?P<{one}>.*?)" if k % 2 else re.escape(one) for k, one in enumerate(parts))
    return re.compile("".join(written), re.DOTALL)
