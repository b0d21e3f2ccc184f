"""The stage ``map``: from multiframes to tiles."""

import hashlib
import json
import tracemalloc
from dataclasses import replace

import numpy as np
import pytest
from msgspec import structs

from recon4.errors import OutOfRange, StoreError
from recon4.export.laz import export_laz
from recon4.mapping import build as map_build
from recon4.mapping import voxel_runs
from recon4.mapping.build import MapInputs, MapMeans, build_map
from recon4.mapping.grid import Grid
from recon4.mapping.map_notes import MapCrs
from recon4.mapping.tile import FIELDS, STORED, SURFACE_FIELDS
from recon4.mapping.tiles import TileSet
from recon4.mapping.tuning import MAP_BUILD, VOXEL_RUNS
from recon4.mapping.undistort import place
from recon4.model.events import MapBuilt
from recon4.progress import Silent
from recon4.settings import MapSettings, preset
from recon4.store.earlier_names import TILE_FIELDS
from tests.earlier_map import write_earlier
from tests.room_walks import FRAME_NS, T0_NS, Walk, room_walk

ALL = MapSettings(voxel_m=0.0, min_neighborhood=1, surface="raw")


def build(walk, folder, settings, *, crs=None, **options):
    folder.mkdir()
    return build_map(
        MapInputs(walk, walk.trajectory, crs=crs), folder, settings=settings, **options
    )


def points(tiles, field):
    return np.concatenate([tile.read([field])[field] for tile in tiles])


def names_of(tiles):
    """A number for each point, the same in every map of a walk."""
    name = (points(tiles, "t_ns") - T0_NS + 500) // 1000
    for field, values in (("sensor", 2), ("ring", 16), ("intensity", 1 << 16)):
        name = name * values + points(tiles, field)
    return name


def everything(tiles):
    return np.concatenate([tile.xyz_m() for tile in tiles])


def digest(folder):
    names = sorted(path for path in folder.rglob("*") if path.is_file())
    return {p.name: hashlib.sha256(p.read_bytes()).hexdigest() for p in names}


def test_without_thinning_every_point_is_in_the_map_once_with_its_fields(tmp_path):
    walk = room_walk(frames=6, points=800)

    tiles = build(walk, tmp_path / "map", ALL)

    expected = np.concatenate([place(frame, walk.trajectory, walk.rig) for frame in walk.frames])
    facts = {
        name: np.concatenate([getattr(frame, name) for frame in walk.frames])
        for name in ("intensity", "ring", "sensor", "echo")
    }
    dt_us = [(f.dt_ns.astype(np.int64) + 500) // 1000 for f in walk.frames]
    starts = [f.t_ns for f in walk.frames]
    facts["t_ns"] = np.concatenate([t + 1000 * dt for t, dt in zip(starts, dt_us, strict=True)])
    facts["frame_id"] = np.repeat(np.arange(6), 800)
    facts["range_m"] = np.concatenate([np.linalg.norm(f.xyz, axis=1) for f in walk.frames])
    found = everything(tiles)
    t_mine, t_theirs = points(tiles, "t_ns"), facts["t_ns"]
    mine = np.lexsort((points(tiles, "intensity"), points(tiles, "ring"), t_mine))
    theirs = np.lexsort((facts["intensity"], facts["ring"], t_theirs))
    assert len(tiles) == len(expected) == 4800
    np.testing.assert_allclose(found[mine], expected[theirs], atol=2.5e-4)
    for name in ("intensity", "ring", "sensor", "echo", "t_ns", "frame_id"):
        np.testing.assert_array_equal(points(tiles, name)[mine], facts[name][theirs])
    np.testing.assert_allclose(points(tiles, "range_m")[mine], facts["range_m"][theirs], atol=0.005)


def test_no_two_points_share_a_voxel_and_the_nearest_one_stays(tmp_path):
    walk = room_walk(frames=15, points=4000)
    settings = MapSettings(voxel_m=0.1, normal_cell_m=0.2, min_neighborhood=1, surface="raw")

    tiles = build(walk, tmp_path / "thin", settings)
    full = build(walk, tmp_path / "full", ALL)

    # Coordinates are stored to 0.25 mm: at the faces of a voxel they may lie in the next one.
    voxel, inside = voxels_of(everything(tiles))
    assert inside.mean() > 0.95
    assert len(np.unique(voxel[inside], axis=0)) == inside.sum()
    nearest = {}
    for key, range_m in zip(
        map(tuple, voxels_of(everything(full))[0]), points(full, "range_m"), strict=True
    ):
        nearest[key] = min(nearest.get(key, np.inf), range_m)
    off_m = points(tiles, "range_m")[inside] - [nearest[tuple(v)] for v in voxel[inside]]
    assert np.mean(np.abs(off_m) < 0.005) > 0.99  # chosen to 4 mm


def voxels_of(p_map):
    """Voxels of 10 cm of points, and which points are not at their faces."""
    at = p_map / 0.1
    return np.floor(at + 1e-6).astype(int), (np.abs(at - np.rint(at)) > 0.003).all(axis=1)


def test_the_map_does_not_depend_on_the_number_of_bursts(tmp_path, monkeypatch):
    monkeypatch.setattr(voxel_runs, "VOXEL_RUNS", structs.replace(VOXEL_RUNS, together=1, least=7))
    walk = room_walk(frames=15)
    settings = MapSettings(voxel_m=0.05)

    for name, burst in {"once": 10**9, "again": 10**9, "streamed": 5000}.items():
        build(walk, tmp_path / name, settings, means=MapMeans(burst=burst))

    assert digest(tmp_path / "once") == digest(tmp_path / "again")
    assert digest(tmp_path / "once") == digest(tmp_path / "streamed")
    assert not list((tmp_path / "streamed").glob("buckets-*"))


def test_normals_of_walls_point_to_the_sensor_and_ignore_tile_borders(tmp_path):
    walk = room_walk(frames=20, points=20_000, noise_m=0.002)
    settings = MapSettings(voxel_m=0.02, tile_m=1.0, normal_cell_m=0.1, surface="raw")

    tiles = build(walk, tmp_path / "small", settings)
    large = build(walk, tmp_path / "large", replace(settings, tile_m=4.0))

    xyz, normal = everything(tiles), points(tiles, "normal").astype(float)
    floor = (np.abs(xyz[:, 2] + 1.4) < 0.01) & (np.abs(xyz[:, :2]) < 2.0).all(axis=1)
    assert floor.sum() > 5000
    assert np.median(normal[floor, 2]) > 0.999
    assert (normal[floor, 2] > 0.95).mean() > 0.99
    incidence = points(tiles, "incidence_rad")[floor]
    height = 1.4 + 0.2 * (points(tiles, "sensor")[floor] == 0)
    expected = np.arccos(np.minimum(height / points(tiles, "range_m")[floor], 1.0))
    assert np.median(np.abs(incidence - expected)) < np.deg2rad(1.5)
    # A point on a border may lie in either voxel, so a handful of them differ.
    _, a, b = np.intersect1d(names_of(tiles), names_of(large), return_indices=True)
    assert len(a) > 0.999 * len(tiles)
    difference = np.abs(normal[a] - points(large, "normal").astype(float)[b]).max(axis=1)
    assert (difference > 0.01).mean() < 0.001


def test_any_first_part_of_a_tile_samples_it_evenly(tmp_path):
    tiles = build(room_walk(frames=10, points=8000), tmp_path / "map", ALL)
    tile = max(tiles, key=len)

    part = tile.xyz_m(limit=len(tile) // 10)

    assert len(part) == len(tile) // 10
    whole = tile.xyz_m()
    for axis in range(3):
        edges = np.quantile(whole[:, axis], np.linspace(0, 1, 9))
        edges[[0, -1]] = -np.inf, np.inf
        share = np.histogram(part[:, axis], edges)[0] / len(part)
        expected = np.histogram(whole[:, axis], edges)[0] / len(whole)
        assert np.abs(share - expected).max() < 0.02
    ordered = tile.spatial_order()
    assert np.array_equal(np.sort(ordered), np.arange(len(tile)))
    steps = np.linalg.norm(np.diff(whole[ordered], axis=0), axis=1)
    assert np.median(steps) < 0.2 < np.median(np.linalg.norm(np.diff(whole, axis=0), axis=1))


def test_disabled_sensors_and_far_points_are_excluded(tmp_path):
    tiles = build(room_walk(frames=5, enabled=(True, False)), tmp_path / "one", ALL)
    near = build(
        room_walk(frames=5),
        tmp_path / "near",
        MapSettings(voxel_m=0, max_range_m=3.0, min_neighborhood=1),
    )

    assert set(points(tiles, "sensor")) == {0}
    assert 0 < len(near) < 15_000
    assert points(near, "range_m").max() <= 3.005


def test_lonely_points_are_removed_and_counted(tmp_path):
    walk = room_walk(frames=10, points=5000)
    walk.frames[3].xyz[7] = [1.0, 0.5, 0.3]

    tiles = build(
        walk, tmp_path / "map", MapSettings(voxel_m=0.0, normal_cell_m=0.2, surface="raw")
    )
    kept = build(walk, tmp_path / "kept", ALL)

    assert tiles.notes.removed["lonely"] >= 1
    assert len(tiles) == len(kept) - tiles.notes.removed["lonely"]
    assert not (points(tiles, "frame_id") == 3)[
        np.linalg.norm(everything(tiles) - [1.35, 0.5, 0.5], axis=1) < 0.15
    ].any()


def test_points_of_long_range_are_removed_next_to_points_of_short_range(tmp_path):
    walk = room_walk(frames=20)
    settings = MapSettings(voxel_m=0.0, far_ratio=1.5, min_neighborhood=1, surface="raw")

    tiles = build(walk, tmp_path / "map", settings)

    cell = np.floor(everything(tiles)).astype(int)
    _, group = np.unique(cell, axis=0, return_inverse=True)
    nearest = np.full(group.max() + 1, np.inf)
    np.minimum.at(nearest, group, points(tiles, "range_m"))
    assert tiles.notes.removed["far"] + len(tiles) == 20 * 3000
    assert tiles.notes.removed["far"] > 100
    near = points(tiles, "range_m") <= 1.5 * nearest[group] + 0.01
    assert near.mean() > 0.999  # a point at the face of a cube may be stored in the next one


def test_the_list_of_tiles_has_rows_and_bounds(tmp_path):
    crs = MapCrs('LOCAL_CS["x"]', (500_000.0, 5_400_000.0, 200.0))

    tiles = build(room_walk(frames=3), tmp_path / "map", ALL, crs=crs)

    listed = json.loads((tmp_path / "map" / "tiles.json").read_text())
    assert tiles.crs == crs
    left_out = {"intensity_normalized", "position_sd_m", *SURFACE_FIELDS}
    assert listed["fields"] == [name for name in STORED if name not in left_out]
    assert tiles.fields == tuple(name for name in FIELDS if name not in left_out)
    assert listed["points"] == len(tiles) == sum(map(len, tiles))
    low, high = tiles.bounds_m
    np.testing.assert_allclose(low, everything(tiles).min(axis=0), atol=1e-6)
    np.testing.assert_allclose(high, everything(tiles).max(axis=0), atol=1e-6)
    assert T0_NS <= listed["time_ns"][0] < listed["time_ns"][1] < T0_NS + 3 * FRAME_NS
    for tile in tiles:
        xyz = tile.read(["xyz"])["xyz"]
        assert (xyz >= 0).all() and (xyz <= listed["tile_m"]).all()


def test_a_walk_without_points_gives_a_map_without_tiles(tmp_path):
    walk = room_walk(frames=2)
    empty = Walk([f.take(slice(0, 0)) for f in walk.frames], walk.rig, walk.trajectory)

    tiles = build(empty, tmp_path / "map", MapSettings())

    assert len(tiles) == 0 and list(tiles) == []
    assert np.isnan(tiles.bounds_m[0]).all()


def test_memory_does_not_grow_with_the_walk(tmp_path):
    settings = MapSettings(voxel_m=0.1, normal_cell_m=0.2)
    peaks = []
    walk = room_walk(frames=10, points=5000)
    for frames in (60, 240):
        longer = walk.repeated(frames)
        tracemalloc.start()
        build(longer, tmp_path / f"{frames}", settings, means=MapMeans(burst=20_000))
        peaks.append(tracemalloc.get_traced_memory()[1])
        tracemalloc.stop()

    assert peaks[1] < 1.3 * peaks[0], peaks


def test_a_trajectory_that_ends_early_is_refused_and_nothing_is_listed(tmp_path):
    walk = room_walk(frames=10)
    walk.trajectory = walk.trajectory[:5]

    with pytest.raises(OutOfRange):
        build(walk, tmp_path / "map", MapSettings())

    with pytest.raises(StoreError, match=r"tiles\.json is not the list"):
        TileSet.open(tmp_path / "map")


def test_damaged_maps_are_refused(tmp_path):
    tiles = build(room_walk(frames=2), tmp_path / "map", MapSettings())
    with pytest.raises(StoreError, match="no field"):
        tiles.tiles[0].read(["color"])

    (tmp_path / "map" / "tiles.json").write_text('{"format": 99}')
    with pytest.raises(StoreError, match="expected format 1, 2 or 3, got 99"):
        TileSet.open(tmp_path / "map")


def test_progress_is_reported_and_can_stop_it(tmp_path):
    class Stop(Silent):
        def advance(self, done=1):
            raise KeyboardInterrupt

    silent = Silent()
    build(room_walk(frames=2), tmp_path / "a", MapSettings(), progress=silent)
    assert isinstance(silent.events[-1], MapBuilt)

    with pytest.raises(KeyboardInterrupt):
        build(room_walk(frames=30), tmp_path / "b", MapSettings(), progress=Stop())
    assert not list((tmp_path / "b").glob("buckets-*"))


def test_cells_and_tiles_are_whole_numbers_of_voxels():
    grid = Grid.of(MapSettings(voxel_m=0.03, tile_m=20.0, normal_cell_m=0.1))

    assert grid.cell_m == pytest.approx(0.09)
    assert grid.tile_m == pytest.approx(0.09 * round(20 / 0.09))


@pytest.fixture(scope="module")
def fitted_and_raw(tmp_path_factory):
    """Maps of one walk in the folders of these names, which tests only read; and their parent."""
    root = tmp_path_factory.mktemp("surfaces")
    walk = room_walk(frames=30, points=20_000, noise_m=0.01)
    walk.frames[3].xyz[7] = [1.0, 0.5, 0.3]
    return root, *(
        build(walk, root / surface, MapSettings(surface=surface)) for surface in ("fitted", "raw")
    )


def test_fitted_tiles_hold_both_positions_of_every_point_and_the_strays_last(fitted_and_raw):
    _, fitted, raw = fitted_and_raw

    assert fitted.strays >= 1
    assert len(fitted) + fitted.strays == len(raw) + raw.notes.removed["lonely"]
    assert fitted.notes.removed.get("lonely", 0) == 0
    measured = everything(fitted.as_measured())
    every = np.concatenate([measured, everything(fitted.as_measured().only_strays())])
    lookup = {tuple(v) for v in np.floor(everything(raw) * 100 + 1e-3).astype(int)}
    found = [tuple(v) in lookup for v in np.floor(every * 100 + 1e-3).astype(int)]
    assert np.mean(found) > 0.97
    floor = (np.abs(measured[:, 2] + 1.4) < 0.03) & (np.abs(measured[:, :2]) < 2.0).all(axis=1)
    assert floor.sum() > 5000
    before = np.abs(measured[floor, 2] + 1.4)
    after = np.abs(everything(fitted)[floor, 2] + 1.4)
    assert after.mean() < 0.55 * before.mean()
    assert points(fitted, "surface_returns")[floor].mean() > 10
    assert fitted.as_measured().only_strays().strays == 0
    assert raw.as_measured() is raw


def test_a_map_whose_fields_have_their_earlier_names_is_read_and_exported_alike(
    fitted_and_raw, tmp_path
):
    root, fitted, _ = fitted_and_raw
    current, folder = root / "fitted", tmp_path / "earlier"
    write_earlier(current, folder)
    facts = json.loads((folder / "tiles.json").read_text())
    for earlier, now in TILE_FIELDS.items():
        (folder / "tiles" / f"{now}.npy").rename(folder / "tiles" / f"{earlier}.npy")
        facts["fields"][facts["fields"].index(now)] = earlier
    (folder / "tiles.json").write_text(json.dumps(facts))

    found = TileSet.open(folder)

    assert found.fields == fitted.fields
    for name in TILE_FIELDS.values():
        np.testing.assert_array_equal(points(found, name), points(fitted, name))
    for map_ in (current, folder):
        export_laz(map_, tmp_path / f"{map_.name}.laz")
    assert (tmp_path / "earlier.laz").read_bytes() == (tmp_path / "fitted.laz").read_bytes()
    (folder / "tiles" / "returns.npy").unlink()
    with pytest.raises(StoreError, match=r"surface_returns\.npy.*no file"):
        TileSet.open(folder)


def test_surfaces_are_fitted_unless_the_documents_are_followed():
    assert MapSettings().surface == "fitted"
    assert preset("thesis").map.surface == "raw"


@pytest.mark.study
def test_the_tiles_of_a_map_do_not_show_in_its_surfaces(tmp_path):
    walk = room_walk(frames=30, points=20_000, noise_m=0.01)

    small, large = (
        build(walk, tmp_path / f"{tile_m:g}", MapSettings(tile_m=tile_m)) for tile_m in (1.0, 10.0)
    )

    _, a, b = np.intersect1d(names_of(small), names_of(large), return_indices=True)
    apart = np.linalg.norm(everything(small)[a] - everything(large)[b], axis=1)
    assert len(a) > 0.98 * len(large)
    assert np.mean(apart > 0.001) < 0.06  # sparse places: their larger cells begin at the tile


def test_fitted_maps_do_not_depend_on_the_number_of_bursts_and_threads(tmp_path, monkeypatch):
    walk = room_walk(frames=15)
    settings = MapSettings(voxel_m=0.05, surface="fitted")

    for threads, burst in ((2, 10**9), (2, 5000), (1, 10**9), (4, 10**9)):
        monkeypatch.setattr(map_build, "MAP_BUILD", structs.replace(MAP_BUILD, workers=threads))
        build(walk, tmp_path / f"{threads} {burst}", settings, means=MapMeans(burst=burst))

    first, *others = (digest(folder) for folder in tmp_path.iterdir())
    assert len(others) == 3
    assert all(other == first for other in others)
