"""Read the constants of our code for Hypothesis: ``python -m tools.code_constants``.

Hypothesis tries numbers and texts of the tested code as examples and keeps what it read of each
file. Processes that begin at once on a fresh clone would each read all of them. It offers no
function for that: the one used here is its own, of the version that the lock file names.
"""

from __future__ import annotations

from pathlib import Path
from types import ModuleType

from hypothesis.internal.constants_ast import constants_from_module

ROOT = Path(__file__).parents[1]


def main() -> None:
    """Read the files that changed since the last time."""
    for top in ("recon4", "app", "tools"):
        for path in (ROOT / top).rglob("*.py"):
            module = ModuleType(path.stem)
            module.__file__ = str(path)
            constants_from_module(module)


if __name__ == "__main__":
    main()
