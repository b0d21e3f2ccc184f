"""Sentences of settings: declared once in English, translated in the catalog."""

import re

import pytest

from recon4.locales.languages import ENGLISH, languages
from recon4.locales.texts import texts
from recon4.settings.help import describe_settings
from recon4_app.jobs.choices import plain_text, read_settings, text_name
from tools.setting_texts import FILE, generated

CODE = re.compile("``([^`]+)``")


def test_the_english_texts_are_those_of_the_declarations():
    assert FILE.read_text("utf-8") == generated(), "make docs"


@pytest.mark.parametrize("language", languages()[1:])
def test_every_setting_has_its_sentence_in_each_language(language):
    for english, other in zip(read_settings(ENGLISH), read_settings(language), strict=True):
        assert english.name == other.name and english.text != other.text
        for before, after in zip(english.settings, other.settings, strict=True):
            assert after.text != before.text, after.path
            assert before.model_copy(update={"text": after.text}) == after


@pytest.mark.parametrize("language", languages()[1:])
def test_a_value_that_a_sentence_names_is_the_same_in_each_language(language):
    say = texts(language, "settings")
    declared = [(one.path, one.text) for group in describe_settings() for one in group.settings]
    named = [(path, value) for path, text in declared for value in CODE.findall(text)]

    assert [one for one in named if one[1] not in say(text_name(one[0]))] == [] and named


def test_numbers_of_a_sentence_stay_as_they_are_typed():
    say = texts("de", "settings")

    assert plain_text("``svd``: closed") == "svd: closed"
    assert "0.001" in say("about-ingest-points_unit_m") and "15 mm" in say(
        "about-map-range_noise_m"
    )
