"""How a group of settings refuses a value."""

from __future__ import annotations

from recon4.errors import ConfigError


def require(holds: bool, rule: str, value: object) -> None:
    """Refuse a value that breaks a rule.

    Raises:
        ConfigError: With the rule and the value, unless the rule holds.
    """
    if not holds:
        raise ConfigError(f"{rule}, got {value}")
