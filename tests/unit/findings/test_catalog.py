"""The catalog has words for every kind of finding, and only for values that are known."""

import re
from functools import cache
from pathlib import Path

import pytest

from recon4.errors import ConfigError
from recon4.findings.explain import explained, listed, markdown
from recon4.findings.wording import catalog, headline, said, text_of, whole_text
from recon4.locales.languages import languages
from recon4.locales.texts import texts
from recon4.model.finding import Finding, Level
from recon4.model.finding_kinds import FindingKind
from recon4.model.usability import Usability

ROOT = Path(__file__).parents[3]
SOURCES = [
    path
    for path in (ROOT / "recon4").rglob("*.py")
    if path != ROOT / "recon4" / "model" / "finding_kinds.py"
]


@cache
def code():
    """All modules but that of the kinds."""
    return "".join(path.read_text("utf-8") for path in SOURCES)


@pytest.mark.parametrize("kind", list(FindingKind))
def test_each_kind_has_words_and_says_how_it_is_detected(kind):
    entry = catalog().kinds[kind]

    assert entry.title and entry.text and entry.meaning
    assert entry.detection or kind in catalog().readers
    assert kind.name == kind.value.replace("-", "_")


def test_each_kind_is_found_by_some_witness_or_reader():
    used = set(re.findall(r"FindingKind\.(\w+)", code()))

    assert {kind.name for kind in FindingKind} - used == set()


def test_a_sentence_needs_the_values_that_it_quotes():
    lost = {"lost": 3, "multiframes": 60, "ratio": 0.05}
    here = Finding(
        kind=FindingKind.TRACKING_LOST, level=Level.CHECK, values=lost | {"first_s": 2.0}
    )
    held = Finding(
        kind=FindingKind.TRACKING_LOST, level=Level.CHECK, values=here.values | {"held": True}
    )

    assert text_of(here) == (
        "Tracking was lost in 3 of 60 multiframes (5.0 %), first 2.0 s after the start."
    )
    assert text_of(held) == f"{text_of(here)} What was registered around them holds the map."


def test_a_value_that_is_no_number_is_not_quoted():
    values = {"end_m": float("nan"), "largest_m": 1.0}

    assert text_of(Finding(kind=FindingKind.CORRECTION, level=Level.NOTE, values=values)) == (
        "Correction by the graph."
    )


def test_lengths_ratios_and_words_have_their_formats():
    near = {"end_m": 0.123, "largest_m": 1.5}
    moved = Finding(kind=FindingKind.CORRECTION, level=Level.NOTE, values=near)
    clock = Finding(
        kind=FindingKind.IMU_CLOCK, level=Level.CHECK,
        values={"size_ms": 12.34, "sd_ms": 0.5, "way": "behind"},
    )  # fmt: skip

    assert "by 12.3 cm and no pose by more than 1.50 m" in text_of(moved)
    assert "12.3 ms ± 0.5 ms behind that of the LiDARs" in text_of(clock)


def test_a_remedy_follows_the_text_and_stands_by_itself_in_the_summary():
    finding = Finding(kind=FindingKind.LOOPS_NONE, level=Level.CHECK)
    record = said(finding)

    assert whole_text(finding) == f"{record['text']} {record['remedy']}"
    assert record["kind"] == "LOOPS-NONE" and record["level"] == "check"


def test_conditions_name_values_that_some_witness_states():
    stated = set(re.findall(r'"(\w+)"|\b(\w+)=', code()))
    stated = {name for pair in stated for name in pair}
    names = {one.given for entry in catalog().kinds.values() for one in entry.text if one.given}

    assert names - stated == set()


def test_every_code_is_explained_and_a_wrong_one_gets_the_nearest():
    assert "fixes follow the velocity" in " ".join(explained("gnss-clock").split())
    assert len(listed().splitlines()) == len(FindingKind)
    assert explained("MIRROR", "de").startswith("MIRROR\n\nSpiegel\n\n")
    assert "Erkannt: " in explained("MIRROR", "de")
    with pytest.raises(ConfigError, match="GNSS-CLOCK"):
        explained("GNSS-CLOK")


def test_the_page_of_the_findings_is_the_catalog():
    page = (ROOT / "docs" / "reference" / "findings.md").read_text("utf-8")

    assert page == markdown(), "run make docs"


@pytest.mark.parametrize("language", languages())
def test_the_pages_have_the_headlines_of_the_catalog(language):
    said = texts(language, "shared")
    page = {"good": "state-sound", "check": "state-check", "do not use": "state-unusable"}

    assert {one: said(page[str(one)]) for one in Usability} == {
        one: headline(one, language) for one in Usability
    }
