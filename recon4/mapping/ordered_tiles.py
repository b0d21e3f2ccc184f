"""The tiles of a map made by workers; what they cannot make, this process makes itself."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from functools import partial

from recon4.errors import StoreError
from recon4.mapping.buckets import TileBuckets
from recon4.mapping.finish import finish_tile
from recon4.mapping.made_tiles import Finished
from recon4.mapping.records import Tile
from recon4.mapping.threads import Each
from recon4.mapping.tile import Recipe
from recon4.mapping.tile_files import read_made, save_recipe
from recon4.mapping.tile_memory import TileMeans
from recon4.mapping.tile_writer import TileWriter
from recon4.model.events import Warned
from recon4.orders.order import OrderKind, Workers
from recon4.progress import Progress
from recon4.sandbox.freed_memory import return_freed_memory


@dataclass(frozen=True, slots=True)
class OrderedTiles:
    """Tiles that workers make."""

    buckets: TileBuckets
    """The records."""
    tiles: Sequence[Tile]
    """Those to make."""
    workers: Workers
    each: Each
    """Threads for the parts of a tile that this process makes."""
    progress: Progress

    def finished(self, recipe: Recipe, writer: TileWriter) -> Iterator[Finished]:
        """Tiles in their order, as soon as each and all before it are made.

        Args:
            recipe: Parameters.
            writer: Of the map.
        """
        save_recipe(self.buckets, recipe, writer)
        here = partial(finish_tile, recipe=recipe, means=TileMeans(None, self.each), writer=writer)
        failures = self._failures()
        answered: dict[int, str] = {}
        said: set[str] = set()
        for number, tile in enumerate(self.tiles):
            while number not in answered:
                item, failure = next(failures)
                answered[item] = failure
            found, why = self._read(tile, answered.pop(number))
            if found is None:
                if why not in said:
                    said.add(why)
                    self.progress.event(Warned(text=f"made here instead of by a worker: {why}"))
                found = here(tile, self.buckets.read(tile))
                return_freed_memory()
            yield found

    def _failures(self) -> Iterator[tuple[int, str]]:
        """Number of each tile as it is answered, and why it was not made; empty = it was."""
        answers = self.workers.make(
            OrderKind.MAP_TILE,
            self.buckets.folder,
            self.tiles,
            waiting=partial(self.progress.advance, 0),
        )
        for answer in answers:
            yield answer.item, answer.failure

    def _read(self, tile: Tile, failure: str) -> tuple[Finished | None, str]:
        """A tile that was made; None and why not, if it was not."""
        if failure:
            return None, failure
        try:
            return read_made(self.buckets.folder, tile), ""
        except StoreError as error:
            return None, str(error)
