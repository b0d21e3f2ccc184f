"""What belongs to a moving thing although scans meet it, and what only seems to be seen through."""

import numpy as np

from recon4.classes.stage import KnownPlaces, classify
from recon4.classes.tuning import SPREAD, THINGS, TOUCHING
from recon4.kernels.free_space import VERDICT
from recon4.kernels.seen_through import EVIDENCE
from recon4.kernels.things import JudgedPoints, move_as_things, spread_to_neighbors
from recon4.mapping.mirrors import Mirror, Wall
from recon4.model.classes import PointClass
from recon4.model.figures import MirrorFigures
from tests.unit.classes.scanned_scenes import HEIGHT_M, ROOM, Thing, box, scanned


def grid(low, high, step_m=0.1):
    """Points of a box, (N, 3)."""
    axes = [np.arange(a, b + 1e-9, step_m) for a, b in zip(low, high, strict=True)]
    return np.stack([one.ravel() for one in np.meshgrid(*axes, indexing="ij")], axis=1)


FLOOR = grid((-2.0, -2.0, 0.0), (4.0, 2.0, 0.0))
PERSON = grid((2.0, -0.2, 0.3), (2.3, 0.2, 1.7))
WALL = grid((3.0, -2.0, 0.0), (3.0, 2.0, 2.5))


def moved(*parts, rules, chosen=None):
    """Which points of some parts move, each part with what is known of it."""
    p = np.concatenate([points for points, _ in parts]) + 0.05
    evidence = np.concatenate([known for _, known in parts]).astype(np.int8)
    verdict, cubes = np.empty(len(p), np.int8), KnownPlaces().cubes
    body_m = np.array([0.0, 0.0, HEIGHT_M])
    points = JudgedPoints(p, evidence, verdict)
    spread_to_neighbors(points, body_m, SPREAD, cubes)
    things = np.ones(len(p), np.bool_) if chosen is None else evidence > chosen
    move_as_things(points, things, body_m, rules, cubes)
    ends = np.cumsum([len(points) for points, _ in parts])[:-1]
    return np.split(verdict == VERDICT.seen_through, ends)


def all_of(points, what):
    return points, np.full(len(points), what)


def halves(points, above, below):
    """What is known of points above and below their middle."""
    return points, np.where(points[:, 2] > points[:, 2].mean(), above, below)


def test_who_stands_for_a_while_moves_as_a_whole_and_floor_and_wall_stand():
    person = halves(PERSON, EVIDENCE.moved, EVIDENCE.met)

    on_floor, of_person, of_wall = moved(
        all_of(FLOOR, EVIDENCE.met), person, all_of(WALL, EVIDENCE.stands), rules=THINGS
    )

    assert of_person.all()
    assert not on_floor.any()
    assert not of_wall.any()


def test_what_surely_stands_in_a_moving_thing_stands():
    person = halves(PERSON, EVIDENCE.moved, EVIDENCE.stands)

    _, of_person = moved(all_of(FLOOR, EVIDENCE.met), person, rules=THINGS)

    # Cubes of neighbors in the middle of him have points of both kinds.
    low = PERSON[:, 2] < 0.9
    assert not of_person[low & (PERSON[:, 2] > 0.5)].any()


def test_a_table_with_some_points_that_seem_to_move_stands():
    table = PERSON, np.where(np.arange(len(PERSON)) % 10 == 0, EVIDENCE.moved, EVIDENCE.met)

    _, of_table = moved(all_of(FLOOR, EVIDENCE.met), table, rules=THINGS)

    assert of_table.mean() < 0.2


def test_the_upper_half_of_who_leans_on_a_wall_moves_and_the_wall_stands():
    person = halves(PERSON + np.array([0.6, 0.0, 0.0]), EVIDENCE.unknown, EVIDENCE.moved)
    wall = all_of(WALL, EVIDENCE.met)

    _, of_person, of_wall = moved(
        all_of(FLOOR, EVIDENCE.met), person, wall, rules=TOUCHING, chosen=EVIDENCE.doubted
    )

    assert of_person.all()
    assert not of_wall.any()


def mirror(x_m, left_m, right_m):
    """A narrow mirror across the walk: a beam has the range of its whole path through the room."""
    room = box("room", *ROOM)

    def reach(p, d, t_s):
        with np.errstate(divide="ignore", invalid="ignore"):
            hit = (x_m - p[:, 0]) / d[:, 0]
            at = p + hit[:, None] * d
            on = (hit > 0.0) & (d[:, 0] > 0.0) & (at[:, 1] > left_m) & (at[:, 1] < right_m)
            back = room.reach(at, d * [-1.0, 1.0, 1.0], t_s)
        return np.where(on, hit + back, np.inf)

    return Thing("mirror", reach)


def behind(before, thing):
    """A thing of which nothing is seen where a mirror is before it."""

    def reach(p, d, t_s):
        return np.where(np.isfinite(before.reach(p, d, t_s)), np.inf, thing.reach(p, d, t_s))

    return Thing(thing.name, reach)


def test_beams_that_a_narrow_mirror_reflects_see_through_nothing():
    before = mirror(4.0, 1.0, 1.25)
    room, shelf = box("room", *ROOM), box("shelf", (6.0, 0.5, 0.0), (6.4, 2.9, 2.0))
    things = behind(before, room), behind(before, shelf), before

    walk, names = scanned(*things, seconds=8.0, speed_m_s=0.6)
    classes, names = np.concatenate(list(classify(walk, walk.trajectory))), np.concatenate(names)

    assert (names == "mirror").sum() > 3000
    assert (classes[names == "shelf"] != PointClass.MOVING).mean() > 0.97


def test_beams_that_a_known_mirror_reflects_are_in_no_image():
    before = mirror(4.0, 0.5, 2.5)
    shelf = box("shelf", (6.0, 0.5, 0.0), (6.4, 2.9, 2.0))
    walk, names = scanned(behind(before, box("room", *ROOM)), behind(before, shelf), before)
    cells = np.argwhere(np.ones((40, 60), np.bool_)) + np.array([-50, 0])
    figures = MirrorFigures(area_m2=6.0, middle_m=(4.0, 1.5), behind=0.1)
    known = Mirror(Wall(np.array([-1.0, 0.0, 0.0]), -4.0), cells, figures, grid_m=0.05)

    without = np.concatenate(list(classify(walk, walk.trajectory)))
    classes = np.concatenate(list(classify(walk, walk.trajectory, mirrors=[known])))

    of_shelf, reflected = (np.concatenate(names) == name for name in ("shelf", "mirror"))
    assert (without[of_shelf] == PointClass.MOVING).mean() > 0.02
    assert (classes[of_shelf] == PointClass.MOVING).mean() < 0.002
    assert (classes[reflected] == PointClass.REFLECTION).mean() > 0.97
