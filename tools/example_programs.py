"""Runs the programs in `examples/` and writes their pages: ``python -m tools.example_programs``.

A page has the text of the program's docstring, the program, and what it printed.
"""

from __future__ import annotations

import ast
import re
import runpy
import warnings
from contextlib import chdir, redirect_stdout
from io import StringIO
from pathlib import Path
from tempfile import TemporaryDirectory

ROOT = Path(__file__).parents[1]
FOLDER = ROOT / "examples"
LOCAL = (
    "process",
    "two_lidars",
    "own_reader",
    "own_finding",
    "read_tiles",
    "cut_slices",
    "evaluate",
)
"""Programs that work in a folder with ``recording/``; those after the first need its ``walk/``."""
REMOTE = ("http_client", "mcp_client")
"""They need a server; `tests/service/test_client_example.py` and `test_assistant_http.py` there
run them."""
SECONDS = 10.0
"""Length of the walk in the pages [s]."""
_HOW = {
    True: "In a folder with a recording (`recon4 simulate office recording --seconds 10 --no-bag` "
    "makes one):",
    False: "With a server that runs, as `recon4 serve .`:",
}


def run(name: str, folder: Path) -> str:
    """What a program prints in a folder; a warning is an error, as everything it raises."""
    printed = StringIO()
    with chdir(folder), redirect_stdout(printed), warnings.catch_warnings():
        warnings.simplefilter("error")
        runpy.run_path(str(FOLDER / f"{name}.py"), run_name="__main__")
    return printed.getvalue()


def page_path(name: str) -> Path:
    """The page of a program."""
    return ROOT / "docs" / "examples" / f"{name.replace('_', '-')}.md"


def page(name: str, output: str) -> str:
    """The text of a page."""
    source = (FOLDER / f"{name}.py").read_text("utf-8")
    documented = ast.get_docstring(ast.parse(source)) or ""
    title, _, text = documented.partition("\n\n")
    program = source[source.index('"""', source.index('"""') + 3) + 3 :].strip()
    parts = [f"# {title.rstrip('.')}", text.strip("\n")]
    if name not in REMOTE:
        parts += [_HOW[True], f"```sh\npython examples/{name}.py\n```"]
    parts += [f"```python\n{program}\n```"]
    if output:
        parts += ["It prints:", f"```\n{output.strip()}\n```"]
    parts += ["All examples: [Python](../reference/python.md#examples)."]
    return "\n\n".join(parts) + "\n"


def without_figures(text: str) -> str:
    """A text with a mark for each number and each verdict: these differ from walk to walk."""
    same = re.sub(r"^verdict: .*(?:\n  .*)*", "verdict: …", text, flags=re.MULTILINE)
    return re.sub(r"-?\d+(?:\.\d*)?", "0", same)


def main() -> None:
    """Simulate a walk, run every program on it, write the pages."""
    from recon4 import api

    with TemporaryDirectory() as made:
        folder = Path(made)
        api.simulate("office", folder / "recording", seconds=SECONDS)
        for name in LOCAL:
            page_path(name).write_text(page(name, run(name, folder)), "utf-8")
    for name in REMOTE:
        page_path(name).write_text(page(name, ""), "utf-8")


if __name__ == "__main__":
    main()
