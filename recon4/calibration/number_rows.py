"""Rows of numbers in a text file of a person."""

from __future__ import annotations

from pathlib import Path

import numpy as np

from recon4.errors import CorruptFile
from recon4.geometry.se3 import Array
from recon4.locales.coded import CodedText
from recon4.untrusted.bounded import read_text_limited


def read_number_rows(path: Path, columns: str, *, most_bytes: int) -> Array:
    """The numbers of each line, (N, C). Commas or blanks separate them; ``#`` begins a comment.

    Args:
        path: The file.
        columns: Names of the columns, with blanks between.
        most_bytes: Largest size of the file.

    Raises:
        CorruptFile: If a line has another number of values, or one is no finite number.
    """
    names, rows = columns.split(), []
    text = read_text_limited(path, most_bytes, failure=CorruptFile)
    for number, line in enumerate(text.splitlines(), 1):
        words = line.partition("#")[0].replace(",", " ").split()
        if not words:
            continue
        try:
            values = [float(word) for word in words]
        except ValueError:
            values = []
        if len(values) != len(names) or not np.isfinite(values).all():
            raise CorruptFile(
                CodedText(
                    "number-rows",
                    file=path.name,
                    number=number,
                    count=len(names),
                    columns=columns,
                    line=line[:60],
                )
            )
        rows.append(values)
    return np.array(rows).reshape(-1, len(names))
