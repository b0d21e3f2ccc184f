"""The block of the report with the approval of the map."""

from __future__ import annotations

import re
from collections.abc import Iterable, Mapping
from html import escape

from recon4.model.usability import Usability

_BEGIN, _END = "<!-- approval -->", "<!-- /approval -->"
_LAST = f"</ul></section>{_END}"
_BLOCK = re.compile(f"{re.escape(_BEGIN)}.*?{re.escape(_END)}", re.DOTALL)

_LEVELS: dict[str, str] = {
    "": "good",  # of an earlier version, which signed no verdict
    Usability.GOOD: "good",
    Usability.CHECK: "warning",
    Usability.DO_NOT_USE: "bad",
}


def draft_block() -> str:
    """HTML for a map without approval."""
    return _block("note", "draft", "Not approved by anybody.")


def approved_block(stamp: Mapping[str, object]) -> str:
    """HTML for an approved map, from the fields of its stamp; all of them are escaped.

    A map approved in spite of its verdict says so, with the reason of the signer.
    """
    text = {name: escape(str(value)) for name, value in stamp.items()}
    verdict = text.get("verdict", "")
    day = text["time"][:16].replace("T", " ")
    words = [
        f"Version {text['version']}, approved by {text['who']} ({text['role']}) on {day} UTC.",
        f"Verdict on the map when it was approved: {verdict}." if verdict else "",
        f"Reason of the signer: “{text['why']}”." if "why" in text else "",
        f'Approval <span class="hash">{text["hash"]}</span>, signed in '
        f"versions/{text['version']}/approval.json.",
    ]
    return _block(_LEVELS.get(verdict, "note"), "approved", " ".join(filter(None, words)))


def replace_block(page: str, block: str) -> str:
    """Replace the block of a report; append it if there is none."""
    if _BLOCK.search(page):
        return _BLOCK.sub(lambda _: block, page, count=1)
    return page + block


def add_to_block(page: str, lines: Iterable[str]) -> str:
    """Add notes of reviewers, HTML each, to the block; escaping is up to the caller."""
    items = "".join(f'<li><b class="note">acknowledged</b>{line}</li>' for line in lines)
    return page.replace(_LAST, items + _LAST, 1)


def is_draft(page: str) -> bool:
    """Whether a report, or its first part, says that nobody approved the map."""
    return draft_block() in page


def _block(level: str, mark: str, words: str) -> str:
    return (
        f'{_BEGIN}<section class="verdict {level}"><ul>'
        f'<li><b class="{level}">{mark}</b>{words}</li>{_LAST}'
    )
