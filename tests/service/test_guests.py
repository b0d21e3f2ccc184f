"""Guests by hostile requests: one project, its map, slices and report, and nothing else."""

import pytest

from recon4_app.access.middleware.origin import SAFE_METHODS
from recon4_app.access.people import Permission
from recon4_app.access.tuning import GUEST_LINK
from tests.project_builder import build_project
from tests.served import served
from tests.service.secure import secure_server
from tests.service.test_access_roles import (  # noqa: F401 - fixtures
    real_path,
    requests_of,
    routes,
    unhurried,
)

MAP = "/api/projects/{project_id}/map"
SLICES = "/api/projects/{project_id}/slices"
SHARED = {
    ("GET", "/api/me"),
    ("POST", "/api/logout"),
    ("GET", "/api/projects/{project_id}"),
    ("GET", "/api/projects/{project_id}/report"),
    ("GET", "/api/projects/{project_id}/thumbnail"),
    ("GET", "/projects/{project_id}/map/"),
    ("GET", "/projects/{project_id}/slices/"),
    *(
        ("GET", MAP + rest)
        for rest in ("", "/walk", "/{key}/sample", "/{key}/cubes", "/{key}/points")
    ),
    *(("POST", MAP + rest) for rest in ("/pick", "/volume", "/crs")),
    *(("GET", SLICES + rest) for rest in ("", "/overview", "/overview/window", "/walk")),
    *(("POST", SLICES + rest) for rest in ("/image", "/pick")),
}
"""All that a guest may request; what is not a GET reads points, or signs out."""
PLANE = {"kind": "horizontal", "z_m": 1.0}


def projects(root):
    build_project(root / "office", points=1000)
    build_project(root / "secret", points=1000)


server = served(projects, run=secure_server)


@pytest.fixture(scope="module")
def link(server):
    with server.signed_in("rita") as rita:
        made = rita.post("/api/projects/office/guests", json={"label": "Client", "days": 1})
        assert made.status_code == 201, made.text
        return made.json()


@pytest.fixture
def guest(server, link):
    with server.client() as client:
        opened = client.post("/api/guests/open", json={"token": link["token"]})
        assert opened.json() == {"project": "office"}
        client.headers["X-Recon4-Token"] = client.get("/api/me").json()["token"]
        yield client


def test_a_guest_may_request_exactly_this(routes):  # noqa: F811
    shared = {
        (method, one.path)
        for method, one in requests_of(routes)
        if one.needs == {Permission.SHARED} and method != "HEAD"
    }

    assert shared == SHARED
    outside = {path for _, path in shared if "{project_id}" not in path}
    assert outside == {"/api/me", "/api/logout"}


def test_every_other_request_of_a_guest_is_refused(server, guest, routes, unhurried):  # noqa: F811
    limits = server.running.app.middleware_stack
    while not hasattr(limits, "_guests"):
        limits = getattr(limits, "_app", None) or limits.app
    limits._guests._burst = 100_000
    limits._guests._left.clear()
    answered = []
    for method, route in requests_of(routes):
        if route.allow_anonymous or route.path == "/api/logout":
            continue
        project = "secret" if route.needs == {Permission.SHARED} else "office"
        path = real_path(route.path).replace("/projects/nothing", f"/projects/{project}")
        body = {} if method in SAFE_METHODS else {"json": {}}
        status = guest.request(method, path, **body).status_code
        if status != 403 and route.path != "/api/me":
            answered.append((method, path, status))
    limits._guests._burst = GUEST_LINK.burst
    limits._guests._left.clear()

    assert answered == []


def test_a_guest_learns_of_no_people_files_or_other_projects(server, guest):
    project = guest.get("/api/projects/office").json()

    assert guest.get("/api/me").json() | {"token": ""} == {
        "name": "guest: Client",
        "role": "guest",
        "may": ["shared"],
        "login": True,
        "token": "",
    }
    assert project["summary"]["points"] > 0 and project["approval"]["text"]
    assert project["files"] == [] and project["rig"] == "" and "settings" not in project["summary"]
    assert guest.get("/api/projects/office/report").status_code == 200
    assert guest.get("/projects/office/map/").status_code == 200


def test_every_error_page_leads_a_guest_back_to_the_shared_map(guest):
    for path, status in (("/", 403), ("/projects/secret/map/", 403), ("/nowhere", 404)):
        page = guest.get(path, headers={"Accept": "text/html,*/*"})

        assert page.status_code == status
        assert 'href="/projects/office/map/">Open the shared map<' in page.text
        assert ">All projects<" not in page.text


@pytest.mark.parametrize("asked", [{"source": "project:secret"}, {"reference": "0" * 12}])
def test_a_guest_sees_no_other_map_by_its_name(guest, asked):
    image = {"plane": PLANE, "width": 64, "height": 64, **asked}

    slices = "/api/projects/office/slices"
    answers = [guest.post(f"{slices}/image", json=image)]
    if "source" in asked:
        paths = ("", "/overview", "/overview/window")
        answers += [guest.get(slices + path, params=asked) for path in paths]

    assert {one.status_code for one in answers} == {403}, [one.text for one in answers]
    assert "one project" in answers[0].json()["detail"]


def test_a_revoked_link_is_refused_at_once_and_the_log_has_no_token(server):
    with server.signed_in("rita") as rita, server.client() as client:
        made = rita.post("/api/projects/office/guests", json={"label": "Gone", "days": 1}).json()
        client.post("/api/guests/open", json={"token": made["token"]})
        assert client.get("/api/projects/office").status_code == 200

        path = f"/api/projects/office/guests/{made['link']['id']}"
        assert rita.delete(path).json()["revoked_by"] == "rita"

        assert client.get("/api/projects/office").status_code == 401
        again = client.post("/api/guests/open", json={"token": made["token"]})
        assert again.status_code == 403
        listed = rita.get("/api/projects/office/guests").json()["links"]
        assert {one["label"]: one["works"] for one in listed}["Gone"] is False
        assert made["token"] not in rita.get("/api/projects/office/guests").text
    with server.signed_in("anna") as anna:
        entries = anna.get("/api/audit").text
    assert "revoke guest link" in entries and "open guest link" in entries
    logs = "".join(one.read_text() for one in (server.root / ".recon4" / "logs").glob("*"))
    assert made["token"] not in entries + logs


@pytest.mark.parametrize("name", ["vera", "otto"])
def test_who_may_not_share_makes_no_link(server, name):
    with server.signed_in(name) as client:
        made = client.post("/api/projects/office/guests", json={"label": "x", "days": 1})
        assert made.status_code == 403


def test_a_signed_in_person_stays_who_they_are(server, link):
    with server.signed_in("vera") as vera:
        assert vera.post("/api/guests/open", json={"token": link["token"]}).status_code == 403
        assert vera.get("/api/me").json()["name"] == "vera"


def test_a_project_of_the_same_name_is_not_shared_by_an_earlier_link(server):
    build_project(server.root / "twice", with_map=False)
    with server.signed_in("anna") as anna, server.client() as client:
        made = anna.post("/api/projects/twice/guests", json={"label": "x", "days": 1}).json()
        assert anna.delete("/api/projects/twice").status_code == 200
        build_project(server.root / "twice", with_map=False)

        assert client.post("/api/guests/open", json={"token": made["token"]}).status_code == 403
