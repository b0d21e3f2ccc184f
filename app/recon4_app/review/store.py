"""State of the review between requests, in memory; the journal is in the project."""

from __future__ import annotations

import asyncio
import secrets
from collections import OrderedDict
from pathlib import Path

from recon4.locales.coded import CodedText
from recon4.review.decisions import Decided, Pair
from recon4.review.pairs import Alignment
from recon4.review.preview import Effect, preview
from recon4.review.queue import queue_json
from recon4.review.row_contents import Measurement
from recon4.review.source import Source
from recon4_app.compute_pool.model import FileAccess, Lane, Terms
from recon4_app.compute_pool.pool import ComputePool
from recon4_app.errors import Conflict
from recon4_app.review.tuning import REVIEW_CACHE


def terms_of(root: Path, person: str) -> Terms:
    """Terms of work that may read only the artifacts of a project."""
    return Terms(person=person, access=FileAccess(read=(root / "artifacts",)))


class Reviews:
    """Cached measurements, queues and effects; one instance per server."""

    def __init__(self, pool: ComputePool) -> None:
        self._pool = pool
        self._measured: OrderedDict[str, tuple[Path, Pair, Measurement]] = OrderedDict()
        self._queues: OrderedDict[tuple[Path, str], bytes] = OrderedDict()
        self._wanted: dict[Path, tuple[str, str]] = {}
        self._effects: dict[Path, tuple[tuple[str, str, str], Effect]] = {}
        self._turns: dict[Path, asyncio.Lock] = {}

    # -- measurements: a decision refers to a registration made by the server

    def remember(self, root: Path, pair: Pair, alignment: Alignment) -> str:
        """Store a registration and return its id."""
        name = secrets.token_hex(12)
        self._measured[name] = (root, pair, alignment.measurement)
        if len(self._measured) > REVIEW_CACHE.max_measurements:
            self._measured.popitem(last=False)
        return name

    def measurement(self, root: Path, pair: Pair, name: str) -> Measurement:
        """The stored registration of this pair.

        Raises:
            Conflict: If the id is unknown, expired, or of another pair.
        """
        found = self._measured.get(name)
        if found is None or found[:2] != (root, pair):
            raise Conflict(CodedText("alignment-forgotten"))
        return found[2]

    # -- the queue: one per graph

    async def queue(self, root: Path, source: Source, *, person: str) -> bytes:
        """`recon4.review.queue.queue_json`, cached per graph."""
        known = (root, source.key)
        if known not in self._queues:
            self._queues[known] = await self._pool.run_interactive(
                Lane.REVIEW, terms_of(root, person), queue_json, source
            )
            if len(self._queues) > REVIEW_CACHE.max_queues:
                self._queues.popitem(last=False)
        return self._queues[known]

    # -- the preview of the effect: the newest request wins

    async def effect(
        self, root: Path, source: Source, *, decided: Decided, before: Decided, person: str
    ) -> Effect | None:
        """`recon4.review.preview.preview`; None if a newer request superseded this one."""
        known = (source.key, decided.key, before.key)
        mine = (decided.key, before.key)
        self._wanted[root] = mine
        async with self._turns.setdefault(root, asyncio.Lock()):
            if self._wanted[root] != mine:
                return None
            if root not in self._effects or self._effects[root][0] != known:
                record = await self._pool.run_interactive(
                    Lane.REVIEW, terms_of(root, person), preview, source, decided, before
                )
                self._effects[root] = (known, record)
            return self._effects[root][1]
