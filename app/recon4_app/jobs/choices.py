"""HTTP routes of the choices of a new job: presets, rigs, every setting with its meaning."""

from __future__ import annotations

import re
from functools import cache
from typing import Any

from fastapi import APIRouter, Depends
from pydantic import BaseModel, ConfigDict, Field

from recon4.errors import WrongSettings
from recon4.locales.coded import all_said
from recon4.locales.languages import ENGLISH
from recon4.locales.texts import texts
from recon4.model.rig import rig_presets
from recon4.settings import PRESET_TEXTS, PRESETS, override, preset, values_by_group
from recon4.settings.help import GroupHelp, SettingHelp, describe_settings
from recon4_app.access.people import Permission, needs
from recon4_app.pages import Language

router = APIRouter(prefix="/api", tags=["settings"], dependencies=[Depends(needs(Permission.LOOK))])

UNITS = {
    "m": "m",
    "s": "s",
    "ns": "ns",
    "hz": "Hz",
    "rad": "rad",
    "deg": "°",
    "m_s": "m/s",
    "m_s2": "m/s²",
    "rad_s": "rad/s",
}
"""Ending of a setting's name -> how its unit is written."""


class Choices(BaseModel):
    """Presets and rigs of a new job."""

    presets: list[str]
    preset_texts: dict[str, str]
    """Preset -> what it is for, in a line."""
    rigs: list[str]


class SettingView(BaseModel):
    """One setting, as a form shows it."""

    path: str
    """``group.field``, what a job's ``settings`` take."""
    name: str
    kind: str
    """``int``, ``float``, ``text``, ``bool`` or ``choice``."""
    choices: list[str]
    """Values of a ``choice``."""
    unit: str
    text: str
    """Description, in the language of the request."""
    default: Any
    value: Any
    """Value in the requested preset."""


class GroupView(BaseModel):
    """The settings of one part of the pipeline."""

    name: str
    text: str
    settings: list[SettingView]


class Assignments(BaseModel):
    """Settings to be checked."""

    model_config = ConfigDict(extra="forbid")

    preset: str = "indoor"
    settings: list[str] = Field(default=[], max_length=300)
    """``group.field=value`` texts over the preset."""


class SettingsCheck(BaseModel):
    """Result of checking settings."""

    problems: dict[str, str]
    """``group.field`` -> the problem and the expected value; empty = all are valid."""


@router.get("/choices", summary="Presets and rigs")
def read_choices() -> Choices:
    """List the presets and the shipped rigs for a new job."""
    return Choices(presets=list(PRESETS), preset_texts=PRESET_TEXTS, rigs=rig_presets())


@router.get("/settings", summary="Every setting")
def read_settings(language: Language, of: str = "indoor") -> list[GroupView]:
    """List every setting with meaning, unit, default, and value in the preset ``of``."""
    values = values_by_group(preset(of))
    return [_group(group, values[group.name], language) for group in _described()]


@router.post("/settings/check", summary="Check settings")
def check_settings(given: Assignments, language: Language) -> SettingsCheck:
    """Check whether a job would accept these settings; lists every problem."""
    chosen = preset(given.preset)
    try:
        override(chosen, given.settings)
    except WrongSettings as error:
        return SettingsCheck(problems=all_said(error.problems, language))
    return SettingsCheck(problems={})


@cache
def _described() -> tuple[GroupHelp, ...]:
    return describe_settings()


def _group(group: GroupHelp, values: dict[str, object], language: str) -> GroupView:
    settings = [_setting(one, values[one.name], language) for one in group.settings]
    text = _in_language(group.name, group.text, language)
    return GroupView(name=group.name, text=text, settings=settings)


def _setting(one: SettingHelp, value: Any, language: str) -> SettingView:
    values = re.findall(r"`([^`]*)`", one.kind)
    truth = values == ["true", "false"]
    return SettingView(
        path=one.path,
        name=one.name,
        kind="bool" if truth else "choice" if values else one.kind,
        choices=[] if truth else values,
        unit=unit_of(one.name),
        text=_in_language(one.path, one.text, language),
        default=one.default,
        value=value,
    )


def unit_of(name: str) -> str:
    """The unit a setting's name ends with; empty = none."""
    endings = sorted(UNITS, key=len, reverse=True)
    return next((UNITS[ending] for ending in endings if name.endswith(f"_{ending}")), "")


def _in_language(path: str, declared: str, language: str) -> str:
    """The sentence of a setting or group: as it is declared, or its translation."""
    if language == ENGLISH:
        return plain_text(declared)
    return texts(language, "settings")(text_name(path))


def text_name(path: str) -> str:
    """Name of the text of a setting or group: ``map.voxel_m`` -> ``about-map-voxel_m``."""
    return f"about-{path.replace('.', '-')}"


def plain_text(text: str) -> str:
    """A docstring without marks of code."""
    return text.replace("``", "")
