"""Places of surveyed points that were picked on the page of slices, in any map of the walk.

A pick is a place in one map. Before another map of the walk takes its place, or when it is put on
its control points, it is kept who saw the picked places: every later map has them, too.
"""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path

import msgspec
import numpy as np

from recon4.errors import OutOfRange, StoreError
from recon4.locales.coded import unreadable
from recon4.model.plain import to_plain
from recon4.model.site_control import SeenPlace, Xyz
from recon4.slices.measured_points import MeasuredPosition, orthonormal
from recon4.store.arrays import load_trajectory
from recon4.store.atomic import write_json
from recon4.store.json_files import read_object
from recon4.store.seal import changing, check_sealed
from recon4.untrusted.limits import LIMITS
from recon4.untrusted.typed import as_type

SEEN_PICKS = "slices/seen_picks.json"
"""Below the project: id -> `SeenPick`."""
TRAJECTORY = "trajectory.npz"
"""Of the stage ``level``."""


class MeasuredPoint(msgspec.Struct, frozen=True):
    """What is measured."""

    id: str
    radius_m: float = 0.0
    """Of a sphere, whose middle is picked [m]."""


class StoredPicks(msgspec.Struct, frozen=True):
    """The fields of ``slices/control.json`` that say where points are."""

    points: list[MeasuredPoint] = []
    picks: dict[str, Xyz] = {}
    along: dict[str, list[Xyz]] = {}
    found_in: dict[str, str] = {}
    """Id -> key of the map it was picked in."""

    def of_map(self, key: str) -> StoredPicks:
        """The same with the picks of one map alone."""
        mine = {name: at for name, at in self.picks.items() if self.found_in.get(name) == key}
        return msgspec.structs.replace(self, picks=mine)


class SeenPick(msgspec.Struct, frozen=True, kw_only=True):
    """A pick, and who saw the place."""

    picked_m: Xyz
    """As it is stored: another pick of this point was not seen by these."""
    seen: SeenPlace


def add_seen_picks(project: Path, seen: Mapping[str, SeenPlace], picks: Mapping[str, Xyz]) -> None:
    """Keep who saw picks, beside those for which it is known already.

    Args:
        project: Its folder.
        seen: Id -> who saw it.
        picks: Id -> pick, as it is stored.
    """
    path = project / SEEN_PICKS
    path.parent.mkdir(exist_ok=True)
    with changing(project, SEEN_PICKS):
        added = {
            name: SeenPick(
                picked_m=picks[name],
                seen=SeenPlace(
                    t_ns=one.t_ns, p_body_m=one.p_body_m, directions_body=one.directions_body
                ),
            )
            for name, one in seen.items()
            if name in picks
        }
        write_json(path, to_plain(_seen_picks(path) | added))


def unseen_picks(project: Path, key: str) -> StoredPicks:
    """The picks of other maps than the one of this key for which it is not known who saw them.

    Raises:
        Altered: If a file was changed.
        StoreError: If a file cannot be read.
    """
    stored = as_stored(project)
    check_sealed(project, SEEN_PICKS)
    known = _seen_picks(project / SEEN_PICKS)
    unseen = {
        name: at
        for name, at in stored.picks.items()
        if stored.found_in.get(name, key) != key
        and name in stored.along
        and (name not in known or known[name].picked_m != at)
    }
    return msgspec.structs.replace(stored, picks=unseen)


def carried_picks(
    project: Path, picks: Mapping[str, Xyz], level: Path
) -> dict[str, MeasuredPosition]:
    """Id -> place in the map of ``level``, of the picks for which it is known who saw them.

    Raises:
        Altered: If the file of who saw them was changed.
        StoreError: If a file cannot be read.
    """
    if not picks:
        return {}
    check_sealed(project, SEEN_PICKS)
    kept = _seen_picks(project / SEEN_PICKS)
    trajectory = load_trajectory(level / TRAJECTORY)
    found = {}
    for name, one in kept.items():
        if picks.get(name) == one.picked_m:
            try:
                p_map = one.seen.place_in(trajectory)
            except OutOfRange:  # the recording of another walk
                continue
            along = orthonormal(one.seen.directions_in(trajectory))
            found[name] = MeasuredPosition(p_map, along)
    return found


def _seen_picks(path: Path) -> dict[str, SeenPick]:
    if not path.is_file():
        return {}
    try:
        record = read_object(path, max_bytes=LIMITS.findings_bytes)
        return as_type(record, dict[str, SeenPick])
    except msgspec.ValidationError as error:
        raise StoreError(unreadable(path.name, error)) from error


def stored_picks(project: Path, artifacts: Mapping[str, Path]) -> dict[str, MeasuredPosition]:
    """Id -> place in the latest map; left out are picks of an earlier one that nobody saw.

    Args:
        project: Its folder.
        artifacts: Of the run that made the map.

    Raises:
        StoreError: If the file is damaged.
    """
    stored = as_stored(project)
    key = artifacts["map"].name
    here = {
        name: MeasuredPosition(np.array(at), orthonormal(stored.along[name]))
        for name, at in stored.picks.items()
        if stored.found_in.get(name) == key and name in stored.along
    }
    earlier = {name: at for name, at in stored.picks.items() if name not in here}
    return here | carried_picks(project, earlier, artifacts["level"])


def as_stored(project: Path) -> StoredPicks:
    """The picks of any map, each in its own.

    Raises:
        StoreError: If the file is damaged.
    """
    path = project / "slices" / "control.json"
    if not path.is_file():
        return StoredPicks()
    try:
        return as_type(read_object(path, max_bytes=LIMITS.findings_bytes), StoredPicks)
    except msgspec.ValidationError as error:
        raise StoreError(unreadable(path.name, error)) from error
