"""The report for the client as PDF/A: `client.typ` lays out the record, offline.

The record is given as JSON. Its texts are strings in the template, never markup: what people or
files call things cannot become a command.
"""

from __future__ import annotations

import json
import unicodedata
from dataclasses import asdict
from datetime import UTC, datetime
from functools import cache
from importlib import resources
from pathlib import Path
from typing import Any

from recon4.errors import ConfigError, StoreError
from recon4.locales.coded import CodedText
from recon4.report.client import ClientReport

INSTALL = "pip install 'recon4[pdf]'"
_UNPRINTABLE = {"Cc", "Cf", "Cs", "Co", "Cn"}


def pdf_of(report: ClientReport) -> bytes:
    """The report as PDF/A-2a; the same record gives the same bytes.

    Raises:
        ConfigError: If the extra ``pdf`` is not installed.
        StoreError: If it cannot be laid out.
    """
    require_pdf()
    import typst

    template = resources.files("recon4.report").joinpath("client.typ").read_bytes()
    given = json.dumps(_printable(asdict(report)), ensure_ascii=False)
    try:
        compiled: Any = typst.compile  # its types refuse bytes beside paths of fonts
        made = compiled(
            template,
            sys_inputs={"report": given},
            font_paths=[_fonts()],
            ignore_system_fonts=True,
            timestamp=_time(report.created),
            format="pdf",
            pdf_standards=["a-2a", "ua-1"],  # archives; read aloud
        )
    except typst.TypstError as error:
        raise StoreError(CodedText("pdf-layout", message=error.message[:400])) from error
    assert isinstance(made, bytes)
    return made


def require_pdf() -> None:
    """Refuse early.

    Raises:
        ConfigError: If the extra ``pdf`` is not installed; it says how to install it.
    """
    try:
        import pyhanko  # noqa: F401
        import typst  # noqa: F401
    except ImportError as error:
        raise ConfigError(CodedText("pdf-packages", install=INSTALL, why=str(error))) from error


@cache
def _drawn() -> frozenset[int]:
    """The characters that have a shape in DejaVu Sans; others would be empty boxes."""
    from matplotlib.ft2font import FT2Font

    return frozenset(FT2Font(str(_fonts() / "DejaVuSans.ttf")).get_charmap())


def _fonts() -> Path:
    """Folder of DejaVu Sans, which matplotlib brings along; the others are within typst."""
    import matplotlib

    return Path(matplotlib.get_data_path()) / "fonts" / "ttf"


def _time(created: str) -> datetime:
    try:
        return datetime.fromisoformat(created).astimezone(UTC)
    except ValueError:
        return datetime(2000, 1, 1, tzinfo=UTC)  # of an earlier version


def _printable(value: Any) -> Any:
    """A record without characters that no font may or can show: their numbers are in their place.

    Drawings are XML of recon4, whose line ends stay.
    """
    if isinstance(value, dict):
        return {k: one if k == "svg" else _printable(one) for k, one in value.items()}
    if isinstance(value, (list, tuple)):
        return [_printable(one) for one in value]
    if isinstance(value, str) and not value.isascii():
        return "".join(_shown(one) for one in value)
    return value


def _shown(character: str) -> str:
    if unicodedata.category(character) in _UNPRINTABLE or ord(character) not in _drawn():
        return f"<U+{ord(character):04X}>"
    return character
