"""tus 1.0, the protocol of resumable uploads (https://tus.io/protocols/resumable-upload): headers.

Checks the headers of requests; no files, no network.
"""

from __future__ import annotations

import base64
import binascii
from collections.abc import Mapping

from recon4.locales.coded import CodedText
from recon4_app.errors import AppError, BadRequest
from recon4_app.uploads.receive import Checksum
from recon4_app.uploads.tuning import TUS

VERSION = "1.0.0"
EXTENSIONS = "creation,creation-with-upload,termination,checksum,expiration"
ALGORITHMS = ("sha256", "sha1")
CHUNK_TYPE = "application/offset+octet-stream"


class WrongVersion(AppError):
    """The sender uses another version of tus."""

    status = 412


class WrongType(AppError):
    """The content type is not that of a chunk."""

    status = 415


def check_version(headers: Mapping[str, str]) -> None:
    """Reject another protocol version.

    Raises:
        WrongVersion: If the request is not tus 1.0.0.
    """
    if headers.get("tus-resumable") != VERSION:
        raise WrongVersion(CodedText("tus-version", version=VERSION))


def check_type(headers: Mapping[str, str]) -> None:
    """Reject a body that is not declared as a chunk.

    Raises:
        WrongType: If the content type is another.
    """
    if headers.get("content-type") != CHUNK_TYPE:
        raise WrongType(CodedText("tus-type", type=CHUNK_TYPE))


def number(headers: Mapping[str, str], name: str) -> int:
    """A count of bytes.

    Raises:
        BadRequest: If the header is missing or no count.
    """
    text = headers.get(name.lower(), "")
    if not (text.isascii() and text.isdigit() and len(text) <= 18):
        raise BadRequest(CodedText("tus-number", header=name, got=text[:40]))
    return int(text)


def metadata(headers: Mapping[str, str]) -> dict[str, str]:
    """``Upload-Metadata``: names and texts.

    Raises:
        BadRequest: If it is malformed.
    """
    text = headers.get("upload-metadata", "")
    if len(text) > TUS.max_metadata:
        raise BadRequest(CodedText("tus-metadata-long", limit=TUS.max_metadata))
    found = {}
    for pair in filter(None, (one.strip() for one in text.split(","))):
        name, _, value = pair.partition(" ")
        try:
            found[name] = base64.b64decode(value, validate=True).decode()
        except ValueError as error:
            raise BadRequest(CodedText("tus-metadata-malformed", name=name[:40])) from error
    return found


def checksum(headers: Mapping[str, str]) -> Checksum | None:
    """``Upload-Checksum``, None when the sender gives none.

    Raises:
        BadRequest: If it is malformed or of an unknown kind.
    """
    text = headers.get("upload-checksum")
    if text is None:
        return None
    algorithm, _, value = text.partition(" ")
    if algorithm not in ALGORITHMS:
        raise BadRequest(
            CodedText("tus-algorithm", known=", ".join(ALGORITHMS), got=algorithm[:20])
        )
    try:
        return Checksum(algorithm, base64.b64decode(value, validate=True))
    except binascii.Error as error:
        raise BadRequest(CodedText("tus-checksum-malformed")) from error
