"""A real browser on a real server."""

from __future__ import annotations

import io
import os
import zlib
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from functools import cache
from pathlib import Path

import pytest
from msgspec import structs
from PIL import Image
from playwright.sync_api import Browser, BrowserContext, Page, expect

from recon4_app import main, server_routes
from recon4_app.projects.thumbnail import Thumbnails
from tests.chromium import DRAW_LESS
from tests.service.running import ROOT

expect.set_options(timeout=45_000)  # two busy cores draw WebGL in software

SCREENSHOTS = os.environ.get("RECON4_SCREENSHOTS") == "1"
BOTH_LOOKS = os.environ.get("RECON4_LOOKS") == "both"
"""``make looks``: every test on both screens."""
SCREENS = {"desktop": (1440, 900), "phone": (390, 844)}
EXPECTED_NOISE = (
    "status of 4",
    "status of 507",  # a full disk
    "net::ERR_FAILED",
    "GPU stall",
    "THREE.Clock",
    "ViewerCameraMessage but websocket",
    "Tried to update non-existent component",  # viser: renamed and taken away in one batch
)


@pytest.fixture(autouse=True)
def room_on_the_disk(monkeypatch):
    """The free space of the machine that runs the tests does not matter."""
    monkeypatch.setattr(server_routes, "ROOM", structs.replace(server_routes.ROOM, little_room=0.0))


@pytest.fixture(scope="session", autouse=True)
def thumbnails_are_kept(tmp_path_factory) -> Iterator[None]:
    """A map that many servers show is drawn once; each drawing takes a process of its own."""
    folder = tmp_path_factory.mktemp("thumbnails")
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(main, "Thumbnails", lambda pool, _: Thumbnails(pool, folder))
        yield


@pytest.fixture(params=["desktop light", "desktop dark", "phone light", "phone dark"])
def look(request) -> tuple[str, str]:
    """A screen and a color scheme."""
    screen, scheme = request.param.split()
    return screen, scheme


looks = pytest.mark.looks
"""Only on these screens, where a test sees the same on the others; ``@looks("desktop light")``."""
TWO_LOOKS = ("desktop light", "phone dark")
"""Each screen and each color scheme once: layout depends on the screen, colors on the scheme, and
nothing on both. Only screenshots are made of all four. A test that says nothing takes turns with
its neighbors: it runs on one of them, by its name."""
both_looks = looks(*TWO_LOOKS)
"""What a page has to hold on both screens."""


def first_of(*names: str) -> pytest.MarkDecorator:
    """For a long workflow in which only the layout depends on the screen.

    The test looks at the layout on both with `on_both_screens`; screenshots are made of all looks.
    """
    return looks(*(names if SCREENSHOTS else names[:1]))


one_look = first_of(*TWO_LOOKS)


LONG = (
    *("review/test_deciding", "test_slices", "test_whole_way", "test_pages", "test_live_page"),
    "review/test_aligning",
)
"""These files take longest; they come first, so that two workers (``-n 2``) end together."""


def pytest_collection_modifyitems(config: pytest.Config, items: list[pytest.Item]) -> None:
    """Leave out the looks a test does not ask for before anything is set up for them."""
    items.sort(key=lambda item: _rank(item.path))
    left_out = [item for item in items if not _asked_for(item)]
    if left_out:
        config.hook.pytest_deselected(items=left_out)
        items[:] = [item for item in items if _asked_for(item)]


@cache
def _rank(path: Path) -> int:
    folder = Path(__file__).parent
    name = path.relative_to(folder).with_suffix("").as_posix() if folder in path.parents else ""
    return LONG.index(name) if name in LONG else len(LONG)


def _asked_for(item: pytest.Item) -> bool:
    mark, call = item.get_closest_marker("looks"), getattr(item, "callspec", None)
    if call is None or "look" not in call.params:
        return True
    if mark is not None:
        return call.params["look"] in mark.args
    turn = zlib.crc32(item.nodeid.partition("[")[0].encode()) % len(TWO_LOOKS)
    asked = TWO_LOOKS if BOTH_LOOKS else TWO_LOOKS[turn : turn + 1]
    return SCREENSHOTS or call.params["look"] in asked


@contextmanager
def browser_context(browser: Browser, look: tuple[str, str]) -> Iterator[BrowserContext]:
    """A fresh profile of the browser with a screen and a color scheme."""
    screen, scheme = look
    width, height = SCREENS[screen]
    context = browser.new_context(
        viewport={"width": width, "height": height},
        color_scheme="dark" if scheme == "dark" else "light",
        has_touch=screen == "phone",
        is_mobile=screen == "phone",
    )
    context.set_default_timeout(60_000)
    if not SCREENSHOTS:
        context.add_init_script(DRAW_LESS)
    yield context
    context.close()


@pytest.fixture
def context(browser, look) -> Iterator[BrowserContext]:
    with browser_context(browser, look) as context:
        yield context


def show_on(page: Page, screen: str) -> None:
    """Show a page on a screen, and draw it there."""
    width, height = SCREENS[screen]
    page.set_viewport_size({"width": width, "height": height})
    page.evaluate("() => new Promise((done) => requestAnimationFrame(() => setTimeout(done)))")


def on_both_screens(page: Page, check: Callable[[Page], None]) -> None:
    """Check a page as it is and on the other screen, and return to its own."""
    own = page.viewport_size
    for screen in SCREENS:
        show_on(page, screen)
        check(page)
    assert own is not None
    page.set_viewport_size(own)


def open_menu(page: Page) -> None:
    """Show the links of the head where they are in a menu: on a narrow screen."""
    menu = page.get_by_role("button", name="Menu")
    expect(page.locator(".account a").first).to_be_attached()
    if menu.is_visible():
        menu.click()
        expect(menu).to_have_attribute("aria-expanded", "true")


def leave_out_viewer(page: Page) -> None:
    """Show an empty page in place of the viewer, where a test is about the page around it.

    Without a graphics card the viewer takes most of the processor time of a page.
    """
    if not SCREENSHOTS:
        empty = "<!doctype html><title>Viewer</title>"
        page.route("**/viewer/", lambda route: route.fulfill(body=empty, content_type="text/html"))


@pytest.fixture
def page(context) -> Iterator[Page]:
    """A page on which any error of our own, and any request to elsewhere, fails the test."""
    page = context.new_page()
    complaints: list[str] = []
    foreign: list[str] = []
    page.on("pageerror", lambda error: complaints.append(str(error)))
    page.on(
        "console",
        lambda message: message.type == "error" and complaints.append(message.text),
    )
    page.on(
        "request",
        lambda request: (
            request.url.startswith(("http://127.0.0.1:", "data:", "blob:"))
            or foreign.append(request.url)
        ),
    )
    yield page
    assert foreign == []
    assert [text for text in complaints if not any(n in text for n in EXPECTED_NOISE)] == []


SHORTEN_PATHS = r"""() => {
  const made = /^.*\/pytest-of-[^/]+\/pytest-\d+\/[^/]+/;
  window.shortened = [...document.querySelectorAll("input:not([type=file])")]
    .filter((field) => made.test(field.value)).map((field) => [field, field.value]);
  for (const [field, path] of window.shortened) field.value = path.replace(made, "/data");
}"""
"""Where a test keeps its files is left out of a screenshot."""


COVERED = """() => document.querySelector("dialog[open]") !== null"""
"""A dialog and what it covers fill the window; what is outside it would not look covered."""

MAX_HEIGHT_PX = 1800
"""The rest of a long page is left out of a screenshot."""


def keep_small(png: bytes, file: Path) -> None:
    """Writes a screenshot with 256 colors."""
    file.parent.mkdir(parents=True, exist_ok=True)
    image = Image.open(io.BytesIO(png)).convert("RGB")
    image = image.crop((0, 0, image.width, min(image.height, MAX_HEIGHT_PX)))
    image.quantize(256, dither=Image.Dither.NONE).save(file, optimize=True)


@cache
def pages() -> str:
    """The documentation as one text."""
    return "".join(
        path.read_text("utf-8") for path in (ROOT / "README.md", *(ROOT / "docs").rglob("*.md"))
    )


@pytest.fixture
def screenshot(look):
    """Keeps a screenshot when ``RECON4_SCREENSHOTS=1``.

    Those that a page of the documentation shows lie beside it, the others in ``out/screenshots``.
    """

    def keep(page: Page, name: str) -> None:
        if SCREENSHOTS:
            screen, scheme = look
            file = f"{name}-{screen}-{scheme}.png"
            folder = ROOT / ("docs/images" if file in pages() else "out/screenshots")
            page.evaluate(SHORTEN_PATHS)
            png = page.screenshot(full_page=screen == "phone" and not page.evaluate(COVERED))
            page.evaluate("() => shortened.forEach(([field, path]) => (field.value = path))")
            keep_small(png, folder / file)

    return keep
