"""Tables of TOML text of unknown origin, read with checks of every value."""

from __future__ import annotations

import re
import tomllib
from dataclasses import dataclass
from typing import TypeGuard

import numpy as np

from recon4.errors import ConfigError
from recon4.geometry.se3 import Array
from recon4.locales.coded import CodedText
from recon4.model.limits import RIG_LIMITS

_BETWEEN_KEYS = re.compile(r"[=\[\]{},\n]")


@dataclass(frozen=True, slots=True)
class TomlTable:
    """One table of a file; every error names the place, the key and what was found."""

    values: dict[str, object]
    where: str
    """File and table, for errors."""

    @staticmethod
    def of(value: object, where: str, known: set[str]) -> TomlTable:
        """Check that a value is a table without other keys than the known ones.

        Raises:
            ConfigError: If it is not.
        """
        if not isinstance(value, dict):
            raise ConfigError(CodedText("table-expected", where=where, got=f"{value!r:.80}"))
        unknown = sorted(set(value) - known)
        if unknown:
            raise ConfigError(
                CodedText(
                    "table-unknown",
                    where=where,
                    unknown=str(unknown)[:200],
                    known=str(sorted(known)),
                )
            )
        return TomlTable(value, where)

    def __contains__(self, key: str) -> bool:
        return key in self.values

    def get(self, key: str, default: object = None) -> object:
        """A value that the caller checks."""
        return self.values.get(key, default)

    def number(self, key: str, default: float = 0.0) -> float:
        """A finite number."""
        value = self.get(key, default)
        if not _is_usable(value):
            raise ConfigError(
                CodedText("table-number", where=self.where, key=key, got=f"{value!r:.80}")
            )
        return float(value)

    def vector(self, key: str, size: int, default: tuple[float, ...] = (0.0, 0.0, 0.0)) -> Array:
        """Finite numbers, (size,)."""
        value = self.get(key, default)
        if (
            not isinstance(value, (list, tuple))
            or len(value) != size
            or not all(map(_is_usable, value))
        ):
            raise ConfigError(
                CodedText(
                    "table-numbers", where=self.where, key=key, size=size, got=f"{value!r:.80}"
                )
            )
        return np.asarray(value, dtype=np.float64)

    def place_m(self, key: str) -> Array:
        """A position in the body [m], (3,); zeros if it is not there."""
        place = self.vector(key, 3)
        if np.linalg.norm(place) > RIG_LIMITS.place_m:
            raise ConfigError(
                CodedText(
                    "table-place",
                    where=self.where,
                    key=key,
                    limit_m=f"{RIG_LIMITS.place_m:g}",
                    got=str(place.tolist()),
                )
            )
        return place

    def angles_rad(self, key: str) -> Array:
        """Angles that the file has in degrees [rad], (3,); zeros if they are not there."""
        degrees = self.vector(key, 3)
        turns = np.array([np.pi / 2.0, np.pi])
        off = np.abs(np.abs(degrees)[:, None] - turns)
        if np.any(off < RIG_LIMITS.right_angle_rad):
            raise ConfigError(
                CodedText(
                    "table-degrees",
                    where=self.where,
                    key=key,
                    got=str(degrees.tolist()),
                    degrees=str(np.round(np.rad2deg(degrees), 2).tolist()),
                )
            )
        return np.asarray(np.deg2rad(degrees))

    def text(self, key: str, default: str = "", *, most: int = RIG_LIMITS.text) -> str:
        """A text of at most ``most`` characters."""
        value = self.get(key, default)
        if not isinstance(value, str) or len(value) > most:
            raise ConfigError(
                CodedText("table-text", where=self.where, key=key, limit=most, got=f"{value!r:.80}")
            )
        return value

    def flag(self, key: str, *, default: bool) -> bool:
        """True or false."""
        value = self.get(key, default)
        if not isinstance(value, bool):
            raise ConfigError(
                CodedText("table-true-false", where=self.where, key=key, got=f"{value!r:.80}")
            )
        return value

    def port(self, default: int) -> int:
        """The key ``port``, 0 to 65535."""
        port = self.number("port", default)
        if not 0 <= port <= 65535 or port != int(port):
            raise ConfigError(CodedText("table-port", where=self.where, got=f"{port:g}"))
        return int(port)


def parse_toml(text: str, where: str, *, max_characters: int) -> dict[str, object]:
    """Parse TOML with bounded size, nesting and length of keys.

    tomllib needs quadratic time for dotted keys, and recursion for nested arrays.

    Args:
        text: The text of a file.
        where: Its name, for errors.
        max_characters: Longer texts are refused.

    Raises:
        ConfigError: If it is too long, too deep or not TOML.
    """
    if len(text) > max_characters:
        raise ConfigError(CodedText("toml-large", where=where, limit=max_characters, got=len(text)))
    longest = max((part.count(".") for part in _BETWEEN_KEYS.split(text)), default=0)
    if longest > RIG_LIMITS.dots:
        raise ConfigError(CodedText("toml-dots", where=where, got=longest))
    try:
        return tomllib.loads(text)
    except (tomllib.TOMLDecodeError, ValueError) as error:
        raise ConfigError(CodedText("toml-invalid", where=where, why=str(error)[:300])) from error
    except RecursionError as error:
        raise ConfigError(CodedText("toml-deep", where=where)) from error


def _is_usable(value: object) -> TypeGuard[int | float]:
    # A comparison is exact for whole numbers of any length; NaN fails it.
    if isinstance(value, bool) or not isinstance(value, int | float):
        return False
    return abs(value) <= RIG_LIMITS.number
