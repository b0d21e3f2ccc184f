"""Corrections of classes in a map that is made: what was counted before is what changes."""

import numpy as np
import pytest

from recon4.classes.corrections import count_points
from recon4.mapping.build import MapInputs, build_map
from recon4.mapping.class_corrections import ClassVolumes
from recon4.model.class_corrections import Reclassified
from recon4.model.classes import PointClass
from recon4.model.volumes import Box, Prism, bounds_of
from recon4.settings import MapSettings
from tests.room_walks import room_walk
from tests.unit.mapping.test_point_classes import MOVES, STANDS, Marked, column

BUILDING = int(PointClass.BUILDING)


def made(folder, walk, surface, *corrections):
    folder.mkdir()
    inputs = MapInputs(
        walk,
        walk.trajectory,
        classes=Marked(),
        corrections=ClassVolumes.of(corrections) if corrections else None,
    )
    return build_map(
        inputs, folder, settings=MapSettings(surface=surface, voxel_m=0.05, tile_m=4.0)
    )


def half_of(tiles):
    """The half of a map at larger x, which tiles share."""
    low, high = tiles.bounds_m
    middle = (low + 2.0 * high) / 3.0
    size = 2.0 * (high - middle) + 0.1
    return Box(center_m=tuple(map(float, high)), size_m=tuple(map(float, (size[0], 50.0, 50.0))))


def place(tiles):
    """Places and classes of all points, those left out as well, in one order."""
    parts = [part for part in (tiles, tiles.only_strays()) if len(part)]
    p = np.concatenate([tile.xyz_m() for part in parts for tile in part])
    classes = np.concatenate([column(part, "classification") for part in parts])
    order = np.lexsort(p.T)
    return p[order], classes[order]


@pytest.mark.parametrize("surface", ["fitted", "raw"])
def test_what_was_counted_in_the_map_is_what_changes_when_it_is_made_again(surface, tmp_path):
    walk = room_walk(frames=4)
    before = made(tmp_path / "a", walk, surface)
    volume = half_of(before)
    to_wall = Reclassified(volume=volume, to=BUILDING)
    away = Reclassified(volume=volume, to=MOVES, only=(BUILDING,))
    back = Reclassified(volume=volume, to=STANDS, only=(MOVES,))
    counts = [
        count_points(before, to_wall).points,
        count_points(before, away, [to_wall]).points,
        count_points(before, back, [to_wall, away]).points,
    ]

    after = made(tmp_path / "b", walk, surface, to_wall)
    gone = made(tmp_path / "c", walk, surface, to_wall, away)
    none = made(tmp_path / "d", walk, surface, to_wall, away, back)

    assert after.notes.corrected == (counts[0],)
    assert none.notes.corrected == tuple(counts)
    assert counts[0] == counts[1] < counts[2]  # what moved before is in the map, too
    assert len(before) == len(after) == len(gone) + counts[0]
    assert (column(after, "classification") == BUILDING).sum() == counts[0] > 1000
    assert len(none) == len(gone) + counts[2]
    p, classes = place(before)
    p_after, classes_after = place(after)
    low, high = bounds_of(volume)
    inside = np.all((p >= low) & (p <= high), axis=1) & (classes == STANDS)
    np.testing.assert_array_equal(p_after, p)
    np.testing.assert_array_equal(classes_after, np.where(inside, BUILDING, classes))


def test_a_map_without_corrections_is_the_same_byte_by_byte(tmp_path):
    walk = room_walk(frames=2)
    far = Reclassified(volume=Box(center_m=(1e4, 0.0, 0.0), size_m=(1.0, 1.0, 1.0)), to=MOVES)

    made(tmp_path / "a", walk, "fitted")
    with_one = made(tmp_path / "b", walk, "fitted", far)

    assert with_one.notes.corrected == (0,)
    for path in (tmp_path / "a" / "tiles").iterdir():
        assert path.read_bytes() == (tmp_path / "b" / "tiles" / path.name).read_bytes()


def test_why_nothing_would_change_is_said(tmp_path):
    tiles = made(tmp_path / "a", room_walk(frames=2), "raw")
    volume = half_of(tiles)
    away = Box(center_m=(10_000.0, 0.0, 0.0), size_m=(1.0, 1.0, 1.0))
    low, high = tiles.bounds_m
    x, y, z = ((low + high) / 2.0).tolist()
    corners = ((x, y), (x + 0.01, y), (x, y + 0.01))
    empty = Prism(polygon_m=corners, low_m=z, high_m=z + 0.01)
    said = [
        count_points(tiles, what).why_none(what)
        for what in (
            Reclassified(volume=away, to=BUILDING),
            Reclassified(volume=empty, to=BUILDING),
            Reclassified(volume=volume, to=BUILDING, only=(int(PointClass.GROUND),)),
            Reclassified(volume=volume, to=BUILDING),
        )
    ]

    assert said[0].startswith("there is no point in it: the map ends 99")
    assert said[1] == "there is no point in it"
    assert said[2].startswith("no point in it has a class that is corrected; it has unclassified")
    assert said[3] is None
    assert said[2].said("de").startswith("kein Punkt darin hat eine Klasse, die korrigiert wird")
    assert "; dort sind nicht klassifiziert (" in said[2].said("de")
