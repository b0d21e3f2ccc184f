"""Work of corrections of classes, in child processes."""

from __future__ import annotations

from pathlib import Path

import msgspec

from recon4.locales.coded import CodedText
from recon4.model.alike import Alike, PickedThing
from recon4.model.class_corrections import ClassCorrection, Reclassified
from recon4.model.plain import to_plain
from recon4.review.class_corrections import CorrectionTrial, propose_alike, try_correction
from recon4_app.errors import ComputeFailed


def tried(
    artifacts: dict[str, str], what: Reclassified, before: tuple[ClassCorrection, ...]
) -> bytes:
    """Count what a correction would change (`try_correction`): JSON, for `trial_of`.

    Raises:
        StoreError: If the project has no classes of points, or an artifact cannot be read.
    """
    folders = {stage: Path(folder) for stage, folder in artifacts.items()}
    return msgspec.json.encode(to_plain(try_correction(folders, what, before)))


def trial_of(data: bytes) -> CorrectionTrial:
    """What `tried` returned.

    Raises:
        ComputeFailed: If a child returned something else.
    """
    try:
        return msgspec.json.decode(data, type=CorrectionTrial)
    except (msgspec.DecodeError, ValueError) as error:
        raise ComputeFailed(CodedText("count-malformed", detail=str(error)[:200])) from error


def alike(
    artifacts: dict[str, str], picked: PickedThing, before: tuple[ClassCorrection, ...]
) -> bytes:
    """Find all things like one (`propose_alike`): JSON, for `alike_of`.

    Raises:
        ConfigError: If nothing is there, or it is too large for a correction.
        StoreError: If the project has no classes of points, or an artifact cannot be read.
    """
    folders = {stage: Path(folder) for stage, folder in artifacts.items()}
    return msgspec.json.encode(to_plain(propose_alike(folders, picked, before)))


def alike_of(data: bytes) -> Alike:
    """What `alike` returned.

    Raises:
        ComputeFailed: If a child returned something else.
    """
    try:
        return msgspec.json.decode(data, type=Alike)
    except (msgspec.DecodeError, ValueError) as error:
        raise ComputeFailed(CodedText("count-malformed", detail=str(error)[:200])) from error
