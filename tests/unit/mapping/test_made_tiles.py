"""The stage ``map`` goes on where it was stopped."""

import pytest

from recon4.errors import Cancelled
from recon4.mapping import build as map_build
from recon4.mapping import finish
from recon4.mapping.build import MapInputs, MapMeans, build_map
from recon4.progress import Silent
from recon4.settings import MapSettings
from recon4.store.unfinished import keeping
from tests.room_walks import room_walk
from tests.unit.mapping.test_map_build import digest

SETTINGS = MapSettings(tile_m=2.0)


class StopsAt(Silent):
    """Asks to stop at a unit of a task."""

    def __init__(self, task, count):
        super().__init__()
        self.task, self.left, self.now = task, count, ""

    def start(self, name, total, unit):
        super().start(name, total, unit)
        self.now = name

    def advance(self, done=1):
        if self.now == self.task:
            self.left -= done
            if self.left < 0:
                raise Cancelled("enough")


@pytest.mark.parametrize(
    ("task", "count", "placed_again"), [("place points", 3, True), ("map", 4, False)]
)
def test_a_map_that_was_stopped_goes_on_with_the_same_bytes(
    tmp_path, monkeypatch, task, count, placed_again
):
    walk, made, placed = room_walk(frames=6, points=800), [], []
    make_tile, place = finish.make_tile, map_build.place_with_origins
    monkeypatch.setattr(finish, "make_tile", lambda *a, **k: made.append(1) or make_tile(*a, **k))
    monkeypatch.setattr(map_build, "place_with_origins", lambda *a: placed.append(1) or place(*a))

    def run(name, progress):
        made.clear()
        placed.clear()
        out = tmp_path / name
        out.mkdir()
        inputs = MapInputs(walk, walk.trajectory)
        with keeping(tmp_path / "project", "map", "key"):
            build_map(inputs, out, settings=SETTINGS, progress=progress, means=MapMeans(burst=900))
        return digest(out), len(made), len(placed)

    whole, tiles, _ = run("whole", Silent())
    with pytest.raises(Cancelled):
        run("stopped", StopsAt(task, count))
    again, rest, placed_twice = run("again", Silent())

    assert again == whole
    assert (placed_twice > 0) == placed_again
    assert rest == tiles if placed_again else rest <= tiles - count
