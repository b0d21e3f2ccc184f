"""The file of the hypotheses that the odometry tried, in its artifact."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

import msgspec

from recon4.errors import StoreError
from recon4.locales.coded import CodedText
from recon4.model.tried_hypotheses import TriedHypothesis
from recon4.store.atomic import write_json
from recon4.store.json_files import read_object
from recon4.untrusted.typed import as_type

TABLE_FILE = "hypotheses.json"
"""In the folder of the stage ``odometry``; earlier versions have none."""


def write_tried(folder: Path, tried: Sequence[TriedHypothesis]) -> None:
    """Write the table into the folder of the stage ``odometry``."""
    write_json(folder / TABLE_FILE, {"tried": msgspec.to_builtins(tried)})


def read_tried(folder: Path) -> tuple[TriedHypothesis, ...]:
    """Read the table of the stage ``odometry``; empty if there is none.

    Raises:
        StoreError: If the file is damaged.
    """
    path = folder / TABLE_FILE
    if not path.exists():
        return ()
    try:
        return as_type(read_object(path).get("tried"), tuple[TriedHypothesis, ...])
    except msgspec.ValidationError as error:
        raise StoreError(CodedText("file-damaged", file=str(path), why=str(error))) from error
