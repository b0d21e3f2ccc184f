"""Places of surveyed points that were picked on the page of slices."""

from __future__ import annotations

from pathlib import Path

import msgspec
import numpy as np

from recon4.errors import StoreError
from recon4.locales.coded import unreadable
from recon4.slices.measured_points import MeasuredPosition, orthonormal
from recon4.store.json_files import read_object
from recon4.untrusted.limits import LIMITS

Xyz = tuple[float, float, float]


class StoredPicks(msgspec.Struct, frozen=True):
    """The fields of ``slices/control.json`` that say where points are."""

    picks: dict[str, Xyz] = {}
    along: dict[str, list[Xyz]] = {}
    found_in: dict[str, str] = {}


def stored_picks(project: Path, key: str) -> dict[str, MeasuredPosition]:
    """Id -> place in a map; those that were picked in another map are left out.

    Args:
        project: Its folder.
        key: Of the map.

    Raises:
        StoreError: If the file is damaged.
    """
    path = project / "slices" / "control.json"
    if not path.is_file():
        return {}
    try:
        stored = msgspec.convert(read_object(path, max_bytes=LIMITS.findings_bytes), StoredPicks)
    except msgspec.ValidationError as error:
        raise StoreError(unreadable(path.name, error)) from error
    return {
        name: MeasuredPosition(np.array(at), orthonormal(stored.along[name]))
        for name, at in stored.picks.items()
        if stored.found_in.get(name) == key and name in stored.along
    }
