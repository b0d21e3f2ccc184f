"""Messages reach pages as well as terminals: what only a command does is named as such."""

import ast
import re
from collections.abc import Iterator
from pathlib import Path

import pytest

from tests.source_trees import sources, trees_with

ROOT = Path(__file__).parents[2]
OPTION = re.compile(r"(?<![\w-])--[a-z]")
OF_COMMANDS = (
    *("recon4/cli/", "app/recon4_app/cli/", "recon4/system/doctor.py", "recon4/cli/terminal.py"),
    *("recon4/settings/help.py", "recon4/archive/backup.py"),
    *(
        "app/recon4_app/settings.py",
        "app/recon4_app/network/",
        "app/recon4_app/access/startup_notice.py",
        "app/recon4_app/access/restoring.py",
    ),
)
"""Their messages appear in the terminal where a command was given, or the server started."""


def texts(tree: ast.Module) -> Iterator[tuple[int, str]]:
    """Line and text of each string of a module, except docstrings; a field of one is ``{}``."""
    alone = {id(node.value) for node in ast.walk(tree) if isinstance(node, ast.Expr)}
    within = {
        id(part)
        for node in ast.walk(tree)
        if isinstance(node, ast.JoinedStr)
        for part in node.values
    }
    for node in ast.walk(tree):
        if isinstance(node, ast.JoinedStr):
            parts = (one.value if isinstance(one, ast.Constant) else "{}" for one in node.values)
            yield node.lineno, "".join(map(str, parts))
        elif isinstance(node, ast.Constant) and id(node) not in alone | within:
            yield node.lineno, str(node.value)


def modules() -> list[Path]:
    return [
        path
        for path in sources("recon4", "app")
        if not str(path.relative_to(ROOT)).startswith(OF_COMMANDS)
    ]


def unnamed(text: str) -> bool:
    """Whether a text has an option without the word *command*; an option alone is no message."""
    return bool(OPTION.search(text)) and not text.startswith("--") and "command" not in text


def test_a_message_with_an_option_says_that_it_is_of_a_command():
    found = [
        f"{path.relative_to(ROOT)}:{line}: {text[:100]}"
        for path, tree in trees_with("--", modules())
        for line, text in texts(tree)
        if unnamed(text)
    ]

    assert found == []


@pytest.mark.parametrize(
    ("text", "is_unnamed"),
    [
        ("give a rig file (--rig)", True),
        ("give a rig (page: field Rig; command: --rig)", False),
        ("--rig", False),
        ("in a-b--c", False),
    ],
)
def test_the_check_knows_an_option_from_a_dash(text, is_unnamed):
    assert unnamed(text) == is_unnamed
