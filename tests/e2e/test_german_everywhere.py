"""Every page says in German what it says in English, but for names, and nothing overflows."""

import re

import pytest
from playwright.sync_api import expect

from recon4.locales.languages import ENGLISH
from recon4.model.finding_kinds import FindingKind
from recon4.model.rig import load_rig, rig_presets
from recon4.settings.presets import PRESET_TEXTS
from recon4_app.pages import LANGUAGE_COOKIE, html_of, page_addresses, text_files
from tests.e2e.conftest import leave_out_viewer, looks, on_both_screens
from tests.e2e.test_german import english_of
from tests.project_builder import build_project
from tests.served import served

pytestmark = pytest.mark.e2e

PAGES = {one.path.format(project_id="office"): one.file for one in page_addresses()} | {
    "/nowhere": "shared/lost.html",
    "/projects/nowhere/": "shared/lost.html",
}
"""Path -> its file in `web/`."""
SHOWN = """() => {
  document.querySelectorAll("details").forEach((one) => (one.open = true));
  const marked = "[lang=en]:not(html), script, style, code, kbd";
  const walker = document.createTreeWalker(document.body, NodeFilter.SHOW_TEXT);
  const texts = [document.title];
  while (walker.nextNode())
    if (!walker.currentNode.parentElement.closest(marked)) texts.push(walker.currentNode.data);
  for (const name of ["aria-label", "title", "placeholder", "label", "alt", "aria-description"])
    for (const one of document.querySelectorAll(`[${name}]`))
      if (!one.closest(marked)) texts.push(one.getAttribute(name));
  return texts.map((text) => text.replaceAll(/\\s+/g, " ").trim()).filter(Boolean);
}"""
"""All texts and labels of a page, with what is folded; without what is marked as English."""
SAME = {
    *("Deutsch", "Name", "Rig", "Rigs", "Sensor", "Start", "Live", "Export", "Team", "Graph"),
    *("Journal", "Multiframes", "Horizontal", "Parallel", "Link", "Port", "Person", "Webhooks"),
    *("Position", "Enter", "Esc"),
}
"""Words that are the same in German."""
TERMS = {
    *("API", "CAD", "COPC", "CSV", "DXF", "EPSG", "GIS", "GNSS", "GPKG", "GeoJSON", "GeoPackage"),
    *("GeoTIFF", "IMU", "KITTI", "LAZ", "PCD", "PDF", "PLY", "PNG", "PTX", "SVG", "TIF", "TUM"),
    *("UBX", "XYZ", "ZIP", "pos", "min", "roll", "pitch", "yaw", "3-D", "4RECON"),
    *("CloudCompare", "Cyclone", "MeshLab", "Open3D", "PCL", "PDAL", "QGIS", "ROS", "Recap"),
    *("recon4", "office"),
}
"""Formats, units, axes and names."""
NAMES = {one for name in (*FindingKind, *PRESET_TEXTS, *rig_presets()) for one in name.split("-")}
OF_RIGS = {
    word
    for name in rig_presets()
    for sensor in load_rig(name).sensors
    for word in (sensor.name, sensor.model, sensor.kind)
}
WORD = re.compile(r"[^\W_]+(?:[._/:-]+[^\W_]+)*")
TWO_WORDS = re.compile(r"\w\w \w\w")
NO_WORD = re.compile(r"[\w-]+(\.[a-z0-9]+)+|https?.*|[\d.:]+")


def is_name(word):
    """Whether a word is the same in every language."""
    known = SAME | TERMS | NAMES | OF_RIGS
    return len(word) < 3 or bool(known & {word, *word.split("-")} or NO_WORD.fullmatch(word))


server = served(lambda root: build_project(root / "office", points=2_000))


def shown(server, page, path, language):
    """The texts of a page in a language."""
    cookie = {"name": LANGUAGE_COOKIE, "value": language, "url": server.url}
    page.context.add_cookies([cookie])
    page.goto(server.url + path)
    expect(page.locator(f"html[lang={language}]")).to_be_attached()
    page.wait_for_load_state("networkidle")
    texts = page.evaluate(SHOWN)
    page.wait_for_load_state("networkidle")  # what was opened reads its content
    page.keyboard.press("?")
    return {*texts, *page.evaluate(SHOWN)}


@looks("desktop light")
@pytest.mark.parametrize("path", PAGES)
def test_a_page_says_nothing_in_both_languages_and_fits(server, page, path):
    leave_out_viewer(page)
    english, german = (shown(server, page, path, language) for language in (ENGLISH, "de"))

    def fits(page):
        assert page.evaluate("document.documentElement.scrollWidth - innerWidth") == 0
        german.update(page.evaluate(SHOWN))

    on_both_screens(page, fits)

    assert german - english
    alike = [one for one in english & german if not all(map(is_name, WORD.findall(one)))]
    assert sorted(alike) == []
    phrases = [one for one in english_of(text_files(html_of(PAGES[path]))) if TWO_WORDS.search(one)]
    assert [text for text in german if any(one in text for one in phrases)] == []
