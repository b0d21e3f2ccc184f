"""Checks that the suffix of a file name matches the format that is written."""

from __future__ import annotations

from pathlib import Path

from recon4.errors import ConfigError

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
        raise ConfigError(f"{path.name}: a map is written as {COPC}, this is a plain LAZ file")
    for special, kind in _UNWRITTEN.items():
        if special.endswith(ending) and name.endswith(special):
            plain = path.name[: -len(special)] + ending
            raise ConfigError(f"{path.name}: {kind} is not supported; use {plain}")
    if not name.endswith(ending):
        raise ConfigError(f"a {ending[1:].upper()} file must be named {ending}, got {path.name}")
