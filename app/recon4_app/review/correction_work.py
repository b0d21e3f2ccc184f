"""Work of corrections of classes, in child processes."""

from __future__ import annotations

from pathlib import Path
from typing import TypeVar

import msgspec

from recon4.locales.coded import CodedText
from recon4.model.alike import Alike, PickedThing
from recon4.model.class_corrections import ClassCorrection, Reclassified
from recon4.model.plain import to_plain
from recon4.review.class_corrections import CorrectionTrial, propose_alike, try_correction
from recon4_app.errors import ComputeFailed

Answer = TypeVar("Answer", CorrectionTrial, Alike)


def tried(
    artifacts: dict[str, str], what: Reclassified, before: tuple[ClassCorrection, ...]
) -> bytes:
    """Count what a correction would change (`try_correction`): JSON, for `answered`.

    Raises:
        StoreError: If the project has no classes of points, or an artifact cannot be read.
    """
    folders = {stage: Path(folder) for stage, folder in artifacts.items()}
    return msgspec.json.encode(to_plain(try_correction(folders, what, before)))


def alike(
    artifacts: dict[str, str], picked: PickedThing, before: tuple[ClassCorrection, ...]
) -> bytes:
    """Find all things like one (`propose_alike`): JSON, for `answered`.

    Raises:
        ConfigError: If nothing is there, or it is too large for a correction.
        StoreError: If the project has no classes of points, or an artifact cannot be read.
    """
    folders = {stage: Path(folder) for stage, folder in artifacts.items()}
    return msgspec.json.encode(to_plain(propose_alike(folders, picked, before)))


def answered(data: bytes, kind: type[Answer]) -> Answer:
    """What `tried` returned, a `CorrectionTrial`, or `alike`, an `Alike`.

    Raises:
        ComputeFailed: If a child returned something else.
    """
    try:
        return msgspec.json.decode(data, type=kind)
    except (msgspec.DecodeError, ValueError) as error:
        raise ComputeFailed(CodedText("count-malformed", detail=str(error)[:200])) from error
