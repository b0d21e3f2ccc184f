"""Findings in another language: the same record in other words and numbers."""

import math

import pytest
from fluent.runtime import FluentBundle, FluentResource

from recon4.findings.wording import catalog, headline, remedy_of, said, text_of, title_of
from recon4.locales.languages import languages
from recon4.locales.numbers import number_functions, shown
from recon4.model.finding import Finding, Level
from recon4.model.finding_kinds import FindingKind
from recon4.model.import_counts import count_text, ratio_text
from recon4.model.usability import Usability

LOST = Finding(
    kind=FindingKind.TRACKING_LOST,
    level=Level.CHECK,
    values={"lost": 3, "multiframes": 6000, "ratio": 0.0005, "first_s": 2.04},
)


def test_german_says_the_same_with_decimal_commas():
    assert text_of(LOST, "de") == (
        "Das Tracking ging in 3 von 6000 Multiframes verloren (0,1 %), zuerst 2,0 s nach dem Start."
    )
    assert title_of(LOST.kind, "de") == "Tracking verloren"
    assert headline("do not use", "de") == "Diese Karte nicht verwenden"


def test_the_record_is_the_same_in_every_language():
    words = {"title", "text", "remedy"}
    english, german = said(LOST), said(LOST, "de")

    assert {key for key in english if english[key] != german[key]} <= words
    assert german["kind"] == "TRACKING-LOST" and german["values"] == LOST.values


def test_what_is_typed_into_a_rig_file_has_a_decimal_point():
    clock = Finding(
        kind=FindingKind.PROFILER_CLOCK, level=Level.CHECK,
        values={"ahead_ms": 12.3, "way": "behind", "add_s": -0.012},
    )  # fmt: skip

    assert "12 ms hinter denen der IMU" in text_of(clock, "de")
    assert "-0.012 zu seinem time_offset_s" in text_of(clock, "de")


def test_one_is_one_and_words_of_a_finding_are_translated():
    one = Finding(kind=FindingKind.LOOPS_ACCEPTED, level=Level.GOOD, values={"accepted": 1})
    moving = Finding(
        kind=FindingKind.MOVING_OBJECTS, level=Level.CHECK,
        values={"outcome": "left out", "points_left_out": 12345}, span_s=(1.0, 2.0),
    )  # fmt: skip

    assert text_of(one, "de") == "Ein Schleifenschluss angenommen."
    assert text_of(moving, "de") == (
        "Die meisten ihrer Punkte sind ausgelassen: der Rest hält die Trajektorie. "
        "12\u202f345 Punkte sind nicht in der Karte."
    )


def test_a_long_value_and_an_unknown_word_are_said_as_they_are():
    pairs = ", ".join(f"{n}-{n + 1}" for n in range(900))
    values = {"count": 900, "pairs": pairs}
    many = Finding(kind=FindingKind.REVIEW_CONFLICT, level=Level.CHECK, values=values)
    odd = Finding(kind=FindingKind.IMU_UNIT, level=Level.CHECK, values={"fault": "a {new} one"})

    assert pairs in text_of(many) and pairs in text_of(many, "de")
    assert text_of(odd, "de") == "a {new} one"


def test_counts_are_translated():
    counts = {"packets": 1000, "packets_missing": 250}

    assert count_text("packets_missing", counts, language="de").startswith(
        "250 von 1250 Datenpakete: nie angekommen"
    )
    assert ratio_text("packets_late", 0.12, "de").startswith("12 % Datenpakete: angekommen")


@pytest.mark.parametrize("language", languages())
@pytest.mark.parametrize("usability", Usability)
def test_every_verdict_has_a_headline(language, usability):
    assert headline(usability, language)


@pytest.mark.parametrize("language", languages())
def test_no_remedy_or_title_is_empty(language):
    assert all(entry.title and entry.meaning for entry in catalog(language).kinds.values())
    assert remedy_of(Finding(kind=FindingKind.MIRROR, level=Level.CHECK), language)


@pytest.mark.parametrize("value", [1e300, -1e30, 10**400, math.inf, math.nan])
def test_a_number_of_a_damaged_file_is_written_however_large(value):
    functions = number_functions("de")
    bundle = FluentBundle(["de"], functions=functions)
    uses = [f"{name}($x)" for name in ("LENGTH", "COUNT")]
    uses += [f"{name}($x, digits: 2)" for name in ("DECIMAL", "PERCENT", "DEGREES", "SIGNIFICANT")]
    bundle.add_resource(FluentResource("a = " + " ".join(f"{{ {use} }}" for use in ["$x", *uses])))

    text, errors = bundle.format_pattern(bundle.get_message("a").value, {"x": shown(value)})
    assert not errors and len(text.split()) >= 7
