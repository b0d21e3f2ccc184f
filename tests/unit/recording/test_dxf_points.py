"""Points of drawings as lists of surveyed points."""

import io

import ezdxf
import pytest

from recon4.errors import CorruptFile
from recon4.recording.tables.points import read_point_table
from recon4.slices.control_points import read_control


def drawing(units=6, binary=False):
    """Two points with texts, a third far from any, and a block with attributes."""
    made = ezdxf.new("R2010", units=units)
    space = made.modelspace()
    for name, at in (("A1", (1000.0, 2000.0, 30.5)), ("B2", (1010.0, 2000.0, 31.25))):
        space.add_point(at)
        space.add_text(name, height=0.3).set_placement((at[0] + 0.2, at[1] + 0.2, 0.0))
    space.add_point((5000.0, 5000.0, 0.0))
    made.blocks.new("SURVEY")
    block = space.add_blockref("SURVEY", (1005.0, 2005.0, 32.0))
    block.add_attrib("HEIGHT", "32.000", (1005.0, 2005.0))
    block.add_attrib("PUNKTNR", "C3", (1005.0, 2005.0))
    out = io.BytesIO() if binary else io.StringIO()
    made.write(out, fmt="bin" if binary else "asc")
    return out.getvalue() if binary else out.getvalue().encode()


def test_points_of_a_drawing_have_the_names_beside_them():
    found = read_point_table(drawing(), "a.dxf")

    assert {one.name: one.xyz_m for one in found.points} == {
        "C3": (1005.0, 2005.0, 32.0),
        "A1": (1000.0, 2000.0, 30.5),
        "B2": (1010.0, 2000.0, 31.25),
        "3": (5000.0, 5000.0, 0.0),
    }
    assert found.preview.question == ""


def test_the_unit_of_a_drawing_counts():
    found = read_control(drawing(units=4), name="a.dxf")
    assert [one.xyz_m for one in found.points if one.id == "B2"] == [(1.01, 2.0, 0.03125)]
    with pytest.raises(CorruptFile, match=r"a\.dxf: expected meters, feet.*got unit 3"):
        read_control(drawing(units=3), name="a.dxf")


def test_a_damaged_drawing_and_one_without_points_are_said():
    empty = io.StringIO()
    ezdxf.new().write(empty)
    with pytest.raises(CorruptFile, match="expected points, or blocks with attributes"):
        read_control(empty.getvalue().encode(), name="a.dxf")
    with pytest.raises(CorruptFile, match="got a binary one"):
        read_control(drawing(binary=True), name="a.dxf")
    with pytest.raises(CorruptFile, match=r"a\.dxf: cut: expected EOF"):
        read_control(drawing()[:-9], name="a.dxf")
    with pytest.raises(CorruptFile, match=r"a\.dxf: cannot be read as DXF"):
        read_control(b"  0\nSECTION\n  x\nENTITIES\n  0\nEOF\n", name="a.dxf")
