"""Lists of corrections of classes, as JSON and as tables."""

import json

import pytest

from recon4.errors import ConfigError
from recon4.model.alike import PickedThing
from recon4.model.classes import PointClass
from recon4.model.volumes import Box, Brush, Prism, Sphere
from recon4.review.correction_files import read_corrections

TABLE = """shape,x,y,z,dx,dy,dz,yaw_deg,radius,low,high,polygon,path,to,only,why
box,1,2,3,1,1,2,90,,,,,,moving,unclassified|6,a visitor
sphere,1,2,3,,,,,0.5,,,,,7,,
prism,,,,,,,,,0.5,1.5,0 0 | 2 0 | 0 2,,Building,,
brush,,,,,,,,0.2,,,,0 0 1 | 0.1 0 1,low noise,,
"""


def listed(tmp_path, text, name="c.csv"):
    path = tmp_path / name
    path.write_text(text, "utf-8")
    return read_corrections(path)


@pytest.mark.parametrize("change", [str, lambda text: "\ufeff" + text.replace(",", ";")])
def test_a_table_has_boxes_balls_prisms_and_brushes(change, tmp_path):
    box, ball, prism, brush = listed(tmp_path, change(TABLE))

    assert box.what.volume.u == pytest.approx((0.0, 1.0, 0.0))
    assert (box.what.to, box.what.only, box.why) == (PointClass.MOVING, (1, 6), "a visitor")
    assert isinstance(ball.what.volume, Sphere)
    assert prism.what.volume == Prism(
        polygon_m=((0.0, 0.0), (2.0, 0.0), (0.0, 2.0)), low_m=0.5, high_m=1.5
    )
    assert prism.what.to == PointClass.BUILDING
    assert brush.what.volume == Brush(path_m=((0.0, 0.0, 1.0), (0.1, 0.0, 1.0)), radius_m=0.2)
    assert prism.where == "c.csv, line 4"


def test_json_has_volumes_of_any_orientation(tmp_path):
    box = {"shape": "box", "center_m": [1, 2, 3], "size_m": [1, 1, 2], "u": [0, 0, 1]}

    (one,) = listed(tmp_path, json.dumps([{"volume": box, "to": "ground"}]), "c.json")

    assert one.what.volume == Box(center_m=(1, 2, 3), size_m=(1, 1, 2), u=(0, 0, 1))


@pytest.mark.parametrize(
    ("change", "why"),
    [
        (lambda t: t.replace("Building", "wall"), "line 4: unknown class 'wall'; known: .*moving"),
        (lambda t: t.replace("sphere,1", "sphere,nan"), "line 3: sphere: expected finite"),
        (lambda t: t.replace("sphere,1", "sphere,one"), "line 3: x: expected a number, got 'one'"),
        (lambda t: t.replace(",0.5,,,,,7", ",0,,,,,7"), "line 3: sphere: .*not empty"),
        (lambda t: t.replace("0 0 | 2 0", "0 0 | 2"), "line 4: polygon: expected places"),
        (
            lambda t: t.replace("box", "cone"),
            "line 2: shape: expected box, sphere, prism, brush or",
        ),
        (lambda t: t.replace("box,1", "box,1,1"), "line 2: more cells"),
        (lambda t: t.partition("\n")[0], "expected 1 to 1000 corrections, got 0"),
        (lambda t: t.replace("shape", "form"), "expected the columns shape and to"),
    ],
)
def test_a_wrong_table_is_refused_with_its_line(change, why, tmp_path):
    with pytest.raises(ConfigError, match=why):
        listed(tmp_path, change(TABLE))


@pytest.mark.parametrize(
    ("text", "why"),
    [
        ("{", "is no JSON"),
        ("{}", "expected a list"),
        ('[{"to": "ground"}]', "correction 1: .*volume"),
        ('[{"volume": {"shape": "cone"}, "to": "ground"}]', "correction 1: .*cone"),
        (
            '[{"volume": {"shape": "sphere", "center_m": [0, 0, NaN], "radius_m": 1}, "to": "6"}]',
            "finite",
        ),
    ],
)
def test_wrong_json_is_refused_with_its_place(text, why, tmp_path):
    with pytest.raises(ConfigError, match=why):
        listed(tmp_path, text, "c.json")


def test_a_table_and_json_have_all_things_like_one(tmp_path):
    rows = "shape,x,y,z,alike,to\nlike,1,2,3,0.5,moving\nlike,1,2,3,,7\n"
    volume = {"shape": "like", "place_m": [1, 2, 3]}

    first, second = listed(tmp_path, rows)
    (third,) = listed(tmp_path, json.dumps([{"volume": volume, "to": "moving"}]), "c.json")

    assert first.what.picked == PickedThing(place_m=(1.0, 2.0, 3.0), to=PointClass.MOVING)
    assert [one.what.most_different for one in (first, second, third)] == [0.5, 1.0, 1.0]
    with pytest.raises(ConfigError, match="line 2: alike: expected 0 to 3, got 9"):
        listed(tmp_path, rows.replace("0.5", "9"))
