"""Estimates of exports: points after thinning, and what is on the disk while a file is made."""

import pytest
from msgspec import structs

from recon4.delivery.estimates import estimate_export
from recon4.delivery.kinds import KINDS
from recon4.export import expected, octree
from recon4.export.map_files import map_to_export, write_map
from recon4.export.node_scans import SCAN_ROW
from recon4.export.options import ExportOptions
from recon4.export.points import PointSource
from recon4.progress import Silent
from recon4.store.project import read_artifacts
from tests.project_builder import build_project


@pytest.fixture(scope="module")
def artifacts(tmp_path_factory):
    folder = tmp_path_factory.mktemp("estimate") / "room"
    build_project(folder, points=40_000, strays=20_000)
    return read_artifacts(folder)


@pytest.mark.parametrize("thin_m", [0.05, 0.2, 0.5])
def test_a_part_of_the_points_says_how_many_thinning_leaves(artifacts, monkeypatch, thin_m):
    """What the map leaves out lies closer together than its points."""
    few = structs.replace(expected.EXPECTED, sample=8_000, tiles=4)
    monkeypatch.setattr(expected, "EXPECTED", few)
    options = ExportOptions(thin_m=thin_m, all_points=True)
    map_ = map_to_export(artifacts, None, options)
    assert len(map_.tiles) > few.sample

    found = estimate_export(artifacts, "map.laz", options)

    true = PointSource.of(map_.tiles, map_.output, map_.selection).count
    assert found.points == pytest.approx(true, rel=0.1)
    assert KINDS["map.laz"].point_bytes <= found.bytes / found.points
    assert found.bytes / found.points <= KINDS["map.laz"].thinned_bytes + 0.01


def test_files_that_sort_points_are_as_large_as_is_said(artifacts, tmp_path, monkeypatch):
    sizes = []
    place = octree.PointFiles.place

    def sorted_(self, cube):
        files = place(self, cube)
        sizes.append(sum(file.path.stat().st_size for file in files.values()))
        return files

    monkeypatch.setattr(octree.PointFiles, "place", sorted_)
    map_ = map_to_export(artifacts, None, ExportOptions())
    write_map(map_, tmp_path / "map.copc.laz", progress=Silent())

    said = estimate_export(artifacts, "map.copc.laz", ExportOptions()).sorted_bytes
    assert 0.3 * said < sizes[0] <= said == round(len(map_.tiles) * 20.0)
    for name in ("map.e57", "map.ptx"):
        assert KINDS[name].sorted_bytes == SCAN_ROW.itemsize
