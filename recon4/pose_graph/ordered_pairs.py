"""Pairs of nodes registered by workers; what they cannot register, this process does itself."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass, field
from itertools import chain, count
from pathlib import Path

from recon4.model.pose_graph import Edge
from recon4.orders.order import OrderKind, Workers
from recon4.orders.parts import Part, Parts
from recon4.pose_graph.pair import Pair
from recon4.pose_graph.pair_files import (
    VIEWS,
    Groups,
    SearchInputs,
    part_path,
    save_part,
    take_tried,
    tried_path,
)
from recon4.progress import Progress
from recon4.store.unfinished import unfinished_file

Tried = dict[int, Edge]
"""Row of a pair -> what it gave."""


@dataclass(frozen=True, slots=True)
class OrderedPairs:
    """Rounds of a search whose pairs workers register."""

    workers: Workers
    folder: Path
    """Holds the views of the nodes, and receives what pairs gave."""
    inputs: SearchInputs
    """What all rounds have in common."""
    _rounds: Iterator[int] = field(default_factory=count)

    @staticmethod
    def of(workers: Workers | None, inputs: SearchInputs) -> OrderedPairs | None:
        """Orders of the running stage; None = without workers, or nothing of it is kept.

        Args:
            workers: Who registers pairs.
            inputs: What all rounds have in common.
        """
        views = unfinished_file(VIEWS)
        return OrderedPairs(workers, views.parent, inputs) if workers and views else None

    def tried(
        self,
        parts: Sequence[Groups],
        pairs: Sequence[Pair],
        *,
        here: Callable[[Groups], Tried],
        progress: Progress,
    ) -> Iterator[Tried]:
        """What each part of a round gave, in their order.

        Args:
            parts: Rows of pairs, by target node.
            pairs: Of the round.
            here: Registers a part in this process.
            progress: Receives a warning where parts were made here.
        """
        number = next(self._rounds)
        if number == 0:  # all views are made
            self.inputs.save(self.folder)
        for part, groups in enumerate(parts):
            save_part(part_path(self.folder, number, part), groups, pairs)

        def read(part: Part) -> Tried:
            path = tried_path(self.folder, *part)
            rows = chain.from_iterable(parts[part[1]])
            return take_tried(path, {row: pairs[row] for row in rows})

        ordered = Parts(
            kind=OrderKind.PAIRS,
            folder=self.folder,
            items=[(number, part) for part in range(len(parts))],
            read=read,
            here=lambda part: here(parts[part[1]]),
        )
        return ordered.made(self.workers, progress)
