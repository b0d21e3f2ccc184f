"""The viewer of a map of a million points: twenty people, and one who reads nothing."""

import time
from concurrent.futures import ThreadPoolExecutor

import pytest
from msgspec import structs

from recon4.locales.numbers import number_functions
from recon4_app.viewer import proxy
from tests.benchmarks.viewer_figures import PEOPLE, own_server
from tests.deadlines import HANG_S
from tests.processes import viewer_process
from tests.project_builder import build_project
from tests.service.running import server_thread
from tests.service.viser_client import camera, viewing

COUNT = number_functions("en")["COUNT"]


@pytest.fixture(scope="module")
def million(tmp_path_factory):
    """A folder of projects with one of a million points."""
    root = tmp_path_factory.mktemp("million")
    build_project(root / "office", points=1_000_000)
    return root


@pytest.mark.study
def test_twenty_people_at_once_each_have_a_map_of_a_million_points(million):
    def ask_for_all(client):
        client.send(camera((8.0, 3.0, 1.5)))
        client.until(lambda c: "Fewer when" in str(c.widgets))
        client.set("Fewer when this browser is slow", False)

    def look(url):
        with viewing(url) as client:
            ask_for_all(client)
            client.until(lambda c: c.shown == whole and f"{COUNT(whole)} of" in c.html())

    with own_server(million) as (server, _), ThreadPoolExecutor(PEOPLE) as people:
        with viewing(server.url) as first:  # the viewer process is there
            ask_for_all(first)
            first.rest(quiet_s=2.0)
            whole = first.shown
        list(people.map(look, [server.url] * PEOPLE))

    assert whole > 800_000


def test_a_browser_that_reads_nothing_is_disconnected_without_effect_on_others(
    million, monkeypatch, caplog
):
    monkeypatch.setattr(
        proxy, "RELAY", structs.replace(proxy.RELAY, stalled_s=3.0)
    )  # `other` reads at least as often
    with (
        server_thread(million) as server,
        viewing(server.url, buffer_bytes=1 << 16) as stalled,
        viewing(server.url) as other,
    ):
        for client in (stalled, other):
            client.send(camera((8.0, 3.0, 1.5)))
            client.until(lambda c: c.shown > 150_000 and "Palette" in str(c.widgets))
        stalled.set("Fewer when this browser is slow", False)  # a million points at once
        for k in range(44):  # the first of them takes none of this
            if k == 4:  # what is made once, for each choice, is there
                before = viewer_process(million).memory_info().rss
            stalled.set("Palette", ("turbo", "gray")[k % 2])
            other.press("Raw or normalized")
            words = f"Points by {('raw', 'normalized')[k % 2]} intensity"
            other.until(lambda c, words=words: words in c.html())
        grown = viewer_process(million).memory_info().rss - before
        deadline_s = time.monotonic() + HANG_S
        while "read nothing" not in caplog.text and time.monotonic() < deadline_s:
            other.rest()

    assert "read nothing" in caplog.text
    assert grown < 64 << 20  # 40 times the colors of a million points are 120 MB
