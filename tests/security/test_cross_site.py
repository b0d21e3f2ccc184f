"""A page of another site makes the browser of a surveyor request exports.

Held: of 6 ways to cause a GET of ``/api/`` from another origin, 0 reach the server's work, with
and without login; a link to a page is still followed. `tests/e2e/test_cross_site.py` tries the same
in a real browser.
"""

from __future__ import annotations

import json
from urllib.parse import quote

import pytest

from tests.served import office, served

ASK = quote(json.dumps({"plane": {"kind": "horizontal", "z_m": 0.0, "thickness_m": 5.0}}))
EXPORT = f"/api/projects/office/slices/export.csv?ask={ASK}"
CROSS = {"Sec-Fetch-Site": "cross-site"}
NAVIGATION = {"Sec-Fetch-Mode": "navigate", "Sec-Fetch-Dest": "document"}


server = served(office(points=1000))


@pytest.mark.parametrize("site", ["cross-site", "same-site"])
@pytest.mark.parametrize(
    "how",
    [
        {"Sec-Fetch-Mode": "no-cors", "Sec-Fetch-Dest": "image"},
        {"Sec-Fetch-Mode": "navigate", "Sec-Fetch-Dest": "iframe"},
        {"Sec-Fetch-Mode": "cors", "Sec-Fetch-Dest": "empty", "Origin": "http://evil.example"},
        NAVIGATION,
    ],
    ids=["image", "frame", "fetch", "link"],
)
def test_a_get_caused_by_another_site_starts_nothing(server, site, how):
    answer = server.get(EXPORT, headers={"Sec-Fetch-Site": site, **how})

    assert answer.status_code == 403
    assert answer.json()["detail"] == "requests from other sites are not accepted"


def test_an_old_browser_that_names_another_origin_is_refused(server):
    assert server.get(EXPORT, headers={"Origin": "http://evil.example"}).status_code == 403


@pytest.mark.parametrize(
    "headers",
    [{}, {"Sec-Fetch-Site": "same-origin"}, {"Sec-Fetch-Site": "none", **NAVIGATION}],
    ids=["script", "own page", "typed"],
)
def test_our_own_pages_and_scripts_are_answered(server, headers):
    assert server.get("/api/projects", headers=headers).status_code == 200


def test_a_link_to_a_page_is_followed_but_no_frame_is_filled(server):
    assert server.get("/", headers=CROSS | NAVIGATION).status_code == 200
    frame = CROSS | {"Sec-Fetch-Mode": "navigate", "Sec-Fetch-Dest": "iframe"}
    assert server.get("/projects/office/", headers=frame).status_code == 403
