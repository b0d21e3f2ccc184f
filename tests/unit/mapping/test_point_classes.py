"""Points of classes that a map leaves out stay in its tiles, and replace no others."""

from dataclasses import dataclass
from pathlib import Path

import numpy as np
import pytest

from recon4.mapping.build import MapInputs, build_map
from recon4.model.classes import CLASSES, PointClass
from recon4.settings import MapSettings
from tests.room_walks import room_walk

MOVES, STANDS = int(PointClass.MOVING), int(PointClass.UNCLASSIFIED)
EVERY = 50
ROOT = Path(__file__).parents[3]


@dataclass
class Marked:
    """Every 50th point moves."""

    def of(self, row, count):
        classes = np.full(count, STANDS, np.uint8)
        classes[row % EVERY :: EVERY] = MOVES
        return classes


def built(folder, walk, surface, *, classes):
    folder.mkdir()
    settings = MapSettings(surface=surface, voxel_m=0.05, tile_m=4.0)
    return build_map(MapInputs(walk, walk.trajectory, classes=classes), folder, settings=settings)


def column(tiles, name):
    return np.concatenate([tile.read([name])[name] for tile in tiles])


@pytest.mark.parametrize("surface", ["fitted", "raw"])
def test_what_moves_is_beside_the_map_with_its_class(surface, tmp_path):
    walk = room_walk(frames=4)

    tiles = built(tmp_path / "map", walk, surface, classes=Marked())

    assert set(column(tiles, "classification")) == {STANDS}
    beside = column(tiles.only_strays(), "classification")
    assert 0 < (beside == MOVES).sum() <= 4 * 3000 / EVERY
    assert set(column(tiles, "echo")) == {0, 1}


def test_the_rest_of_the_map_is_that_of_the_standing_points_alone(tmp_path):
    walk = room_walk(frames=6)
    marked = Marked()
    for frame in walk.frames:  # the places of what moves are those of others, much nearer
        moving = np.flatnonzero(marked.of(frame.frame_id, len(frame)) == MOVES)
        frame.xyz[moving] = frame.xyz[moving - 1]
    standing = [f.take(marked.of(f.frame_id, len(f)) == STANDS) for f in walk.frames]

    with_them = built(tmp_path / "a", walk, "fitted", classes=marked)
    walk.frames = standing
    without = built(tmp_path / "b", walk, "fitted", classes=None)

    assert len(with_them) == len(without)
    for name in ("frame_id", "intensity"):
        np.testing.assert_array_equal(column(with_them, name), column(without, name))


def test_the_table_of_the_documentation_is_that_of_the_code():
    page = (ROOT / "docs" / "explanation" / "map.md").read_text("utf-8")

    for code, facts in CLASSES.items():
        delivered = "yes" if facts.delivered else ""
        assert f"| {int(code)} | {facts.title} | {facts.text} | {delivered} |" in page
