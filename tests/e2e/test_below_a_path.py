"""Every page in a real browser, on a server below a path of a host, behind a real nginx."""

import pytest
from playwright.sync_api import expect

from tests.e2e.conftest import EXPECTED_NOISE, browser_context, open_menu
from tests.e2e.test_accessibility import PAGES as JUDGED
from tests.service.behind_nginx import behind_nginx, needs_nginx
from tests.service.secure import PASSWORD

pytestmark = [pytest.mark.e2e, needs_nginx]

PAGES = (
    *(path for path in JUDGED if path != "/nowhere"),
    *("/rigs/4recon/", "/account", "/docs/", "/docs/how-to/server.html"),
)

ANSWERED = {"live": "Nothing is recorded", "docs": "Projects of this server"}
"""First part of an address -> what its pages show; the others show who signed in."""


@pytest.fixture
def site(tmp_path):
    with behind_nginx(tmp_path, "/maps/old", name="localhost") as (found,):
        yield found


@pytest.fixture
def page(browser, site):
    """A page on which a request to elsewhere on the host, or a failed one, fails the test."""
    outside, failed, complaints = [], [], []

    def note(url):
        below = (f"{site.url}/", f"{site.url.replace('https', 'wss', 1)}/", "data:", "blob:")
        url.startswith(below) or outside.append(url)

    with browser_context(browser, ("desktop", "light")) as context:
        page = context.new_page()
        page.on("request", lambda request: note(request.url))
        page.on("websocket", lambda socket: note(socket.url))
        page.on(
            "response",
            lambda answer: (
                answer.status < 400
                or answer.url == f"{site.url}/api/me"  # the login page asks
                or failed.append((answer.status, answer.url))
            ),
        )
        page.on("pageerror", lambda error: complaints.append(str(error)))
        page.on("console", lambda one: one.type == "error" and complaints.append(one.text))
        yield page
    assert (outside, failed) == ([], [])
    assert [text for text in complaints if not any(n in text for n in EXPECTED_NOISE)] == []


def sign_in(page, site, path):
    page.goto(site.url + path)
    page.get_by_label("Name").fill("anna")
    page.get_by_label("Password", exact=True).fill(PASSWORD)
    page.get_by_role("button", name="Sign in").click()
    page.wait_for_url(site.url + path)


def links(page):
    return page.evaluate("[...document.querySelectorAll('a[href]')].map((one) => one.href)")


@pytest.mark.study
def test_every_page_loads_and_links_below_the_path(site, page):
    sign_in(page, site, "/projects/office/")
    viewer = page.frame_locator("iframe")
    expect(viewer.get_by_text("map frame · z up · meters")).to_be_visible()
    page.frames[-1].wait_for_function("window.__viserMutable?.canvas")  # its WebSocket works

    for path in PAGES:
        page.goto(site.url + path, wait_until="load")
        expect(page.locator("h1, h2, .brand").first).to_be_visible()
        first = path.split("/")[1]
        answered = ANSWERED.get(first, "anna")  # the modules run
        expect(page.locator("body")).to_contain_text(answered)
        assert page.url.partition("?")[0] == site.url + path  # what is shown may follow
        ours = [one for one in links(page) if one.startswith(site.origin)]
        assert ours
        assert [one for one in ours if not one.startswith(f"{site.url}/")] == [], path


def test_a_person_works_below_the_path(site, page, tmp_path):
    recording = tmp_path / "walk"
    recording.mkdir()
    (recording / "000000.bin").write_bytes(b"\0" * 1600)
    sign_in(page, site, "/")

    page.locator("upload-box input[type=file]").nth(0).set_input_files(recording / "000000.bin")
    expect(page.locator("upload-box")).to_contain_text("On the server")
    page.locator("a.cover").first.click()
    page.wait_for_url(f"{site.url}/projects/office/")
    page.get_by_role("link", name="Review").click()
    page.wait_for_url(f"{site.url}/projects/office/review/")
    page.get_by_role("link", name="Slices").click()
    page.wait_for_url(f"{site.url}/projects/office/slices/*")
    open_menu(page)
    page.get_by_role("link", name="Rigs").click()
    page.wait_for_url(f"{site.url}/rigs")
    open_menu(page)
    page.get_by_role("link", name="Help").click()
    page.wait_for_url(f"{site.url}/docs/")
    page.evaluate("localStorage.setItem('maps/old/x', '1'); localStorage.setItem('other', '2')")
    page.go_back()
    page.wait_for_load_state("networkidle")  # signed out, its requests would be refused
    open_menu(page)
    page.get_by_role("button", name="Sign out").click()
    page.wait_for_url(f"{site.url}/login")
    assert page.evaluate("Object.keys(localStorage)") == ["other"]
