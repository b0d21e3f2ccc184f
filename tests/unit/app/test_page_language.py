"""A page is in the language that was chosen, else in the one that the browser asks for."""

import json
import re
from collections import Counter
from html.parser import HTMLParser

import pytest
from starlette.requests import HTTPConnection, Request

from recon4.locales.coded import CodedText
from recon4.locales.languages import ENGLISH, ROOT, languages
from recon4.locales.texts import messages_of, texts
from recon4.settings.presets import PRESET_TEXTS
from recon4_app import pages
from recon4_app.error_responses import _page
from recon4_app.pages import WEB, html_of, language_of, page_response, text_files

PAGES = [
    path.relative_to(WEB).as_posix()
    for path in sorted(WEB.rglob("*.html"))
    if path.name != "head.html"
]
TRANSLATED = [file for file in PAGES if "data-texts=" in html_of(file)]
LABELS = {"aria-label", "title", "alt", "placeholder", "label"}
ASKED = re.compile(r'(?<![\w.])t\(\s*"([a-z0-9-]+)"')
IMPORTED = re.compile(r'^(?:import|export)\b[^;]*?"(\.{1,2}/[^"]+\.js)";', re.MULTILINE)


def scripts_of(page):
    """The modules of a page with all that they import."""
    waiting = [WEB / one for one in re.findall(r'src="/web/([^"]+\.js)"', page)]
    found = []
    while waiting:
        path = waiting.pop().resolve()
        if path not in found and "vendor" not in path.parts:
            found.append(path)
            waiting += [path.parent / one for one in IMPORTED.findall(path.read_text("utf-8"))]
    return found


def texts_of(page):
    """The texts for the scripts of a page, by language."""
    found = re.search(r'<script type="application/json" id="texts">(.*?)</script>', page, re.DOTALL)
    return dict(json.loads(found[1]))


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


def test_english_content_is_marked_within_the_bar_of_the_language():
    page = page_response("shared/api.html", asking("de")).body.decode()

    assert '<html lang="de"' in page and '<main class="api" lang="en">' in page
    assert texts_of(page).keys() == {"de"}


def test_a_lost_page_has_its_title_in_the_language():
    request = Request(asking("de").scope | {"method": "GET", "path": "/x"})
    detail = CodedText("project-unknown", name="{{ title }} <b>")
    page = _page(request, 404, detail, headers=None).body.decode()

    assert "<title>Seite nicht gefunden · recon4</title>" in page and "Alle Projekte" in page
    assert "<p>kein Projekt &#x27;{{ title }} &lt;b&gt;&#x27;</p>" in page


def test_scripts_find_their_texts_in_the_page_and_english_ones_only_if_some_lack():
    page = page_response("live/live.html", asking("de")).body.decode()

    assert texts_of(page).keys() == {"de"}
    assert "Angemeldet als { $name }" in texts_of(page)["de"]
    assert "head-sign-out = Abmelden" in texts_of(page)["de"]


def test_texts_cannot_end_the_element_they_are_in(monkeypatch, tmp_path):
    monkeypatch.setattr(pages, "ROOT", tmp_path)
    (tmp_path / "en").mkdir()
    (tmp_path / "en" / "shared.ftl").write_text("a = </script><!-- x\n")
    pages._texts_of_scripts.cache_clear()

    page = page_response("shared/api.html", asking()).body.decode()
    pages._texts_of_scripts.cache_clear()

    assert texts_of(page) == {"en": "a = </script><!-- x\n\n"}


def test_no_page_has_a_name_twice():
    files = {text_files(html_of(file)) for file in TRANSLATED}
    names = {
        file: list(messages_of(ROOT / ENGLISH / f"{file}.ftl")) for one in files for file in one
    }

    for one in files:
        counted = Counter(name for file in one for name in names[file])
        assert [name for name, n in counted.items() if n > 1] == [], one


class _Words(HTMLParser):
    """The texts and labels of a page as its file has them, without those from the Fluent files."""

    def __init__(self):
        super().__init__()
        self.found, self.skipped = [], 0

    def handle_starttag(self, tag, attrs):
        self.skipped += tag in {"code", "script", "style"}
        self.found += [value or "" for name, value in attrs if name in LABELS]

    def handle_endtag(self, tag):
        self.skipped -= tag in {"code", "script", "style"}

    def handle_data(self, data):
        self.found += [data] * (self.skipped == 0)


@pytest.mark.parametrize("file", TRANSLATED)
def test_a_translated_page_says_nothing_besides_its_texts(file):
    words = _Words()
    words.feed(html_of(file))
    own = [re.sub(r"\{\{ [a-z0-9-]+ \}\}|\brecon4\b|https://…", "", one) for one in words.found]

    assert [one.strip() for one in own if re.search(r"[^\W\d_]{2}", one)] == []


def test_the_phone_names_presets_as_the_shell_does():
    say = texts(ENGLISH, "shared")

    assert {name: say(f"preset-{name}") for name in PRESET_TEXTS} == PRESET_TEXTS


@pytest.mark.parametrize("file", PAGES)
def test_scripts_ask_only_for_texts_of_their_page(file):
    page = html_of(file)
    asked = {name: path for path in scripts_of(page) for name in ASKED.findall(path.read_text())}
    known = {
        name for one in text_files(page) for name in messages_of(ROOT / ENGLISH / f"{one}.ftl")
    }

    assert {name: path.name for name, path in asked.items() if name not in known} == {}
