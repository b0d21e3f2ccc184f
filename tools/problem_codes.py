"""The page of all codes of the HTTP API: what each says in English, and its status.

The texts are those of the catalog. The status of a code is that of the errors which the code of
recon4 raises with it; the others have that of their route.
"""

from __future__ import annotations

import ast
from collections import defaultdict
from collections.abc import Iterator
from importlib import import_module
from pathlib import Path
from typing import TypeVar

from fluent.syntax import FluentParser
from fluent.syntax import ast as fluent

from recon4.errors import Recon4Error
from recon4.locales.coded import FILES, KINDS
from recon4.locales.languages import ENGLISH, ROOT
from recon4.locales.texts import messages_of, readable
from recon4_app.error_responses import FRAMEWORK_CODES
from recon4_app.errors import AppError

REPOSITORY = Path(__file__).parents[1]
INTRODUCTION = """Each error of the [HTTP API](api.md) has a `code`, which stays, and the `values` \
that its text quotes.
The text is `detail`, in the language of the request; here it is in English, with `‹values›`.
Reasons why a job ended are the `reason` of the job and have no status."""
_Error = TypeVar("_Error", bound=Exception)
TITLES = {
    "problems": "Problems of requests",
    "endings": "Reasons why jobs ended",
    "references": "What is said of references",
    "recordings": "What is said of recordings",
    "files": "What is wrong with files, settings and projects",
    "formats": "What is wrong with recordings, clouds, tables and models",
    "usage": "Wrong usage of commands",
    "results": "What is wrong with results, and with what commands are given",
}


def problems_page(made: str) -> str:
    """All codes by subject, with the status of their errors.

    Args:
        made: What is said about how the page is made.
    """
    statuses = statuses_of_codes()
    parts = ["# Codes of the HTTP API", made, INTRODUCTION]
    for file in FILES:
        parts.append(f"## {TITLES[file]}")
        for subject, names in _subjects(file):
            rows = [_row(file, name, statuses) for name in names]
            if rows:
                table = ["| code | status | text |", "|---|---|---|", *rows]
                parts += [f"### {subject}", "\n".join(table)]
    return "\n\n".join(parts) + "\n"


def statuses_of_codes() -> dict[str, set[int]]:
    """Code -> statuses of the errors that are raised with it."""
    status_of = {one.__name__: 422 for one in _below(Recon4Error)}
    import_module("recon4_app.main")  # it brings in every room that has errors
    status_of |= {one.__name__: one.status for one in _below(AppError)}
    found: dict[str, set[int]] = defaultdict(set)
    for status, code in FRAMEWORK_CODES.items():
        found[code].add(status)
    for kind, code in KINDS.items():
        found[code].add(status_of[kind.__name__])
    for room in ("recon4", "app"):
        for path in (REPOSITORY / room).rglob("*.py"):
            for error, code in _raised(ast.parse(path.read_text("utf-8"))):
                if error in status_of:
                    found[code].add(status_of[error])
    return found


def _below(base: type[_Error]) -> Iterator[type[_Error]]:
    yield base
    for one in base.__subclasses__():
        yield from _below(one)


def _raised(tree: ast.Module) -> Iterator[tuple[str, str]]:
    """Name of the class and code of each ``Error(CodedText("code", …))``."""
    for node in ast.walk(tree):
        match node:
            case ast.Call(
                func=ast.Name(id=error),
                args=[
                    ast.Call(
                        func=ast.Name(id="CodedText"), args=[ast.Constant(value=str(code)), *_]
                    ),
                    *_,
                ],
            ):
                yield error, code


def _subjects(file: str) -> Iterator[tuple[str, list[str]]]:
    """Subjects of a file of texts, with the codes of each."""
    subject, names = "General", list[str]()
    source = (ROOT / ENGLISH / f"{file}.ftl").read_text("utf-8")
    for one in FluentParser(with_spans=False).parse(source).body:
        if isinstance(one, fluent.GroupComment):
            yield subject, names
            subject, names = str(one.content), []
        elif isinstance(one, fluent.Message) and not one.id.name.startswith("word-"):
            names.append(one.id.name)
    yield subject, names


def _row(file: str, name: str, statuses: dict[str, set[int]]) -> str:
    pattern = messages_of(ROOT / ENGLISH / f"{file}.ftl")[name].value
    assert pattern is not None
    text = " ".join(readable(pattern).split()).replace("|", "\\|")
    status = ", ".join(str(one) for one in sorted(statuses.get(name, ())))
    return f"| `{name}` | {status} | {text} |"
