"""What the small files of a project folder say of it; a page shows the readable rest."""

from __future__ import annotations

from pathlib import Path
from typing import Any

from recon4.errors import StoreError
from recon4.locales.coded import CodedText
from recon4.review.approval_state import ApprovalState, approval_state, not_valid
from recon4.review.state import artifact_keys
from recon4.store.earlier_names import SUMMARY, current_names
from recon4.store.json_files import read_object
from recon4.untrusted.names import visible
from recon4_app.projects.tuning import PROJECT_LIST


def summary_of(folder: Path) -> tuple[dict[str, object], str]:
    """``summary.json`` with current names, and the problem with it."""
    summary, problem = object_of(folder, "summary.json")
    return current_names(summary, SUMMARY), problem


def object_of(folder: Path, name: str) -> tuple[dict[str, object], str]:
    """A JSON object and the problem with its file; a page shows the readable rest."""
    path = folder / name
    if not path.exists():
        return {}, ""
    try:
        return read_object(path), ""
    except StoreError as error:
        problem = str(error).replace(f"{folder}/", "")
        return {}, visible(problem, most=PROJECT_LIST.max_problem)


def rig_name(rig: Any) -> str:
    return visible(str(rig.get("name", "")) if isinstance(rig, dict) else str(rig or ""))


def shown_name(facts: dict[str, object], folder: Path) -> str:
    return visible(str(facts.get("name") or folder.name))


def approval_in(folder: Path, summary: dict[str, object]) -> ApprovalState:
    """State of the approval of the files of a project."""
    try:
        return approval_state(folder, artifact_keys(summary))
    except StoreError as error:
        return not_valid(CodedText("approval-unreadable"), error)


def tags_of(facts: dict[str, object]) -> tuple[str, ...]:
    """Tags that people gave a project."""
    found = facts.get("tags")
    texts = [one for one in found if isinstance(one, str)] if isinstance(found, list) else []
    return tuple(map(visible, texts[: PROJECT_LIST.max_tags]))
