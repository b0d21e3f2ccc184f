"""Whether the results of a project include the decisions in force."""

from __future__ import annotations

from pathlib import Path
from typing import Any

from recon4.errors import StoreError
from recon4.locales.coded import CodedText
from recon4.review.decisions import NOTHING_DECIDED, joined_key
from recon4.review.tuning import SUMMARIES
from recon4.store.earlier_names import SUMMARY, current_names
from recon4.store.json_files import read_object
from recon4.store.stage import read_manifest


def read_summary(root: Path) -> dict[str, Any] | None:
    """``summary.json`` of the latest finished run; None if there is none.

    Raises:
        StoreError: If it is damaged.
    """
    path = root / "summary.json"
    if not path.is_file():
        return None
    return current_names(read_object(path, max_bytes=SUMMARIES.max_summary_bytes), SUMMARY)


def artifact_keys(summary: dict[str, Any]) -> dict[str, str]:
    """Stage -> key of the artifact behind the results."""
    try:
        return {str(one["stage"]): str(one["key"]) for one in summary.get("stages", [])}
    except (TypeError, KeyError) as error:
        raise StoreError(CodedText("summary-stages-unreadable", why=repr(error))) from error


def decisions_in_map(root: Path) -> str | None:
    """`Decided.key` of the decisions in the results; None if there are no results.

    Raises:
        StoreError: If a file is damaged.
    """
    summary = read_summary(root)
    if summary is None:
        return None
    keys = artifact_keys(summary)
    pairs = _input(root, keys.get("review"), "decisions") or NOTHING_DECIDED.key
    control = _input(root, keys.get("level"), "control")
    return joined_key(pairs, control, _input(root, keys.get("map"), "corrections"))


def _input(root: Path, key: str | None, name: str) -> str | None:
    """Key of an input of an artifact; None = it has no such input, or there is no artifact."""
    if key is None:
        return None
    return read_manifest(root / "artifacts" / key)["recipe"]["inputs"].get(name)
