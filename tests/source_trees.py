"""Syntax trees of those files of the product that hold a text: to parse all takes seconds."""

import ast
import re
from collections.abc import Iterable, Iterator
from pathlib import Path

ROOT = Path(__file__).parents[1]


def sources(*tops: str) -> list[Path]:
    """The Python files of folders, ``recon4`` for example, in a fixed order."""
    return [path for top in tops for path in sorted((ROOT / top).rglob("*.py"))]


def trees_with(text: str, paths: Iterable[Path]) -> Iterator[tuple[Path, ast.Module]]:
    """Path and tree of each file that holds what is looked for.

    Args:
        text: Regular expression that the source has to match somewhere.
        paths: The files to look into.
    """
    wanted = re.compile(text)
    for path in paths:
        source = path.read_text("utf-8")
        if wanted.search(source):
            yield path, ast.parse(source)
