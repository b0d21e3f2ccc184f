"""All tiles of a map in their order, made by threads of this process or by workers."""

from __future__ import annotations

from collections import deque
from collections.abc import Iterator, Sequence
from concurrent.futures import Future, ThreadPoolExecutor
from functools import partial
from itertools import zip_longest

from recon4.mapping.buckets import TileBuckets
from recon4.mapping.made_tiles import Finished, TileCounts
from recon4.mapping.records import Records, Tile
from recon4.mapping.threads import InThreads
from recon4.mapping.tile import Recipe, make_tile
from recon4.mapping.tile_memory import Scratch, TileMeans
from recon4.mapping.tile_writer import TileWriter
from recon4.mapping.tuning import MAP_BUILD
from recon4.sandbox.freed_memory import return_freed_memory


def finish_tile(
    tile: Tile, records: Records, *, recipe: Recipe, means: TileMeans, writer: TileWriter
) -> Finished:
    """Make a tile and compress it.

    Args:
        tile: Its index.
        records: In the order of their voxels, thinned, with the halo.
        recipe: Parameters.
        means: Memory to work in, and threads.
        writer: Of the map.
    """
    made = make_tile(records, tile, recipe, means=means)
    packed = writer.pack(tile, made.blocks, points=made.points, strays=made.strays, each=means.each)
    return packed, TileCounts(made.removed, made.corrected, made.classes)


def read_tiles(
    buckets: TileBuckets, tiles: Sequence[Tile], pool: ThreadPoolExecutor
) -> Iterator[Records]:
    """Records of tiles in their order; while some are used, those of the next tile are read.

    Much of a large tile is made by one thread, while the other one reads. A tile of more than
    `MAP_BUILD.ahead` records is not read before it is used.
    """
    coming: deque[Future[Records]] = deque()
    try:
        for tile, after in zip_longest(tiles, tiles[1:]):
            if not coming:
                coming.append(pool.submit(buckets.read, tile))
            if after is not None and sum(buckets.counts[after]) <= MAP_BUILD.ahead:
                coming.append(pool.submit(buckets.read, after))
            yield coming.popleft().result()
    finally:
        for future in coming:
            future.cancel()


def finished_tiles(
    buckets: TileBuckets,
    tiles: Sequence[Tile],
    pool: ThreadPoolExecutor,
    *,
    recipe: Recipe,
    writer: TileWriter,
) -> Iterator[Finished]:
    """Tiles in their order: several small ones at a time, of a large one several parts.

    So there is never more than one large tile in memory, and the records of the next one.

    Args:
        buckets: The records.
        tiles: Those to make.
        pool: Threads.
        recipe: Parameters.
        writer: Of the map.
    """
    finish = partial(finish_tile, recipe=recipe, writer=writer)
    small, large = TileMeans(Scratch()), TileMeans(None, InThreads(pool))
    waiting: deque[Future[Finished]] = deque()
    try:
        read = read_tiles(buckets, tiles, pool)
        for tile in tiles:
            records = next(read)
            is_large = len(records) >= MAP_BUILD.large
            if not is_large:
                waiting.append(pool.submit(finish, tile, records, means=small))
            while len(waiting) > (0 if is_large else MAP_BUILD.workers):
                yield waiting.popleft().result()
            if is_large:
                small = TileMeans(Scratch())  # what the threads held is free
                return_freed_memory()
                yield finish(tile, records, means=large)
            del records  # before the next ones are read
        while waiting:
            yield waiting.popleft().result()
    finally:
        for future in waiting:
            future.cancel()
