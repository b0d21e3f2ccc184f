"""Files of the map from the page of its project."""

import re
import zipfile

import numpy as np
import pytest
from playwright.sync_api import expect

from recon4.review.trusted_keys import ensure_own_key
from tests.e2e.conftest import leave_out_viewer, looks, one_look
from tests.project_builder import approve_project, build_project
from tests.service.running import server_thread

pytestmark = pytest.mark.e2e


@pytest.fixture(scope="module")
def server(tmp_path_factory):
    root = tmp_path_factory.mktemp("projects")
    build_project(root / "office", points=5_000, strays=3)
    build_project(root / "house", points=5_000)
    ensure_own_key(root / ".recon4")
    approve_project(root / "house", root / ".recon4/signing.key", who="J. Novák")
    with server_thread(root) as running:
        yield running


@one_look
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


@looks("desktop light")
def test_the_part_that_the_page_map_shows_is_exported_and_the_way_leads_back(
    server, page, screenshot, tmp_path
):
    leave_out_viewer(page)
    map_page = f"{server.url}/projects/office/map/?z=0.5..&box=8,1,1.5,6,4,4,0.5236"
    page.goto(map_page)
    expect(page.locator("#status .shown")).to_have_text(re.compile(r"of 5.000 points$"))
    page.get_by_role("link", name="Export this part…").click()
    panel = page.locator("export-panel")
    part = panel.get_by_role("group", name="Part shown on the page Map")
    expect(part).to_contain_text("box 6 × 4 × 3 m, middle 8, 1, 2, turned by 30°")
    panel.get_by_role("combobox", name="File").select_option("plan.dxf")
    expect(part).to_contain_text("made of the whole map")
    panel.get_by_role("combobox", name="File").select_option("map.xyz")
    screenshot(page, "export-part")
    panel.get_by_role("button", name="Make file").click()
    row = panel.locator(".exports li").first
    expect(row).to_contain_text("inside of a box 6 × 4 × 3 m")
    with page.expect_download() as download:
        row.get_by_role("link").click()
    download.value.save_as(tmp_path / "part.xyz")

    found = np.loadtxt(tmp_path / "part.xyz", skiprows=1)[:, :3]
    x, y, z = (found - (8.0, 1.0, 2.0)).T
    turn = np.radians(30.0)
    assert 10 < len(found) < 2_500
    assert (np.abs(np.cos(turn) * x + np.sin(turn) * y) < 3.001).all()
    assert (np.abs(np.cos(turn) * y - np.sin(turn) * x) < 2.001).all()
    assert (np.abs(z) < 1.501).all()
    part.get_by_role("link", name="Back to the map").click()
    expect(page).to_have_url(re.compile("map/.*box=8,1,1.5,6,4,4,0.5236"))
    page.go_back()
    panel.get_by_role("button", name="All of the map").click()
    expect(part).to_have_count(0)
    assert page.url == f"{server.url}/projects/office/"


@one_look
def test_a_delivery_is_chosen_packed_downloaded_and_verified_on_the_page(
    server, page, screenshot, tmp_path
):
    leave_out_viewer(page)
    page.goto(f"{server.url}/projects/house/")
    panel = page.locator("export-panel")
    kind = panel.get_by_role("combobox", name="File")
    kind.select_option("map.ply")
    panel.get_by_label("Thin out").fill("300")
    panel.get_by_role("button", name="Make file").click()
    rows = panel.locator(".exports > li")
    expect(rows.first.get_by_role("link")).to_be_visible()
    before = rows.count()

    kind.select_option("delivery.zip")
    now = panel.get_by_role("group", name="Made now, of the whole map")
    for name in ("COPC", "Findings, CSV"):
        now.get_by_role("checkbox", name=name, exact=True).uncheck()
    expect(panel.get_by_role("alert").first).to_contain_text("at least one file")
    now.get_by_role("checkbox", name="LAZ", exact=True).check()
    panel.get_by_role("group", name="Exported before").get_by_role("checkbox").first.check()
    panel.get_by_label("License of the data").fill("CC BY 4.0")
    panel.get_by_role("combobox", name="Language").select_option("de")
    expect(panel.get_by_role("status").first).to_contain_text("About ")
    panel.locator("button.primary").evaluate("button => button.scrollIntoView(false)")
    screenshot(page, "delivery")
    panel.get_by_role("button", name="Make file").click()
    row = rows.first
    expect(rows).to_have_count(before + 1)
    row.get_by_role("button", name="Verify").click()
    expect(row).to_contain_text("✓ 6 files are intact")
    expect(row).to_contain_text(re.compile("Signed by this server, key [0-9a-f]+"))
    expect(row).to_contain_text("map.laz, map.ply · German · with a license")
    row.evaluate("row => row.scrollIntoView({ block: 'center' })")
    screenshot(page, "delivery-verified")
    with page.expect_download() as download:
        row.get_by_role("link", name="Delivery, ZIP").click()
    assert download.value.suggested_filename == "house-delivery.zip"
    with zipfile.ZipFile(download.value.path()) as packed:
        assert {"map.laz", "map.ply", "LICENSE.txt", "report.pdf"} < set(packed.namelist())
