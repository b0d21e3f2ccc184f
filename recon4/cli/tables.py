"""Options about tables of people: columns and unit."""

from __future__ import annotations

from typing import TYPE_CHECKING

from recon4.errors import ConfigError
from recon4.locales.coded import CodedText

if TYPE_CHECKING:
    from recon4.recording.tables.coordinates import ColumnChoice


def parse_choice(columns: str, unit: str) -> ColumnChoice:
    """The options ``--columns`` and ``--unit``.

    Raises:
        ConfigError: If a word is not known.
    """
    from recon4.recording.tables.column_names import UNITS_M, parse_meanings
    from recon4.recording.tables.coordinates import ColumnChoice

    chosen = next((known for known in UNITS_M if known == unit), None)
    if unit and chosen is None:
        raise ConfigError(CodedText("option-unit", units_m=", ".join(UNITS_M), unit=unit[:40]))
    return ColumnChoice(parse_meanings(columns), chosen)
