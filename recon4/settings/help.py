"""Every setting with its meaning, read from the one place where it is declared."""

from __future__ import annotations

import ast
import inspect
from dataclasses import dataclass, fields
from itertools import pairwise
from typing import Any, get_args, get_type_hints

from recon4.settings import PRESETS, Settings, values_by_group
from recon4.settings.require import ValueRange, range_of


@dataclass(frozen=True, slots=True)
class SettingHelp:
    """One setting."""

    group: str
    name: str
    kind: str
    """Allowed values: ``int``, ``float``, ``text``, or the choices."""
    limits: ValueRange | None
    """Of numbers."""
    default: Any
    text: str
    """Meaning and unit; empty if the name is sufficient."""

    @property
    def values(self) -> str:
        """What it may be: range and unit, or the choices."""
        return f"{self.limits} {self.limits.unit}".rstrip() if self.limits else self.kind

    @property
    def path(self) -> str:
        """What ``--set`` takes."""
        return f"{self.group}.{self.name}"


@dataclass(frozen=True, slots=True)
class GroupHelp:
    """The settings of one stage."""

    name: str
    text: str
    settings: tuple[SettingHelp, ...]


def describe_settings() -> tuple[GroupHelp, ...]:
    """All groups in the order they are declared."""
    return tuple(_group(f.name) for f in fields(Settings))


def differences(settings: Settings) -> dict[str, object]:
    """``group.field`` -> value of what is not as by default."""
    chosen, default = values_by_group(settings), values_by_group(Settings())
    return {
        f"{group}.{name}": value
        for group, values in chosen.items()
        for name, value in values.items()
        if value != default[group][name]
    }


def markdown() -> str:
    """``docs/reference/settings.md``."""
    parts = [
        "# Settings",
        "",
        "Written by `recon4 settings --markdown` from `recon4/settings/`; do not edit.",
        "Change one with `--set group.name=value`, many with `--preset`.",
        "What only an expert would change is *tuning*: a record beside its algorithm.",
        "A setting of an earlier version that is tuning now is accepted at its value; at another",
        "one it is refused, or announced if a finished project was made with it.",
        "",
        "## Presets",
        "",
        "| preset | differs from the defaults in |",
        "|---|---|",
    ]
    for name, settings in PRESETS.items():
        changed = ", ".join(
            f"`{path}={_shown(value)}`" for path, value in differences(settings).items()
        )
        parts.append(f"| `{name}` | {changed or 'nothing'} |")
    for group in describe_settings():
        parts += ["", f"## {group.name}", "", group.text, "", "| setting | value | default | |"]
        parts.append("|---|---|---|---|")
        for s in group.settings:
            parts.append(f"| `{s.path}` | {s.values} | `{_shown(s.default)}` | {_cell(s.text)} |")
    return "\n".join(parts) + "\n"


def _group(name: str) -> GroupHelp:
    kind = get_type_hints(Settings)[name]
    hints, texts = get_type_hints(kind), _texts_under_fields(kind)
    ranges = {n: range_of(h) for n, h in get_type_hints(kind, include_extras=True).items()}
    settings = tuple(
        SettingHelp(
            group=name,
            name=f.name,
            kind=_kind(hints[f.name]),
            limits=ranges[f.name],
            default=f.default,
            text=texts.get(f.name, ""),
        )
        for f in fields(kind)
    )
    return GroupHelp(name, inspect.getdoc(kind) or "", settings)


def _texts_under_fields(kind: type) -> dict[str, str]:
    """Field -> the string that stands under it; Python itself does not keep those."""
    declaration = ast.parse(inspect.getsource(kind)).body[0]
    assert isinstance(declaration, ast.ClassDef)
    return _texts_in(declaration.body)


def _texts_in(body: list[ast.stmt]) -> dict[str, str]:
    found = {}
    for field, below in pairwise(body):
        match field, below:
            case ast.AnnAssign(target=ast.Name(id=name)), ast.Expr(
                value=ast.Constant(value=str(text))
            ):
                found[name] = " ".join(text.split())
    return found


def _kind(hint: Any) -> str:
    choices = get_args(hint)
    if choices:
        return ", ".join(f"`{choice}`" for choice in choices)
    return {"str": "text", "bool": "`true`, `false`"}.get(hint.__name__, hint.__name__)


def _shown(value: Any) -> str:
    if isinstance(value, bool):
        return str(value).lower()
    return str(value) if value != "" else '""'


def _cell(text: str) -> str:
    return text.replace("``", "`").replace("|", "\\|")
