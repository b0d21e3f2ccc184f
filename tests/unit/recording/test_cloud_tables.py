"""Layouts of ``PointCloud2``: types of fields, lengths of rows."""

import numpy as np
import pytest

from recon4.model.derived_kinds import DerivedKind
from tests.builders import T0_NS, Bag, bag_path
from tests.robot_bags import RobotBag
from tests.unit.recording.point_bags import ROOM, STEP_NS, read
from tests.variants.messages import CloudMessage


def cloud_bag(folder, table, alter=lambda message: None):
    """A bag of three clouds, each altered before it is written."""
    path = bag_path(folder, "db3")
    with Bag(path, "db3") as bag:

        def write(topic, kind, t_ns, message, *, write=bag.write):
            alter(message)
            write(topic, kind, t_ns, message)

        bag.write = write
        for k in range(3):
            bag.cloud("/points", T0_NS + k * STEP_NS, table)
    return path


def with_type(name, code):
    def alter(message):
        next(field for field in message.fields if field.name == name).datatype = code

    return alter


@pytest.mark.parametrize("kind", ["u8", "i8"])
def test_times_of_64_bits_are_read(kind, tmp_path):
    since = np.round(ROOM["time"] * 1e9).astype(kind)
    table = {**ROOM, "time": since}

    _, shots, report = read(cloud_bag(tmp_path, table))

    expected = T0_NS + np.sort(since).astype(np.int64)
    np.testing.assert_array_equal(shots[0].t_ns - shots[0].t_ns[0], expected - expected[0])
    assert not report.counts["clouds_untimed"]


def test_a_field_of_an_unknown_type_is_named(tmp_path):
    _, shots, report = read(cloud_bag(tmp_path, ROOM, with_type("intensity", 13)))

    assert len(shots) == 3
    (found,) = (one for one in report.derived if one.kind is DerivedKind.FIELDS_UNREAD)
    assert found.values == {"where": "/points", "fields": "intensity (13)"}


@pytest.mark.parametrize("kind", ["<f4", "<f8"])
def test_clouds_with_bytes_in_another_order_than_they_state_are_read_and_it_is_stated(
    kind, tmp_path
):
    def alter(message):
        message.is_bigendian = True

    table = ROOM | {name: ROOM[name].astype(kind) for name in "xyz"}
    _, shots, report = read(cloud_bag(tmp_path, table, alter))

    np.testing.assert_array_equal(shots[0].xyz[:, 0], ROOM["x"])
    assert report.counts["clouds_other_order"] == 3
    (found,) = (one for one in report.derived if one.kind is DerivedKind.BYTES_ORDER)
    assert found.values == {"where": "/points"}


def test_clouds_with_the_bytes_that_they_state_keep_them(tmp_path):
    path = bag_path(tmp_path, "db3")
    with RobotBag(path, "db3") as bag:
        for k in range(3):
            t_ns = T0_NS + k * STEP_NS
            points = np.rec.fromarrays(
                [column.astype(column.dtype.newbyteorder(">")) for column in ROOM.values()],
                names=",".join(ROOM),
            )
            CloudMessage("/points", "lidar", t_ns, np.asarray(points))(bag, t_ns)

    _, shots, report = read(path)

    np.testing.assert_array_equal(shots[0].xyz[:, 0], ROOM["x"])
    assert not report.counts["clouds_other_order"]


def test_coordinates_of_an_unknown_type_are_the_reason_why_there_are_no_points(tmp_path):
    path = cloud_bag(tmp_path, ROOM, with_type("y", 13))

    _, _, report = read(path)

    assert "unknown types: y (13)" in report.why_no_points()


@pytest.mark.parametrize("row_step", [0, 7, 1 << 30])
def test_the_length_of_a_row_does_not_matter_where_rows_are_packed(row_step, tmp_path):
    def alter(message):
        message.row_step = row_step

    _, shots, _ = read(cloud_bag(tmp_path, ROOM, alter))

    np.testing.assert_array_equal(shots[0].xyz[:, 0], ROOM["x"])


def test_a_cloud_with_too_few_bytes_says_so_where_no_point_is_left(tmp_path):
    def alter(message):
        message.data = message.data[:-1]

    _, _, report = read(cloud_bag(tmp_path, ROOM, alter))

    assert "does not fit into" in report.why_no_points()
