"""What a search and a worker that registers pairs for it exchange: files of one folder.

``search.json``: what all rounds have in common; ``views``: what each node sees;
``pairs_N_K``: the pairs of part ``K`` of round ``N``; ``tried_N_K``: what they gave.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from pathlib import Path

import msgspec
import numpy as np

from recon4.errors import StoreError
from recon4.geometry.se3 import SE3
from recon4.locales.coded import at, text_of
from recon4.model.pose_graph import Edge, EdgeKind
from recon4.pose_graph.pair import Pair
from recon4.pose_graph.tried_pairs import tried_bytes, tried_edge
from recon4.settings.reads import GraphReads
from recon4.store.atomic import atomic_file, fsync
from recon4.store.frame_folders import FrameFolders
from recon4.untrusted.bounded import read_bytes_limited
from recon4.untrusted.limits import LIMITS
from recon4.untrusted.typed import decoded

VIEWS = "views"
_SEARCH = "search.json"

Groups = list[list[int]]
"""Rows of pairs, by target node: what one part registers."""


class SearchInputs(msgspec.Struct, frozen=True, kw_only=True):
    """What pairs are registered with."""

    folders: FrameFolders
    settings: GraphReads

    def save(self, folder: Path) -> None:
        """Write them into the folder of an order, when all views are there.

        Raises:
            StoreError: If they cannot be written.
        """
        fsync(folder / VIEWS)
        facts = _Search(inputs=self, views_bytes=(folder / VIEWS).stat().st_size)
        with atomic_file(folder / _SEARCH) as temporary:
            temporary.write_bytes(msgspec.json.encode(facts))

    @staticmethod
    def load(folder: Path) -> SearchInputs:
        """Read what `save` wrote.

        Raises:
            StoreError: If they are missing or damaged, or the views are not those of them.
        """
        path = folder / _SEARCH
        data = read_bytes_limited(path, LIMITS.tile_list_bytes, failure=StoreError)
        try:
            found = decoded(data, _Search)
        except (msgspec.DecodeError, RecursionError) as error:
            raise StoreError(at(_SEARCH, text_of(error))) from error
        views = folder / VIEWS
        size = views.stat().st_size if views.is_file() else -1
        if size != found.views_bytes:
            raise StoreError(f"{VIEWS}: expected {found.views_bytes} bytes, got {size}")
        return found.inputs


class _Search(msgspec.Struct, frozen=True, kw_only=True):
    """Contents of the file of a search."""

    inputs: SearchInputs
    views_bytes: int
    """Size of the file of views."""


class _Pair(msgspec.Struct, array_like=True):
    """A pair to register."""

    row: int
    i: int
    j: int
    kind: EdgeKind
    recognized: bool
    T_i_j: bytes
    """Rotation and translation, float64."""


def save_part(path: Path, groups: Groups, pairs: Sequence[Pair]) -> None:
    """Write the pairs of a part of a round.

    Args:
        path: By `part_path`.
        groups: Rows of pairs, by target node.
        pairs: Of the round.

    Raises:
        OSError: If it cannot be written.
    """
    plain = [[_plain(row, pairs[row]) for row in group] for group in groups]
    path.write_bytes(msgspec.msgpack.encode(plain))


def load_part(path: Path) -> tuple[Groups, dict[int, Pair]]:
    """Read what `save_part` wrote: rows by target node, and the pair of each row.

    Raises:
        StoreError: If it is missing or damaged.
    """
    data = read_bytes_limited(path, LIMITS.array_bytes, failure=StoreError)
    try:
        plain = msgspec.msgpack.decode(data, type=list[list[_Pair]])
        pairs = {one.row: _pair(one) for group in plain for one in group}
    except (msgspec.DecodeError, RecursionError, ValueError) as error:
        raise StoreError(at(path.name, text_of(error))) from error
    return [[one.row for one in group] for group in plain], pairs


def save_tried(path: Path, pairs: Mapping[int, Pair], edges: Mapping[int, Edge]) -> None:
    """Write what pairs gave, whole or not at all.

    Args:
        path: By `tried_path`.
        pairs: Row -> pair.
        edges: Row -> edge of each of them.

    Raises:
        StoreError: If it cannot be written (`NoSpace` when the disk is full).
    """
    records = {row: tried_bytes(pairs[row], edge) for row, edge in edges.items()}
    with atomic_file(path) as temporary:
        temporary.write_bytes(msgspec.msgpack.encode(records))


def take_tried(path: Path, pairs: Mapping[int, Pair]) -> dict[int, Edge]:
    """Read what `save_tried` wrote, and remove the file.

    Args:
        path: By `tried_path`.
        pairs: Row -> pair of all that belong to it.

    Raises:
        StoreError: If it is missing or damaged, or of other pairs.
    """
    data = read_bytes_limited(path, LIMITS.array_bytes, failure=StoreError)
    try:
        records = msgspec.msgpack.decode(data, type=dict[int, bytes])
        edges = {row: tried_edge(pairs[row], record) for row, record in records.items()}
    except (msgspec.DecodeError, RecursionError, KeyError, ValueError) as error:
        raise StoreError(at(path.name, text_of(error))) from error
    found = {row: edge for row, edge in edges.items() if edge is not None}
    if len(found) != len(pairs):
        raise StoreError(f"{path.name}: expected {len(pairs)} pairs, got {len(found)} of them")
    path.unlink()
    return found


def part_path(folder: Path, number: int, part: int) -> Path:
    """File of the pairs of a part of a round."""
    return folder / f"pairs_{number}_{part}"


def tried_path(folder: Path, number: int, part: int) -> Path:
    """File of what a part of a round gave."""
    return folder / f"tried_{number}_{part}"


def _plain(row: int, pair: Pair) -> _Pair:
    T_i_j = np.concatenate([pair.T_i_j.R.ravel(), pair.T_i_j.t.ravel()]).astype(np.float64)
    return _Pair(row, pair.i, pair.j, pair.kind, pair.recognized, T_i_j.tobytes())


def _pair(one: _Pair) -> Pair:
    values = np.frombuffer(one.T_i_j, np.float64).copy()
    T_i_j = SE3(values[:9].reshape(3, 3), values[9:])
    return Pair(one.i, one.j, one.kind, T_i_j, recognized=one.recognized)
