"""Who may talk to the server: hosts, origins, sizes, headers."""

import http.client
from urllib.parse import urlsplit

import pytest
from websockets.exceptions import InvalidStatus
from websockets.sync.client import connect

from recon4.errors import ConfigError
from recon4_app.settings import ServerSettings
from tests.project_builder import build_project
from tests.served import office, served

server = served(office(points=1000))


def own(server):
    return urlsplit(server.url).netloc


@pytest.mark.parametrize(
    "host",
    ["evil.example", "127.0.0.1.evil.example", "evil.example:80@127.0.0.1", "127.0.0.1/evil", ""],
)
def test_a_foreign_host_name_is_not_answered(server, host):
    answer = server.get("/api/projects", headers={"Host": host})

    assert answer.status_code == 400


@pytest.mark.parametrize("host", ["127.0.0.1", "localhost:1234", "LOCALHOST", "[::1]:8000"])
def test_our_own_host_names_are_answered_on_any_port(server, host):
    assert server.get("/healthz", headers={"Host": host}).status_code == 200


ORIGINS = [
    "null",
    "http://evil.example",
    "http://127.0.0.1",
    "http://127.0.0.1:1",
    "http://localhost:{port}",
    "http://127.0.0.1:{port}.evil.example",
    "http://evil.example/127.0.0.1:{port}",
    "ftp://127.0.0.1:{port}",
]


@pytest.mark.parametrize("origin", ORIGINS)
def test_another_site_cannot_change_anything(server, origin):
    headers = {"Origin": origin.format(port=urlsplit(server.url).port)}

    answer = server.post("/api/jobs", json={}, headers=headers)

    assert answer.status_code == 403


def test_a_cross_site_request_cannot_change_anything(server):
    answer = server.post("/api/jobs", json={}, headers={"Sec-Fetch-Site": "cross-site"})

    assert answer.status_code == 403


def test_our_own_page_and_a_script_get_as_far_as_the_form(server):
    page = server.post("/api/jobs", json={}, headers={"Origin": server.url})
    script = server.post("/api/jobs", json={})

    assert (page.status_code, script.status_code) == (422, 422)


@pytest.mark.parametrize("origin", [*ORIGINS, None])
def test_a_websocket_of_another_site_is_refused(server, origin):
    port = urlsplit(server.url).port
    url = f"ws://{own(server)}/projects/office/viewer"

    with pytest.raises(InvalidStatus) as refused:
        connect(url, origin=origin and origin.format(port=port), proxy=None)

    assert refused.value.response.status_code == 403


def test_every_answer_carries_the_security_headers(server):
    paths = (
        "/",
        "/projects/office/",
        "/web/shared/base.css",
        "/api/projects",
        "/api/nothing",
        "/api",
    )

    for path in paths:
        headers = server.get(path).headers
        assert headers["content-security-policy"].startswith("default-src 'self'"), path
        assert headers["x-content-type-options"] == "nosniff"
        assert headers["referrer-policy"] == "no-referrer"


def test_a_report_may_not_run_anything(server):
    policy = server.get("/api/projects/office/report").headers["content-security-policy"]

    assert policy.startswith("sandbox; default-src 'none'")


def test_a_large_request_is_refused(server):
    answer = server.post("/api/jobs", json={"project": "x" * 2_000_000})

    assert answer.status_code == 413


TRAVERSALS = [
    "/projects/../../etc/passwd",
    "/projects/%2e%2e/",
    "/projects/%2e%2e%2f%2e%2e%2fetc/",
    "/api/projects/..",
    "/api/projects/%2e%2e",
    "/api/projects/.recon4",
    "/api/projects/office%00",
    "/api/projects/office/files/..%2fproject.json",
    "/api/projects/office/files/project.json",
    "/api/projects/office/files/ledger.sqlite",
    "/api/projects/office/files/%2e%2e%2f%2e%2e%2fetc%2fpasswd",
    "/api/projects/link/files/summary.json",
    "/web/../app/main.py",
    "/web/%2e%2e/app/main.py",
    "/web/..%2fapp/main.py",
]


@pytest.mark.parametrize("path", TRAVERSALS)
def test_no_path_leads_out_of_the_projects(server, path, tmp_path_factory):
    outside = tmp_path_factory.mktemp("outside")
    (outside / "project.json").write_text('{"format": 1}')
    link = server.root / "link"
    link.unlink(missing_ok=True)
    link.symlink_to(outside)
    connection = http.client.HTTPConnection(own(server))

    connection.request("GET", path)
    status = connection.getresponse().status
    connection.close()

    assert status == 404


def test_a_result_that_is_a_link_to_elsewhere_is_not_served(server, tmp_path):
    (tmp_path / "secret").write_text("secret")
    link = server.root / "office" / "graph.g2o"
    link.symlink_to(tmp_path / "secret")

    assert server.get("/api/projects/office/files/graph.g2o").status_code == 404


def test_only_named_folders_can_be_looked_into(server):
    assert server.get("/api/recordings", params={"folder": "/etc"}).status_code == 403
    assert (
        server.get("/api/recordings", params={"folder": f"{server.root}/../.."}).status_code == 403
    )
    assert server.get("/api/recordings", params={"folder": str(server.root)}).status_code == 200


@pytest.mark.parametrize(
    ("path", "params"),
    [
        ("/api/audit", {"before": 10**30}),
        ("/api/audit", {"most": 10**9}),
        ("/api/jobs/0123456789abcdef/log/since", {"offset": 1 << 49}),
    ],
)
def test_numbers_beyond_all_sense_are_refused_in_words(server, path, params):
    answer = server.get(path, params=params)

    assert answer.status_code == 422 and answer.json()["error"] == "Invalid"


def test_points_beyond_all_sense_are_refused_in_words(server):
    far = [[1e300, 0.0, 0.0], [0.0, 1e300, 0.0], [0.0, 0.0, -1e300]]

    answer = server.post("/api/projects/office/review/fit", json={"p_i": far, "p_j": far})

    assert answer.status_code == 422 and "p_i" in answer.json()["detail"]


@pytest.mark.parametrize("host", ["0.0.0.0", "192.168.1.5", "::", "example.org", ""])
def test_an_open_network_is_refused_without_login(tmp_path, host):
    with pytest.raises(ConfigError, match="only loopback"):
        ServerSettings(root=tmp_path, host=host)


def test_a_project_is_not_taken_for_the_folder_of_projects(tmp_path):
    build_project(tmp_path / "office", points=10)

    with pytest.raises(ConfigError, match="is a project itself"):
        ServerSettings(root=tmp_path / "office")
