"""Compile the tests as pytest does: ``python -m tools.rewritten_tests``.

pytest rewrites the assertions of each test file and keeps the result beside the file. Processes
that begin at once on a fresh clone would each rewrite all of them. It offers no function for that:
those used here are its own, of the version that the lock file names.
"""

from __future__ import annotations

from pathlib import Path
from types import SimpleNamespace
from typing import Any

from _pytest.assertion import rewrite

ROOT = Path(__file__).parents[1]
STATE: Any = SimpleNamespace(trace=print)
CONFIG: Any = None
"""Without one no hook is called for assertions that hold, which is also the default of a run."""


def main() -> None:
    """Rewrite the files that changed since the last time."""
    for path in (ROOT / "tests").rglob("*.py"):
        if path.stem == "conftest" or path.stem.startswith("test_"):
            _rewrite(path)


def _rewrite(path: Path) -> None:
    folder = rewrite.get_cache_dir(path)
    kept = folder / f"{path.stem}{rewrite.PYC_TAIL}"
    if rewrite._read_pyc(path, kept) is None:
        rewrite.try_makedirs(folder)
        source_hash, code = rewrite._rewrite_test(path, CONFIG)
        rewrite._write_pyc(STATE, code, source_hash, kept)


if __name__ == "__main__":
    main()
