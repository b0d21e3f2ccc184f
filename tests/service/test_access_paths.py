"""Hostile names in every path parameter of every route: none leads anywhere, none is a failure."""

import http.client
import re
from itertools import cycle, islice
from urllib.parse import quote, urlsplit

import pytest

from recon4_app.access.middleware.origin import SAFE_METHODS
from recon4_app.access.routes_check import declared
from recon4_app.main import create_app
from recon4_app.settings import ServerSettings
from tests.deadlines import HANG_S
from tests.project_builder import build_project
from tests.service.running import server_thread

SECRET = b"the secret outside"

WAYS_OUT = [
    "..",
    "../../secret",
    "..\\..\\secret",
    "/etc/passwd",
    "office/../../secret",
    ".recon4",
]
ODD = [
    ".",
    "link",
    "office\x00.json",
    "office\r\nX-Injected: 1",
    "office ",
    "оffice",  # a Cyrillic o
    "office\u200b",
    "\u202eeciffo",
    "a" * 5000,
    "\ud800",
    "<script>alert(1)</script>",
    "'; DROP TABLE people; --",
    "*",
]
"""Names that lead nowhere; what they could upset is the same for every path: each is put into many
paths, in full, and each path gets some of them."""
OF_A_PATH = 3


@pytest.fixture(scope="module")
def server(tmp_path_factory):
    root = tmp_path_factory.mktemp("projects")
    build_project(root / "office", points=100)
    outside = tmp_path_factory.mktemp("outside")
    (outside / "project.json").write_text('{"format": 1}')
    for name in ("summary.json", "report.html", "map.laz"):
        (outside / name).write_bytes(SECRET)
    (root.parent / "secret").mkdir(exist_ok=True)
    (root.parent / "secret" / "project.json").write_text('{"format": 1}')
    (root.parent / "secret" / "summary.json").write_bytes(SECRET)
    (root / "link").symlink_to(outside)
    with server_thread(root) as running:
        yield running


def paths_with_parameters(tmp_path):
    app = create_app(ServerSettings(root=tmp_path))
    return [
        (method, one.path)
        for one in declared(app)
        for method in sorted(one.methods - {"OPTIONS"})
        if "{" in one.path
    ]


def sent(name, way):
    """The name as it could stand in a URL."""
    data = name.encode("utf-8", "surrogatepass")
    if way == "encoded":
        return quote(data, safe="")
    if way == "twice":
        return quote(quote(data, safe=""), safe="")
    return "".join(chr(b) if 33 <= b < 127 and b not in b"?#" else f"%{b:02X}" for b in data)


@pytest.mark.parametrize("way", ["encoded", "twice", "plain"])
def test_no_hostile_name_in_any_path_reaches_anything_or_makes_the_server_fail(
    server, tmp_path, way
):
    connection = http.client.HTTPConnection(urlsplit(server.url).netloc, timeout=HANG_S)
    wrong = []
    odd = cycle(ODD)
    for method, path in paths_with_parameters(tmp_path):
        more = islice(odd, OF_A_PATH) if way == "encoded" else ()
        for name in (*WAYS_OUT, *more):
            target = re.sub(r"{[^}]*}", sent(name, way).replace("\\", r"\\"), path)
            body = {} if method in SAFE_METHODS else {"body": "{}"}
            headers = {"Content-Type": "application/json", "Connection": "keep-alive"}
            connection.request(method, target, headers=headers, **body)
            answer = connection.getresponse()
            content = answer.read()
            leaked = SECRET in content or b"root:x:" in content or "x-injected" in answer.headers
            if answer.status >= 500 or leaked:
                wrong.append((method, target[:120], answer.status))
    connection.close()

    assert wrong == []
    assert (server.root / "office" / "project.json").exists()
    assert (server.root / ".recon4" / "access.sqlite").exists()


def test_a_failure_reveals_neither_path_nor_code(server, monkeypatch):
    def fail(*_):
        raise RuntimeError(f"secret in {server.root}")

    monkeypatch.setattr("recon4_app.projects.store.ProjectStore.all", fail)
    answer = server.get("/api/projects")

    assert answer.status_code == 500
    assert str(server.root) not in answer.text
    assert "Traceback" not in answer.text
    assert re.search(r"internal error [0-9a-f]{8}", answer.text)
    assert answer.headers["x-content-type-options"] == "nosniff"
    assert answer.headers["content-security-policy"].startswith("default-src 'self'")


def test_the_tests_own_way_of_asking_is_strict():
    assert sent("../x", "plain") == "../x"
    assert sent("../x", "encoded") == "..%2Fx"
    assert sent("../x", "twice") == "..%252Fx"
