"""Texts of programs that know their code: said again in the language of who reads them.

Errors and reasons travel through code as what they always were, a text in English. One that is a
`CodedText` also has its code and the values that it quotes, so that the edge (HTTP, a page) says
it in another language, and a program compares the code.

>>> raise NotFound(CodedText("project-unknown", name="attic"))
"""

from __future__ import annotations

import re
from collections.abc import Iterable, Mapping
from dataclasses import dataclass, field
from functools import cache
from types import MappingProxyType

from recon4 import errors
from recon4.locales.languages import ENGLISH
from recon4.locales.numbers import as_float, localized
from recon4.locales.texts import Functions, Shown, Texts

FILES = ("problems", "endings", "references", "recordings", "files", "formats", "results", "usage")
"""Files of the texts with a code: problems of requests, reasons why jobs ended, what is said of
references, of recordings, of files, settings and projects, of formats, of results, and of wrong
usage of commands."""
STEPS = ("projects",)
"""Files with the names of stages and steps."""
TERMINAL = ("terminal",)
"""Files of what commands say where nothing is wrong."""
COUNTS = ("counts",)
"""Files of what became of data that is counted, for texts that quote it."""
CODE = "_code"
"""End of the name of a value that is the code of the error in another value of a finding."""
UNCODED = "message"
"""Code of a text that has none; its value ``detail`` is the text."""

KINDS: Mapping[type, str] = MappingProxyType(
    {
        errors.ConfigError: "kind-configuration",
        errors.RecordingError: "kind-recording",
        errors.UnknownFormat: "kind-unknown-format",
        errors.EmptyRecording: "kind-empty-recording",
        errors.CorruptFile: "kind-corrupt-file",
        errors.OutOfRange: "kind-out-of-range",
        errors.MapTooLarge: "kind-map-too-large",
        errors.CalibrationError: "kind-calibration",
        errors.GraphError: "kind-graph",
        errors.GeoreferenceError: "kind-georeference",
        errors.StoreError: "kind-store",
        errors.NoSpace: "kind-no-space",
    }
)
"""Codes of errors that state none of their own; each quotes the message as ``detail``."""


class CodedText(str):
    """A text in English that knows its code and its values."""

    code: str
    """Name of its message in one of `FILES`; stable."""
    values: Mapping[str, Shown]
    """What the text quotes, by name."""

    def __new__(cls, code: str, /, **values: Shown) -> CodedText:
        """The text of a code.

        Raises:
            KeyError: If there is no such code, or its text quotes a value that is not given.
        """
        text = super().__new__(cls, _texts(ENGLISH)(code, **values))
        text.code, text.values = code, MappingProxyType(values)
        return text

    def __reduce__(self) -> tuple[object, ...]:
        """Code and values are enough to copy it into another process."""
        return _again, (self.code, dict(self.values))

    def said(self, language: str) -> str:
        """The text in a language; a text with a code that it quotes is in that language, too."""
        return _texts(language)(self.code, **self.said_values(language))

    def said_values(self, language: str) -> dict[str, Shown]:
        """What the text quotes, by name, as a text of that language quotes it."""
        return {
            name: said(value, language) if isinstance(value, str) else value
            for name, value in self.values.items()
        }


def flat_values(values: Mapping[str, Shown]) -> dict[str, Shown]:
    """Values as a file or another process keeps them; `stored_text` reads them.

    A coded text among them stays one: its own text, then its code as ``NAME:``, then its values as
    ``NAME:VALUE``. Names of files that are no UTF-8 get an escape for each such byte.

    >>> flat_values({"why": CodedText("job-unknown", job="a1")})
    {'why': 'no job a1', 'why:': 'job-unknown', 'why:job': 'a1'}
    """
    flat: dict[str, Shown] = {}
    for name, value in values.items():
        if isinstance(value, CodedText):
            inner = {"": value.code, **flat_values(value.values)}
            flat |= {name: _utf8(str(value))} | {f"{name}:{key}": inner[key] for key in inner}
        else:
            flat[name] = _utf8(value) if isinstance(value, str) else value
    return flat


def _utf8(text: str) -> str:
    return text.encode(errors="backslashreplace").decode()


def folded_values(values: Mapping[str, Shown]) -> dict[str, Shown]:
    """The values that `flat_values` wrote, coded texts again.

    What is nested deeper than any text is left out.
    """
    known = {name: value for name, value in values.items() if name.count(":") <= 8}
    folded = {name: value for name, value in known.items() if ":" not in name}
    for name, value in folded.items():
        begin = f"{name}:"
        inner = {key[len(begin) :]: one for key, one in known.items() if key.startswith(begin)}
        code = inner.pop("", None)
        if isinstance(code, str):
            folded[name] = stored_text(code, inner, str(value))
    return folded


@dataclass(frozen=True, slots=True, kw_only=True)
class StoredText:
    """A text as a file keeps it: in English, and with code and values if it has a code."""

    text: str
    code: str = ""
    values: dict[str, int | float | str] = field(default_factory=dict)

    @staticmethod
    def of(text: str) -> StoredText:
        """What is stored of a text."""
        if not isinstance(text, CodedText):
            return StoredText(text=text)
        values = {
            name: int(value) if isinstance(value, bool) else value
            for name, value in flat_values(text.values).items()
        }
        return StoredText(text=str(text), code=text.code, values=values)

    def again(self) -> str:
        """The text that was stored: a `CodedText` if its code is known."""
        return stored_text(self.code, self.values, self.text)

    def said(self, language: str) -> str:
        """The text in a language; in English if it has no code that is known."""
        return said(self.again(), language)


def coded(error: BaseException) -> CodedText:
    """The message of an error with its code: its own, or that of the kind of error.

    An error that states no code often quotes a library. What kind it is can be said in every
    language; the message itself is the value ``detail``, in English.
    """
    text = error.args[0] if error.args else ""
    if isinstance(error, errors.WrongSettings):
        text = joined(error.problems.values())
    if isinstance(text, CodedText):
        return text
    kinds = (KINDS[one] for one in type(error).__mro__ if one in KINDS)
    return CodedText(next(kinds, UNCODED), detail=str(error))


def text_of(error: BaseException) -> str:
    """The message of an error: a `CodedText` if it has a code, or is of a kind that has one."""
    text = coded(error)
    return text if text.code != UNCODED else str(error)


def at(where: str, why: str) -> CodedText:
    """What is wrong, behind the name of the file or place where it is."""
    return CodedText("where-why", where=where, why=why)


def unreadable(name: str, error: BaseException) -> CodedText:
    """That a file cannot be read, and why."""
    return CodedText("file-unreadable", name=name, why=text_of(error))


def as_coded(text: object, english: str = "") -> CodedText:
    """A text with its code; `UNCODED` if it has none.

    Args:
        text: Perhaps a `CodedText`.
        english: What it says in English; empty = itself.
    """
    if isinstance(text, CodedText):
        return text
    return CodedText(UNCODED, detail=english or str(text))


def said(text: str, language: str) -> str:
    """A text in a language, if it has a code; else as it is."""
    return text.said(language) if isinstance(text, CodedText) else text


def all_said(texts: Mapping[str, str], language: str) -> dict[str, str]:
    """Texts by name, each as `said`."""
    return {name: said(text, language) for name, text in texts.items()}


def stored_text(code: str, values: Mapping[str, Shown], english: str) -> str:
    """A text that was stored with its code and `flat_values`; only English if they say nothing now.

    A later version may have another code; what another process sent may be anything.
    """
    try:
        return CodedText(code, **folded_values(values))
    except (KeyError, TypeError, ValueError):
        return english


def codes() -> tuple[str, ...]:
    """All codes, in the order of the files; words that texts quote are none."""
    names = [name for file in FILES for name in Texts(ENGLISH, file).names()]
    return tuple(name for name in names if not name.startswith("word-"))


def joined(texts: Iterable[str]) -> str:
    """Texts behind each other as one, which is coded if there are several; none give none."""
    first, *others = (*texts,) or ("",)
    return CodedText("and-further", first=first, further=joined(others)) if others else first


def _again(code: str, values: dict[str, Shown]) -> CodedText:
    return CodedText(code, **values)


@cache
def _texts(language: str) -> Texts:
    return Texts(language, "shared", *STEPS, *TERMINAL, *COUNTS, *FILES, functions=_functions)


def _functions(texts: Texts) -> Functions:
    def words(value: str, of: str) -> str:
        named = ((f"word-{of}-{one}", f"{of}-{one}", one) for one in value.split())
        return "; ".join(
            next((texts(name) for name in (own, shared) if name in texts), one)
            for own, shared, one in named
        )

    def named(word: str, of: str) -> str:
        name = f"{of}-{re.sub(r'[^a-z0-9]+', '-', word.lower()).strip('-')}"
        return texts(name) if name in texts else word

    def how(ended: str, number: float) -> str:
        name = f"word-exit-{ended}"
        known = name if name in texts else "word-exit-other"
        return texts(known, how=ended, number=number)

    def place(stage: str, what: str) -> str:
        kind = "none" if not what else "stage" if stage else "work"
        return texts(f"word-place-{kind}", stage=stage, what=what)

    def counted(written: str, of: str) -> str:
        pairs = (one.rpartition(":") for one in written.split(";"))
        return ", ".join(f"{named(title, of)} ({count})" for title, _, count in pairs)

    def agreeing(walls: float, level: float) -> str:
        kind = "level" if as_float(walls) < 0.0 else "walls" if as_float(level) < 0.0 else "both"
        return texts(f"word-agreeing-{kind}", walls=as_float(walls), level=as_float(level))

    def rate(hz: float) -> str:
        return texts("word-rate", hz=as_float(hz)) if as_float(hz) > 0.0 else ""

    def turns(hz: float) -> str:
        return texts("word-turns", hz=as_float(hz)) if as_float(hz) > 0.0 else ""

    def numbers(written: str) -> str:
        return "; ".join(localized(one, texts.language) for one in written.split())

    return {
        "AGREEING": agreeing,
        "COUNTED": counted,
        "NUMBERS": numbers,
        "RATE": rate,
        "TURNS": turns,
        "QUOTED": lambda value: repr(str(value)),
        "WORDS": words,
        "NAMED": named,
        "EXIT": how,
        "PLACE": place,
    }
