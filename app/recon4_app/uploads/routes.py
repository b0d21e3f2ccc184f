"""HTTP routes of the uploads: tus 1.0 for the bytes, plain JSON for their recordings."""

from __future__ import annotations

import asyncio
import contextlib
import time
from datetime import UTC, datetime
from email.utils import formatdate
from typing import Annotated

from fastapi import APIRouter, Depends, Path, Request, Response
from fastapi.routing import APIRoute
from pydantic import BaseModel, ConfigDict, Field
from starlette.datastructures import MutableHeaders
from starlette.middleware.body_limit import RequestBodyLimitMiddleware
from starlette.requests import ClientDisconnect
from starlette.types import Message, Receive, Scope, Send

from recon4.locales.coded import CodedText
from recon4.untrusted.names import check_name
from recon4_app.access.audit import audit
from recon4_app.access.people import Permission, Who, needs
from recon4_app.deps import Server, ServerParts
from recon4_app.error_responses import problems
from recon4_app.errors import AppError, BadRequest, Conflict
from recon4_app.names import Name
from recon4_app.network.behind import public_path
from recon4_app.uploads import tus
from recon4_app.uploads.model import Upload, UploadedFile
from recon4_app.uploads.receive import receive
from recon4_app.uploads.tuning import SETTLING

PREFIX = "/api/uploads/files"


class TusRoute(APIRoute):
    """A tus route; it accepts bodies as large as a file, which are never held in memory."""

    async def handle(self, scope: Scope, receive: Receive, send: Send) -> None:
        """Handle a request with the upload limit and the tus header of every response."""

        async def send_tus(message: Message) -> None:
            if message["type"] == "http.response.start":
                MutableHeaders(scope=message)["Tus-Resumable"] = tus.VERSION
            await send(message)

        most = scope["app"].state.parts.settings.max_upload_bytes
        await RequestBodyLimitMiddleware(super().handle, most)(scope, receive, send_tus)


router = APIRouter(
    prefix="/api/uploads",
    tags=["uploads"],
    dependencies=[Depends(needs(Permission.PROCESS))],
    responses=problems(404, 507),
)
files = APIRouter(
    prefix=PREFIX,
    tags=["uploads"],
    dependencies=[Depends(needs(Permission.PROCESS))],
    responses=problems(404, 412),
    route_class=TusRoute,
)


class Locked(AppError):
    """Another request writes to the same file."""

    status = 423


class NewUpload(BaseModel):
    """A recording to be announced."""

    model_config = ConfigDict(extra="forbid")

    name: Name = Field(min_length=1, max_length=200)
    """Display name: that of the file or folder."""
    files: int = Field(ge=1, le=100_000)
    """Number of files."""
    bytes: int = Field(ge=0)
    """Size of all files."""
    fingerprint: Name = Field(default="", max_length=200)
    """By which the sender recognizes the same files, to resume."""


class UploadView(BaseModel):
    """An upload and its progress."""

    id: str
    name: str
    files: int
    bytes: int
    received: int
    """Bytes that are durably on the server's disk."""
    fingerprint: str
    by: str
    """Person who sends it."""
    created: str
    expires: str
    """When it is removed unless more data arrive, UTC, ISO 8601."""
    finished: bool
    recording: str
    """Path for a job; empty until the upload is complete."""
    folder: str
    """Name of the recording on the server, to delete it."""


class FileView(BaseModel):
    """One file of an upload."""

    name: str
    """Announced name."""
    bytes: int
    offset: int
    """Bytes that are durably on the server's disk: resume from here."""
    url: str
    """URL for the remaining bytes."""


@router.get("", summary="Uploads")
def list_uploads(server: Server) -> list[UploadView]:
    """List unfinished and recently finished uploads, the newest first."""
    return [_view(server, upload) for upload in server.uploads.all()]


@router.post("", status_code=201, summary="Announce a recording")
def begin_upload(new: NewUpload, server: Server, who: Who, *, request: Request) -> UploadView:
    """Announce a recording of one or several files; then send each file with tus.

    Rejected if the disk has too little space (507), if it is too large (413) or if too many uploads
    are unfinished (429).
    """
    upload = server.uploads.begin(
        new.name, files=new.files, total=new.bytes, fingerprint=new.fingerprint, by=who.name
    )
    audit(request, "upload recording", f"{upload.folder}: {upload.bytes} bytes")
    return _view(server, upload)


@router.get("/{upload_id}", summary="One upload")
def read_upload(upload_id: str, server: Server) -> UploadView:
    """Read an upload and its progress."""
    return _view(server, server.uploads.get(upload_id))


@router.get("/{upload_id}/files", summary="Files of an upload")
def list_files(upload_id: str, request: Request, server: Server) -> list[FileView]:
    """List the announced files with their offsets, to resume an upload."""
    upload = server.uploads.get(upload_id)
    return [
        FileView(
            name=file.name, bytes=file.bytes, offset=file.offset, url=_url(request, upload, file)
        )
        for file in upload.listed
    ]


@router.delete("/{upload_id}", status_code=204, summary="Remove an upload")
def remove_upload(upload_id: str, server: Server, request: Request) -> None:
    """Remove an upload and its received bytes. A complete recording stays."""
    upload = server.uploads.get(upload_id)
    server.uploads.remove(upload)
    audit(request, "give up upload", upload.folder)


def _headers(*rows: tuple[str, bool, str]) -> list[dict[str, object]]:
    """Parameters of OpenAPI: name, whether it is required, description."""
    return [
        {
            "name": name,
            "in": "header",
            "required": required,
            "schema": {"type": "string"},
            "description": text,
        }
        for name, required, text in rows
    ]


CREATE: dict[str, object] = {
    "parameters": _headers(
        ("Tus-Resumable", True, "1.0.0"),
        ("Upload-Length", True, "Bytes of the file"),
        (
            "Upload-Metadata",
            False,
            "Pairs of name and base64, comma-separated: filename, relativePath, upload (an id)",
        ),
    )
}
CHUNK: dict[str, object] = {
    "parameters": _headers(
        ("Tus-Resumable", True, "1.0.0"),
        ("Upload-Offset", True, "Position of the bytes: the offset that HEAD returns"),
        ("Upload-Checksum", False, "sha256 or sha1, a space, the digest in base64"),
    ),
    "requestBody": {
        "content": {tus.CHUNK_TYPE: {"schema": {"type": "string", "format": "binary"}}},
        "required": True,
    },
}


@files.options("", status_code=204, summary="Options of tus")
def options(server: Server) -> Response:
    """Read version, extensions and limits of tus on this server."""
    return Response(
        status_code=204,
        headers={
            "Tus-Version": tus.VERSION,
            "Tus-Extension": tus.EXTENSIONS,
            "Tus-Checksum-Algorithm": ",".join(tus.ALGORITHMS),
            "Tus-Max-Size": str(server.settings.max_upload_bytes),
        },
    )


@files.post("", status_code=201, summary="Announce a file", openapi_extra=CREATE)
async def create(request: Request, server: Server, who: Who) -> Response:
    """Announce one file (tus creation); send its bytes to the ``Location`` of the response.

    Without ``upload`` in its metadata the file is a recording of its own.
    A body has its first bytes.
    """
    tus.check_version(request.headers)
    length = tus.number(request.headers, "Upload-Length")
    upload, file = await asyncio.to_thread(
        _announce, server, tus.metadata(request.headers), length, by=who.name
    )
    headers = {"Location": _url(request, upload, file)}
    if request.headers.get("content-type") == tus.CHUNK_TYPE and file.offset == 0:
        await _take(server, upload, file, request=request)
    await asyncio.to_thread(server.uploads.finish, upload)
    return Response(status_code=201, headers=headers | _offset_headers(server, upload, file))


@files.head("/{file_id}", summary="Offset of a file")
async def head(file_id: Annotated[str, Path(max_length=40)], server: Server) -> Response:
    """Read the bytes of a file that are durably on the server's disk, as ``Upload-Offset``."""
    upload, file = server.uploads.file(file_id)
    with contextlib.suppress(TimeoutError):  # an interrupted request may still write its bytes
        async with asyncio.timeout(SETTLING.settles_within_s), file.lock:
            pass
    headers = {"Upload-Length": str(file.bytes), "Cache-Control": "no-store"}
    return Response(headers=headers | _offset_headers(server, upload, file))


@files.patch("/{file_id}", status_code=204, summary="Send bytes", openapi_extra=CHUNK)
async def patch(
    file_id: Annotated[str, Path(max_length=40)], request: Request, server: Server
) -> Response:
    """Append bytes to a file. They are durably on disk when the response is 204."""
    tus.check_version(request.headers)
    tus.check_type(request.headers)
    upload, file = server.uploads.file(file_id)
    await _take(server, upload, file, request=request)
    await asyncio.to_thread(server.uploads.finish, upload)
    return Response(status_code=204, headers=_offset_headers(server, upload, file))


@files.delete("/{file_id}", status_code=204, summary="Remove a file")
def terminate(file_id: Annotated[str, Path(max_length=40)], server: Server) -> Response:
    """Remove the upload to which this file belongs (tus termination)."""
    upload, _ = server.uploads.file(file_id)
    server.uploads.remove(upload)
    return Response(status_code=204)


def _announce(
    server: ServerParts, metadata: dict[str, str], length: int, *, by: str
) -> tuple[Upload, UploadedFile]:
    name = metadata.get("relativePath") or metadata.get("filename") or metadata.get("name") or ""
    check_name(name, what="the name of a file", most=1000)
    if metadata.get("upload"):
        upload = server.uploads.get(metadata["upload"])
    else:
        name = name or "recording"
        upload = server.uploads.begin(name[:200], files=1, total=length, fingerprint="", by=by)
    if not name:
        raise BadRequest(CodedText("upload-no-name"))
    return upload, server.uploads.add(upload, name[:1000], length=length)


async def _take(
    server: ServerParts, upload: Upload, file: UploadedFile, *, request: Request
) -> None:
    """Write the body of a request to its file; one request per file at a time."""
    if file.lock.locked():
        raise Locked(CodedText("upload-locked"))
    async with file.lock:
        offset = tus.number(request.headers, "Upload-Offset") if request.method == "PATCH" else 0
        if upload.finished or offset != file.offset:
            raise Conflict(CodedText("upload-offset", expected=file.offset, got=offset))
        path = server.uploads.data(upload, file)
        try:
            file.offset = await receive(
                path,
                request.stream(),
                offset=offset,
                length=file.bytes,
                checksum=tus.checksum(request.headers),
            )
        except (ClientDisconnect, TimeoutError) as error:
            raise BadRequest(CodedText("upload-sender-left")) from error
        finally:
            if path.exists():  # not if the upload was removed meanwhile
                file.offset = path.stat().st_size
            upload.changed_s = time.time()


def _offset_headers(server: ServerParts, upload: Upload, file: UploadedFile) -> dict[str, str]:
    headers = {"Upload-Offset": str(file.offset)}
    if not upload.finished:
        headers["Upload-Expires"] = formatdate(server.uploads.expires(upload), usegmt=True)
    return headers


def _url(request: Request, upload: Upload, file: UploadedFile) -> str:
    return public_path(request.scope, f"{PREFIX}/{upload.id}-{file.number}")


def _view(server: ServerParts, upload: Upload) -> UploadView:
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
        folder=upload.folder,
        recording=str(upload.recording(server.uploads.recordings)) if upload.finished else "",
    )
