"""Notes and saved views: nothing is lost, nothing is changed by who may not."""

from concurrent.futures import ThreadPoolExecutor
from dataclasses import replace

import pytest

from recon4.errors import StoreError
from recon4.store.checked import Altered
from recon4_app.access.people import Person, Role
from recon4_app.annotations.model import NewMapView, NewNote, NoteChange
from recon4_app.annotations.store import NOTES, VIEWS, add_note, add_view, change_note
from recon4_app.annotations.tuning import ANNOTATIONS
from recon4_app.errors import Conflict, NotFound, Refused

KEY = "ab" * 16


def new(text="a crack"):
    return NewNote(p_map=(1.0, 2.0, 3.0), text=text, key=KEY)


def test_notes_of_two_people_at_once_are_all_kept(tmp_path):
    with ThreadPoolExecutor(4) as pool:
        made = list(pool.map(lambda k: add_note(tmp_path, new(f"note {k}"), f"p{k % 2}"), range(8)))

    kept = NOTES.read(tmp_path)
    assert sorted(one.id for one in kept) == sorted(one.id for one in made)
    assert {one.text for one in kept} == {f"note {k}" for k in range(8)}


def test_of_two_changes_of_one_note_at_once_one_is_refused_and_says_whose(tmp_path):
    note = add_note(tmp_path, new(), "vera")

    def change(k):
        try:
            return change_note(
                tmp_path, note.id, NoteChange(revision=1, text=f"by {k}"), who=f"p{k}"
            )
        except Conflict as error:
            return str(error)

    with ThreadPoolExecutor(4) as pool:
        results = list(pool.map(change, range(4)))

    (done,) = [one for one in results if not isinstance(one, str)]
    assert NOTES.read(tmp_path) == [done] and done.revision == 2
    assert [one for one in results if isinstance(one, str)] == [
        f"{done.changed_by} changed this note meanwhile: look at it again"
    ] * 3


def test_a_change_keeps_the_author_and_what_is_not_given(tmp_path):
    note = add_note(tmp_path, new(), "vera")

    done = change_note(tmp_path, note.id, NoteChange(revision=1, status="done"), who="otto")

    assert (done.who, done.changed_by, done.text, done.status) == (
        "vera",
        "otto",
        "a crack",
        "done",
    )
    with pytest.raises(NotFound, match="any more"):
        change_note(tmp_path, "0" * 12, NoteChange(revision=1), who="otto")


def test_only_the_author_or_a_reviewer_removes(tmp_path):
    note, view = add_note(tmp_path, new(), "vera"), NewMapView(name="Door", query="camera=1,2")
    kept = add_view(tmp_path, view, "vera")

    with pytest.raises(Refused, match="vera made this note"):
        NOTES.remove(tmp_path, note.id, Person("otto", Role.OPERATOR))
    assert len(NOTES.read(tmp_path)) == 1
    NOTES.remove(tmp_path, note.id, Person("rita", Role.REVIEWER))
    VIEWS.remove(tmp_path, kept.id, Person("vera", Role.OPERATOR))
    assert NOTES.read(tmp_path) == VIEWS.read(tmp_path) == []


def test_there_are_not_more_than_the_limit(tmp_path):
    few = replace(NOTES, most=1)
    add_note(tmp_path, new(), "vera")

    with pytest.raises(Conflict, match="at most 1 note"), few.changed(tmp_path) as notes:
        notes.append(notes[0])

    assert len(NOTES.read(tmp_path)) == 1


@pytest.mark.parametrize("text", ['{"format": 2, "items": []}', '{"format": 1, "items": [1]}', "x"])
def test_a_file_that_is_none_of_ours_is_an_error(tmp_path, text):
    (tmp_path / "annotations").mkdir()
    (tmp_path / NOTES.name).write_text(text)

    with pytest.raises(StoreError, match=r"notes\.json"):
        NOTES.read(tmp_path)
    with pytest.raises(StoreError):
        add_note(tmp_path, new(), "vera")
    assert (tmp_path / NOTES.name).read_text() == text


def test_a_file_that_another_program_changed_is_not_read(tmp_path):
    add_note(tmp_path, new(), "vera")
    file = tmp_path / NOTES.name
    file.write_text(file.read_text().replace("a crack", "a hole"))

    with pytest.raises(Altered):
        NOTES.read(tmp_path)


@pytest.mark.parametrize("query", ["<script>", "a b", "x" * (ANNOTATIONS.max_query_characters + 1)])
def test_a_view_has_a_query_and_nothing_else(query):
    with pytest.raises(ValueError, match="query"):
        NewMapView(name="Door", query=query)
