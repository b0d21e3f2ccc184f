"""The tiles of a map made by workers; what they cannot make, this process makes itself."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from functools import partial

from recon4.mapping.buckets import TileBuckets
from recon4.mapping.finish import finish_tile
from recon4.mapping.made_tiles import Finished
from recon4.mapping.records import Tile
from recon4.mapping.threads import Each
from recon4.mapping.tile import Recipe
from recon4.mapping.tile_files import read_made, save_recipe
from recon4.mapping.tile_memory import TileMeans
from recon4.mapping.tile_writer import TileWriter
from recon4.orders.order import OrderKind, Workers
from recon4.orders.parts import Part, Parts
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
        means = TileMeans(None, self.each)

        def here(part: Part) -> Finished:
            i, j, k = part
            tile = i, j, k
            records = self.buckets.read(tile)
            found = finish_tile(tile, records, recipe=recipe, means=means, writer=writer)
            del records
            return_freed_memory()
            return found

        parts = Parts(
            kind=OrderKind.MAP_TILE,
            folder=self.buckets.folder,
            items=self.tiles,
            read=partial(read_made, self.buckets.folder),
            here=here,
        )
        return parts.made(self.workers, self.progress)
