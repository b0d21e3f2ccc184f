"""The report for the client as HTML: it says what its record says, and nothing in it is markup."""

from dataclasses import replace
from html.parser import HTMLParser

import pytest

from recon4.delivery.report_files import ReportWish, report_of, write_client_html
from recon4.report.client import FindingBox
from recon4.report.client_html import client_html
from recon4.review.approval_state import NOT_APPROVED
from tests.made_once import made_once
from tests.project_builder import build_project
from tests.unit.delivery.test_pdf_report import HOSTILE


class Page(HTMLParser):
    """Texts and elements of a page."""

    def __init__(self, text):
        super().__init__()
        self.texts, self.tags, self.sources = [], set(), []
        self.feed(text)

    def handle_starttag(self, tag, attrs):
        self.tags.add(tag)
        self.sources += [value for name, value in attrs if name in ("src", "href")]
        assert not any(name.startswith("on") for name, _ in attrs)

    def handle_data(self, data):
        if data.strip():
            self.texts.append(data.strip())


@pytest.fixture(scope="module")
def room(tmp_path_factory):
    return made_once(
        tmp_path_factory, "client-html", lambda folder: build_project(folder, points=2000)
    )


@pytest.mark.parametrize("language", ["en", "de"])
def test_it_says_all_that_the_record_says(room, tmp_path, language):
    wish = ReportWish(language=language)
    report = report_of(room, None, NOT_APPROVED, wish=wish)
    made = write_client_html(room, tmp_path / "client.html", wish)
    page = Page((tmp_path / "client.html").read_text("utf-8"))

    said = [report.title, report.front.verdict, report.words["draft"], *report.front.limits]
    for rows in (report.front.what, report.front.where, report.front.accuracy):
        said += [text for row in rows for text in (row.label, row.value)]
    for section in report.sections:
        said += [section.title, *section.text]
        said += [cell for table in section.tables for row in table.rows for cell in row]
        said += [text for one in section.findings for text in (one.title, one.code, one.text)]
    assert not made.signed
    assert [text for text in said if text.strip() and text.strip() not in page.texts] == []
    images = sum(len(section.drawings) for section in report.sections)
    assert len(page.sources) > images > 0


def test_hostile_texts_are_shown_and_nothing_runs(room):
    report = report_of(room, None, NOT_APPROVED, wish=ReportWish())
    markup = "<script>alert(1)</script><img src=x onerror=alert(1)> {{ 7*7 }} {% raw %}"
    texts = [markup, *HOSTILE[1:]]
    boxes = tuple(
        FindingBox(code="MIRROR", level="check", label="check", title=text, text=text)
        for text in texts
    )
    section = replace(report.sections[0], title=markup, findings=boxes)
    made = client_html(replace(report, title=markup, sections=(section,)))
    page = Page(made)

    assert {"script", "iframe", "link", "form"} & page.tags == set()
    assert page.texts.count(markup) >= 3
    assert all(source.startswith("data:image/svg+xml;base64,") for source in page.sources)
