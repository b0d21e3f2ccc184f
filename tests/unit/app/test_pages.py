"""The pages as the server sends them."""

import re

import pytest

from recon4_app.pages import HEAD_HERE, WEB, html_of

PAGES = sorted(
    path.relative_to(WEB).as_posix() for path in WEB.rglob("*.html") if path.name != "head.html"
)


@pytest.mark.parametrize("file", PAGES)
def test_a_page_has_the_shared_head_once(file):
    html = html_of(file)

    assert html.startswith("<!doctype html>") and HEAD_HERE not in html
    head = html[: html.index("</head>")]
    for once in ("<meta charset=", '<meta name="viewport"', "/web/shared/base.css"):
        assert head.count(once) == html.count(once) == 1, once


@pytest.mark.parametrize("file", PAGES)
def test_every_file_of_a_head_exists(file):
    files = re.findall(r'(?:href|src)="/web/([^"]+)"', html_of(file))

    assert files
    assert [name for name in files if not (WEB / name).is_file()] == []


def test_a_page_names_what_its_script_imports_at_any_depth():
    html = html_of("projects/index.html", "/maps")

    for module in ("projects/organize", "shared/http", "shared/vendor/fluent/scope"):
        assert html.count(f'<link rel="modulepreload" href="/maps/web/{module}.js" />') == 1
    assert html.index("modulepreload") < html.index('<script type="module"')
