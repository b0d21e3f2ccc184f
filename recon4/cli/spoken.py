"""What commands say of themselves in the language of the terminal: help, and wrong usage.

A command and its options are declared in English; ``help.ftl`` of a language has their sentences.
What the library of the command line says of wrong usage is recognized by the English texts.
"""

from __future__ import annotations

import re
import sys
from collections.abc import Iterator
from functools import cache
from typing import Any

from recon4.locales.coded import CodedText, said
from recon4.locales.languages import ENGLISH, ROOT
from recon4.locales.texts import Texts, messages_of, pattern_of

_TITLES = {"argument": "Arguments", "option": "Options"}
"""Of the boxes of a help, by the kind of parameter."""
_METAVARS = ("options_metavar", "subcommand_metavar")


def paragraphs(text: str | None) -> list[str]:
    """The paragraphs of a help text, each in a line."""
    return [" ".join(one.split()) for one in (text or "").split("\n\n") if one.strip()]


def all_below(command: Any, path: tuple[str, ...] = ()) -> Iterator[tuple[tuple[str, ...], Any]]:
    """A command and all those below it, with their names."""
    yield path, command
    for name, one in getattr(command, "commands", {}).items():
        yield from all_below(one, (*path, name))


def speak(context: Any, language: str) -> None:
    """Say the help of a command and of all below it in a language."""
    words = _words(language)
    if words or "typer.rich_utils" in sys.modules:  # in English it has them
        _translate_library(Texts(language, "help"))
    if not words:
        return
    for _, command in all_below(context.command):
        command.get_help_option(context)  # makes it
        for one in (command, *command.get_params(context)):
            _translate(one, words)
        for name in _METAVARS:
            written = getattr(command, name, None)
            if written:
                setattr(command, name, words.get(written, written))
        _translate_usage(command, words["Usage"])


def wrong_usage(error: Any, language: str) -> str:
    """What is wrong with how a command was called, and what says how it is."""
    context = getattr(error, "ctx", None)
    command = context.command_path if context else "recon4"
    text = _recognized(error.format_message(), getattr(error, "message", ""))
    return f"{said(text, language)}\n{CodedText('usage-help', command=command).said(language)}"


def _translate(one: Any, words: dict[str, str]) -> None:
    """Translate what the help says of a command, an argument or an option."""
    found = paragraphs(getattr(one, "help", None))
    if found:
        one.help = "\n\n".join(words.get(text, text) for text in found)
    title = getattr(one, "rich_help_panel", None) or _TITLES.get(
        getattr(one, "param_type_name", ""), "Commands"
    )
    if isinstance(title, str):
        one.rich_help_panel = words.get(title, title)


def _translate_usage(command: Any, usage: str) -> None:
    """Translate the first word of the line that says how a command is called."""
    english = command.get_usage
    command.get_usage = lambda context: english(context).replace("Usage", usage, 1)


def _translate_library(words: Texts) -> None:
    from typer import rich_utils

    rich_utils.DEFAULT_STRING = f"[{words('typer-default')}: {{}}]"
    rich_utils.REQUIRED_LONG_STRING = f"[{words('typer-required')}]"


@cache
def _words(language: str) -> dict[str, str]:
    """English sentence -> the sentence in a language; empty for English."""
    if language == ENGLISH:
        return {}
    english, own = Texts(ENGLISH, "help"), Texts(language, "help")
    return {english(name): own(name) for name in english.names()}


def _recognized(text: str, quoted: str) -> str:
    """A text of the library as a `CodedText`, if it is one of the known ones.

    Args:
        text: The whole.
        quoted: A text of ours that it may quote.
    """
    if text == quoted and isinstance(quoted, CodedText):
        return quoted
    for code, pattern in _patterns():
        found = pattern.fullmatch(text)
        if found:
            values = {name: _recognized(one, quoted) for name, one in found.groupdict().items()}
            return CodedText(code, **values)
    return text


@cache
def _patterns() -> tuple[tuple[str, re.Pattern[str]], ...]:
    """What the library says, by code."""
    files = [messages_of(ROOT / ENGLISH / f"{name}.ftl") for name in ("usage", "problems")]
    fields = {name: one for name, one in files[1].items() if name.startswith("field-")}
    found = []
    for name, message in {**files[0], **fields}.items():
        assert message.value is not None, name
        found.append((name, pattern_of(message.value)))
    return tuple(sorted(found, key=lambda pair: -len(pair[1].pattern)))  # the longest says most
