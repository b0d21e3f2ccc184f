"""Why a job ended, as it is stored: a code and values, which say it in every language."""

from __future__ import annotations

from dataclasses import dataclass, field

from recon4.locales.coded import CodedText, as_coded, flat_values, stored_text


@dataclass(frozen=True, slots=True, kw_only=True)
class JobReason:
    """The code of a text with what it quotes (`recon4.locales.coded`)."""

    code: str
    values: dict[str, bool | int | float | str] = field(default_factory=dict)


def reason_of(note: str) -> JobReason | None:
    """What is stored beside a note; None = it has no code."""
    if not isinstance(note, CodedText):
        return None
    return JobReason(code=note.code, values=flat_values(note.values))


def said_before(reason: JobReason | None, note: str) -> str:
    """A note that was stored, with its code again if it has one."""
    return stored_text(reason.code, reason.values, note) if reason else note


def in_language(reason: JobReason | None, note: str, language: str) -> str:
    """A note that was stored, in a language.

    One without a code, as of an earlier version, is quoted in English.
    """
    return as_coded(said_before(reason, note)).said(language) if note else ""
