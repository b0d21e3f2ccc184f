"""Sentences of the documentation that are too long: ``python -m tools.sentences`` lists them.

Tables, code, headings and the studies, which are notes, do not count.
"""

from __future__ import annotations

import re
from pathlib import Path

DOCS = Path(__file__).parents[1] / "docs"
MAX_WORDS = 35
NOTES = ("studies", "examples")
"""Folders of notes and of programs."""
_CODE = re.compile(r"^```.*?^```|^ {4}(?! *[-*\d|]).*?$", re.MULTILINE | re.DOTALL)
_BLOCK = re.compile(r"\n\s*\n|\n(?=\s*(?:[-*]|\d+\.) )|\n(?=\|)")
_END = re.compile(r"(?<=[.!?:;])[\"”*)]*\s+(?=[\"“(*`\[]*[A-ZÄÖÜ0-9`_‹])|(?<=[.!?])\s*$")


def sentences(markdown: str) -> list[str]:
    """The sentences of a page; a colon or semicolon with a capital behind it ends one, too."""
    prose = re.sub(r"`[^`\n]+`", "`code`", _CODE.sub("", markdown))
    prose = re.sub(r"\]\([^)]*\)", "]", prose)
    blocks = [one for one in _BLOCK.split(prose) if not re.match(r"\s*(?:\||#|!\[|<)", one)]
    return [part.strip() for one in blocks for part in _END.split(" ".join(one.split())) if part]


def words(sentence: str) -> int:
    """Words of a sentence; code between backticks is one word."""
    return len(re.findall(r"\S*\w\S*", re.sub(r"`[^`]*`", "code", sentence)))


def too_long() -> dict[str, list[str]]:
    """Page -> its sentences above `MAX_WORDS`."""
    found = {}
    for page in sorted(DOCS.rglob("*.md")):
        name = page.relative_to(DOCS).as_posix()
        if name.split("/")[0] not in NOTES:
            found[name] = [s for s in sentences(page.read_text("utf-8")) if words(s) > MAX_WORDS]
    return {name: long for name, long in found.items() if long}


if __name__ == "__main__":
    for name, long in too_long().items():
        for one in long:
            print(f"{name}: {words(one)}: {one}")
