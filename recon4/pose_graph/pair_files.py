"""What a search and a worker that registers pairs for it exchange: files of one folder.

``search.json``: what all rounds have in common; ``views``: what each node sees;
``round_N.msgpack``: the pairs of a round; ``tried_N_K``: what part ``K`` of them gave.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from pathlib import Path

import msgspec
import numpy as np

from recon4.errors import StoreError
from recon4.geometry.se3 import SE3
from recon4.model.pose_graph import Edge, EdgeKind
from recon4.pose_graph.pair import Pair
from recon4.pose_graph.tried_pairs import tried_bytes, tried_edge
from recon4.settings.reads import GraphReads
from recon4.store.atomic import atomic_file, fsync
from recon4.store.frame_folders import FrameFolders
from recon4.untrusted.bounded import read_bytes_limited
from recon4.untrusted.limits import LIMITS

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
            found = msgspec.json.decode(data, type=_Search)
        except (msgspec.DecodeError, RecursionError) as error:
            raise StoreError(f"{_SEARCH}: {error}") from error
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

    i: int
    j: int
    kind: EdgeKind
    recognized: bool
    T_i_j: bytes
    """Rotation and translation, float64."""


class Round(msgspec.Struct, array_like=True):
    """Pairs of one order, and which of them each part registers."""

    pairs: list[_Pair]
    parts: list[Groups]

    def pair(self, row: int) -> Pair:
        """A pair by its row."""
        one = self.pairs[row]
        values = np.frombuffer(one.T_i_j, np.float64).copy()
        T_i_j = SE3(values[:9].reshape(3, 3), values[9:])
        return Pair(one.i, one.j, one.kind, T_i_j, recognized=one.recognized)

    @staticmethod
    def of(pairs: Sequence[Pair], parts: Sequence[Groups]) -> Round:
        """The pairs of an order."""
        return Round([_plain(pair) for pair in pairs], list(parts))

    def save(self, folder: Path, number: int) -> None:
        """Write it into the folder of an order.

        Raises:
            StoreError: If it cannot be written.
        """
        with atomic_file(_round_path(folder, number)) as temporary:
            temporary.write_bytes(msgspec.msgpack.encode(self))

    @staticmethod
    def load(folder: Path, number: int) -> Round:
        """Read what `save` wrote.

        Raises:
            StoreError: If it is missing or damaged.
        """
        path = _round_path(folder, number)
        data = read_bytes_limited(path, LIMITS.array_bytes, failure=StoreError)
        try:
            return msgspec.msgpack.decode(data, type=Round)
        except (msgspec.DecodeError, RecursionError) as error:
            raise StoreError(f"{path.name}: {error}") from error


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
        raise StoreError(f"{path.name}: {error}") from error
    found = {row: edge for row, edge in edges.items() if edge is not None}
    if len(found) != len(pairs):
        raise StoreError(f"{path.name}: expected {len(pairs)} pairs, got {len(found)} of them")
    path.unlink()
    return found


def tried_path(folder: Path, number: int, part: int) -> Path:
    """File of what a part of a round gave."""
    return folder / f"tried_{number}_{part}"


def _round_path(folder: Path, number: int) -> Path:
    return folder / f"round_{number}.msgpack"


def _plain(pair: Pair) -> _Pair:
    T_i_j = np.concatenate([pair.T_i_j.R.ravel(), pair.T_i_j.t.ravel()])
    return _Pair(pair.i, pair.j, pair.kind, pair.recognized, T_i_j.astype(np.float64).tobytes())
