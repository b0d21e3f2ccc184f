"""Every page, judged by axe-core: names of controls, structure, contrast."""

import pytest

from recon4_app.pages import WEB, page_addresses
from tests.e2e.axe import barriers, needs_axe
from tests.e2e.conftest import leave_out_viewer, looks, show_on
from tests.project_builder import build_project
from tests.review_fixtures import copy_made
from tests.service.running import SLOW, server_thread

pytestmark = pytest.mark.e2e

ELSEWHERE = {f"account/{name}.html" for name in ("account", "guest", "login", "pair")}
"""Pages of a server with login: `test_login.py` judges them."""
PAGES = {
    one.path.format(project_id="office"): one.file
    for one in page_addresses()
    if one.file not in ELSEWHERE
} | {"/nowhere": "shared/lost.html"}
"""Path -> its file in `web/`."""

JUDGED_OF_API = 24
"""Operations of the page API that are judged: all two hundred are made by one template."""


@pytest.fixture(scope="module")
def server(tmp_path_factory):
    root = tmp_path_factory.mktemp("projects")
    copy_made(tmp_path_factory, root / "office")
    build_project(root / "hall")
    with server_thread(root, worker_module=SLOW) as running:
        yield running


@looks("desktop light")
@needs_axe
@pytest.mark.parametrize("path", PAGES)
def test_a_page_has_no_barrier_that_axe_finds(server, page, path):
    leave_out_viewer(page)
    page.goto(server.url + path)
    page.wait_for_load_state("networkidle")
    if path == "/api":
        page.locator("details").evaluate_all(
            "(all, most) => all.slice(most).forEach((one) => one.remove())", JUDGED_OF_API
        )
    page.locator("details").evaluate_all("(all) => all.forEach((one) => (one.open = true))")
    page.wait_for_load_state("networkidle")  # what was opened reads its content

    assert barriers(page) == []
    page.emulate_media(color_scheme="dark")
    show_on(page, "phone")
    assert barriers(page) == []


def test_every_page_is_judged():
    files = {path.relative_to(WEB).as_posix() for path in WEB.rglob("*.html")}

    assert files - {"shared/head.html"} == set(PAGES.values()) | ELSEWHERE
