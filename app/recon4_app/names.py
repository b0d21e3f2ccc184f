"""Names and notes in requests: field types that reject invisible characters."""

from __future__ import annotations

from typing import Annotated

from pydantic import AfterValidator

from recon4.untrusted.names import check_name, check_note


def _name(text: str) -> str:
    return check_name(text, what="a name")


def _note(text: str) -> str:
    return check_note(text, what="a note")


Name = Annotated[str, AfterValidator(_name)]
"""One line of text; the field's own limits of length apply too."""
Note = Annotated[str, AfterValidator(_note)]
"""Some lines of text."""
