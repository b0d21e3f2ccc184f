"""HTTP face of the uploads: tus 1.0 for the bytes, plain JSON for what they belong to."""

from __future__ import annotations

import asyncio
import contextlib
from datetime import UTC, datetime
from email.utils import formatdate
from typing import Annotated, Any

from fastapi import APIRouter, Depends, Path, Request, Response
from fastapi.routing import APIRoute
from pydantic import BaseModel, ConfigDict, Field
from starlette.datastructures import MutableHeaders
from starlette.middleware.body_limit import RequestBodyLimitMiddleware
from starlette.requests import ClientDisconnect
from starlette.types import Message, Receive, Scope, Send

from app.access.audit import audit
from app.access.people import Permission, Who, needs
from app.deps import Parts, Server
from app.errors import AppError, BadRequest, Conflict, ProblemDetail
from app.names import Name
from app.uploads import tus
from app.uploads.model import Upload, UploadPart
from app.uploads.receive import receive
from recon4.names import check_name

PREFIX = "/api/uploads/files"
SETTLES_WITHIN_S = 3.0


class TusRoute(APIRoute):
    """A route that speaks tus and takes bodies as large as a file: they are never in memory."""

    async def handle(self, scope: Scope, receive: Receive, send: Send) -> None:
        """Pass the request on, with our limit and the header every answer bears."""

        async def send_tus(message: Message) -> None:
            if message["type"] == "http.response.start":
                MutableHeaders(scope=message)["Tus-Resumable"] = tus.VERSION
            await send(message)

        most = scope["app"].state.parts.settings.upload_bytes
        await RequestBodyLimitMiddleware(super().handle, most)(scope, receive, send_tus)


router = APIRouter(
    prefix="/api/uploads",
    tags=["uploads"],
    dependencies=[Depends(needs(Permission.PROCESS))],
    responses={404: {"model": ProblemDetail}, 507: {"model": ProblemDetail}},
)
files = APIRouter(
    prefix=PREFIX,
    tags=["uploads"],
    dependencies=[Depends(needs(Permission.PROCESS))],
    responses={404: {"model": ProblemDetail}, 412: {"model": ProblemDetail}},
    route_class=TusRoute,
)


class Locked(AppError):
    """Another request writes to the same file."""

    status = 423


class NewUpload(BaseModel):
    """A recording that is about to be sent."""

    model_config = ConfigDict(extra="forbid")

    name: Name = Field(min_length=1, max_length=200)
    """As people call it: the name of the file or folder."""
    files: int = Field(ge=1, le=100_000)
    """How many files it has."""
    bytes: int = Field(ge=0)
    """How large all of them are."""
    fingerprint: Name = Field(default="", max_length=200)
    """What you recognize the same files by, to go on after a break."""


class UploadView(BaseModel):
    """An upload and how far it is."""

    id: str
    name: str
    files: int
    bytes: int
    received: int
    """Bytes that are safely on the server's disk."""
    fingerprint: str
    by: str
    """Who sends it."""
    created: str
    expires: str
    """When it is given up if nothing comes any more, UTC, ISO 8601."""
    finished: bool
    recording: str
    """Path to start a job with; empty until everything is there."""


class FileView(BaseModel):
    """One file of an upload."""

    name: str
    """As it was announced."""
    bytes: int
    offset: int
    """Bytes that are safely on the server's disk: go on from here."""
    url: str
    """Where to send the rest to."""


@router.get("", summary="Uploads")
def list_uploads(server: Server) -> list[UploadView]:
    """Uploads that are unfinished or were finished lately, the newest first."""
    return [_view(server, upload) for upload in server.uploads.all()]


@router.post("", status_code=201, summary="Announce a recording")
def begin_upload(new: NewUpload, server: Server, who: Who, request: Request) -> UploadView:
    """Announce a recording of one or several files; then send each file with tus.

    Refused when the disk has no room for it (507), when it is too large (413) or when too many
    uploads are unfinished (429).
    """
    upload = server.uploads.begin(
        new.name, files=new.files, total=new.bytes, fingerprint=new.fingerprint, by=who.name
    )
    audit(request, "upload recording", f"{upload.folder}: {upload.bytes} bytes")
    return _view(server, upload)


@router.get("/{upload_id}", summary="One upload")
def read_upload(upload_id: str, server: Server) -> UploadView:
    """How far an upload is."""
    return _view(server, server.uploads.get(upload_id))


@router.get("/{upload_id}/files", summary="Files of an upload")
def list_files(upload_id: str, server: Server) -> list[FileView]:
    """The files announced so far with their offsets: what to know to go on after a break."""
    upload = server.uploads.get(upload_id)
    return [
        FileView(name=part.name, bytes=part.bytes, offset=part.offset, url=_url(upload, part))
        for part in upload.parts.values()
    ]


@router.delete("/{upload_id}", status_code=204, summary="Give up an upload")
def remove_upload(upload_id: str, server: Server, request: Request) -> None:
    """Forget an upload and what came of it. A recording that is whole stays."""
    upload = server.uploads.get(upload_id)
    server.uploads.remove(upload)
    audit(request, "give up upload", upload.folder)


CREATE: dict[str, Any] = {
    "parameters": [
        {
            "name": name,
            "in": "header",
            "required": needed,
            "schema": {"type": "string"},
            "description": words,
        }
        for name, needed, words in (
            ("Tus-Resumable", True, "1.0.0"),
            ("Upload-Length", True, "Bytes of the file"),
            (
                "Upload-Metadata",
                False,
                "Pairs of name and base64, with commas: filename, relativePath, upload (an id)",
            ),
        )
    ]
}
CHUNK: dict[str, Any] = {
    "parameters": [
        {
            "name": name,
            "in": "header",
            "required": needed,
            "schema": {"type": "string"},
            "description": words,
        }
        for name, needed, words in (
            ("Tus-Resumable", True, "1.0.0"),
            ("Upload-Offset", True, "Where the bytes belong: the offset that HEAD says"),
            ("Upload-Checksum", False, "sha256 or sha1, a blank, the digest in base64"),
        )
    ],
    "requestBody": {
        "content": {tus.CHUNK_TYPE: {"schema": {"type": "string", "format": "binary"}}},
        "required": True,
    },
}


@files.options("", status_code=204, summary="What the server speaks")
def options(server: Server) -> Response:
    """Version, extensions and limits of tus on this server."""
    return Response(
        status_code=204,
        headers={
            "Tus-Version": tus.VERSION,
            "Tus-Extension": tus.EXTENSIONS,
            "Tus-Checksum-Algorithm": ",".join(tus.ALGORITHMS),
            "Tus-Max-Size": str(server.settings.upload_bytes),
        },
    )


@files.post("", status_code=201, summary="Announce a file", openapi_extra=CREATE)
async def create(request: Request, server: Server, who: Who) -> Response:
    """Announce one file (tus creation); the answer's ``Location`` takes its bytes.

    Without ``upload`` in its metadata the file is a recording of its own.
    A body is taken as its first bytes.
    """
    tus.check_version(request.headers)
    length = tus.number(request.headers, "Upload-Length")
    upload, part = await asyncio.to_thread(
        _announce, server, tus.metadata(request.headers), length, who.name
    )
    headers = {"Location": _url(upload, part)}
    if request.headers.get("content-type") == tus.CHUNK_TYPE and part.offset == 0:
        await _take(server, upload, part, request)
    await asyncio.to_thread(server.uploads.finish, upload)
    return Response(status_code=201, headers=headers | _told(server, upload, part))


@files.head("/{file_id}", summary="How far a file is")
async def head(file_id: Annotated[str, Path(max_length=40)], server: Server) -> Response:
    """Bytes of a file that are safely on the server's disk, as ``Upload-Offset``."""
    upload, part = server.uploads.part(file_id)
    with contextlib.suppress(TimeoutError):  # a request that was cut may still put its bytes away
        async with asyncio.timeout(SETTLES_WITHIN_S), part.turn:
            pass
    headers = {"Upload-Length": str(part.bytes), "Cache-Control": "no-store"}
    return Response(headers=headers | _told(server, upload, part))


@files.patch("/{file_id}", status_code=204, summary="Send bytes", openapi_extra=CHUNK)
async def patch(
    file_id: Annotated[str, Path(max_length=40)], request: Request, server: Server
) -> Response:
    """Append bytes to a file. They are safely on disk when 204 comes back."""
    tus.check_version(request.headers)
    tus.check_type(request.headers)
    upload, part = server.uploads.part(file_id)
    await _take(server, upload, part, request)
    await asyncio.to_thread(server.uploads.finish, upload)
    return Response(status_code=204, headers=_told(server, upload, part))


@files.delete("/{file_id}", status_code=204, summary="Give up a file")
def terminate(file_id: Annotated[str, Path(max_length=40)], server: Server) -> Response:
    """Give up the upload this file belongs to (tus termination)."""
    upload, _ = server.uploads.part(file_id)
    server.uploads.remove(upload)
    return Response(status_code=204)


def _announce(
    server: Parts, metadata: dict[str, str], length: int, by: str
) -> tuple[Upload, UploadPart]:
    name = metadata.get("relativePath") or metadata.get("filename") or metadata.get("name") or ""
    check_name(name, what="the name of a file", most=1000)
    if metadata.get("upload"):
        upload = server.uploads.get(metadata["upload"])
    else:
        name = name or "recording"
        upload = server.uploads.begin(name[:200], files=1, total=length, fingerprint="", by=by)
    if not name:
        raise BadRequest("Upload-Metadata must name the file: relativePath or filename")
    return upload, server.uploads.add(upload, name[:1000], length=length)


async def _take(server: Parts, upload: Upload, part: UploadPart, request: Request) -> None:
    """The body of a request into its file; one request a file at a time."""
    if part.turn.locked():
        raise Locked("another request writes to this file; ask HEAD and try again")
    async with part.turn:
        offset = tus.number(request.headers, "Upload-Offset") if request.method == "PATCH" else 0
        if upload.finished or offset != part.offset:
            raise Conflict(f"the file is at {part.offset}, the bytes belong to {offset}")
        path = server.uploads.data(upload, part)
        try:
            part.offset = await receive(
                path,
                request.stream(),
                offset=offset,
                length=part.bytes,
                checksum=tus.checksum(request.headers),
            )
        except (ClientDisconnect, TimeoutError) as error:
            raise BadRequest("the sender broke off; ask HEAD how far it came") from error
        finally:
            if path.exists():  # not when it was given up meanwhile
                part.offset = path.stat().st_size


def _told(server: Parts, upload: Upload, part: UploadPart) -> dict[str, str]:
    told = {"Upload-Offset": str(part.offset)}
    if not upload.finished:
        told["Upload-Expires"] = formatdate(server.uploads.expires(upload), usegmt=True)
    return told


def _url(upload: Upload, part: UploadPart) -> str:
    return f"{PREFIX}/{upload.id}-{part.number}"


def _view(server: Parts, upload: Upload) -> UploadView:
    expires = datetime.fromtimestamp(server.uploads.expires(upload), UTC)
    return UploadView(
        id=upload.id,
        name=upload.name,
        files=upload.files,
        bytes=upload.bytes,
        received=upload.received,
        fingerprint=upload.fingerprint,
        by=upload.by,
        created=upload.created,
        expires=expires.isoformat(timespec="seconds"),
        finished=upload.finished,
        recording=str(upload.recording(server.uploads.recordings)) if upload.finished else "",
    )
