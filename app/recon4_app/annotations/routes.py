"""HTTP routes of notes and saved views."""

from __future__ import annotations

import base64
import binascii
from functools import partial
from pathlib import Path
from typing import Annotated

from fastapi import APIRouter, Depends, Request, Response
from fastapi import Path as PathField
from starlette.concurrency import run_in_threadpool

from recon4.export.bcf import BcfNote, NoteCamera, notes_bcf
from recon4.export.notes import PlacedNote, notes_geojson
from recon4.locales.coded import CodedText
from recon4_app.access.audit import audit
from recon4_app.access.people import Permission, Who, needs
from recon4_app.annotations import store
from recon4_app.annotations.model import (
    MapNote,
    MapViewsView,
    NewMapView,
    NewNote,
    NoteChange,
    NotePhoto,
    NotesView,
    Revision,
    SavedMapView,
)
from recon4_app.annotations.photo_work import kept_photo
from recon4_app.annotations.store import NOTES, VIEWS
from recon4_app.compute_pool.model import Lane, Terms
from recon4_app.deps import Server
from recon4_app.error_responses import problems
from recon4_app.errors import BadRequest
from recon4_app.network.request_caller import CalledBy

LOOK = [Depends(needs(Permission.LOOK))]
PROCESS = [Depends(needs(Permission.PROCESS))]
PHOTO_HEADERS = {"Content-Security-Policy": "default-src 'none'; sandbox"}
"""A photo is nothing else, whatever a browser makes of it; ``nosniff`` is on every response."""
EntryId = Annotated[str, PathField(max_length=64)]

router = APIRouter(
    prefix="/api/projects/{project_id}",
    tags=["notes"],
    responses=problems(404, 422),
)


@router.get("/notes", dependencies=LOOK, summary="Notes on a map")
def read_notes(project_id: str, server: Server, who: Who) -> NotesView:
    """Text, place, status, author and time of each."""
    notes = NOTES.read(server.projects.folder(project_id))
    return NotesView(may_change=who.may(Permission.PROCESS), notes=notes)


@router.post("/notes", status_code=201, dependencies=PROCESS, summary="Pin a note to a place")
def add_note(
    project_id: str, new: NewNote, server: Server, *, who: Who, request: Request
) -> MapNote:
    """The note is on disk before the response is sent."""
    note = store.add_note(server.projects.folder(project_id), new, who.name)
    audit(request, "add note", f"{project_id}: {note.id}")
    return note


@router.patch(
    "/notes/{note_id}",
    dependencies=PROCESS,
    responses=problems(409),
    summary="Change a note",
)
def change_note(
    project_id: str, note_id: EntryId, change: NoteChange, *, server: Server, request: Request
) -> MapNote:
    """Text or status. 409 if somebody changed it since ``revision``: no change is lost."""
    who = request.scope["state"]["person"]
    folder = server.projects.folder(project_id)
    note = store.change_note(folder, note_id, change, who=who.name)
    audit(request, "change note", f"{project_id}: {note.id}")
    return note


@router.delete("/notes/{note_id}", status_code=204, dependencies=PROCESS, summary="Remove a note")
def remove_note(
    project_id: str, note_id: EntryId, server: Server, *, who: Who, request: Request
) -> None:
    """One's own; a reviewer removes those of others too."""
    store.remove_note(server.projects.folder(project_id), note_id, who)
    audit(request, "remove note", f"{project_id}: {note_id}")


@router.put(
    "/notes/{note_id}/photo",
    dependencies=PROCESS,
    responses=problems(409),
    summary="Give a note a photo",
)
async def set_photo(
    project_id: str, note_id: EntryId, given: NotePhoto, *, server: Server, caller: CalledBy
) -> MapNote:
    """JPEG or PNG, decoded in a confined process and written again; the one before is removed."""
    folder = server.projects.folder(project_id)
    await run_in_threadpool(store.find_note, folder, note_id)
    try:
        data = base64.b64decode(given.base64, validate=True)
    except (binascii.Error, ValueError) as error:
        raise BadRequest(CodedText("photo-not-base64")) from error
    work = server.compute_pool.run_background
    terms = Terms(person=caller.name)
    jpeg = await caller.wait(work(Lane.INSPECT, terms, kept_photo, data))
    change = partial(store.set_photo, revision=given.revision, who=caller.name)
    note = await run_in_threadpool(change, folder, note_id, jpeg)
    await run_in_threadpool(audit, caller.request, "photo of note", f"{project_id}: {note.id}")
    return note


@router.delete(
    "/notes/{note_id}/photo",
    dependencies=PROCESS,
    responses=problems(409),
    summary="Take the photo of a note away",
)
def remove_photo(
    project_id: str, note_id: EntryId, revision: Revision, *, server: Server, request: Request
) -> MapNote:
    """409 if somebody changed the note since ``revision``."""
    who = request.scope["state"]["person"]
    folder = server.projects.folder(project_id)
    note = store.set_photo(folder, note_id, b"", revision=revision, who=who.name)
    audit(request, "remove photo of note", f"{project_id}: {note.id}")
    return note


@router.get(
    "/notes/{note_id}/photo", dependencies=LOOK, response_class=Response, summary="Its photo"
)
def read_photo(project_id: str, note_id: EntryId, server: Server) -> Response:
    """A JPEG file that this server wrote."""
    folder = server.projects.folder(project_id)
    data = store.read_photo(folder, store.find_note(folder, note_id))
    return Response(data, media_type="image/jpeg", headers=PHOTO_HEADERS)


@router.get("/notes.bcf", dependencies=LOOK, response_class=Response, summary="Notes as BCF 3.0")
def notes_bcf_file(project_id: str, server: Server) -> Response:
    """Topics with viewpoints and photos, for programs that plan and build with models."""
    folder = server.projects.folder(project_id)
    notes = [_bcf_note(folder, one) for one in NOTES.read(folder)]
    data = notes_bcf(folder, server.projects.get(project_id).name, notes)
    head = {"Content-Disposition": f'attachment; filename="{project_id}-notes.bcf"'}
    return Response(data, media_type="application/octet-stream", headers=head)


def _bcf_note(folder: Path, note: MapNote) -> BcfNote:
    fields = ("id", "text", "status", "who", "time", "changed_by", "changed", "p_map")
    return BcfNote(
        **{name: getattr(note, name) for name in fields},
        camera=NoteCamera(**note.camera.model_dump()) if note.camera else None,
        photo=store.read_photo(folder, note) if note.photo else None,
    )


@router.get("/notes.geojson", dependencies=LOOK, response_class=Response, summary="Notes for a GIS")
def notes_file(project_id: str, server: Server) -> Response:
    """GeoJSON, in WGS 84 if the map is georeferenced; each note says its coordinates."""
    folder = server.projects.folder(project_id)
    notes = [
        PlacedNote(one.p_map, one.model_dump(exclude={"p_map", "camera"}))
        for one in NOTES.read(folder)
    ]
    head = {"Content-Disposition": f'attachment; filename="{project_id}-notes.geojson"'}
    return Response(notes_geojson(folder, notes), media_type="application/geo+json", headers=head)


@router.get("/views", dependencies=LOOK, summary="Saved views of a map")
def read_views(project_id: str, server: Server, who: Who) -> MapViewsView:
    """Name, state of the address, author and time of each."""
    views = VIEWS.read(server.projects.folder(project_id))
    return MapViewsView(may_change=who.may(Permission.PROCESS), views=views)


@router.post("/views", status_code=201, dependencies=PROCESS, summary="Save a view")
def add_view(
    project_id: str, new: NewMapView, server: Server, *, who: Who, request: Request
) -> SavedMapView:
    """The view is on disk before the response is sent."""
    view = store.add_view(server.projects.folder(project_id), new, who.name)
    audit(request, "save view", f"{project_id}: {view.name}")
    return view


@router.delete(
    "/views/{view_id}", status_code=204, dependencies=PROCESS, summary="Remove a saved view"
)
def remove_view(
    project_id: str, view_id: EntryId, server: Server, *, who: Who, request: Request
) -> None:
    """One's own; a reviewer removes those of others too."""
    VIEWS.remove(server.projects.folder(project_id), view_id, who)
    audit(request, "remove view", f"{project_id}: {view_id}")
