"""Notes and saved views: nothing is lost, nothing is changed by who may not."""

import io
from concurrent.futures import ThreadPoolExecutor
from dataclasses import replace

import pytest
from msgspec import structs
from PIL import Image

from recon4.errors import ConfigError, StoreError
from recon4.store.checked import Altered
from recon4.store.seal import compare_all
from recon4_app.access.people import Person, Role
from recon4_app.annotations.model import NewMapView, NewNote, NoteChange
from recon4_app.annotations.photo_work import kept_photo
from recon4_app.annotations.store import (
    NOTES,
    VIEWS,
    add_note,
    add_view,
    change_note,
    read_photo,
    remove_note,
    set_photo,
)
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


def photo(size=(60, 40), kind="JPEG", mode="RGB", **more):
    out = io.BytesIO()
    Image.new(mode, size, "red").save(out, kind, **more)
    return out.getvalue()


def test_a_photo_is_kept_with_its_note_and_goes_with_it(tmp_path):
    note = add_note(tmp_path, new(), "vera")
    first = set_photo(tmp_path, note.id, photo(), revision=1, who="vera")
    second = set_photo(tmp_path, note.id, photo((9, 9)), revision=2, who="otto")

    assert read_photo(tmp_path, second) == photo((9, 9))
    assert (second.revision, second.changed_by) == (3, "otto")
    assert len(list((tmp_path / "annotations/photos").iterdir())) == 1  # the first is gone
    assert first.photo != second.photo
    with pytest.raises(Conflict, match="otto changed"):
        set_photo(tmp_path, note.id, photo(), revision=1, who="vera")
    assert read_photo(tmp_path, second) == photo((9, 9))
    assert [message for _, message in compare_all(tmp_path) if message] == []

    remove_note(tmp_path, note.id, Person("vera", Role.OPERATOR))
    assert list((tmp_path / "annotations/photos").iterdir()) == []
    assert [message for _, message in compare_all(tmp_path) if message] == []


def test_a_photo_is_taken_away_and_a_changed_one_is_not_shown(tmp_path):
    note = add_note(tmp_path, new(), "vera")
    note = set_photo(tmp_path, note.id, photo(), revision=1, who="vera")
    (file,) = (tmp_path / "annotations/photos").iterdir()
    file.write_bytes(b"<script>")
    with pytest.raises(StoreError, match="changed by another program"):
        read_photo(tmp_path, note)
    file.write_bytes(photo())

    after = set_photo(tmp_path, note.id, b"", revision=2, who="vera")

    assert after.photo == "" and not file.exists()
    with pytest.raises(NotFound):
        read_photo(tmp_path, after)


def test_a_project_has_no_more_photos_than_fit_into_a_file(tmp_path, monkeypatch):
    limits = structs.replace(ANNOTATIONS, max_photos=1)
    monkeypatch.setattr("recon4_app.annotations.store.ANNOTATIONS", limits)
    first, second = add_note(tmp_path, new(), "vera"), add_note(tmp_path, new(), "vera")
    set_photo(tmp_path, first.id, photo(), revision=1, who="vera")

    with pytest.raises(Conflict, match="at most 1 photos"):
        set_photo(tmp_path, second.id, photo((9, 9)), revision=1, who="vera")
    assert len(list((tmp_path / "annotations/photos").iterdir())) == 1


def test_a_kept_photo_is_small_upright_and_says_nothing_else():
    exif = Image.Exif()
    exif[0x0112] = 6  # turned by a quarter
    exif[0x010F] = "a camera that somebody owns"
    sent = photo((4000, 1000), exif=exif) + b"<script>alert(1)</script>"

    kept = kept_photo(sent)

    with Image.open(io.BytesIO(kept)) as image:
        assert (image.format, image.size) == ("JPEG", (512, 2048))
        assert dict(image.getexif()) == {}
    assert b"somebody" not in kept and b"script" not in kept


def test_what_is_transparent_becomes_white():
    with Image.open(io.BytesIO(kept_photo(photo(kind="PNG", mode="RGBA")))) as image:
        red = image.getpixel((5, 5))
    clear = io.BytesIO()
    Image.new("RGBA", (20, 20), (255, 0, 0, 0)).save(clear, "PNG")
    with Image.open(io.BytesIO(kept_photo(clear.getvalue()))) as image:
        white = image.getpixel((5, 5))

    assert red[0] > 200 and red[1] < 60 and min(white) > 250


@pytest.mark.parametrize(
    ("data", "message"),
    [
        (b"", "JPEG or PNG"),
        (b"<svg xmlns='http://www.w3.org/2000/svg'/>", "JPEG or PNG"),
        (photo(kind="GIF"), "JPEG or PNG"),
        (photo()[:300], "JPEG or PNG"),
        (photo((8000, 7000), kind="PNG", mode="1"), "at most 50 million"),
    ],
)
def test_what_is_no_usable_photo_is_refused(data, message):
    with pytest.raises(ConfigError, match=message):
        kept_photo(data)


def test_where_the_author_looked_from_is_kept(tmp_path):
    seen = {"eye_m": (0, 0, 5), "ahead": (0, 0, -1), "up": (0, 1, 0), "aspect": 1.5}
    note = add_note(tmp_path, NewNote(p_map=(0, 0, 0), text="x", key=KEY, camera=seen), "vera")

    assert NOTES.read(tmp_path) == [note] and note.camera.aspect == 1.5
    with pytest.raises(ValueError, match="unit vector"):
        NewNote(p_map=(0, 0, 0), text="x", key=KEY, camera={**seen, "up": (0, 0, 0)})
