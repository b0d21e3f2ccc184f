"""The view that a browser keeps as JSON."""

import json

import pytest

from recon4.store.earlier_names import PALETTES
from recon4_app.viewer.client.view import Stretch, ViewState, stretch_from_text, view_from_json
from recon4_app.viewer.cloud.palette import Range
from recon4_app.viewer.scene.layers import FINAL

VIEW = ViewState(
    color_by="raw intensity",
    palette="turbo",
    ranges={"height": (0.0, 2.5)},
    point_size_m=0.01,
    chosen={"trajectory": False},
    points="map and multiframe",
    moment=7,
    window_s=2.0,
    edge_color="chi²",
    detail=500_000,
    adapt=False,
    measurements=(((1.0, 2.0, 3.0),), ((0.0, 0.0, 0.0), (1.0, 0.0, 0.0))),
    stretch=Stretch(span_s=(2.0, 3.5), places=((1.0, 2.0, 0.0),)),
)


def test_a_view_survives_a_round_trip_through_a_browser():
    assert view_from_json(VIEW.to_json()) == VIEW


@pytest.mark.parametrize(("earlier", "palette"), PALETTES.items())
def test_a_palette_of_an_earlier_version_is_kept(earlier, palette):
    kept = json.dumps({**json.loads(VIEW.to_json()), "palette": earlier})

    assert view_from_json(kept).palette == palette


@pytest.mark.parametrize(
    "changes",
    [
        {"color_by": "<script>"},
        {"palette": None},
        {"ranges": {"height": [0.0, "x"]}},
        {"ranges": {"height": [0.0, float("nan")]}},
        {"moment": "many"},
        {"measurements": [[[1, 2, 3], [4, 5, 6], [7, 8, 9]]]},
        {"measurements": [[[1, 2]]]},
        {"chosen": 5},
        {"stretch": {"span_s": [1, "x"], "places": []}},
        {"stretch": {"span_s": None, "places": [[0, 0, 0]] * 3}},
        {"stretch": 5},
    ],
)
def test_a_malformed_view_is_none(changes):
    assert view_from_json(json.dumps({**json.loads(VIEW.to_json()), **changes})) is None


@pytest.mark.parametrize("text", [None, "", "[]", "3", "{}", "[" * 100_000])
def test_malformed_text_is_none(text):
    assert view_from_json(text) is None


def test_what_a_person_did_not_switch_is_as_it_is_at_first():
    assert ViewState().shows(FINAL)
    assert not ViewState().with_layer(FINAL.key, on=False).shows(FINAL)


def test_a_range_belongs_to_what_the_points_are_colored_by():
    view = ViewState(color_by="height").with_range(Range(1.0, 2.0))

    assert view.range_of("height") == Range(1.0, 2.0)
    assert view.range_of("time") is None
    assert view.with_range(None).range_of("height") is None


def test_a_view_kept_by_an_earlier_version_has_no_stretch():
    record = json.loads(VIEW.to_json())
    del record["stretch"]

    assert view_from_json(json.dumps(record)).stretch is None


def test_the_fragment_of_a_link_names_a_stretch():
    assert stretch_from_text("span=12,15.25&place=1,2,0,3.5,-2,0") == Stretch(
        span_s=(12.0, 15.25), places=((1.0, 2.0, 0.0), (3.5, -2.0, 0.0))
    )
    assert stretch_from_text("span=15,12").span_s == (12.0, 15.0)
    assert stretch_from_text("place=1,2,0").span_s is None


@pytest.mark.parametrize(
    "text",
    [None, "", "x", "span=", "span=1", "span=1,nan", "span=1,1e300", "place=1,2", "span=1,2,3",
     "place=1,2,3,4,5,6,7,8,9", "span=<b>,2"],
)  # fmt: skip
def test_a_malformed_fragment_names_none(text):
    assert stretch_from_text(text) is None
