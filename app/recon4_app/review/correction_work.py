"""Work of corrections of classes, in child processes."""

from __future__ import annotations

from pathlib import Path

import msgspec

from recon4.model.alike import PickedThing
from recon4.model.class_corrections import ClassCorrection, Reclassified
from recon4.model.plain import to_plain
from recon4.review.class_corrections import propose_alike, try_correction


def tried(
    artifacts: dict[str, str], what: Reclassified, before: tuple[ClassCorrection, ...]
) -> bytes:
    """Count what a correction would change (`try_correction`): JSON, for `decode_record`.

    Raises:
        StoreError: If the project has no classes of points, or an artifact cannot be read.
    """
    folders = {stage: Path(folder) for stage, folder in artifacts.items()}
    return msgspec.json.encode(to_plain(try_correction(folders, what, before)))


def alike(
    artifacts: dict[str, str], picked: PickedThing, before: tuple[ClassCorrection, ...]
) -> bytes:
    """Find all things like one (`propose_alike`): JSON, for `decode_record`.

    Raises:
        ConfigError: If nothing is there, or it is too large for a correction.
        StoreError: If the project has no classes of points, or an artifact cannot be read.
    """
    folders = {stage: Path(folder) for stage, folder in artifacts.items()}
    return msgspec.json.encode(to_plain(propose_alike(folders, picked, before)))
