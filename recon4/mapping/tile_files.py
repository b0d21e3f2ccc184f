"""What the stage ``map`` and a worker that makes a tile of it exchange: files of one folder.

``recipe.npz``, ``recipe.json``, ``table.npz``, ``paths.npz``: what all tiles have in common;
``I_J_K``: the records of a tile; ``made_I_J_K``: the tile as it will be stored.
"""

from __future__ import annotations

from dataclasses import dataclass, field
from itertools import pairwise
from pathlib import Path
from typing import Any

import msgspec
import numpy as np
from numpy.typing import NDArray

from recon4.errors import StoreError
from recon4.kernels.cell_table import CellIndex
from recon4.kernels.structure_points import Structure
from recon4.locales.coded import CodedText, at, text_of
from recon4.mapping.buckets import TileBuckets
from recon4.mapping.class_corrections import ClassVolume, ClassVolumes
from recon4.mapping.deviation import PoseCovariances
from recon4.mapping.finish import finish_tile
from recon4.mapping.grid import Grid
from recon4.mapping.made_tiles import Finished, made_bytes, made_of
from recon4.mapping.records import Tile
from recon4.mapping.sensor_paths import SensorPaths
from recon4.mapping.tile import Recipe
from recon4.mapping.tile_memory import Scratch, TileMeans
from recon4.mapping.tile_writer import TileWriter
from recon4.mapping.tuning import MAP_BUILD
from recon4.model.volumes import Volume
from recon4.orders.parts import Part
from recon4.sandbox.freed_memory import return_freed_memory
from recon4.settings import MapSettings
from recon4.store.arrays import (
    load_arrays,
    load_intensity_table,
    save_arrays,
    save_intensity_table,
)
from recon4.store.atomic import atomic_file
from recon4.untrusted.bounded import read_bytes_limited
from recon4.untrusted.limits import LIMITS
from recon4.untrusted.typed import decoded

_ARRAYS, _FACTS, _TABLE, _PATHS = "recipe.npz", "recipe.json", "table.npz", "paths.npz"
_INDICES = ("ground", "below", "cubes")
"""Fields of `Structure` that are an index of cells."""


class _Correction(msgspec.Struct, frozen=True, kw_only=True):
    """A `ClassVolume`."""

    volume: Volume
    to: int
    changes: list[int]
    """Codes of the classes whose points it changes."""


class _Facts(msgspec.Struct, frozen=True, kw_only=True):
    """What of a recipe is no array."""

    settings: MapSettings
    noise_m: float
    fields: list[str]
    """Of the map."""
    corrections: list[_Correction] | None
    has_table: bool


def save_recipe(buckets: TileBuckets, recipe: Recipe, writer: TileWriter) -> None:
    """Write into the folder of the records what all tiles have in common.

    Args:
        buckets: The records, all written.
        recipe: Parameters.
        writer: Of the map.

    Raises:
        OSError: If it cannot be written.
    """
    folder = buckets.folder
    save_arrays(folder / _ARRAYS, _arrays_of(recipe, buckets.counts))
    writer.paths.save(folder / _PATHS)
    if recipe.intensity is not None:
        save_intensity_table(folder / _TABLE, recipe.intensity)
    facts = _Facts(
        settings=recipe.settings,
        noise_m=recipe.noise_m,
        fields=writer.fields,
        corrections=_corrections(recipe.corrections),
        has_table=recipe.intensity is not None,
    )
    (folder / _FACTS).write_bytes(msgspec.json.encode(facts))


def read_made(folder: Path, tile: Part) -> Finished:
    """Read a tile that a worker has made, and remove its file.

    Args:
        folder: Of the records.
        tile: Its index.

    Raises:
        StoreError: If it is missing or damaged.
    """
    path = _made_path(folder, tile)
    data = read_bytes_limited(path, LIMITS.array_bytes, failure=StoreError)
    try:
        made = made_of(data)
    except (msgspec.DecodeError, RecursionError) as error:
        raise StoreError(at(path.name, text_of(error))) from error
    path.unlink()
    return made


@dataclass(frozen=True, slots=True, eq=False)
class TileMaker:
    """Makes tiles of one folder on a worker."""

    buckets: TileBuckets
    recipe: Recipe
    writer: TileWriter
    """Compresses tiles; it writes none."""
    scratch: Scratch = field(default_factory=Scratch)

    @staticmethod
    def open(folder: Path) -> TileMaker:
        """Read what all tiles have in common.

        Raises:
            StoreError: If a file is missing or damaged.
        """
        data = read_bytes_limited(folder / _FACTS, LIMITS.tile_list_bytes, failure=StoreError)
        try:
            facts = decoded(data, _Facts)
        except (msgspec.DecodeError, RecursionError) as error:
            raise StoreError(at(_FACTS, text_of(error))) from error
        arrays, grid = load_arrays(folder / _ARRAYS), Grid.of(facts.settings)
        recipe = _recipe_of(facts, arrays, folder)
        paths = SensorPaths.load(folder / _PATHS)
        writer = TileWriter(folder, facts.fields, tile_m=grid.tile_m, paths=paths)
        buckets = TileBuckets(folder, grid)
        buckets.take(_runs(arrays))
        return TileMaker(buckets, recipe, writer)

    def make(self, numbers: tuple[int, ...]) -> None:
        """Make a tile and leave its file in the folder, whole or not at all.

        Args:
            numbers: Its index.

        Raises:
            StoreError: If there is no such tile, or it cannot be written.
        """
        i, j, k = numbers
        tile = i, j, k
        if tile not in self.buckets.counts:
            raise StoreError(CodedText("map-no-tile", tile=str(tile)))
        records = self.buckets.read(tile)
        is_large = len(records) >= MAP_BUILD.large
        means = TileMeans(None if is_large else self.scratch)
        made = finish_tile(tile, records, recipe=self.recipe, means=means, writer=self.writer)
        del records
        with atomic_file(_made_path(self.buckets.folder, tile)) as temporary:
            temporary.write_bytes(made_bytes(made))
        if is_large:
            return_freed_memory()


def _made_path(folder: Path, tile: Part) -> Path:
    return folder / "made_{}_{}_{}".format(*tile)


def _arrays_of(recipe: Recipe, runs: dict[Tile, list[int]]) -> dict[str, NDArray[Any]]:
    tiles = sorted(runs)
    arrays: dict[str, NDArray[Any]] = {
        "t_ns": recipe.t_ns,
        "tiles": np.array(tiles, np.int64).reshape(-1, 3),
        "runs": np.array([count for tile in tiles for count in runs[tile]], np.int64),
        "runs_stop": np.cumsum([len(runs[tile]) for tile in tiles], dtype=np.int64),
    }
    if recipe.covariances is not None:
        arrays |= {"position_m": recipe.covariances.position_m, "cov": recipe.covariances.cov}
    if recipe.structure is not None:
        for name, values in recipe.structure._asdict().items():
            if name in _INDICES:
                arrays |= {f"{name}_key": values.key, f"{name}_slots": values.slots}
            else:
                arrays[name] = values
    return arrays


def _runs(arrays: dict[str, NDArray[Any]]) -> dict[Tile, list[int]]:
    tiles = [(i, j, k) for i, j, k in arrays["tiles"].tolist()]
    bounds = pairwise([0, *arrays["runs_stop"].tolist()])
    counts = arrays["runs"].tolist()
    return {tile: counts[a:b] for tile, (a, b) in zip(tiles, bounds, strict=True)}


def _recipe_of(facts: _Facts, arrays: dict[str, NDArray[Any]], folder: Path) -> Recipe:
    covariances = structure = corrections = None
    if "cov" in arrays:
        covariances = PoseCovariances(arrays["position_m"], arrays["cov"])
    if "ground_key" in arrays:
        structure = _structure(arrays)
    if facts.corrections is not None:
        corrections = ClassVolumes(tuple(map(_class_volume, facts.corrections)))
    return Recipe(
        Grid.of(facts.settings),
        facts.settings,
        load_intensity_table(folder / _TABLE) if facts.has_table else None,
        arrays["t_ns"],
        facts.noise_m,
        covariances,
        corrections,
        structure,
    )


def _structure(arrays: dict[str, NDArray[Any]]) -> Structure:
    index = {name: CellIndex(arrays[f"{name}_key"], arrays[f"{name}_slots"]) for name in _INDICES}
    return Structure(
        ground=index["ground"],
        ground_m=arrays["ground_m"],
        below=index["below"],
        below_m=arrays["below_m"],
        cubes=index["cubes"],
        normal=arrays["normal"],
        offset=arrays["offset"],
        near=arrays["near"],
        growth=arrays["growth"],
    )


def _corrections(volumes: ClassVolumes | None) -> list[_Correction] | None:
    if volumes is None:
        return None
    return [
        _Correction(volume=one.volume, to=one.to, changes=np.flatnonzero(one.changes).tolist())
        for one in volumes.steps
    ]


def _class_volume(one: _Correction) -> ClassVolume:
    return ClassVolume.changing(one.volume, one.to, one.changes)
