"""The worlds by name."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from importlib import import_module

from recon4.errors import ConfigError
from recon4.locales.coded import CodedText
from recon4.simulation.world import World

FIXED = ("office", "staircase", "street", "field", "hall", "showroom")
"""Worlds of one geometry."""
PROCEDURAL = (
    "corridor", "tunnel", "garage", "plaza", "storeys", "tower", "forest", "mirrors", "elevator",
    "rooms",
)  # fmt: skip
"""Worlds of which there are variants: ``corridor`` is variant 0, ``corridor:7`` another one."""
WORLDS = FIXED + PROCEDURAL
_MAX_VARIANT = 1_000_000


def build_world(name: str) -> World:
    """A world by its name.

    Args:
        name: One of `WORLDS`; of one in `PROCEDURAL` also ``NAME:VARIANT``. The variant draws the
            geometry.

    Raises:
        ConfigError: If there is no such world or no such variant.
    """
    base, colon, number = name.partition(":")
    if base not in WORLDS:
        raise ConfigError(CodedText("simulate-world", base=base, worlds=", ".join(WORLDS)))
    module = import_module(f"recon4.simulation.worlds.{base}")
    if base in FIXED:
        if colon:
            raise ConfigError(CodedText("simulate-no-variants", base=base, name=name))
        build: Callable[[], World] = module.build
        return build()
    variant = int(number) if number.isascii() and number.isdecimal() else 0 if not colon else -1
    if not 0 <= variant <= _MAX_VARIANT:
        raise ConfigError(CodedText("simulate-variant", max_variant=_MAX_VARIANT, name=name))
    build_variant: Callable[[int], World] = module.build
    return replace(build_variant(variant), name=name)
