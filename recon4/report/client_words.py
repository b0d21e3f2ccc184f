"""Texts of the report for the client: one catalog, a file for each language."""

from __future__ import annotations

import tomllib
from functools import cache
from importlib import resources

from recon4.errors import ConfigError

LANGUAGES = ("en",)
"""Languages that have a catalog, ``client_<language>.toml``."""


class Words:
    """The texts of one language."""

    def __init__(self, language: str, texts: dict[str, str]) -> None:
        self.language = language
        self._texts = texts

    def __call__(self, key: str, /, **values: str) -> str:
        """A text with the values that it quotes filled in; the values are taken as they are."""
        return self._texts[key].format(**values)

    def all(self, prefix: str) -> dict[str, str]:
        """Texts whose key begins with the prefix, by the rest of the key."""
        found = self._texts.items()
        return {k.removeprefix(prefix): text for k, text in found if k.startswith(prefix)}


@cache
def words(language: str = "en") -> Words:
    """The catalog of a language.

    Raises:
        ConfigError: If there is none.
    """
    if language not in LANGUAGES:
        raise ConfigError(f"language {language[:20]!r}: expected one of {', '.join(LANGUAGES)}")
    text = resources.files("recon4.report").joinpath(f"client_{language}.toml").read_text("utf-8")
    return Words(language, dict(_flat(tomllib.loads(text))))


def _flat(table: dict[str, object], prefix: str = "") -> list[tuple[str, str]]:
    out: list[tuple[str, str]] = []
    for name, value in table.items():
        if isinstance(value, dict):
            out += _flat(value, f"{prefix}{name}.")
        else:
            out.append((f"{prefix}{name}", str(value)))
    return out
