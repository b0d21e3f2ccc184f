"""Which unit tests a change needs, for ``make quick``: ``python -m tools.touched`` prints them.

A room is tested by the folder or the files of its name: `recon4/mapping/` by
`tests/unit/mapping/`, `recon4/settings/` by `tests/unit/test_settings*.py`. What a change breaks
elsewhere, ``make test`` says.
"""

from __future__ import annotations

import subprocess
import sys
from collections.abc import Iterable
from pathlib import Path, PurePosixPath

ROOT = Path(__file__).parents[1]
UPSTREAM = "origin/main"
RULES = (
    *("contributing", "docs", "http_types", "language", "languages"),
    *("layers", "settings", "structure"),
)
ALWAYS = tuple(f"tests/unit/test_{name}.py" for name in RULES)
"""What any change can break."""
OF_TOP = {"app": "app", "web": "web", "examples": "api"}
"""Folders that are a room as a whole -> its name in `tests/unit`."""


def touched(root: Path = ROOT) -> list[str]:
    """Files that differ from `UPSTREAM`; if none does, those of the last commit.

    New files count unless git ignores them; without the branch the working folder is compared with
    the last commit.
    """
    base = _git(root, "merge-base", UPSTREAM, "HEAD") or ["HEAD"]
    changed = _git(root, "diff", "--name-only", *base)
    changed += _git(root, "ls-files", "--others", "--exclude-standard")
    return sorted(changed or _git(root, "diff", "--name-only", "HEAD~1"))


def _git(root: Path, *arguments: str) -> list[str]:
    """Lines of the output of git; none if it fails."""
    command = ["git", *arguments]
    return subprocess.run(command, cwd=root, capture_output=True, text=True).stdout.splitlines()


def mirrors_of(file: str, root: Path = ROOT) -> list[str]:
    """Paths of the unit tests that mirror a file; none if there are none of its name."""
    parts = PurePosixPath(file).parts
    if parts[:2] == ("tests", "unit"):
        return _changed_test(PurePosixPath(file), root)
    if len(parts) < 2 or parts[0] not in {"recon4", "tools", *OF_TOP}:
        return []
    room = OF_TOP.get(parts[0]) or parts[1].removesuffix(".py")
    folder = root / "tests" / "unit"
    places = [folder / room, *sorted(folder.glob(f"test_{room}*.py"))]
    return [path.relative_to(root).as_posix() for path in places if path.exists()]


def _changed_test(file: PurePosixPath, root: Path) -> list[str]:
    """A changed test itself; for what the tests of a room share, all of them."""
    path = file if file.name.startswith("test_") else file.parent
    is_room = path.parts != ("tests", "unit")
    return [path.as_posix()] if is_room and (root / path).exists() else []


def without_those_below(paths: Iterable[str]) -> list[str]:
    """Each path once, and none that lies in a folder that is there as well."""
    chosen = dict.fromkeys(paths)
    return [
        path
        for path in chosen
        if not any(str(above) in chosen for above in PurePosixPath(path).parents)
    ]


def main() -> None:
    """Print the paths of the tests, a line each; sources without a test of their name to stderr."""
    found = list(ALWAYS)
    for file in touched():
        tests = mirrors_of(file)
        found += tests
        if not tests and file.startswith(("recon4/", "app/recon4_app/")) and file.endswith(".py"):
            print(f"no unit test has the name of {file}: make test covers it", file=sys.stderr)
    print("\n".join(without_those_below(found)))


if __name__ == "__main__":
    main()
