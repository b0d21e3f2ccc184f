"""The map as a file for another program, from the page of its project."""

import pytest
from playwright.sync_api import expect

from tests.e2e.conftest import leave_out_viewer, looks
from tests.project_builder import build_project
from tests.service.running import server_thread

pytestmark = pytest.mark.e2e


@pytest.fixture(scope="module")
def server(tmp_path_factory):
    root = tmp_path_factory.mktemp("projects")
    build_project(root / "office", points=5_000, strays=3)
    with server_thread(root) as running:
        yield running


@looks("desktop light", "phone dark")
def test_the_map_is_downloaded_as_e57_and_what_cannot_be_written_is_said(
    server, page, screenshot, tmp_path
):
    leave_out_viewer(page)
    page.goto(f"{server.url}/projects/office/")
    part = page.locator("map-file")
    part.get_by_text("Map for another program").click()
    expect(part.get_by_label("Also noise")).to_be_enabled()
    part.get_by_label("Format").select_option("e57")
    expect(part.get_by_label("Also noise")).to_be_disabled()
    with page.expect_download() as download:
        part.get_by_role("link", name="Download").click()
    download.value.save_as(tmp_path / "map.e57")

    assert download.value.suggested_filename == "office-map.e57"
    assert (tmp_path / "map.e57").read_bytes().startswith(b"ASTM-E57")
    part.get_by_label("CRS").fill("EPSG:25832")
    part.get_by_role("link", name="Download").click()
    expect(part.get_by_role("alert")).to_contain_text("cannot be put into EPSG:25832")
    screenshot(page, "map-file")
