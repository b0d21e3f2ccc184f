"""Who asks for the state of a review, and in which language they read it."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Annotated

from fastapi import Depends

from recon4_app.access.people import Person, Who
from recon4_app.pages import Language


@dataclass(frozen=True, slots=True)
class Reader:
    """A person with the language of their request."""

    who: Person
    language: str


def reader_of(who: Who, language: Language) -> Reader:
    """The person who requests something."""
    return Reader(who, language)


ReadBy = Annotated[Reader, Depends(reader_of)]
