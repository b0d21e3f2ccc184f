"""What people pinned to a map, in files of its project.

PROJECT/annotations/notes.json    notes
PROJECT/annotations/photos/     their photos, as JPEG: <note>-<SHA-256, 12 digits>.jpg
PROJECT/annotations/views.json    saved views

A file is read and written as a whole, one change at a time, and sealed. A change of what another
person changed meanwhile is refused; changes of different notes never meet.
"""

from __future__ import annotations

import hashlib
import secrets
from collections.abc import Iterator, Mapping, Sequence
from contextlib import contextmanager
from dataclasses import dataclass
from datetime import UTC, datetime
from pathlib import Path
from typing import Generic, TypeVar

from pydantic import TypeAdapter

from recon4.errors import StoreError
from recon4.locales.coded import CodedText, unreadable
from recon4.store.atomic import atomic_file, make_folders, write_json
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
                CodedText(
                    "notes-format",
                    name=self.name,
                    format=ANNOTATIONS.format,
                    found=repr(found.get("format")),
                )
            )
        try:
            return self.adapter.validate_python(found.get("items"))
        except ValueError as error:
            raise StoreError(unreadable(self.name, error)) from error

    @contextmanager
    def changed(
        self, root: Path, *, adds: Mapping[str, bytes] = {}, drops: Sequence[str] = ()
    ) -> Iterator[list[Item]]:
        """The entries, to be changed in place; they are on disk when the block ends.

        Args:
            root: The project.
            adds: Files that are written before the list: what it names is always there.
            drops: Files that are removed after it.

        Raises:
            Conflict: If there are too many.
        """
        with changing(root, self.name, *adds, *drops):  # one block at a time
            items = self.read(root)
            yield items
            if len(items) > self.most:
                raise Conflict(CodedText("entries-too-many", what=self.what, limit=self.most))
            for name, data in adds.items():
                make_folders((root / name).parent)
                with atomic_file(root / name) as out:
                    out.write_bytes(data)
            make_folders((root / self.name).parent)
            plain = self.adapter.dump_python(items, mode="json")
            write_json(root / self.name, {"format": ANNOTATIONS.format, "items": plain})
            for name in drops:
                (root / name).unlink(missing_ok=True)

    def at(self, items: list[Item], item_id: str) -> int:
        """The place of an entry.

        Raises:
            NotFound: If there is none with this id.
        """
        places = [k for k, one in enumerate(items) if one.id == item_id]
        if not places:
            raise NotFound(CodedText("entry-gone", what=self.what, id=item_id[:20]))
        return places[0]

    def remove(self, root: Path, item_id: str, who: Person, *, drops: Sequence[str] = ()) -> None:
        """Remove an entry of one's own with its files; a reviewer removes those of others too.

        Raises:
            NotFound: If there is none with this id.
            Refused: If it is another person's, and this one is no reviewer.
        """
        with self.changed(root, drops=drops) as items:
            at = self.at(items, item_id)
            if items[at].who != who.name and not who.may(Permission.REVIEW):
                raise Refused(CodedText("entry-of-other", name=items[at].who, what=self.what))
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
        _refuse_unseen(before, change.revision)
        given = change.model_dump(exclude={"revision"}, exclude_none=True)
        stamp = {"changed_by": who, "changed": _now(), "revision": before.revision + 1}
        notes[at] = after = before.model_copy(update=given | stamp)
    return after


def set_photo(root: Path, note_id: str, jpeg: bytes, *, revision: int, who: str) -> MapNote:
    """Give a note a photo, in place of the one it has; empty takes it away.

    Args:
        root: The project.
        note_id: The note.
        jpeg: A file that this server wrote.
        revision: The revision of the note that the person saw.
        who: The person.

    Raises:
        NotFound: If there is no such note.
        Conflict: If another change was made since, or there are too many photos.
    """
    before = find_note(root, note_id)
    sha256 = hashlib.sha256(jpeg).hexdigest() if jpeg else ""
    old, new = _photo_name(note_id, before.photo), _photo_name(note_id, sha256)
    adds = {new: jpeg} if new else {}
    with NOTES.changed(root, adds=adds, drops=[old] if old and old != new else []) as notes:
        at = NOTES.at(notes, note_id)
        _refuse_unseen(notes[at], revision)
        others = sum(bool(one.photo) for one in notes if one.id != note_id)
        if new and others >= ANNOTATIONS.max_photos:
            raise Conflict(CodedText("photos-too-many", limit=ANNOTATIONS.max_photos))
        stamp = {"changed_by": who, "changed": _now(), "revision": revision + 1}
        notes[at] = after = notes[at].model_copy(update={"photo": sha256} | stamp)
    return after


def remove_note(root: Path, note_id: str, who: Person) -> None:
    """Remove a note and its photo; errors as of `ListFile.remove`."""
    name = _photo_name(note_id, find_note(root, note_id).photo)
    NOTES.remove(root, note_id, who, drops=[name] if name else [])


def find_note(root: Path, note_id: str) -> MapNote:
    """A note by its id.

    Raises:
        NotFound: If there is none.
    """
    notes = NOTES.read(root)
    return notes[NOTES.at(notes, note_id)]


def read_photo(root: Path, note: MapNote) -> bytes:
    """The photo of a note, a JPEG file.

    Raises:
        NotFound: If it has none.
        StoreError: If the file is missing or was changed.
    """
    name = _photo_name(note.id, note.photo)
    if not name:
        raise NotFound(CodedText("photo-missing"))
    try:
        data = (root / name).read_bytes()
    except OSError as error:
        raise StoreError(unreadable(name, error)) from error
    if hashlib.sha256(data).hexdigest() != note.photo:
        raise StoreError(CodedText("note-file-changed", file=name))
    return data


def _photo_name(note_id: str, sha256: str) -> str:
    return f"annotations/photos/{note_id}-{sha256[:12]}.jpg" if sha256 else ""


def _refuse_unseen(note: MapNote, revision: int) -> None:
    if revision != note.revision:
        raise Conflict(CodedText("note-changed", name=note.changed_by))


def add_view(root: Path, new: NewMapView, who: str) -> SavedMapView:
    """Save a view; it is on disk when this returns."""
    view = SavedMapView(**new.model_dump(), id=secrets.token_hex(6), who=who, time=_now())
    with VIEWS.changed(root) as views:
        views.append(view)
    return view


def _now() -> str:
    return datetime.now(UTC).isoformat(timespec="milliseconds")
