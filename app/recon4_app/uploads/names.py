"""Conversion of file names from browsers to names that are safe on every system."""

from __future__ import annotations

import re
import unicodedata
from pathlib import PurePosixPath

from recon4.locales.coded import CodedText
from recon4_app.errors import BadRequest
from recon4_app.uploads.tuning import UPLOAD_NAMES

RESERVED = frozenset(
    {"con", "prn", "aux", "nul"} | {f"{port}{n}" for port in ("com", "lpt") for n in range(10)}
)
"""Names Windows keeps for devices, with any ending."""


def safe_path(relative: str) -> PurePosixPath:
    """A relative path made of safe names; folders are kept so that readers find their files.

    Raises:
        BadRequest: If it is empty, contains ``..``, or is nested too deep.
    """
    parts = [part for part in re.split(r"[/\\]+", relative) if part not in ("", ".")]
    if not parts or ".." in parts or len(parts) > UPLOAD_NAMES.max_folders:
        raise BadRequest(
            CodedText(
                "upload-name-invalid", limit=UPLOAD_NAMES.max_folders - 1, name=relative[:100]
            )
        )
    return PurePosixPath(*map(safe_name, parts))


def safe_name(name: str) -> str:
    """The name with letters, digits and ``._+-`` only; accents are removed, the rest is ``_``."""
    plain = unicodedata.normalize("NFKD", name).encode("ascii", "ignore").decode()
    kept = re.sub(r"[^A-Za-z0-9._+-]+", "_", plain).lstrip(".").rstrip(". ")
    kept = kept if re.search(r"[A-Za-z0-9]", kept) else f"file{kept}"
    if kept.split(".", 1)[0].lower() in RESERVED:
        kept = f"_{kept}"
    return kept if len(kept) <= UPLOAD_NAMES.max_letters else f"{kept[:70]}~{kept[-29:]}"


def slug(name: str) -> str:
    """A short name for a folder or project: the name without its ending."""
    stem = safe_name(name.rsplit("/", 1)[-1])
    stem = re.sub(r"\.[A-Za-z0-9]{1,8}$", "", stem)
    return re.sub(r"[^A-Za-z0-9-]+", "-", stem).strip("-").lower()[:40] or "recording"


def another(path: PurePosixPath, taken: set[str]) -> PurePosixPath:
    """The path, or a numbered one if a file of that name (in any case) exists."""
    found, n = path, 2
    while str(found).lower() in taken:
        found, n = path.with_name(f"{path.stem}~{n}{path.suffix}"), n + 1
    return found
