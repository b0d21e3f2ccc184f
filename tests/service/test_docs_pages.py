"""The documentation site on the server: every page, link and image, without internet."""

import re
from functools import cache
from html.parser import HTMLParser
from posixpath import join, normpath

import pytest
from markdown_it import MarkdownIt

from recon4_app.docs_pages import files, folder, policy_of
from tests.served import served
from tests.service.running import ROOT

SOURCES = sorted((ROOT / "docs").rglob("*.md"))
ADDRESSES = [path.relative_to(ROOT / "docs").with_suffix(".html").as_posix() for path in SOURCES]
BLOCKS = ("li", "table", "tr", "pre", "blockquote", "h1", "h2", "h3", "img")

server = served()


class Elements(HTMLParser):
    """The elements of a page, and of its article, in order."""

    def __init__(self, text):
        super().__init__()
        self.all, self.article, self._inside = [], [], False
        self.feed(text)

    def handle_starttag(self, tag, attributes):
        self._inside |= tag == "article"
        self.all.append((tag, dict(attributes)))
        if self._inside:
            self.article.append(tag)

    def handle_endtag(self, tag):
        self._inside &= tag != "article"


@cache
def elements(address):
    return Elements((folder() / address).read_text("utf-8"))


def test_the_site_is_built_from_the_pages_of_now():
    newest = max(SOURCES, key=lambda path: path.stat().st_mtime)
    built = (folder() / "index.html").stat().st_mtime if folder().is_dir() else 0

    assert built > newest.stat().st_mtime, f"{newest.name} is newer: run `make site`"
    assert {one for one in files() if one.endswith(".html")} == {*ADDRESSES, "404.html"}


@pytest.mark.parametrize("address", ADDRESSES)
def test_a_page_is_served_and_all_it_refers_to_exists(server, address):
    assert server.get(f"/docs/{address}").status_code == 200
    missing = []
    for tag, attributes in elements(address).all:
        target = attributes.get("href") or attributes.get("src") or ""
        path, _, anchor = target.partition("#")
        if ":" in path or normpath(join(address, "..", path)) == "..":
            continue  # elsewhere, or the server itself
        there = normpath(join(address, "..", path)) if path else address
        there = there.removeprefix("./") if there != "." else "index.html"
        if there not in files() or (anchor and anchor not in anchors(there)):
            missing.append((tag, target))

    assert missing == []


@cache
def anchors(address):
    return {"__skip", *(attributes.get("id") for _, attributes in elements(address).all)}


@pytest.mark.parametrize("source", SOURCES, ids=lambda path: path.stem)
def test_a_page_has_the_same_blocks_on_the_site_and_beside_the_code(source):
    there = Elements(
        "<article>"
        + MarkdownIt("commonmark", {"html": True}).enable("table").render(source.read_text("utf-8"))
    )
    address = source.relative_to(ROOT / "docs").with_suffix(".html").as_posix()

    def counted(tags):
        return {tag: tags.count(tag) for tag in BLOCKS}

    assert counted(elements(address).article) == counted(there.article)


@pytest.mark.parametrize("address", ADDRESSES)
def test_a_page_needs_nothing_that_the_policy_forbids(server, address):
    page = elements(address).all
    policy = server.get(f"/docs/{address}").headers["content-security-policy"]

    assert "unsafe" not in policy and policy.startswith("default-src 'self'; img-src 'self'")
    assert policy.count("'sha256-") == len(re.findall(r"'sha256-[\w+/]{43}='", policy)) >= 3
    loaded = [a.get("src") or a.get("href") or "" for tag, a in page if tag in LOADED]
    assert [
        one for one in loaded if re.match(r"\w+:|//", one) and not one.startswith("data:")
    ] == []
    forbidden = [(tag, name) for tag, a in page for name in a if name.startswith("on")]
    assert forbidden + [(tag, a["style"]) for tag, a in page if "style" in a] == []


LOADED = {"script", "link", "img", "iframe"}


def test_the_policy_admits_the_scripts_of_a_page_and_no_other(tmp_path):
    page = tmp_path / "page.html"
    page.write_text("<script>1</script><script src='x'></script>")

    assert policy_of(page).endswith(
        "; script-src 'self' 'sha256-a4ayc/80/OGda4BO/1o/V0etpOqiLx1JwB5S3beHW0s='"
    )


@pytest.mark.parametrize(
    ("earlier", "now"),
    [("recordings", "reference"), ("server.md", "how-to"), ("reference/live.md", "how-to")],
)
def test_the_name_of_a_page_leads_to_it(server, earlier, now):
    page = server.get(f"/docs/{earlier}")

    name = earlier.rpartition("/")[2].removesuffix(".md")
    assert page.status_code == 307 and page.headers["location"] == f"/docs/{now}/{name}.html"


def test_the_help_begins_with_the_start_page_and_search_has_every_page(server):
    assert "<h1" in server.get("/docs/").text
    found = {
        one["location"].partition("#")[0] for one in server.get("/docs/search.json").json()["items"]
    }

    assert found == set(ADDRESSES)


@pytest.mark.parametrize(
    "name", ["..%2fREADME", "missing", "images/..%2f..%2fREADME.md", "a b", "a" * 5000]
)
def test_nothing_else_is_served(server, name):
    assert server.get(f"/docs/{name}").status_code == 404
