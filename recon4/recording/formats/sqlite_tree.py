"""Check that the pages of an SQLite table form a tree, before SQLite walks through them.

Inner pages that name one page many times make a table endless. If its leaves are empty, SQLite
goes through all of them inside a single step, in which it can be neither limited nor interrupted.
File format: https://www.sqlite.org/fileformat2.html, section 1.6.
"""

from __future__ import annotations

import os
from pathlib import Path

from recon4.errors import CorruptFile
from recon4.locales.coded import CodedText

_INNER_TABLE = 5
_HEADER_BYTES = 12
_MAX_DEPTH = 20
"""As in SQLite."""


def check_table_tree(path: Path, root: int, page_bytes: int) -> None:
    """Check the tree of one table, by its inner pages; leaves are read by SQLite.

    Pages behind the end of a file that is cut off are left to SQLite as well.

    Args:
        path: The database.
        root: Number of the root page, from 1.
        page_bytes: Size of a page.

    Raises:
        CorruptFile: If a page is named twice or the tree is deeper than 20 levels.
    """
    pages = path.stat().st_size // page_bytes
    seen = bytearray(pages + 1)
    level, depth = [root], 0
    file = os.open(path, os.O_RDONLY)
    try:
        while level:
            depth += 1
            following = []
            for number in level:
                if not 0 < number <= pages:
                    continue
                if seen[number] or depth > _MAX_DEPTH:
                    raise CorruptFile(
                        CodedText("db3-tree", file=path.name, number=number, depth=depth)
                    )
                seen[number] = 1
                following += _children(file, number, page_bytes)
            level = following
    finally:
        os.close(file)


def _children(file: int, number: int, page_bytes: int) -> list[int]:
    """Numbers of the pages below an inner page; none of a leaf."""
    start = (number - 1) * page_bytes
    at = start + (100 if number == 1 else 0)
    header = os.pread(file, _HEADER_BYTES, at)
    if len(header) < _HEADER_BYTES or header[0] != _INNER_TABLE:
        return []
    cells = int.from_bytes(header[3:5], "big")
    page = os.pread(file, page_bytes, start)
    pointers = at - start + _HEADER_BYTES
    found = [int.from_bytes(header[8:12], "big")]
    for k in range(min(cells, page_bytes // 2)):
        place = pointers + 2 * k
        cell = int.from_bytes(page[place : place + 2], "big")
        found.append(int.from_bytes(page[cell : cell + 4], "big"))
    return found
