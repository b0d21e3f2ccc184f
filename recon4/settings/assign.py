"""Settings as text: assignments of the command line, JSON, the canonical form that is hashed."""

from __future__ import annotations

import json
import re
from dataclasses import asdict, fields, is_dataclass, replace
from typing import Any, get_args, get_type_hints

from recon4.errors import ConfigError, WrongSettings
from recon4.locales.coded import CodedText, text_of
from recon4.settings.presets import Settings
from recon4.settings.renamed import RENAMED, Retired, retired


def override(settings: Settings, assignments: list[str]) -> Settings:
    """Apply assignments ``group.field=value``; the last one of a field counts.

    Raises:
        WrongSettings: Names every wrong setting with the expected and the given value.
    """
    problems: dict[str, str] = {}
    values: dict[str, dict[str, object]] = {}
    for text in assignments:
        path, _, value = (part.strip() for part in text.partition("="))
        try:
            if fixed := _retired(path):
                _check_fixed(fixed, path, value)
                continue
            group, name, kind = _find(settings, text)
            values.setdefault(group, {})[name] = _parse(value, kind, path)
        except ConfigError as error:
            problems[path] = text_of(error)
    changed = {
        group: _replaced(getattr(settings, group), group, fresh, problems=problems)
        for group, fresh in values.items()
    }
    if problems:
        raise WrongSettings(problems)
    return replace(settings, **changed)


def _retired(path: str) -> Retired | None:
    group, _, name = path.partition(".")
    return retired().get((group, RENAMED.get((group, name), name)))


def _check_fixed(fixed: Retired, path: str, text: str) -> None:
    """Accept the assignment of a retired setting that changes nothing.

    Raises:
        ConfigError: If it changes something.
    """
    said = fixed.changed(path, _parse(text, type(fixed.value), path))
    if said:
        raise ConfigError(said)


def _find(settings: Settings, text: str) -> tuple[str, str, Any]:
    """Group, name and type of the setting of an assignment."""
    path, sign, _ = text.partition("=")
    group_name, dot, name = path.strip().partition(".")
    if not sign or not dot:
        raise ConfigError(CodedText("setting-form", got=f"{text!r}"))
    if group_name not in _names(settings):
        raise ConfigError(
            CodedText("setting-group-unknown", group=f"{group_name!r}", known=str(_names(settings)))
        )
    group = getattr(settings, group_name)
    if (group_name, name) in RENAMED:
        fresh = f"{group_name}.{RENAMED[group_name, name]}"
        raise ConfigError(CodedText("setting-renamed", setting=path, name=f"{fresh!r}"))
    if name not in _names(group):
        raise ConfigError(
            CodedText(
                "setting-unknown", setting=f"{path!r}", group=group_name, known=str(_names(group))
            )
        )
    return group_name, name, get_type_hints(type(group))[name]


def _replaced(group: Any, name: str, values: dict[str, object], *, problems: dict[str, str]) -> Any:
    """The group with other values; invalid ones are skipped and added to ``problems``."""
    left = dict(values)
    while left:
        try:
            return replace(group, **left)
        except ConfigError as error:
            # A rule may name two fields: the error is assigned to the first given one.
            message = text_of(error)
            named = [field for field in re.findall(r"\w+", message) if field in left]
            wrong = named[0] if named else next(iter(left))
            problems[f"{name}.{wrong}"] = message
            del left[wrong]
    return group


def to_json(settings: object) -> dict[str, object]:
    """Plain JSON values of a group or of all settings."""
    assert is_dataclass(settings) and not isinstance(settings, type)
    return asdict(settings)


def values_by_group(settings: Settings) -> dict[str, dict[str, object]]:
    """Plain JSON values of all settings, by group."""
    return {group.name: to_json(getattr(settings, group.name)) for group in fields(settings)}


def canonical(settings: object) -> str:
    """Canonical JSON of settings: equal settings give equal text. Stage keys are hashed from it."""
    return json.dumps(to_json(settings), sort_keys=True, separators=(",", ":"))


def _parse(text: str, kind: Any, path: str) -> Any:
    choices = get_args(kind)
    if choices:
        if text not in choices:
            raise ConfigError(
                CodedText(
                    "setting-choice", setting=path, choices=", ".join(choices), got=f"{text!r}"
                )
            )
        return text
    if kind is bool:
        if text.lower() not in {"true", "false"}:
            raise ConfigError(CodedText("setting-true-false", setting=path, got=f"{text!r}"))
        return text.lower() == "true"
    try:
        return kind(text)
    except ValueError as error:
        raise ConfigError(
            CodedText("setting-type", setting=path, type=kind.__name__, got=f"{text!r}")
        ) from error


def _names(group: object) -> list[str]:
    assert is_dataclass(group)
    return [f.name for f in fields(group)]
