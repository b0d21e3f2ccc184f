"""HTTP routes of notes and saved views."""

from __future__ import annotations

from typing import Annotated

from fastapi import APIRouter, Depends, Path, Request, Response

from recon4.export.notes import PlacedNote, notes_geojson
from recon4_app.access.audit import audit
from recon4_app.access.people import Permission, Who, needs
from recon4_app.annotations import store
from recon4_app.annotations.model import (
    MapNote,
    MapViewsView,
    NewMapView,
    NewNote,
    NoteChange,
    NotesView,
    SavedMapView,
)
from recon4_app.annotations.store import NOTES, VIEWS
from recon4_app.deps import Server
from recon4_app.error_responses import problems

LOOK = [Depends(needs(Permission.LOOK))]
PROCESS = [Depends(needs(Permission.PROCESS))]
EntryId = Annotated[str, Path(max_length=64)]

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
    NOTES.remove(server.projects.folder(project_id), note_id, who)
    audit(request, "remove note", f"{project_id}: {note_id}")


@router.get("/notes.geojson", dependencies=LOOK, response_class=Response, summary="Notes for a GIS")
def notes_file(project_id: str, server: Server) -> Response:
    """GeoJSON, in WGS 84 if the map is georeferenced; each note says its coordinates."""
    folder = server.projects.folder(project_id)
    notes = [PlacedNote(one.p_map, one.model_dump(exclude={"p_map"})) for one in NOTES.read(folder)]
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
