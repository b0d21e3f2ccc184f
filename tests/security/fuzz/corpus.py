"""Mutants that once ended as none may: ``found/<kind>--<what>`` each."""

from __future__ import annotations

from pathlib import Path

from tests.security.fuzz.kind import Reading
from tests.security.fuzz.kinds import KINDS

CORPUS = sorted((Path(__file__).parent / "found").iterdir())


def read_kind(path: Path, folder: Path) -> Reading:
    """Read a file of the corpus as the kind its name begins with."""
    kind = KINDS[path.name.partition("--")[0]]
    kind.prepare(folder)
    (folder / kind.file_name).write_bytes(path.read_bytes())
    return kind.read(folder / kind.file_name)
