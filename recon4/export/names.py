"""Checks that the suffix of a file name matches the format that is written."""

from __future__ import annotations

from pathlib import Path

from recon4.errors import ConfigError
from recon4.locales.coded import CodedText

COPC = ".copc.laz"
_UNWRITTEN = {
    ".ept.laz": "an Entwine point tile",
    ".splat.ply": "a Gaussian splat",
    ".compressed.ply": "a compressed splat",
    ".cog.tif": "a cloud optimized GeoTIFF",
}
"""Suffixes of formats whose last part equals that of a format recon4 writes."""


def check_name(path: Path, ending: str) -> None:
    """Refuse a name whose ending is not ``ending``, or that promises a special kind of it.

    Raises:
        ConfigError: Saying which name would do.
    """
    name = path.name.lower()
    if ending == ".laz" and name.endswith(COPC):
        raise ConfigError(CodedText("export-copc-name", file=path.name, copc=COPC))
    for special, kind in _UNWRITTEN.items():
        if special.endswith(ending) and name.endswith(special):
            plain = path.name[: -len(special)] + ending
            raise ConfigError(CodedText("export-kind", file=path.name, kind=kind, plain=plain))
    if not name.endswith(ending):
        raise ConfigError(
            CodedText("export-name", ending=ending[1:].upper(), suffix=ending, file=path.name)
        )
