"""Every page, judged by axe-core: names of controls, structure, contrast."""

import pytest

from recon4_app.pages import WEB, page_addresses
from tests.e2e.axe import barriers, needs_axe
from tests.e2e.conftest import both_looks, leave_out_viewer
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

OPENED = 24
"""Folded parts of a page that are opened."""


@pytest.fixture(scope="module")
def server(tmp_path_factory):
    root = tmp_path_factory.mktemp("projects")
    copy_made(tmp_path_factory, root / "office")
    build_project(root / "hall")
    with server_thread(root, worker_module=SLOW) as running:
        yield running


@both_looks
@needs_axe
@pytest.mark.parametrize("path", PAGES)
def test_a_page_has_no_barrier_that_axe_finds(server, page, path):
    leave_out_viewer(page)
    page.expect_failed = True
    page.goto(server.url + path)
    page.wait_for_load_state("networkidle")
    # All that /api unfolds is alike: its two hundred operations take a minute of a core.
    page.evaluate(
        "(most) => [...document.querySelectorAll('details')].slice(0, most)"
        ".forEach((one) => (one.open = true))",
        OPENED,
    )
    page.wait_for_load_state("networkidle")  # what was opened reads its content

    assert barriers(page) == []


def test_every_page_is_judged():
    files = {path.relative_to(WEB).as_posix() for path in WEB.rglob("*.html")}

    assert files - {"shared/head.html"} == set(PAGES.values()) | ELSEWHERE
