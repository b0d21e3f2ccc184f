"""Which points of tiny scenes are of the carrier or of something that moves."""

from collections import deque

import numpy as np
import pytest

from recon4.classes.stage import KnownPlaces, _compared_spans, classify, write_classes
from recon4.classes.tuning import SPREAD
from recon4.classes.views import RegularViews
from recon4.errors import StoreError
from recon4.kernels.free_space import VERDICT
from recon4.kernels.seen_through import EVIDENCE
from recon4.kernels.things import JudgedPoints, spread_to_neighbors
from recon4.mapping.tuning import MAP_BUILD
from recon4.model.classes import PointClass, is_delivered
from recon4.store.classes import StoredClasses
from tests.unit.classes.scanned_scenes import HEIGHT_M, ROOM, Thing, box, cylinder, pane, scanned

STANDS = int(PointClass.UNCLASSIFIED)


def found(*things, **how):
    """Class and name of all points of a scene."""
    walk, names = scanned(*things, **how)
    return np.concatenate(list(classify(walk, walk.trajectory))), np.concatenate(names)


def kept(classes, names, name):
    return (classes[names == name] == STANDS).mean()


def test_a_person_who_crosses_the_room_is_moving_and_the_room_stands():
    person = cylinder("person", lambda t_s: (7.0, -2.5 + 0.4 * t_s), 0.25)

    classes, names = found(box("room", *ROOM), person)

    assert (classes[names == "person"] == PointClass.MOVING).mean() > 0.9
    assert kept(classes, names, "room") > 0.998


def test_the_carrier_behind_the_sensor_is_found_and_the_walls_beside_are_kept():
    carrier = cylinder("carrier", lambda t_s: (0.4 * t_s - 0.4, 0.0), 0.2, 1.6)

    classes, names = found(
        *(box("corridor", (-6.0, -0.7, 0.0), (9.0, 0.7, 2.5)), carrier),
        seconds=7.0,
        azimuth_deg=(-180.0, 180.0),
    )

    assert (classes[names == "carrier"] == PointClass.CARRIER).mean() > 0.99
    assert kept(classes, names, "corridor") > 0.998


def test_who_walks_beside_the_carrier_moves_and_is_no_part_of_the_carrier():
    carrier = cylinder("carrier", lambda t_s: (0.4 * t_s - 0.4, 0.0), 0.2, 1.6)
    friend = cylinder("friend", lambda t_s: (0.4 * t_s, 0.9 + 0.15 * np.sin(t_s)), 0.2)

    classes, names = found(
        *(box("hall", (-6.0, -1.5, 0.0), (12.0, 1.8, 2.5)), carrier, friend),
        azimuth_deg=(-180.0, 180.0),
    )

    assert (classes[names == "carrier"] == PointClass.CARRIER).mean() > 0.99
    assert (classes[names == "friend"] == PointClass.MOVING).mean() > 0.95
    assert kept(classes, names, "hall") > 0.995


def test_beams_that_graze_a_doorway_do_not_erase_its_frame():
    left = box("frame", (5.0, -3.0, 0.0), (5.2, -0.45, 3.0))
    right = box("frame", (5.0, 0.45, 0.0), (5.2, 3.0, 3.0))

    classes, names = found(box("room", (-3.0, -3.0, 0.0), (14.0, 3.0, 3.0)), left, right)

    assert kept(classes, names, "frame") > 0.999
    assert kept(classes, names, "room") > 0.998


@pytest.mark.parametrize("radius_m", [0.02, 0.1])
def test_a_pole_stands(radius_m):
    pole = cylinder("pole", lambda _: (6.0, 0.8), radius_m, 2.5)

    classes, names = found(box("room", *ROOM), pole)

    assert kept(classes, names, "pole") > 0.99


def test_the_room_behind_a_pane_stands():
    classes, names = found(box("room", *ROOM), pane(7.0))

    assert (names == "pane").any()
    assert kept(classes, names, "room") == 1.0


def test_who_stands_the_whole_walk_is_not_moving():
    person = cylinder("person", lambda _: (7.0, 1.0), 0.25)

    classes, names = found(box("room", *ROOM), person)

    assert kept(classes, names, "person") > 0.99


def test_a_car_that_stands_until_it_drives_off_is_moving():
    car = cylinder("car", lambda t_s: (6.0, 1.5 + 3.0 * max(float(np.min(t_s)) - 6.0, 0.0)), 0.4)

    classes, names = found(box("room", (-3.0, -3.0, 0.0), (9.0, 12.0, 3.0)), car, seconds=14.0)

    assert (classes[names == "car"] == PointClass.MOVING).mean() > 0.9
    assert kept(classes, names, "room") > 0.998


def test_most_of_a_bus_that_stands_close_to_a_wall_until_it_drives_off_is_moving():
    standing = box("bus", (4.0, 1.6, 0.0), (8.0, 2.7, 2.2))

    def reach(p, d, t_s):
        gone_m = 3.0 * max(float(np.min(t_s)) - 6.0, 0.0)
        return standing.reach(p - [gone_m, 0.0, 0.0], d, t_s)

    hall = box("hall", (-3.0, -3.0, 0.0), (40.0, 3.0, 3.0))

    classes, names = found(hall, Thing("bus", reach), seconds=14.0)

    assert (classes[names == "bus"] == PointClass.MOVING).mean() > 0.7
    assert kept(classes, names, "hall") > 0.998


def test_what_comes_back_to_its_place_is_moving_although_scans_meet_it():
    def place(t_s):
        return (6.0, 1.5) if float(np.min(t_s)) % 3.0 < 1.4 else (6.0, -8.0)

    classes, names = found(box("room", *ROOM), cylinder("car", place, 0.4))

    assert (names == "car").sum() > 500
    assert (classes[names == "car"] == PointClass.MOVING).mean() > 0.9
    assert kept(classes, names, "room") > 0.998


def test_the_feet_of_who_walks_are_moving_and_the_floor_under_them_stands():
    person = cylinder("person", lambda t_s: (4.0, -2.5 + 0.4 * t_s), 0.25)
    walk, _ = scanned(box("room", *ROOM), person)

    classes, names = found(box("room", *ROOM), person)

    z_m = HEIGHT_M + np.concatenate([frame.xyz[:, 2] for frame in walk.frames])
    feet = (names == "person") & (z_m > 0.15) & (z_m < 0.4)
    assert feet.sum() > 20
    assert (classes[feet] == PointClass.MOVING).mean() > 0.9
    assert kept(classes, names, "room") > 0.998


def test_the_classes_of_a_walk_are_stored_by_multiframe(tmp_path):
    person = cylinder("person", lambda t_s: (7.0, -2.5 + 0.4 * t_s), 0.25)
    walk, _ = scanned(box("room", *ROOM), person, seconds=6.0)

    figures = write_classes(classify(walk, walk.trajectory), tmp_path)
    stored = StoredClasses.open(tmp_path)

    expected = list(classify(walk, walk.trajectory))
    for k, classes in enumerate(expected):
        np.testing.assert_array_equal(stored.of(k, len(classes)), classes)
    counts = np.bincount(np.concatenate(expected), minlength=256)
    assert figures.points == counts.sum()
    assert figures.classes["moving"] == counts[PointClass.MOVING] > 0


def test_damaged_classes_are_refused(tmp_path):
    walk, _ = scanned(box("room", *ROOM), seconds=2.0)
    write_classes(classify(walk, walk.trajectory), tmp_path)
    stored = StoredClasses.open(tmp_path)

    with pytest.raises(StoreError, match="expected 3 packed bytes"):
        stored.of(0, 3)
    with pytest.raises(StoreError, match="one of 4 multiframes"):
        stored.of(4, 1)
    (tmp_path / "classes.zst").write_bytes(b"short")
    with pytest.raises(StoreError, match="expected the bytes"):
        StoredClasses.open(tmp_path)


def test_what_moves_the_carrier_reflections_and_noise_are_left_out():
    codes = np.array([0, 1, 2, 3, 4, 5, 6, 7, 18, 64, 65, 66], np.uint8)

    np.testing.assert_array_equal(is_delivered(codes), codes * (codes < 7) == codes)


def test_images_of_scans_stay_as_they_are_while_threads_read_them_across_a_gap():
    walk, _ = scanned(box("room", *ROOM), seconds=46.0, speed_m_s=0.1)
    whole = [frame for k, frame in enumerate(walk.frames) if not 12 < k < 80]  # 34 s without a scan
    frames = type(walk)(whole, walk.rig, walk.trajectory)
    in_work = deque(maxlen=MAP_BUILD.workers)

    for _, views in _compared_spans(frames, RegularViews(frames, walk.trajectory, mirrors=())):
        for images, rows, before in in_work:
            assert np.array_equal(images[rows], before)
        if views is not None:
            rows = np.unique(np.concatenate([views.asked, views.before, views.after]))
            in_work.append((views.sights.images, rows, views.sights.images[rows].copy()))
    assert len(in_work) == MAP_BUILD.workers


def test_all_points_of_a_dense_scan_may_lie_in_one_cube():
    """A hand before the sensor: more points than 16 bits count."""
    p = np.full((40_000, 3), 1.05)
    evidence, verdict = np.full((2, len(p)), EVIDENCE.met, np.int8)
    evidence[:5000] = EVIDENCE.moved

    points = JudgedPoints(p, evidence, verdict)
    spread_to_neighbors(points, np.zeros(3), SPREAD, KnownPlaces().cubes)

    assert (verdict == VERDICT.met).all()
