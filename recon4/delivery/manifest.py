"""``manifest.json`` of a delivery: which file has which bytes, signed. It may come from others."""

from __future__ import annotations

import json
from dataclasses import dataclass
from pathlib import Path

import msgspec

from recon4.delivery.tuning import DELIVERIES
from recon4.errors import StoreError
from recon4.locales.coded import CodedText, at
from recon4.review.signature import has_valid_signature, sign
from recon4.store.formats import FORMATS
from recon4.store.json_files import parse_object
from recon4.untrusted.names import visible
from recon4.untrusted.typed import as_type

MANIFEST = "manifest.json"
KIND = "recon4 delivery"


@dataclass(frozen=True, slots=True)
class DeliveredFile:
    """A file of a delivery."""

    bytes: int
    sha256: str


@dataclass(frozen=True, slots=True, kw_only=True)
class DeliveryManifest:
    """What a delivery says of itself."""

    format: int
    kind: str
    project: str
    made: str
    """UTC, ISO 8601."""
    recon4: str
    """Version of the program."""
    approval: str
    """State of the approval of the map, in one line."""
    crs: str
    files: dict[str, DeliveredFile]
    signature: dict[str, str] | None
    """As `recon4.review.signature.sign` makes it; None = not signed."""


def manifest_text(manifest: DeliveryManifest, key_file: Path | None) -> str:
    """The manifest as JSON, signed if there is a key; its own signature is replaced.

    Raises:
        StoreError: If the key cannot be read.
    """
    record: dict[str, object] = msgspec.to_builtins(manifest)
    del record["signature"]
    signature = sign(record, key_file) if key_file is not None else None
    return json.dumps(record | {"signature": signature}, indent=1, ensure_ascii=False) + "\n"


def read_manifest(data: bytes) -> DeliveryManifest:
    """Parse the manifest of a delivery, and check its signature if it has one.

    Raises:
        StoreError: If it is not one, names no file, or was changed after it was signed.
    """
    record = parse_object(data, MANIFEST)
    if record.get("kind") != KIND or record.get("format") != FORMATS.delivery:
        raise StoreError(
            CodedText("manifest-format", manifest=MANIFEST, kind=KIND, delivery=FORMATS.delivery)
        )
    try:
        found = as_type(record, DeliveryManifest)
    except msgspec.ValidationError as error:
        raise StoreError(at(MANIFEST, visible(str(error)))) from error
    if not found.files or len(found.files) > DELIVERIES.max_files:
        raise StoreError(
            CodedText(
                "manifest-files",
                manifest=MANIFEST,
                max_files=DELIVERIES.max_files,
                count=len(found.files),
            )
        )
    body = {name: value for name, value in record.items() if name != "signature"}
    if found.signature is not None and not has_valid_signature(body, found.signature):
        raise StoreError(CodedText("manifest-changed", manifest=MANIFEST))
    return found
