"""Options about tables of people: columns and unit."""

from __future__ import annotations

from typing import TYPE_CHECKING

from recon4.errors import ConfigError

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
        raise ConfigError(f"--unit: expected one of {', '.join(UNITS_M)}, got {unit[:40]!r}")
    return ColumnChoice(parse_meanings(columns), chosen)
