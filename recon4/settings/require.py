"""Validation of the values of settings."""

from __future__ import annotations

from recon4.errors import ConfigError


def require(valid: bool, rule: str, value: object) -> None:
    """Raise an error for an invalid value.

    Raises:
        ConfigError: Names the rule and the value.
    """
    if not valid:
        raise ConfigError(f"{rule}, got {value}")
