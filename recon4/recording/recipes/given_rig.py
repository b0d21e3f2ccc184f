"""The rig of a command: a rig file, or the sensors of a recording with a recipe for points."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

from recon4.errors import ConfigError
from recon4.locales.coded import CodedText
from recon4.model.point_recipes import PointRecipe, parse_fields_text
from recon4.model.rig import Rig, parse_rig
from recon4.recording.info.describe import describe
from recon4.recording.packets.companions import load_described_rig


def recipe_given(fields: str) -> PointRecipe | None:
    """The recipe of the option ``--fields``; None = it is not given.

    Raises:
        ConfigError: If it makes no sense.
    """
    return parse_fields_text(fields, "command: --fields") if fields else None


def rig_given(recordings: Sequence[Path], rig: str, fields: str) -> Rig | None:
    """The rig of the options ``--rig`` and ``--fields``; None = neither is given.

    Args:
        recordings: Files or folders of one walk.
        rig: A rig file, or the name of a shipped rig; empty = not given.
        fields: A recipe; empty = not given.

    Raises:
        ConfigError: If both are given, or one makes no sense or does not fit.
        RecordingError: If the recording cannot be read.
    """
    recipe = recipe_given(fields)
    if recipe is None:
        return load_described_rig(rig)[0] if rig else None
    if rig:
        raise ConfigError(CodedText("recipe-and-rig", recipe=recipe.toml()))
    found = describe(recordings[0], fields=recipe)
    if not found.first_rig:
        raise ConfigError(
            CodedText("recipe-no-rig", fields=fields, missing="; ".join(found.missing))
        )
    return parse_rig(found.first_rig, where="command: --fields")
