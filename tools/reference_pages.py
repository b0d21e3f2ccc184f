"""Pages of the reference that are made from the code: ``python -m tools.reference_pages``.

Commands from the command line itself, the Python interface from its docstrings, routes from the
server's OpenAPI description, codes of errors from the catalog of texts.
"""

from __future__ import annotations

import inspect
import re
from collections.abc import Iterator
from pathlib import Path
from typing import Any

from typer.main import get_command

from tools.http_types import described
from tools.problem_codes import problems_page

FOLDER = Path(__file__).parents[1] / "docs" / "reference"
MADE = "Made from the code by `make docs`; do not edit."


def commands_page() -> str:
    """All commands with their arguments and options."""
    from recon4.cli.main import app

    parts = ["# Commands", MADE, "`recon4 COMMAND --help` says the same on the terminal."]
    return "\n\n".join([*parts, *_commands(get_command(app), "recon4")]) + "\n"


def _commands(command: Any, name: str) -> Iterator[str]:
    below = getattr(command, "commands", {})
    if not below:
        yield _command(command, name)
    for key in sorted(below):
        yield from _commands(below[key], f"{name} {key}")


def _command(command: Any, name: str) -> str:
    # Typer has arguments of its own in place of those of click.
    arguments = [one for one in command.params if one.param_type_name == "argument"]
    options = [one for one in command.params if one.param_type_name == "option"]
    words = [f"{one.name}{'…' if one.nargs < 0 else ''}".upper() for one in arguments]
    usage = " ".join([name, *words, *(["[OPTIONS]"] if options else [])])
    parts = [f"## {name}", inspect.cleandoc(command.help or ""), f"```\n{usage}\n```"]
    rows = [_row(word, one) for word, one in zip(words, arguments, strict=True)]
    rows += [_row(", ".join([*one.opts, *one.secondary_opts]), one) for one in options]
    if rows:
        parts.append("\n".join(["| | default | |", "|---|---|---|", *rows]))
    return "\n\n".join(parts)


def _row(name: str, parameter: Any) -> str:
    """Name, default and meaning of a parameter as a row of a table."""
    default = parameter.default
    unset = (
        callable(default) or default in (None, False, (), [], ...) or "Sentinel" in repr(default)
    )
    shown = "required" if parameter.required else "" if unset else f"`{default}`"
    return f"| `{name}` | {shown} | {_cell(getattr(parameter, 'help', None) or '')} |"


def _cell(text: str) -> str:
    return " ".join(text.split()).replace("|", "\\|")


def python_page() -> str:
    """The names of `recon4.api` with their signatures and docstrings."""
    from recon4 import api

    parts = ["# The Python interface", MADE, "How to begin: [Python](python.md)."]
    return "\n\n".join([*parts, *(_name(one, getattr(api, one)) for one in api.__all__)]) + "\n"


def _name(name: str, found: Any) -> str:
    if inspect.ismodule(found):
        return f"## {name}\n\n```text\n{inspect.getdoc(found)}\n```"
    text = inspect.getdoc(found) or ""
    parts = [f"## {name}", f"```text\n{name}{_signature(found)}\n\n{text}\n```"]
    if inspect.isclass(found):
        parts += [
            f"**{name}.{key}**\n\n```text\n{inspect.getdoc(member)}\n```"
            for key, member in inspect.getmembers(found)
            if not key.startswith("_") and key in vars(found) and inspect.getdoc(member)
            if inspect.isfunction(member) or isinstance(member, property)
        ]
    return "\n\n".join(parts)


def _signature(found: Any) -> str:
    text = str(inspect.signature(found))
    plain = re.sub(r"(: |-> )'([^']*)'", r"\1\2", text)  # annotations are kept as texts
    return re.sub(r"(?:pathlib|collections\.abc|typing|recon4(?:\.\w+)+)\.", "", plain)


def http_page() -> str:
    """All routes of the API with what they do and answer."""
    rows = []
    for path, methods in sorted(described()["paths"].items()):
        for method, route in methods.items():
            rows.append(f"| `{method.upper()} {path}` | {_cell(_first(route))} |")
    parts = ["# Routes of the HTTP API", MADE, "How to use them: [the HTTP API](api.md)."]
    table = "\n".join(["| route | |", "|---|---|", *rows])
    return "\n\n".join([*parts, table]) + "\n"


def _first(route: dict[str, str]) -> str:
    """The first sentence of the description of a route."""
    text = route.get("description") or route.get("summary") or ""
    return text.split("\n\n")[0]


def lidars_page() -> str:
    """The facts of all models of LiDAR, and what they were compared with."""
    from recon4.model.lidars import CHECKED, LIDARS

    head = (
        "| model | maker | beams | view ° | from m | range m | deviation cm | beam mrad "
        "| compared with |"
    )
    rows = [
        f"| {m.name} | {m.maker} | {m.beams or ''} | {m.azimuth_deg:g} x "
        f"{m.elevation_deg[0]:g} to {m.elevation_deg[1]:g} | {m.min_range_m:g} | {m.range_m:g} "
        f"| {100.0 * m.range_sd_m:g} | {1000.0 * m.divergence_rad:g} | {CHECKED.get(m.name, '')} |"
        for m in LIDARS.values()
    ]
    table = "\n".join([head, "|---|---|---:|---|---:|---:|---:|---:|---|", *rows])
    return "\n\n".join(["# LiDARs", MADE, _LIDARS_TEXT, table]) + "\n"


_LIDARS_TEXT = """What recon4 knows of each model, from `recon4/model/lidars.py`.
Range: usual range at 10 % reflectivity. Deviation: standard deviation of a range; half of the
accuracy where the maker states only that. Beam: full divergence in its wider direction.

Rows without an entry in the last column are as remembered from the manuals: no copy was at hand.

| fact | who uses it |
|---|---|
| view | bands in which segments of sensors without rings are drawn |
| view, beams | cells in which moving objects are searched: as wide as rings are apart |
| from | nearer points are dropped and counted, as those of the carrier are |
| deviation | fitted surfaces (`map.range_noise_m`) from 1.5 cm on, the simulator |
| range, beam | the simulator |"""

PAGES = {
    "cli.md": commands_page,
    "http.md": http_page,
    "lidars.md": lidars_page,
    "problems.md": lambda: problems_page(MADE),
    "python-api.md": python_page,
}
"""Name of a page -> what makes it."""


def main() -> None:
    """Write all of them."""
    for name, made in PAGES.items():
        (FOLDER / name).write_text(made(), "utf-8")


if __name__ == "__main__":
    main()
