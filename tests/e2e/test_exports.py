"""Files of the map from the page of its project."""

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
def test_a_file_is_ordered_downloaded_and_listed_and_what_cannot_be_made_is_said(
    server, page, screenshot, tmp_path
):
    leave_out_viewer(page)
    page.goto(f"{server.url}/projects/office/")
    panel = page.locator("export-panel")
    panel.get_by_role("combobox", name="File").select_option("map.xyz")
    panel.get_by_role("combobox", name="Points").select_option("some")
    panel.get_by_role("checkbox", name="unclassified").press("Space")
    expect(panel.get_by_role("status")).to_contain_text(
        "About 5 000 points".replace(" 000", "\u202f000")
    )
    panel.get_by_role("button", name="Make file").press("Enter")
    link = panel.get_by_role("link", name="XYZ, lines of text").first
    with page.expect_download() as download:
        link.click()
    download.value.save_as(tmp_path / "map.xyz")

    assert download.value.suggested_filename == "office-map.xyz"
    assert len((tmp_path / "map.xyz").read_text().splitlines()) == 5_001
    expect(panel.locator(".exports li").first).to_contain_text("local")
    panel.get_by_text("Hash and version").first.click()
    page.locator("#export-title").evaluate("title => title.scrollIntoView()")
    screenshot(page, "exports")
    panel.get_by_text("Coordinates, box and more").click()
    panel.get_by_label("CRS").fill("EPSG:25832")
    expect(panel.get_by_role("alert")).to_contain_text("cannot be put into EPSG:25832")

    page.context.add_cookies([{"name": "recon4_language", "value": "de", "url": server.url}])
    page.reload()
    row = panel.locator(".exports li").first
    expect(row).to_contain_text("5\u202f000 Punkte · local")
    expect(row).not_to_contain_text("points · local")
