"""Cards of the list of projects, and an index of them that outlives the server.

A card is read from two small files, and again when one of them is another file than before: by
time, inode and size, which are looked up for every list. So the index is never stale. Cards of
approved maps are not kept on disk: their signatures are checked again by each server.
"""

from __future__ import annotations

import logging
from pathlib import Path
from typing import Any

import msgspec

from recon4.model.usability import Usability
from recon4.review.approval_state import NOT_APPROVED
from recon4.store.atomic import atomic_file, make_folders
from recon4.untrusted.names import visible
from recon4.untrusted.typed import decoded
from recon4_app.projects.described import (
    approval_in,
    object_of,
    rig_name,
    shown_name,
    summary_of,
    tags_of,
)
from recon4_app.projects.folder_times import Stamp, iso, stamp_of
from recon4_app.projects.model import ProjectCard
from recon4_app.projects.tuning import PROJECT_LIST

log = logging.getLogger(__name__)


class _Kept(msgspec.Struct, frozen=True, array_like=True):
    """A card with the files it was read from."""

    stamp: Stamp
    card: ProjectCard


class _Index(msgspec.Struct, frozen=True):
    """The file of the index."""

    version: str
    cards: dict[str, _Kept]


class CardIndex:
    """The cards of the projects below a folder."""

    def __init__(self, path: Path | None, version: str) -> None:
        """Read the index that an earlier server left.

        Args:
            path: The file of the index; None = none is kept.
            version: Of recon4: another one may make other cards of the same files.
        """
        self._path, self._version = path, version
        self._cards = _read_index(path, version) if path else {}
        self._unsaved = 0

    def card(self, folder: Path) -> ProjectCard | None:
        """The card of a project; None if the folder is none."""
        stamp = stamp_of(folder)
        if stamp[0] is None:
            return None
        kept = self._cards.get(folder.name)
        if kept is None or kept.stamp != stamp:
            kept = self._cards[folder.name] = _Kept(stamp, _read_card(folder, stamp))
            self._unsaved += 1
        return kept.card

    def forget_all_but(self, names: set[str]) -> None:
        """Forget projects that are gone."""
        for gone in [name for name in list(self._cards) if name not in names]:
            self._cards.pop(gone, None)
            self._unsaved += 1

    def save(self) -> None:
        """Keep the index for the next server, if it has changed."""
        if not self._unsaved or self._path is None:
            return
        self._unsaved = 0
        cards = list(self._cards.items())  # requests add some meanwhile
        drafts = {name: kept for name, kept in cards if _is_draft(kept.card)}
        make_folders(self._path.parent)
        with atomic_file(self._path) as part:
            part.write_bytes(msgspec.json.encode(_Index(self._version, drafts)))


def _is_draft(card: ProjectCard) -> bool:
    """Whether nobody ever approved it: no signature makes the card."""
    return card.approval == NOT_APPROVED


def _read_index(path: Path, version: str) -> dict[str, _Kept]:
    """The kept cards; none if the file is missing, damaged or of another version."""
    try:
        found = decoded(path.read_bytes(), _Index)
    except FileNotFoundError:
        return {}
    except (OSError, msgspec.DecodeError) as error:
        log.warning("%s is made again: %s", path.name, error)
        return {}
    return found.cards if found.version == version else {}


def _read_card(folder: Path, stamp: Stamp) -> ProjectCard:
    facts, problem = object_of(folder, "project.json")
    summary, more = summary_of(folder)
    finished = stamp[1] is not None
    return ProjectCard(
        id=folder.name,
        name=shown_name(facts, folder),
        finished=finished,
        updated=iso(max(one[0] for one in stamp[:3] if one is not None) / 1e9),
        preset=visible(str(facts.get("preset") or "")),
        rig=rig_name(facts.get("rig")),
        has_map=finished and ("points" in summary or summary.get("map") == "2d"),
        tags=tags_of(facts),
        archived=facts.get("archived") is True,
        recording=_recording(facts),
        path_length_m=_number(summary.get("path_length_m")),
        points=_whole(summary.get("points")),
        approval=approval_in(folder, summary),
        usability=_usability(summary),
        problem="; ".join(filter(None, (problem, more))),
    )


def _usability(summary: dict[str, object]) -> str:
    """The verdict on the map; empty where there is none, as in files of format 1."""
    verdict = summary.get("verdict")
    usability = verdict.get("usability") if isinstance(verdict, dict) else None
    return usability if usability in list(Usability) else ""


def _number(value: Any) -> float | None:
    return (
        float(value) if isinstance(value, int | float) and abs(value) < PROJECT_LIST.large else None
    )


def _whole(value: Any) -> int | None:
    return value if isinstance(value, int) and abs(value) < PROJECT_LIST.large else None


def _recording(facts: dict[str, object]) -> str:
    """SHA-256 of the first recording; empty = not known yet."""
    inputs = facts.get("inputs")
    first = inputs[0] if isinstance(inputs, list) and inputs else None
    found = first.get("sha256") if isinstance(first, dict) else None
    return visible(found) if isinstance(found, str) else ""
