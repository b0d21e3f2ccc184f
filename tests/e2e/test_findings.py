"""Findings on the pages: each leads to its place in the viewer, which marks its stretch."""

import json
import re
from urllib.parse import parse_qs, urlsplit

import numpy as np
import pytest
from playwright.sync_api import expect

from recon4.findings.wording import remedy_of, said, text_of, title_of
from recon4.model.finding import Finding, Level
from recon4.model.finding_kinds import FindingKind
from recon4.store.seal import changing
from tests.e2e.conftest import leave_out_viewer, looks, one_look
from tests.project_builder import add_multiframes, build_project, loop_walk, write_summary
from tests.service.running import server_thread

pytestmark = pytest.mark.e2e

WALK = loop_walk()


def place_m(span_s):
    """Positions at both ends of a stretch."""
    return tuple(tuple(WALK.T_a_b.t[round(10 * second)].tolist()) for second in span_s)


LOST = Finding(
    kind=FindingKind.TRACKING_LOST,
    level=Level.DO_NOT_USE,
    span_s=(20.0, 25.0),
    place_m=place_m((20.0, 25.0)),
    values={"lost": 50, "multiframes": 600, "ratio": 0.083, "first_s": 20.0},
)
WEAK = Finding(
    kind=FindingKind.WEAK_DIRECTION,
    level=Level.CHECK,
    span_s=(40.0, 44.0),
    place_m=place_m((40.0, 44.0)),
    direction="horizontal",
    values={"known": True, "sd_m": 0.4},
)
OLD = Finding(kind=FindingKind.RIG_NOT_COMPARED, level=Level.NOTE)
AGREES = Finding(kind=FindingKind.RIG_AGREES, level=Level.GOOD)
FAST = Finding(kind=FindingKind.TOO_FAST, level=Level.NOTE, span_s=(7.0, 7.0))
FINDINGS = (LOST, WEAK, OLD, FAST, AGREES)


@pytest.fixture(scope="module")
def found(tmp_path_factory):
    """A server with a project whose map has findings."""
    root = tmp_path_factory.mktemp("projects")
    build_project(root / "office", points=20_000)
    add_multiframes(root / "office")
    with changing(root / "office", "summary.json", compared=False):
        summary = json.loads((root / "office/summary.json").read_text())
        verdict = {"usability": "do not use", "reasons": [text_of(LOST)], "unobserved": []}
        findings = [said(one) for one in FINDINGS]
        write_summary(root / "office", summary | {"verdict": verdict, "findings": findings})
    with server_thread(root) as running:
        yield running


def entry(page, finding):
    """The list entry of a finding."""
    return page.locator("finding-list li").filter(has_text=title_of(finding.kind))


LOOKS_AT = """(middle) => {
  const controls = window.__viserMutable?.cameraControl;
  if (!controls || document.getElementById("cover")) return false;
  const { x, y, z } = controls.getTarget(controls._target.clone());  // y up: x y z = -y z -x
  return Math.hypot(-z - middle[0], -x - middle[1], y - middle[2]) < 0.05;
}"""


MARKED_PIXELS = """() => {
  const canvas = document.querySelector("#views canvas");
  const color = getComputedStyle(canvas).getPropertyValue("--bad").trim();
  const pen = document.createElement("canvas").getContext("2d");
  pen.fillStyle = color;
  pen.fillRect(0, 0, 1, 1);
  const wanted = pen.getImageData(0, 0, 1, 1).data;
  const { data } = canvas.getContext("2d").getImageData(0, 0, canvas.width, canvas.height);
  let count = 0;
  for (let at = 0; at < data.length; at += 4)
    count += [0, 1, 2].every((k) => Math.abs(data[at + k] - wanted[k]) < 8);
  return count;
}"""


def looks_at(viewer, finding):
    """Wait until the camera of the viewer looks at the middle of the box around a stretch."""
    start_s, end_s = finding.span_s
    part = WALK.T_a_b.t[round(10 * start_s) : round(10 * end_s) + 1]
    middle = (part.min(axis=0) + part.max(axis=0)) / 2.0
    viewer.wait_for_function(LOOKS_AT, arg=middle.tolist(), timeout=120_000)


def kept_stretch(viewer):
    """The span that the viewer's view marks, as the browser keeps it."""
    view = json.loads(viewer.evaluate("localStorage['viser-user:recon4.view.office']"))
    return view["stretch"] and view["stretch"]["span_s"]


@one_look
def test_a_finding_flies_to_its_stretch_in_the_viewer_and_marks_it(found, page, screenshot):
    page.goto(f"{found.url}/projects/office/")
    for finding, times in ((WEAK, "40.0 s to 44.0 s"), (LOST, "20.0 s to 25.0 s")):
        entry(page, finding).get_by_role("link", name=f"In the graph: {times}").click()
        looks_at(page.frames[1], finding)
    if page.viewport_size["width"] > 1000:  # on a phone the panel is folded
        slider = page.frames[1].locator(".mantine-Slider-markLabel", has_text="20.0 s to 25.0 s")
        slider.scroll_into_view_if_needed()
    expect(page.locator(".walk-axis i")).to_have_count(3)
    expect(page.locator(".walk-axis i.chosen")).to_have_attribute("title", re.compile("20.0 s to"))
    screenshot(page, "finding-in-the-viewer")

    assert kept_stretch(page.frames[1]) == [20.0, 25.0]


@looks("desktop light")
def test_a_finding_chosen_before_the_viewer_has_loaded_is_opened_there(found, page):
    asked = []

    def answer_the_second(route):
        asked.append(route)
        if len(asked) > 1:
            route.fulfill(body="<title>Viewer</title>", content_type="text/html")

    page.route("**/viewer/", answer_the_second)
    page.goto(f"{found.url}/projects/office/")
    page.locator("iframe").wait_for()
    entry(page, WEAK).get_by_role("link", name="In the graph: 40.0 s to 44.0 s").click()

    page.wait_for_function(
        "() => { const viewer = document.querySelector('iframe');"
        " return viewer.contentDocument.title === 'Viewer'"
        " && viewer.contentWindow.location.hash === location.hash; }"
    )
    asked[0].abort()


MISS_FIRST_KEYS = """let missed = 0;
addEventListener("keydown", (event) => {
  if (event.key === "g" && ++missed <= 2) event.stopImmediatePropagation();
}, true);"""


@looks("desktop dark")
def test_the_link_of_a_finding_opens_where_it_is_and_escape_clears_the_mark(found, page):
    page.add_init_script(MISS_FIRST_KEYS)  # as a viewer does that is busy or starts
    page.goto(f"{found.url}/projects/office/#span=40,44")
    expect(page.locator("iframe")).to_be_attached()
    viewer = page.frames[1]
    looks_at(viewer, WEAK)

    page.locator("iframe").focus()
    page.keyboard.press("7")
    page.keyboard.press("g")
    looks_at(viewer, WEAK)
    page.keyboard.press("Escape")

    viewer.wait_for_function(
        "JSON.parse(localStorage['viser-user:recon4.view.office']).stretch === null"
    )


@one_look
def test_each_finding_has_its_level_code_text_and_remedy(found, page, screenshot):
    leave_out_viewer(page)
    page.goto(f"{found.url}/projects/office/")
    for finding, level in ((LOST, "Do not use"), (WEAK, "Check"), (AGREES, "Confirms")):
        expect(entry(page, finding)).to_contain_text(level)
        expect(entry(page, finding)).to_contain_text(text_of(finding))
        expect(entry(page, finding)).to_contain_text(remedy_of(finding))
    screenshot(page, "project-findings")

    code = entry(page, WEAK).get_by_role("link", name="WEAK-DIRECTION")
    with page.expect_popup() as opened:
        code.click()
    expect(opened.value.locator("#weak-direction")).to_be_visible()


@looks("desktop light")
def test_a_finding_flies_to_its_stretch_on_the_page_of_the_map_and_marks_it(
    found, page, screenshot
):
    page.goto(f"{found.url}/projects/office/slices/")
    page.locator("map-verdict summary").first.click()
    with page.expect_popup() as opened:
        entry(page, WEAK).get_by_role("link", name="Show in the map").click()
    shown = opened.value
    assert "/projects/office/map/?span=40,44&place=" in shown.url

    expect(shown).to_have_url(re.compile("camera=.*&span=40,44"))
    expect(shown.locator("#overlay line.stretch").first).to_be_attached()
    camera = parse_qs(urlsplit(shown.url).query)["camera"][0].split(",")
    part = WALK.T_a_b.t[400:441]
    middle = (part.min(axis=0) + part.max(axis=0)) / 2.0
    np.testing.assert_allclose([float(x) for x in camera[:3]], middle, atol=0.02)
    screenshot(shown, "map-finding")
    shown.keyboard.press("Escape")
    expect(shown.locator("#overlay line.stretch")).to_have_count(0)
    expect(shown).not_to_have_url(re.compile("span="))


@one_look
def test_a_reviewer_acknowledges_a_finding_with_a_note_that_stays(found, page, screenshot):
    leave_out_viewer(page)
    page.goto(f"{found.url}/projects/office/")
    one = entry(page, OLD)
    one.get_by_text("Acknowledge…").click()
    one.get_by_label("Note").fill("the rig is new, checked on the bench")
    one.get_by_role("button", name="Acknowledge").click()

    expect(one).to_contain_text("Acknowledged by local")
    expect(one).to_contain_text("checked on the bench")
    page.reload()
    expect(one).to_contain_text("checked on the bench")
    expect(entry(page, AGREES).get_by_text("Acknowledge…")).to_have_count(0)
    expect(page.locator("#state")).to_contain_text("Do not use this map")
    screenshot(page, "finding-acknowledged")


@looks("desktop light")
def test_findings_are_downloaded_and_filtered_by_level_and_kind_with_the_keyboard(found, page):
    leave_out_viewer(page)
    page.goto(f"{found.url}/projects/office/")
    for name, text in (("Findings, CSV", "WEAK-DIRECTION"), ("Findings, GeoJSON", "LineString")):
        with page.expect_download() as download:
            page.get_by_role("link", name=name).click()
        assert text in download.value.path().read_text("utf-8")

    page.get_by_label("Level of findings").focus()
    page.keyboard.type("Note")

    expect(page.locator("finding-list ul.findings > li:visible")).to_have_count(2)
    page.get_by_label("Kind of findings").select_option("TOO-FAST")
    expect(page.locator("finding-list ul.findings > li:visible")).to_have_count(1)
    expect(entry(page, FAST)).to_be_visible()


@one_look
def test_a_finding_is_cut_and_marked_in_the_slices(found, page, screenshot):
    page.goto(f"{found.url}/projects/office/slices/")
    page.locator("map-verdict summary").first.click()
    entry(page, WEAK).get_by_role("link", name="Cut here").click()

    page.wait_for_url("**/slices/?*mark=*")
    expect(page.locator(".facing")).to_contain_text("z = 1.200 m")
    expect(page.locator("body.drawing")).to_have_count(0)
    assert page.evaluate(MARKED_PIXELS) > 50
    middle = np.mean(WEAK.place_m, axis=0)
    query = parse_qs(urlsplit(page.url).query)
    cut = [float(query[name][0]) for name in ("u", "v", "z")]
    np.testing.assert_allclose(cut, middle, atol=1e-3)
    screenshot(page, "slices-finding")

    page.keyboard.press("v")
    page.wait_for_url("**/slices/?kind=vertical*")
    expect(page.locator("body.drawing")).to_have_count(0)
    assert page.evaluate(MARKED_PIXELS) > 50
