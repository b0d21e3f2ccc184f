"""Order and headings of the commands in ``recon4 --help``: by what a person wants to do."""

from __future__ import annotations

from typing import Any

from typer.core import TyperGroup

from recon4.cli.spoken import speak
from recon4.locales.languages import of_terminal

HEADINGS = {
    "From a recording to a map": (
        "info",
        "process",
        "batch",
        "calibrate",
        "settings",
    ),
    "Recordings": ("record", "replay", "convert", "simulate"),
    "In the browser": ("serve", "demo", "users", "keys", "mcp"),
    "Findings and accuracy": ("audit", "explain", "evaluate", "compare", "doubles", "control"),
    "Points, slices and drawings": (
        "slice",
        "targets",
        "classify",
        "plan",
        "orthophoto",
        "terrain",
        "volume",
    ),
    "For the client": ("export", "report", "deliver", "verify"),
    "Storage and this computer": ("storage", "backup", "restore", "doctor", "compile"),
}


class CommandGroup(TyperGroup):
    """All commands, under the headings of the table."""

    def __init__(self, **arguments: Any) -> None:
        super().__init__(**arguments)
        for heading, names in HEADINGS.items():
            for name in names:
                vars(self.commands[name])["rich_help_panel"] = heading

    def parse_args(self, ctx: Any, args: list[str]) -> list[str]:
        """Parse in the language of the environment; ``--language`` may name another one."""
        speak(ctx, of_terminal())
        return super().parse_args(ctx, args)

    def list_commands(self, ctx: Any) -> list[str]:
        """Names in the order of the table; one that is missing in it comes last."""
        placed = [name for names in HEADINGS.values() for name in names]
        return [*placed, *(name for name in self.commands if name not in placed)]
