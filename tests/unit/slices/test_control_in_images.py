"""Lists of surveyed points in images, as OpenDroneMap has them: x, y, z, pixel, image, name."""

import pytest

from recon4.recording.tables.coordinates import ColumnChoice
from recon4.slices.control_points import read_control


@pytest.mark.parametrize(
    ("folder", "columns", "points", "first", "again"),
    [
        (
            "odm-br",
            ("x", "y", "z", "-", "-", "-", "id"),
            6,
            ("HV01", (658528.361, 7167002.098, 890.636)),
            "line 3: point 'HV01' is there already",
        ),
        (
            "odm-boruszyn",
            ("x", "y", "z", "-", "-", "-"),
            7,
            ("2", (340607.768, 548220.879, 70.8)),
            "line 3: point '2' is at this place already",
        ),
    ],
)
def test_a_coordinate_is_not_the_name_of_its_point(data, folder, columns, points, first, again):
    file = data(f"control/{folder}") / "gcp_list.txt"

    found = read_control(file.read_bytes())
    confirmed = read_control(file.read_bytes(), choice=ColumnChoice(found.table.columns))

    assert found.table.columns == columns and "does not name each column" in found.table.question
    assert confirmed.points == found.points and confirmed.table.question == ""
    assert len(found.points) == points
    assert (found.points[0].id, found.points[0].xyz_m) == first
    assert found.skipped[0] == again


def test_a_text_that_stands_for_several_places_is_no_name():
    rows = ["1.5 2.5 3.5 a.jpg", "4.5 2.5 3.5 a.jpg", "7.5 2.5 3.5 b.jpg"]

    found = read_control("\n".join(rows).encode())

    assert found.table.columns == ("x", "y", "z", "-")
    assert [one.id for one in found.points] == ["1", "2", "3"]
