import io

import numpy as np
import pytest
from PIL import Image

from recon4.errors import ConfigError
from recon4.slices.colors import Span, paint, table
from recon4.slices.points import SliceWindow
from recon4.slices.reference import load_reference
from recon4.slices.reference_import import import_reference
from recon4.slices.slice_image import RasterGrid, draw, png
from recon4.slices.slice_plane import SlicePlane
from recon4.slices.tuning_files import SLICE_COLORS
from tests.unit.slices.room_map import T0_NS, write_map

CUT = SlicePlane.horizontal(1.0, thickness_m=0.2)
PAPER = RasterGrid(SliceWindow(0.0, 0.0, 4.0, 2.0), 0.1)
POINTS = np.array(
    [[0.05, 1.95, 1.0], [0.07, 1.93, 1.05], [3.95, 0.05, 0.95], [2.05, 1.05, 2.0], [5.0, 1.0, 1.0]]
)


@pytest.fixture
def tiles(tmp_path):
    return write_map(
        tmp_path / "map",
        POINTS,
        intensity=np.array([10, 30, 50, 70, 90], np.uint16),
        sensor=np.array([0, 1, 1, 0, 0], np.uint8),
        t_ns=T0_NS + np.arange(5) * 10**9,
    )


def test_every_point_is_where_it_belongs_and_pixels_show_means(tiles):
    drawn = draw(tiles, CUT, PAPER, color="intensity")

    assert drawn.points == 3
    assert np.argwhere(drawn.count).tolist() == [[0, 0], [19, 39]]
    assert drawn.value[0, 0] == 20.0  # mean of 10 and 30
    assert drawn.value[19, 39] == 50.0
    assert np.isnan(drawn.value[10, 20])


def test_sensors_are_never_mixed(tiles):
    drawn = draw(tiles, CUT, PAPER, color="sensor")

    assert drawn.value[0, 0] in (0.0, 1.0)
    assert drawn.value[19, 39] == 1.0


def test_time_counts_from_the_start_and_height_is_that_of_the_map(tiles):
    time = draw(tiles, CUT, PAPER, color="time")
    height = draw(tiles, CUT, PAPER, color="height")

    assert time.value[19, 39] == pytest.approx(2.0)
    assert height.value[19, 39] == pytest.approx(0.95, abs=2.5e-4)


def test_points_grow_when_pixels_become_smaller_than_the_grid_of_the_map(tiles):
    paper = RasterGrid(SliceWindow(3.9, 0.0, 4.0, 0.1), 0.001)

    drawn = draw(tiles, CUT, paper, color="height")

    assert drawn.points == 1
    assert (drawn.count > 0).sum() == 69  # all within 4.5 pixels


def test_distances_are_colored_from_blue_to_red_and_the_reference_is_green(tiles, tmp_path):
    cloud = tmp_path / "reference.xyz"
    cloud.write_text("\n".join(f"{x:.2f} 1.90 1.0" for x in np.arange(0.0, 4.0, 0.02)))
    import_reference(cloud, tmp_path / "reference")
    reference = load_reference(tmp_path / "reference", method="point")

    drawn = draw(tiles, CUT, PAPER, color="distance", reference=reference)
    rgba = drawn.rgba(Span(*SLICE_COLORS.distance_range_m), "light")

    assert drawn.span == Span(0.0, 0.10)
    assert drawn.value[0, 0] == pytest.approx(np.hypot(0.05, 0.01), abs=1e-3)
    assert np.isinf(drawn.value[19, 39])
    assert rgba[19, 39, 0] > 200 > rgba[19, 39, 2]
    assert tuple(rgba[1, 20, :3]) == SLICE_COLORS.reference_color


def test_the_ends_of_a_palette_stand_for_everything_beyond():
    colors = paint(np.array([-5.0, 0.0, 1.0, 9.0]), Span(0.0, 1.0), color="height", ground="light")

    assert np.array_equal(colors[0], colors[1]) and np.array_equal(colors[2], colors[3])
    assert np.array_equal(colors[3], table("height", "light")[255])


@pytest.mark.parametrize("color", ["height", "intensity", "normalized"])
def test_thin_lines_of_all_values_are_seen_on_a_dark_screen(color):
    panel = np.array([[0x1A, 0x20, 0x26]])

    contrast = (luminance(table(color, "dark")) + 0.05) / (luminance(panel) + 0.05)

    assert contrast.min() >= 3.0  # WCAG 2.2, 1.4.11: graphical objects


def luminance(rgb):
    """Relative luminance of colors (WCAG 2.2), (N,)."""
    part = rgb / 255.0
    linear = np.where(part <= 0.04045, part / 12.92, ((part + 0.055) / 1.055) ** 2.4)
    return linear @ (0.2126, 0.7152, 0.0722)


def test_an_image_is_a_png_transparent_without_points(tiles):
    drawn = draw(tiles, CUT, PAPER)

    image = Image.open(io.BytesIO(png(drawn.rgba(drawn.span, "dark"))))

    assert image.size == (40, 20)
    assert image.getpixel((20, 10))[3] == 0 and image.getpixel((0, 0))[3] > 100


def test_a_too_large_image_is_rejected_before_it_is_drawn():
    with pytest.raises(ConfigError, match="larger pixels"):
        RasterGrid(SliceWindow(0.0, 0.0, 1000.0, 1000.0), 0.001)


def test_what_the_map_lacks_is_said(tiles):
    with pytest.raises(ConfigError, match="reference"):
        draw(tiles, CUT, PAPER, color="distance")
