"""No page writes an address of the server by hand: the server may be at a path of its host."""

import re

import pytest

from recon4_app.access.routes_check import declared
from recon4_app.main import create_app
from recon4_app.pages import WEB, html_of
from recon4_app.settings import ServerSettings
from tools.structure import ROOT

HELPERS = ("at", "wholeUrl", "socketUrl", "urlOf")
"""Functions of ``web/shared`` that put the prefix in front of an address."""
READ_BY_HAND = re.compile(r"location\.(origin|host|hostname|port|protocol|pathname\.)|localStorage")
CODE = sorted(path for path in WEB.rglob("*.js") if path.name != "address.js")
PAGES = sorted(
    path.relative_to(WEB).as_posix() for path in WEB.rglob("*.html") if path.name != "head.html"
)
ADDRESS = re.compile(r"""\s[\w-]+\s*=\s*(["'])(/[^"']*)\1|url\(["']?(/[^)"']*)""")


@pytest.fixture(scope="module")
def first_parts(tmp_path_factory):
    """What an address of the server may begin with: ``api``, ``projects``."""
    app = create_app(ServerSettings(root=tmp_path_factory.mktemp("root")))
    return sorted({"web", *(route.path.split("/")[1] for route in declared(app))} - {""})


def by_hand(code, first_parts):
    """Addresses in a module that do not go through a helper."""
    words = "|".join(map(re.escape, first_parts))
    address = re.compile(rf"([\w.]*\(|href\s*[:=]\s*)?[\"'`](/(?:{words})(?![\w-])|/(?=[\"'`]))")
    found = [one[2] for one in address.finditer(code) if not allowed(one[1] or "", one[2])]
    return found + [one[0] for one in READ_BY_HAND.finditer(code)]


def allowed(before, address):
    name = before.rstrip("( ")
    if address == "/":  # a separator, unless something goes there
        return not re.search(r"href\s*[:=]|(^|\.)(assign|replace|open|fetch|EventSource)$", name)
    return name in HELPERS


def test_the_check_knows_the_routes(first_parts):
    assert {"api", "projects", "web", "live", "docs", "login", "rigs"} <= set(first_parts)


@pytest.mark.parametrize(
    "code",
    [
        'html`<a href="/rigs">Rigs</a>`',
        'fetch("/api/me")',
        'new WebSocket(location.host + "x")',
        "const url = `/projects/${id}/`;",
        'location.assign("/")',
        'html`<a href="/">Projects</a>`',
        'const id = location.pathname.split("/")[2];',
        "import x from '/web/shared/dom.js'",
        'localStorage.setItem("a", "b")',
    ],
)
def test_an_address_by_hand_is_found(code, first_parts):
    assert by_hand(code, first_parts)


@pytest.mark.parametrize(
    "code",
    ['at("/api/me")', 'path.split("/")', 'const example = "/data/walk.pcap"', "at(`/rigs/${id}/`)"],
)
def test_what_goes_through_a_helper_is_fine(code, first_parts):
    assert by_hand(code, first_parts) == []


@pytest.mark.parametrize("path", CODE, ids=lambda path: path.relative_to(WEB).as_posix())
def test_a_module_writes_no_address_by_hand(path, first_parts):
    assert by_hand(path.read_text("utf-8"), first_parts) == []


@pytest.mark.parametrize("file", PAGES)
def test_every_address_of_a_page_begins_with_the_prefix(file):
    addresses = [one[2] or one[3] for one in ADDRESS.finditer(html_of(file, "/maps/old"))]

    assert addresses
    assert [one for one in addresses if not one.startswith("/maps/old/")] == []


def test_style_sheets_name_no_address_of_the_server():
    assert [path.name for path in WEB.rglob("*.css") if ADDRESS.search(path.read_text())] == []


def test_the_server_redirects_to_addresses_with_the_prefix_only():
    by_hand = re.compile(r"""RedirectResponse\(f?["']|["']Location["']: f?["']|href=\\?["']/""")
    code = {path: path.read_text("utf-8") for path in (ROOT / "app").rglob("*.py")}

    assert [path.name for path, text in code.items() if by_hand.search(text)] == []
