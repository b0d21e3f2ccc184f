"""The worlds by name."""

from __future__ import annotations

from collections.abc import Callable
from importlib import import_module

from recon4.errors import ConfigError
from recon4.simulation.world import World

WORLDS = ("office", "staircase", "street", "field", "corridor")


def build_world(name: str) -> World:
    """A world by its name.

    Raises:
        ConfigError: If there is no such world.
    """
    if name not in WORLDS:
        raise ConfigError(f"no world named {name!r}; there are: {', '.join(WORLDS)}")
    build: Callable[[], World] = import_module(f"recon4.simulation.worlds.{name}").build
    return build()
