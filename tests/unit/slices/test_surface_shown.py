"""A slice or a view shows points on fitted surfaces or as measured, and says which."""

import numpy as np
import pytest

from recon4.mapping.tiles import surface_text
from recon4_app.slices.model import PickRequest, SliceImageRequest, SlicePlaneSpec, WindowSpec
from recon4_app.slices.slice_work import pick_point, slice_image
from recon4_app.viewer.client.legend import legend
from recon4_app.viewer.client.view import ViewState, view_from_json
from recon4_app.viewer.cloud.parts import Cloud
from recon4_app.viewer.scene.build import Content
from tests.unit.slices.room_map import write_map

LEVEL = SlicePlaneSpec(kind="horizontal", z_m=1.0, thickness_m=0.5)
WINDOW = WindowSpec(left=0.5, bottom=0.0, right=1.5, top=2.0)
OFFSET_M = 0.03125
"""Exact as a half float."""


@pytest.fixture
def folder(tmp_path):
    """Points on a wall at x = 1 m that were measured 3 cm beside it."""
    rng = np.random.default_rng(2)
    p = np.column_stack([np.ones(4000), rng.uniform(0, 2, 4000), rng.uniform(0.5, 1.5, 4000)])
    write_map(tmp_path / "map", p, raw_offset_m=np.tile([OFFSET_M, 0.0, 0.0], (4000, 1)))
    return tmp_path / "map"


def ask(**changes):
    return SliceImageRequest(plane=LEVEL, window=WINDOW, width=200, height=400, **changes)


@pytest.mark.parametrize("surface", ["fitted", "raw"])
def test_a_slice_says_where_its_points_lie(folder, surface):
    assert slice_image(str(folder), "", ask(surface=surface)).surface == surface


def test_the_image_shows_the_points_where_they_were_measured(folder):
    on, raw = (slice_image(str(folder), "", ask(surface=s)) for s in ("fitted", "raw"))

    assert ask().surface == "fitted"
    assert on.points == raw.points > 1000
    assert on.png != raw.png


@pytest.mark.parametrize(("surface", "x_m"), [("fitted", 1.0), ("raw", 1.0 + OFFSET_M)])
def test_a_picked_point_is_one_of_those_shown(folder, surface, x_m):
    wanted = PickRequest(plane=LEVEL, uv=(1.01, 1.0), radius_m=0.2, surface=surface)

    found = pick_point({"map": str(folder)}, wanted)

    assert found.p_map[0] == pytest.approx(x_m, abs=1e-6)


@pytest.mark.parametrize(("surface", "x_m"), [("fitted", 1.0), ("raw", 1.0 + OFFSET_M)])
def test_the_viewer_draws_either(folder, surface, x_m):
    cloud = Cloud(folder).on(surface)

    part, tile = cloud.part((0, 0)), cloud.tiles.tiles[0]
    for x in (cloud.base.p_part[:, 0] + cloud.base.origin_m[0], part.p_part[:, 0]):
        assert np.abs(x - x_m).max() < 1e-6
    assert np.abs(tile.read(["xyz"])["xyz"][:, 0] - x_m).max() < 1e-6
    view = ViewState(surface=surface)
    assert view_from_json(view.to_json()) == view
    expected = {"fitted": "On fitted surfaces, 0 ", "raw": "As measured, 0 "}[surface]
    assert legend(Content(cloud=Cloud(folder)), view).surface.startswith(expected)


def test_a_sheet_names_either():
    assert len({surface_text(surface) for surface in ("fitted", "raw", "strays")}) == 3


@pytest.fixture
def with_strays(tmp_path):
    """The same wall with nine stray returns half a meter behind it."""
    rng = np.random.default_rng(2)
    p = np.column_stack([np.ones(4000), rng.uniform(0, 2, 4000), rng.uniform(0.5, 1.5, 4000)])
    p[-9:, 0] = 1.5
    offset = np.tile([OFFSET_M, 0.0, 0.0], (4000, 1))
    write_map(tmp_path / "strays", p, strays=9, raw_offset_m=offset)
    return tmp_path / "strays"


def test_a_slice_shows_the_stray_returns_alone(with_strays):
    window = WindowSpec(left=0.5, bottom=0.0, right=2.0, top=2.0)
    shown = {
        surface: slice_image(
            str(with_strays),
            "",
            SliceImageRequest(plane=LEVEL, window=window, width=200, height=400, surface=surface),
        )
        for surface in ("fitted", "raw", "strays")
    }
    wanted = PickRequest(plane=LEVEL, uv=(1.5, 1.0), radius_m=0.5, surface="strays")

    found = pick_point({"map": str(with_strays)}, wanted)

    assert {name: image.surface for name, image in shown.items()} == {n: n for n in shown}
    assert 0 < shown["strays"].points <= 9
    assert shown["fitted"].points == shown["raw"].points > 1000
    assert found.p_map[0] == pytest.approx(1.5, abs=1e-6)


def test_the_viewer_draws_the_stray_returns_alone(with_strays):
    cloud = Cloud(with_strays)

    strays = cloud.on("strays")

    assert len(cloud) == len(cloud.on("raw")) == 3991
    assert len(strays) == len(strays.part((0, 0)).p_part) == 9
    assert np.abs(strays.part((0, 0)).p_part[:, 0] - 1.5).max() < 1e-6
    view = ViewState(surface="strays")
    assert view_from_json(view.to_json()) == view
    assert legend(Content(cloud=cloud), view).surface == "Only the 9 points left out"
    assert legend(Content(cloud=cloud), ViewState()).surface.endswith("9 points left out")


def test_a_map_without_stray_returns_stays_as_it_is(folder):
    assert len(Cloud(folder).on("strays")) == 4000
    image = slice_image(str(folder), "", ask(surface="strays"))
    assert image.surface == "fitted"
