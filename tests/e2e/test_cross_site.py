"""A page of another site, open in a real browser, tries to start exports."""

from __future__ import annotations

import http.server
import threading
from urllib.parse import urlsplit

import pytest

from recon4_app.compute_pool.model import Lane
from tests.security.test_cross_site import EXPORT
from tests.served import office, served

pytestmark = pytest.mark.e2e


server = served(office(points=1000))


class ForeignPages(http.server.BaseHTTPRequestHandler):
    """``/`` tries every request a page can make by itself; ``/redirect`` redirects the browser."""

    target = ""

    def do_GET(self) -> None:
        if self.path == "/redirect":
            self.send_response(302)
            self.send_header("Location", self.target + EXPORT)
            self.end_headers()
            return
        url = self.target + EXPORT
        page = (
            f'<img src="{url}&n=1"><iframe src="{url}&n=2"></iframe>'
            f'<iframe src="/redirect"></iframe><link rel="stylesheet" href="{url}&n=4">'
            f'<script>fetch("{url}&n=5", {{mode: "no-cors"}}).finally(() => '
            f'{{ document.title = "done"; }})</script>'
            f'<a id="link" href="{url}&n=6">go</a><a id="page" href="{self.target}/">page</a>'
        )
        self.send_response(200)
        self.send_header("Content-Type", "text/html")
        self.end_headers()
        self.wfile.write(page.encode())

    def log_message(self, *_: object) -> None:
        pass


@pytest.fixture
def foreign(server):
    handler = type("Pages", (ForeignPages,), {"target": server.url})
    pages = http.server.ThreadingHTTPServer(("127.0.0.1", 0), handler)
    thread = threading.Thread(target=pages.serve_forever)
    thread.start()
    yield f"http://localhost:{pages.server_port}/"  # another site than 127.0.0.1
    pages.shutdown()
    thread.join()
    pages.server_close()


def test_a_foreign_page_in_a_real_browser_starts_no_export(server, foreign, browser):
    page = browser.new_page()
    sent: list[str] = []
    answered: list[int] = []
    host = urlsplit(server.url).netloc
    page.on("request", lambda r: urlsplit(r.url).netloc == host and sent.append(r.url))
    page.on("response", lambda r: urlsplit(r.url).netloc == host and answered.append(r.status))
    page.goto(foreign, wait_until="load")
    page.wait_for_function("document.title === 'done'")
    page.click("#link")
    page.wait_for_load_state("load")

    assert len(sent) >= 6
    assert set(answered) == {403}
    pool = server.app.state.parts.compute_pool
    assert pool.queues[Lane.EXPORT].granted == 0

    page.goto(foreign)
    page.click("#page")
    page.wait_for_url(server.url + "/")
    page.close()
