"""Blocks of tiles: what is written is what is read, block by block, and damage is named."""

import json
from dataclasses import replace
from itertools import pairwise

import numpy as np
import pytest

from recon4.errors import StoreError
from recon4.mapping.columns import BLOCKS, KeptBlocks, PackedColumns
from recon4.mapping.sensor_paths import SensorPaths
from recon4.mapping.tile import FIELDS, STORED
from recon4.mapping.tile_order import (
    block_ends,
    progressive,
    spatial_order,
    spatial_order_of,
    stored_blocks,
)
from recon4.mapping.tile_packing import FIELD_PACKING, pack, unpack
from recon4.mapping.tile_writer import TileWriter
from recon4.mapping.tiles import TileSet
from recon4.mapping.tuning import TILES
from recon4.store.tuning import PACKING
from tests.earlier_map import write_earlier

T0_NS = 1_700_000_000_000_000_000
FRAME_NS = 100_000_000
FRAMES = 20


def some_columns(rng, count):
    """Every stored field of a tile: floor and wall, seen from a walk along x."""
    xyz = rng.uniform(0.0, 5.0, (count, 3)).astype(np.float32)
    frame_id = rng.integers(0, FRAMES, count).astype(np.uint32)
    columns = {
        name: rng.integers(0, 200, (count, width) if width > 1 else count).astype(dtype)
        for name, (dtype, width) in FIELDS.items()
        if name in STORED
    }
    t_ns = T0_NS + frame_id.astype(np.int64) * FRAME_NS + rng.integers(0, FRAME_NS, count)
    columns |= {"xyz": xyz, "frame_id": frame_id, "t_ns": t_ns}
    columns["raw_offset_m"] = rng.normal(0.0, 0.02, (count, 3)).astype(np.float16)
    columns["normal"] = np.tile(np.array([0.0, -0.6, 0.8], np.float16), (count, 1))
    columns["surface_sd_m"][0] = np.nan
    columns["position_sd_m"] = rng.uniform(0.001, 0.02, count).astype(np.float16)
    return columns


def walk_paths():
    t_ns = T0_NS + np.arange(FRAMES + 1, dtype=np.int64) * FRAME_NS
    along_m = np.linspace(0.0, 2.0, len(t_ns))
    one = np.stack([along_m, 0.0 * along_m, 1.5 + 0.0 * along_m], axis=1)
    return SensorPaths(t_ns[:-1], t_ns, np.stack([one + k for k in range(200)]))


@pytest.fixture
def written(tmp_path):
    """Two tiles, the first of several blocks and with stray returns."""
    rng = np.random.default_rng(5)
    first, second = some_columns(rng, 3000), some_columns(rng, 70)
    with TileWriter(tmp_path, STORED, tile_m=5.0, paths=walk_paths()) as writer:
        writer.append((0, 0, 0), first, strays=200)
        writer.append((1, 0, 0), second)
    return tmp_path, first, second


def test_fields_are_exact_and_lengths_and_times_within_half_a_step(written):
    folder, first, _ = written
    tiles = TileSet.open(folder)

    found = tiles.tiles[0].read(STORED)

    off_m = np.abs(found["xyz"].astype(float) - first["xyz"][:2800])
    assert 4e-5 < off_m.max() < 5.1e-5
    raw_m = found["raw_offset_m"].astype(float) - first["raw_offset_m"][:2800]
    assert np.abs(raw_m).max() < 2.5e-4
    assert np.abs(found["t_ns"] - first["t_ns"][:2800]).max() <= 500
    deviation_m = found["position_sd_m"].astype(float) - first["position_sd_m"][:2800]
    assert np.abs(deviation_m).max() < 6e-5
    for name in set(STORED) - {"xyz", "raw_offset_m", "t_ns", "position_sd_m"}:
        assert found[name].dtype == FIELDS[name][0]
        np.testing.assert_array_equal(found[name], first[name][:2800], err_msg=name)


def test_a_map_with_coarser_steps_is_read_as_before(tmp_path, monkeypatch):
    coarse = replace(FIELD_PACKING["xyz"], step=PACKING.step_m)
    columns = some_columns(np.random.default_rng(5), 500)
    with monkeypatch.context() as patch:
        patch.setitem(FIELD_PACKING, "xyz", coarse)
        with TileWriter(tmp_path, STORED, tile_m=5.0, paths=walk_paths()) as writer:
            writer.append((0, 0, 0), columns)
    facts = json.loads((tmp_path / "tiles.json").read_text())
    (tmp_path / "tiles.json").write_text(json.dumps(facts | {"format": 2}))

    found = TileSet.open(tmp_path).tiles[0].read(["xyz", "raw_offset_m"])

    off_m = np.abs(found["xyz"].astype(float) - columns["xyz"])
    assert 2e-4 < off_m.max() < 2.5e-4
    assert np.abs(found["raw_offset_m"] - columns["raw_offset_m"].astype(float)).max() < 2.5e-4


def test_any_rows_are_those_of_the_whole_tile(written):
    folder, first, _ = written
    tile = TileSet.open(folder).tiles[0]
    whole = tile.read(["xyz", "t_ns", "ring"])

    assert len(block_ends(2800)) + len(block_ends(200)) == 4
    for rows in (slice(0, 5), slice(170, 190), slice(2799, 2800), slice(3, 2800, 7)):
        part = tile.read(["xyz", "t_ns", "ring"], rows=rows)
        for name, values in part.items():
            np.testing.assert_array_equal(values, whole[name][rows])
    strays = tile.stray_part(5.0).read(["intensity"])["intensity"]
    np.testing.assert_array_equal(strays, first["intensity"][2800:])


def test_ranges_follow_from_the_paths_of_the_sensors(written):
    folder, first, _ = written
    tile = TileSet.open(folder).tiles[0]

    found = tile.read(["range_m", "incidence_rad"])

    s = (first["t_ns"] - T0_NS)[:2800] / (FRAMES * FRAME_NS)
    sensor_m = np.stack([2.0 * s, 0.0 * s, 1.5 + 0.0 * s], axis=1) + first["sensor"][:2800, None]
    to_sensor_m = sensor_m - (first["xyz"] + first["raw_offset_m"].astype(float))[:2800]
    range_m = np.linalg.norm(to_sensor_m, axis=1)
    np.testing.assert_allclose(found["range_m"], range_m, atol=1e-3)
    cosine = np.abs(to_sensor_m @ [0.0, -0.6, 0.8]) / range_m
    np.testing.assert_allclose(np.cos(found["incidence_rad"]), cosine, atol=2e-3)


def test_what_is_read_is_stored_again_as_the_same_bytes(written, tmp_path):
    folder, _, _ = written
    tiles = TileSet.open(folder)
    with TileWriter(tmp_path / "again", STORED, tile_m=5.0, paths=walk_paths()) as writer:
        for tile in tiles:
            parts = tile.read(STORED), tile.stray_part(5.0).read(STORED)
            columns = {name: np.concatenate([part[name] for part in parts]) for name in STORED}
            writer.append(tile.ijk, columns, strays=tile.strays)

    for path in [*(folder / "tiles").iterdir(), folder / "tiles.json"]:
        again = tmp_path / "again" / path.relative_to(folder)
        assert again.read_bytes() == path.read_bytes(), path.name


@pytest.mark.parametrize("count", [1, 63, 64, 65, 1000, 5000])
def test_blocks_are_stored_in_the_order_of_space(count):
    place = np.argsort(spatial_order(count))
    blocks = list(stored_blocks(10 + np.arange(count)))
    for (first, stop), rows in zip(pairwise([0, *block_ends(count)]), blocks, strict=True):
        expected = np.argsort(place[first:stop])
        np.testing.assert_array_equal(spatial_order_of(count, first, stop), expected)
        np.testing.assert_array_equal(rows, 10 + place[first:stop][expected])
    np.testing.assert_array_equal(
        progressive(np.arange(count))[np.argsort(place)], np.arange(count)
    )


def test_the_first_block_is_a_sixteenth_and_none_is_too_large():
    ends = block_ends(999_970)

    assert ends[0] == 62_499
    assert ends[-1] == 999_970
    assert 0 < min(np.diff(ends)) <= max(np.diff(ends)) <= TILES.block
    assert block_ends(30) == [2, 30]
    assert block_ends(0) == []


@pytest.mark.parametrize("values", [[-(1 << 62), 1 << 62, 0], [5], [-1, 1, -300, 70_000]])
def test_whole_numbers_of_any_size_come_back(values):
    numbers = np.array(values, np.int64)
    order = np.arange(len(values), dtype=np.int32)[::-1].copy()
    exact = numbers // TILES.time_step_ns * TILES.time_step_ns

    packed = pack("t_ns", exact)

    found = np.zeros(len(exact) + 1, np.int64)
    unpack("t_ns", packed, rows=order, out=found, where="")
    np.testing.assert_array_equal(found[:-1], exact[::-1])
    assert found[-1] == 0


@pytest.mark.parametrize("name", ["xyz", "normal", "echo"])
def test_a_damaged_block_is_named_and_the_others_can_be_read(written, name):
    folder, _, second = written
    path = folder / "tiles" / f"{name}.zst"
    data = bytearray(path.read_bytes())
    data[int(np.load(folder / "tiles" / BLOCKS)["end"][1, STORED.index(name)]) - 6] ^= 4
    path.write_bytes(data)
    tiles = TileSet.open(folder)

    with pytest.raises(StoreError, match=rf"tiles/{name}\.zst: block 1: "):
        tiles.tiles[0].read([name])
    assert len(tiles.tiles[0].read([name], limit=100)[name]) == 100
    assert len(tiles.tiles[1].read([name])[name]) == len(second["xyz"])


def cut_file(folder):
    path = folder / "tiles" / "ring.zst"
    path.write_bytes(path.read_bytes()[:-1])


def shrink_index(folder):
    index = np.load(folder / "tiles" / BLOCKS)
    np.save(folder / "tiles" / BLOCKS, index[:-1])


def swap_blocks(folder):
    index = np.load(folder / "tiles" / BLOCKS)
    np.save(folder / "tiles" / BLOCKS, index[::-1])


def widen_numbers(folder):
    index = np.load(folder / "tiles" / BLOCKS)
    index["width"][1] = 9
    np.save(folder / "tiles" / BLOCKS, index)


def lose_paths(folder):
    (folder / "tiles" / "paths.npz").unlink()


def name_no_field(folder):
    facts = json.loads((folder / "tiles.json").read_text())
    facts["fields"][0] = "color"
    (folder / "tiles.json").write_text(json.dumps(facts))


def move_a_border(folder):
    facts = json.loads((folder / "tiles.json").read_text())
    facts["tiles"][0] |= {"stop": 2900, "strays": 100}
    facts["points"] += 100
    (folder / "tiles.json").write_text(json.dumps(facts))


@pytest.mark.parametrize(
    ("damage", "words"),
    [
        (cut_file, r"ring\.zst: expected \d+ bytes"),
        (shrink_index, r"blocks\.npy: expected blocks of 3070 points, got 3005"),
        (swap_blocks, r"blocks\.npy: row \d"),
        (widen_numbers, r"blocks\.npy: row 1"),
        (lose_paths, r"paths\.npz"),
        (move_a_border, r"blocks\.npy: expected tiles of whole blocks, got one to point 2900"),
        (name_no_field, "unknown field 'color'"),
    ],
)
def test_files_that_do_not_fit_each_other_are_refused(written, damage, words):
    damage(written[0])

    with pytest.raises(StoreError, match=words):
        TileSet.open(written[0])


def test_a_map_of_an_earlier_version_is_read_alike(written, tmp_path):
    folder, _, _ = written
    write_earlier(folder, tmp_path / "earlier")
    now, earlier = TileSet.open(folder), TileSet.open(tmp_path / "earlier")

    assert isinstance(now.columns, PackedColumns)
    assert earlier.fields == now.fields
    for mine, other in zip(now, earlier, strict=True):
        for name, values in mine.as_measured().read(now.fields).items():
            np.testing.assert_array_equal(other.as_measured().read([name])[name], values)
        some = other.read(["xyz"], rows=slice(1, 60, 3))["xyz"]
        np.testing.assert_array_equal(some, mine.read(["xyz"], rows=slice(1, 60, 3))["xyz"])
    (tmp_path / "earlier/tiles/ring.npy").write_bytes(b"")
    with pytest.raises(StoreError, match=r"ring\.npy: expected \d+ bytes for 3070 points, got 0"):
        TileSet.open(tmp_path / "earlier")


def test_kept_blocks_take_no_more_memory_than_they_may():
    kept, made = KeptBlocks(1000), []

    def make(block):
        made.append(block)
        return np.zeros(400, np.uint8)

    for block in (1, 2, 1, 3, 1, 2):
        kept.get(("xyz", block), lambda block=block: make(block))

    assert made == [1, 2, 3, 2]
    KeptBlocks(0).get(("xyz", 4), lambda: make(4))
