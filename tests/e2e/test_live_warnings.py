"""Warnings on the phone of an operator leave most of the screen to the map."""

from __future__ import annotations

import json

import pytest
from playwright.sync_api import expect

from recon4.model.rig import load_rig
from tests.e2e.test_live_page import walked_with_problems
from tests.scan_captures import capture_server
from tests.served import served

pytestmark = pytest.mark.e2e
LATE = (
    "The preview is 17 s behind: 20 of the last 25 frames are left out of the preview (20 in all); "
    "the recording is complete"
)
LOST = "Tracking lost: stop, then go back a few steps"
SILENT = "vertical LiDAR silent for 8 s"
MAP = """() => {
  const under = ["MAIN", "BODY", "CANVAS"];
  const covers = (one) => {
    for (let at = one; at && !under.includes(at.tagName); at = at.parentElement)
      if (getComputedStyle(at).backgroundColor !== "rgba(0, 0, 0, 0)") return true;
    return false;
  };
  const across = [...Array(Math.floor(innerWidth / 5)).keys()];
  const down = [...Array(Math.floor(innerHeight / 5)).keys()];
  const seen = across.flatMap((x) => down.map((y) => document.elementFromPoint(5 * x, 5 * y)));
  return seen.filter((one) => !covers(one)).length / seen.length;
}"""
"""Part of the screen that nothing covers."""

server = served(run=capture_server, fresh=True, below="projects", ours=load_rig("4recon"))


@pytest.fixture
def look():
    return "phone", "light"


def walking(warnings):
    """A message of a walk with a line for each sensor and some warnings."""
    rates = {"horizontal": 754.0, "vertical": 0.0, "IMU": 200.0}
    found = [{"level": level, "text": text} for level, text in warnings]
    gaps = {"gaps": [], "well": 0.4, "elsewhere": 0}
    more = {"state": "recording", "project": "walk", "findings": found, "rates": rates}
    return json.dumps(json.loads(walked_with_problems()) | more | {"gaps": gaps})


@pytest.mark.parametrize(
    ("warnings", "shown"),
    [
        ([("error", SILENT), ("warning", LATE), ("warning", LATE), ("info", LATE)], [SILENT]),
        ([("warning", LATE), ("warning", LATE)], [LATE]),
        ([("error", SILENT), ("error", LOST), ("warning", LATE)], [SILENT, LOST]),
    ],
)
def test_the_most_urgent_is_on_the_map_and_the_rest_a_touch_away(server, context, warnings, shown):
    page = context.new_page()
    page.route_web_socket("**/api/live/stream", lambda socket: socket.send(walking(warnings)))
    page.goto(f"{server.url}/live")
    expect(page.locator("#findings li:not(.more)")).to_have_text(shown)

    assert page.evaluate(MAP) >= 0.65

    page.locator("#findings .more button").click()
    expect(page.locator("#all-findings li")).to_have_text([text for _, text in warnings])
