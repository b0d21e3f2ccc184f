"""The block of the report with the approval of the map."""

from __future__ import annotations

import re
from html import escape

_BEGIN, _END = "<!-- approval -->", "<!-- /approval -->"
_BLOCK = re.compile(f"{re.escape(_BEGIN)}.*?{re.escape(_END)}", re.DOTALL)


def draft_block() -> str:
    """HTML for a map without approval."""
    return _block("note", "draft", "Not approved by anybody.")


def approved_block(*, version: int, who: str, role: str, time: str, hash: str) -> str:
    """HTML for an approved map; names are escaped."""
    shown = time[:16].replace("T", " ")
    return _block(
        "good",
        "approved",
        f"Version {version}, approved by {escape(who)} ({escape(role)}) on {escape(shown)} UTC. "
        f'Approval <span class="hash">{escape(hash)}</span>, signed in '
        f"versions/{version}/approval.json.",
    )


def replace_block(page: str, block: str) -> str:
    """Replace the block of a report; append it if there is none."""
    if _BLOCK.search(page):
        return _BLOCK.sub(lambda _: block, page, count=1)
    return page + block


def _block(level: str, mark: str, words: str) -> str:
    return (
        f'{_BEGIN}<section class="verdict {level}"><ul>'
        f'<li><b class="{level}">{mark}</b>{words}</li></ul></section>{_END}'
    )
