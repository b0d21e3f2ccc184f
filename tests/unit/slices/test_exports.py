import csv
import math
import signal
import subprocess
import sys
import tempfile

import ezdxf
import laspy
import numpy as np
import pytest
import rasterio
import rasterio.transform
from msgspec import structs

from recon4.api.maps import OpenedMap
from recon4.api.slices import SliceLook, write_planes
from recon4.errors import ConfigError, GeoreferenceError
from recon4.georeference.crs import CrsTransform, GeodeticOrigin
from recon4.georeference.site_grid import SiteGrid
from recon4.recording.formats.scratch import sweep_scratch
from recon4.slices import export
from recon4.slices.export import SliceSelection, write_csv, write_dxf, write_laz
from recon4.slices.geotiff import write_geotiff
from recon4.slices.map_crs import MapFrame, frame_of
from recon4.slices.pick import nearest_surface, pick
from recon4.slices.points import SliceWindow, points_in
from recon4.slices.sheet import SheetText, approval_text, grid_step_m, lay_out, write_sheet
from recon4.slices.slice_image import RasterGrid, draw
from recon4.slices.slice_plane import SlicePlane
from tests.unit.slices.room_map import TILE_M, wall, write_map

BRNO = CrsTransform(
    GeodeticOrigin(
        lat_rad=math.radians(49.2265), lon_rad=math.radians(16.5967), ellipsoidal_height_m=275.0
    )
)
LOCAL = MapFrame("", "", None)
PLACED = MapFrame(BRNO.crs, BRNO.wkt, BRNO.to_crs)
CUT = SlicePlane.horizontal(0.5, thickness_m=0.2)


@pytest.fixture(scope="module")
def tiles(tmp_path_factory):
    rng = np.random.default_rng(12)
    p, normal = wall(rng, 40_000, x_m=1.0)
    n = len(p)
    return write_map(
        tmp_path_factory.mktemp("map") / "m",
        p,
        normal=normal,
        intensity=rng.integers(0, 255, n).astype(np.uint16),
        sensor=rng.integers(0, 2, n).astype(np.uint8),
    )


def inside(tiles, *planes):
    return [
        np.concatenate([plane.to_map(p.uvd) for p in points_in(tiles, plane)]) for plane in planes
    ]


def test_a_dxf_has_a_layer_a_slice_in_metres_and_opens_without_complaint(tiles, tmp_path):
    planes = CUT.repeated(3, spacing_m=0.3)

    count = write_dxf(SliceSelection(tiles, planes), tmp_path / "s.dxf", frame=LOCAL)

    drawing = ezdxf.readfile(tmp_path / "s.dxf")
    points = list(drawing.modelspace())
    layers = {point.dxf.layer for point in points}
    assert drawing.audit().errors == [] and drawing.units == ezdxf.units.M
    assert 300 < len(points) < count == sum(map(len, inside(tiles, *planes)))
    assert sorted(layers) == ["SLICE_001_Z_0_500", "SLICE_002_Z_0_800", "SLICE_003_Z_1_100"]
    assert len({point.dxf.handle for point in points}) == len(points)
    comment = (tmp_path / "s.dxf").read_text("utf-8").splitlines()[1]
    assert comment == f"recon4 slice: {len(points)} of {count} points, one per square centimeter"
    z = np.array([p.dxf.location.z for p in points if p.dxf.layer == "SLICE_002_Z_0_800"])
    assert np.abs(z - 0.8).max() <= 0.1001


def test_all_files_of_a_slice_state_the_same_number_of_points(tiles, tmp_path):
    opened, look = OpenedMap(tiles, LOCAL, None), SliceLook("height", "wall")

    stated = {
        name: write_planes(opened, [CUT], tmp_path / f"s.{name}", look=look)
        for name in ("pdf", "tif", "dxf", "laz", "csv")
    }

    assert set(stated.values()) == {len(inside(tiles, CUT)[0])}


def test_a_square_centimeter_of_a_dxf_has_one_point_also_where_two_tiles_meet(tmp_path):
    p, normal = wall(np.random.default_rng(3), 4_000, x_m=TILE_M, size_m=(0.5, 0.5))
    tiles = write_map(tmp_path / "m", p, normal=normal)
    along = SlicePlane.vertical((TILE_M, 0.0), (TILE_M, 1.0), thickness_m=0.5)

    write_dxf(SliceSelection(tiles, [along]), tmp_path / "s.dxf", frame=LOCAL, flat=True)

    xyz = np.array([p.dxf.location.xyz for p in ezdxf.readfile(tmp_path / "s.dxf").modelspace()])
    cells = np.floor(xyz[:, :2] / 0.01)
    assert len(tiles.tiles) == 2 and len(np.unique(cells, axis=0)) > 0.97 * len(cells) > 1000


def test_a_flat_dxf_has_the_section_on_the_sheet(tiles, tmp_path):
    plane = SlicePlane.vertical((0.0, 1.0), (4.0, 1.0), thickness_m=0.2)

    write_dxf(SliceSelection(tiles, [plane]), tmp_path / "s.dxf", frame=LOCAL, flat=True)

    xyz = np.array([p.dxf.location.xyz for p in ezdxf.readfile(tmp_path / "s.dxf").modelspace()])
    assert np.abs(xyz[:, 0] - 1.0).max() < 0.06
    assert np.ptp(xyz[:, 1]) > 1.5 and np.abs(xyz[:, 2]).max() == 0.0


def test_a_laz_holds_the_points_of_the_slice_in_the_crs(tiles, tmp_path):
    count = write_laz(SliceSelection(tiles, [CUT]), tmp_path / "s.laz", frame=PLACED)

    with laspy.open(tmp_path / "s.laz") as file:
        found, crs = file.read(), file.header.parse_crs()
    expected = BRNO.to_crs(inside(tiles, CUT)[0])
    assert crs.to_epsg() == 32633 and len(found) == count == len(expected)
    assert np.sort(found.x) == pytest.approx(np.sort(expected[:, 0]), abs=0.0006)
    assert list(tmp_path.iterdir()) == [tmp_path / "s.laz"]


KILLED = """
import os, signal, sys
from pathlib import Path
from recon4.export import laz
from recon4.mapping.tiles import TileSet
from recon4.slices import export
from recon4.slices.slice_plane import SlicePlane
from recon4.slices.map_crs import MapFrame

def killed(*_, **__):
    os.kill(os.getpid(), signal.SIGKILL)

laz.export_laz = killed
cut = SlicePlane.horizontal(0.5, thickness_m=0.2)
chosen = export.SliceSelection(TileSet.open(Path(sys.argv[1])), [cut])
export.write_laz(chosen, Path(sys.argv[2]), frame=MapFrame("", "", None))
"""


def test_a_laz_whose_writer_was_killed_leaves_nothing_beside_it(tiles, tmp_path, monkeypatch):
    out, temporary = tmp_path / "out", tmp_path / "tmp"
    out.mkdir()
    temporary.mkdir()
    monkeypatch.setenv("TMPDIR", str(temporary))
    monkeypatch.setattr(tempfile, "tempdir", str(temporary))
    command = [sys.executable, "-c", KILLED, str(tiles.columns.folder.parent), str(out / "s.laz")]

    ended = subprocess.run(command, capture_output=True, check=False, timeout=300.0)

    assert ended.returncode == -signal.SIGKILL, ended.stderr
    assert list(out.iterdir()) == []
    assert sweep_scratch() == 1
    assert [*temporary.glob("*/*")] == []


def test_a_csv_holds_every_point_with_place_and_coordinates(tiles, tmp_path):
    count = write_csv(SliceSelection(tiles, [CUT]), tmp_path / "s.csv", frame=LOCAL)

    lines = (tmp_path / "s.csv").read_text().splitlines()
    rows = list(csv.DictReader(lines[1:]))
    x = np.array([float(row["x_m"]) for row in rows])
    assert lines[0] == "# recon4 slice, map frame (local), x y z, z up, meters"
    assert len(rows) == count and np.abs(x - 1.0).max() < 0.06
    assert float(rows[0]["z_m"]) == pytest.approx(0.5 + float(rows[0]["off_m"]), abs=2e-4)


def test_a_geotiff_lies_where_the_crs_says(tiles, tmp_path):
    drawn = draw(tiles, CUT, RasterGrid(SliceWindow(0.0, -1.0, 3.0, 5.0), 0.02), color="intensity")

    write_geotiff(drawn, tmp_path / "s.tif", frame=PLACED, rgba=drawn.rgba(drawn.span, "light"))

    with rasterio.open(tmp_path / "s.tif") as file:
        bands = file.read()
        rows, columns = np.nonzero(bands[3])
        xs, ys = rasterio.transform.xy(file.transform, rows, columns)
        xs, ys = np.asarray(xs), np.asarray(ys)
        assert file.crs.to_epsg() == 32633 and file.count == 4
    expected = BRNO.to_crs(inside(tiles, CUT)[0])
    assert xs.mean() == pytest.approx(expected[:, 0].mean(), abs=0.01)
    assert ys.mean() == pytest.approx(expected[:, 1].mean(), abs=0.05)
    assert np.ptp(ys) == pytest.approx(np.ptp(expected[:, 1]), abs=0.05)


def test_a_geotiff_in_the_grid_of_a_site_has_its_coordinates(tiles, tmp_path):
    grid = SiteGrid((601_200.0, 1_160_300.0, 200.0))
    frame = MapFrame(grid.crs, grid.wkt, grid.to_crs)
    drawn = draw(tiles, CUT, RasterGrid(SliceWindow(0.0, -1.0, 3.0, 5.0), 0.02))

    write_geotiff(drawn, tmp_path / "s.tif", frame=frame, rgba=drawn.rgba(drawn.span, "light"))

    with rasterio.open(tmp_path / "s.tif") as file:
        assert file.transform @ (0, 0) == pytest.approx((601_200.0, 1_160_305.0), abs=1e-6)
        assert file.transform @ (150, 300) == pytest.approx((601_203.0, 1_160_299.0), abs=1e-6)
        assert file.crs is None or file.crs.to_epsg() is None


def test_a_geotiff_of_a_section_has_its_own_meters(tiles, tmp_path):
    plane = SlicePlane.vertical((0.0, 1.0), (4.0, 1.0), thickness_m=0.5)
    drawn = draw(tiles, plane, RasterGrid(SliceWindow(0.0, -1.0, 4.0, 3.0), 0.01))

    write_geotiff(drawn, tmp_path / "s.tif", frame=PLACED, rgba=drawn.rgba(drawn.span, "light"))

    with rasterio.open(tmp_path / "s.tif") as file:
        assert file.transform @ (0, 0) == pytest.approx((0.0, 3.0))
        assert file.transform @ (400, 400) == pytest.approx((4.0, -1.0))
        assert file.crs is None or file.crs.to_epsg() is None


def test_an_image_too_large_for_one_transformation_is_rejected(tiles, tmp_path):
    drawn = draw(tiles, CUT, RasterGrid(SliceWindow(-40e3, -40e3, 40e3, 40e3), 100.0))
    small = draw(tiles, CUT, RasterGrid(SliceWindow(-40e3, -40e3, 40e3, 40e3), 100.0))
    object.__setattr__(small.paper, "pixel_m", 0.01)

    with pytest.raises(GeoreferenceError, match="smaller part"):
        write_geotiff(small, tmp_path / "s.tif", frame=PLACED, rgba=drawn.rgba(drawn.span, "light"))


@pytest.mark.parametrize("ending", ["png", "svg", "pdf"])
@pytest.mark.study
def test_a_sheet_is_the_same_file_each_time(tiles, tmp_path, ending):
    layout = lay_out(SliceWindow(0.0, -1.0, 3.0, 5.0))
    drawn = draw(tiles, CUT, layout.paper)
    text = SheetText("office", LOCAL.text, "recon4", approval_text(None), "as measured")

    for name in ("a", "b"):
        write_sheet(drawn, layout, tmp_path / f"{name}.{ending}", span=drawn.span, text=text)

    first, again = (tmp_path / f"{name}.{ending}" for name in ("a", "b"))
    assert first.read_bytes() == again.read_bytes() and first.stat().st_size > 10_000


def test_a_sheet_has_a_usual_scale_at_which_all_fits():
    layout = lay_out(SliceWindow(0.0, 0.0, 40.0, 10.0), "a4")

    window = layout.window
    assert layout.scale == 200
    assert (window.right - window.left) * 1000 / 200 == pytest.approx(297 - 18 - 8)
    assert (window.left + window.right) / 2 == pytest.approx(20.0)
    assert layout.paper.width == round(271 / 25.4 * 300)


def test_an_unusual_scale_is_refused():
    with pytest.raises(ConfigError, match="one of"):
        lay_out(SliceWindow(0, 0, 1, 1), scale=37)


def test_grid_lines_are_at_round_numbers():
    assert [grid_step_m(x) for x in (14.0, 15.0, 50.0, 0.3)] == [1.0, 2.0, 5.0, 0.05]


def test_an_approved_map_says_by_whom():
    approval = {"version": 2, "who": "Ada", "role": "reviewer", "time": "T", "hash": "ab" * 32}

    assert (
        approval_text(approval) == f"Approved by Ada (reviewer) T, version 2, statement {'ab' * 8}"
    )
    assert approval_text(None) == "Not approved"


def test_coordinates_of_the_crs_lead_back_to_the_map():
    p = np.random.default_rng(1).uniform(-300, 300, (50, 3))

    assert np.abs(PLACED.from_crs(BRNO.to_crs(p)) - p).max() < 1e-5
    east, north, up = BRNO.to_crs(np.zeros((1, 3)))[0]
    assert f"origin at E {east:.3f} N {north:.3f} H {up:.3f} in EPSG:" in PLACED.text


def test_coordinates_of_another_place_are_refused():
    with pytest.raises(GeoreferenceError):
        PLACED.from_crs(np.array([[-5e6, 9e6, 0.0]]))


def test_a_map_without_a_place_is_local(tiles):
    folder = tiles.columns.folder.parent

    assert frame_of({"map": folder}).text == "map frame (local), x y z, z up, meters"


def test_the_nearest_point_of_the_slice_is_picked(tiles):
    every = inside(tiles, CUT)[0]
    target = every[7]

    found = pick(tiles, CUT, (float(target[0]) + 1e-4, float(target[1])), radius_m=0.02)

    assert found is not None and found.p_map == pytest.approx(target, abs=1e-9)
    assert pick(tiles, CUT, (3.0, 3.0), radius_m=0.1) is None


def test_the_foot_on_the_surface_is_found(tiles):
    foot = nearest_surface(tiles, np.array([1.08, 2.0, 1.0]))

    assert foot.p_map == pytest.approx([1.0, 2.0, 1.0], abs=0.008)
    assert np.abs(foot.normal) == pytest.approx([1.0, 0.0, 0.0], abs=0.05)
    assert nearest_surface(tiles, np.array([3.0, 2.0, 1.0])) is None


def test_a_dxf_of_too_many_points_is_refused_with_their_number_before_it_is_written(
    tiles, tmp_path, monkeypatch
):
    plane, limits = CUT.repeated(3, spacing_m=0.3), export.SLICE_EXPORT
    write_dxf(SliceSelection(tiles, plane), tmp_path / "s.dxf", frame=LOCAL)
    count = len(list(ezdxf.readfile(tmp_path / "s.dxf").modelspace()))
    monkeypatch.setattr(export, "SLICE_EXPORT", structs.replace(limits, max_dxf_points=count))
    assert write_dxf(SliceSelection(tiles, plane), tmp_path / "s.dxf", frame=LOCAL) > count
    monkeypatch.setattr(export, "SLICE_EXPORT", structs.replace(limits, max_dxf_points=count // 2))
    monkeypatch.setattr(export, "atomic_file", None)  # nothing may be begun

    with pytest.raises(ConfigError, match=f"at most {count // 2} points .* got {count}: .* LAZ"):
        write_dxf(SliceSelection(tiles, plane), tmp_path / "t.dxf", frame=LOCAL)

    assert not (tmp_path / "t.dxf").exists()
