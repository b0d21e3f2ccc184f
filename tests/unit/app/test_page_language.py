"""A page is in the language that was chosen, else in the one that the browser asks for."""

import re

import pytest
from starlette.requests import HTTPConnection

from recon4.locales.languages import ENGLISH, ROOT, languages
from recon4.locales.texts import messages_of, texts
from recon4.settings.presets import PRESET_TEXTS
from recon4_app.pages import WEB, language_of, page_response

TRANSLATED = [
    path.relative_to(WEB).as_posix()
    for path in sorted(WEB.rglob("*.html"))
    if "data-texts=" in path.read_text("utf-8")
]


def asking(accept="", cookie=""):
    headers = [(b"accept-language", accept.encode()), (b"cookie", cookie.encode())]
    return HTTPConnection({"type": "http", "headers": headers})


def test_a_choice_counts_more_than_the_browser_and_an_unknown_one_not_at_all():
    assert language_of(asking("de-DE,de;q=0.9")) == "de"
    assert language_of(asking("de-DE", "recon4_language=en")) == "en"
    assert language_of(asking("de-DE", "recon4_language=../en")) == "de"
    assert language_of(asking()) == ENGLISH


@pytest.mark.parametrize("language", languages())
@pytest.mark.parametrize("file", TRANSLATED)
def test_a_page_has_all_of_its_texts_in_each_language(file, language):
    sent = page_response(file, asking(language))
    page = sent.body.decode()

    assert f'<html lang="{language}" data-languages="{" ".join(languages())}"' in page
    assert re.findall(r"\{\{.*?\}\}", page) == []
    assert sent.headers["content-language"] == language
    assert "Cookie" in sent.headers["vary"]


@pytest.mark.parametrize("file", ["rigs/rigs.html", "storage/storage.html"])
def test_a_page_without_translation_is_english_for_everybody(file):
    sent = page_response(file, asking("de"))

    assert '<html lang="en">' in sent.body.decode() and "content-language" not in sent.headers


def test_the_phone_names_presets_as_the_shell_does():
    say = texts(ENGLISH, "live")

    assert {name: say(f"preset-{name}") for name in PRESET_TEXTS} == PRESET_TEXTS


def test_scripts_ask_only_for_texts_of_their_page():
    scripts = "".join(path.read_text("utf-8") for path in (WEB / "live").glob("*.js"))
    asked = set(re.findall(r'\bt\(\s*"([a-z0-9-]+)"', scripts))

    assert len(asked) > 50
    assert asked - messages_of(ROOT / ENGLISH / "live.ftl").keys() == set()
