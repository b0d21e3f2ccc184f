"""What people pinned to a map, in files of its project.

PROJECT/annotations/notes.json  notes
PROJECT/annotations/views.json  saved views

A file is read and written as a whole, one change at a time, and sealed. A change of what another
person changed meanwhile is refused; changes of different notes never meet.
"""

from __future__ import annotations

import secrets
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from datetime import UTC, datetime
from pathlib import Path
from typing import Generic, TypeVar

from pydantic import TypeAdapter

from recon4.errors import StoreError
from recon4.store.atomic import make_folders, write_json
from recon4.store.json_files import read_object
from recon4.store.seal import changing, check_sealed
from recon4_app.access.people import Permission, Person
from recon4_app.annotations.model import MapNote, NewMapView, NewNote, NoteChange, SavedMapView
from recon4_app.annotations.tuning import ANNOTATIONS
from recon4_app.errors import Conflict, NotFound, Refused

Item = TypeVar("Item", MapNote, SavedMapView)


@dataclass(frozen=True, slots=True)
class ListFile(Generic[Item]):
    """A list in a file of each project."""

    name: str
    """Below the project folder."""
    what: str
    """What an entry is called."""
    adapter: TypeAdapter[list[Item]]
    most: int

    def read(self, root: Path) -> list[Item]:
        """The entries, oldest first; none if there is no file.

        Raises:
            Altered: If the file was changed by another program.
            StoreError: If it is damaged.
        """
        check_sealed(root, self.name)
        if not (root / self.name).exists():
            return []
        found = read_object(root / self.name, max_bytes=ANNOTATIONS.max_file_bytes)
        if found.get("format") != ANNOTATIONS.format:
            raise StoreError(
                f"{self.name}: expected format {ANNOTATIONS.format}, got {found.get('format')!r}"
            )
        try:
            return self.adapter.validate_python(found.get("items"))
        except ValueError as error:
            raise StoreError(f"{self.name} cannot be read: {error}") from error

    @contextmanager
    def changed(self, root: Path) -> Iterator[list[Item]]:
        """The entries, to be changed in place; they are on disk when the block ends.

        Raises:
            Conflict: If there are too many.
        """
        with changing(root, self.name):  # one block at a time
            items = self.read(root)
            yield items
            if len(items) > self.most:
                raise Conflict(f"a project has at most {self.most} {self.what}s; remove one first")
            make_folders((root / self.name).parent)
            plain = self.adapter.dump_python(items, mode="json")
            write_json(root / self.name, {"format": ANNOTATIONS.format, "items": plain})

    def at(self, items: list[Item], item_id: str) -> int:
        """The place of an entry.

        Raises:
            NotFound: If there is none with this id.
        """
        places = [k for k, one in enumerate(items) if one.id == item_id]
        if not places:
            raise NotFound(f"there is no {self.what} {item_id[:20]!r} any more")
        return places[0]

    def remove(self, root: Path, item_id: str, who: Person) -> None:
        """Remove an entry of one's own; a reviewer removes those of others too.

        Raises:
            NotFound: If there is none with this id.
            Refused: If it is another person's, and this one is no reviewer.
        """
        with self.changed(root) as items:
            at = self.at(items, item_id)
            if items[at].who != who.name and not who.may(Permission.REVIEW):
                raise Refused(
                    f"{items[at].who} made this {self.what}: only they or a reviewer remove it"
                )
            del items[at]


NOTES = ListFile(
    "annotations/notes.json", "note", TypeAdapter(list[MapNote]), ANNOTATIONS.max_notes
)
VIEWS = ListFile(
    "annotations/views.json", "view", TypeAdapter(list[SavedMapView]), ANNOTATIONS.max_views
)


def add_note(root: Path, new: NewNote, who: str) -> MapNote:
    """Pin a note to a place; it is on disk when this returns."""
    time = _now()
    note = MapNote(
        **new.model_dump(),
        id=secrets.token_hex(6),
        status="open",
        who=who,
        time=time,
        changed_by=who,
        changed=time,
        revision=1,
    )
    with NOTES.changed(root) as notes:
        notes.append(note)
    return note


def change_note(root: Path, note_id: str, change: NoteChange, *, who: str) -> MapNote:
    """Change text or status of a note; it is on disk when this returns.

    Raises:
        NotFound: If there is no such note.
        Conflict: If another change was made since the person read it.
    """
    with NOTES.changed(root) as notes:
        at = NOTES.at(notes, note_id)
        before = notes[at]
        if change.revision != before.revision:
            raise Conflict(f"{before.changed_by} changed this note meanwhile: look at it again")
        given = change.model_dump(exclude={"revision"}, exclude_none=True)
        stamp = {"changed_by": who, "changed": _now(), "revision": before.revision + 1}
        notes[at] = after = before.model_copy(update=given | stamp)
    return after


def add_view(root: Path, new: NewMapView, who: str) -> SavedMapView:
    """Save a view; it is on disk when this returns."""
    view = SavedMapView(**new.model_dump(), id=secrets.token_hex(6), who=who, time=_now())
    with VIEWS.changed(root) as views:
        views.append(view)
    return view


def _now() -> str:
    return datetime.now(UTC).isoformat(timespec="milliseconds")
