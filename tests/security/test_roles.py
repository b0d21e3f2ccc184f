"""Access never exceeds the role: every route, every method, own and foreign objects.

Figures: routes x methods a route does not have x roles: 0 answers of success; roles x things of
others: 0 read, changed or ended beyond the role. The rest of the class stands where it grew:
routes x their own methods x roles, WebSockets x roles, CSRF and messages to viser in
`tests/service/test_access_roles.py`; Host and Origin in `test_guard.py`; login, sessions and
throttle in `test_access_throttling.py`; hostile names in paths in `test_access_paths.py`.
"""

import re

import pytest

from tests.first_variants import all_but_first_are_studies
from tests.service.test_access_roles import (  # noqa: F401 - fixtures
    client_of,
    closed,
    requests_of,
    routes,
    server,
    unhurried,
)

METHODS = ("GET", "POST", "PUT", "PATCH", "DELETE", "TRACE")
NAMES = (None, "vera", "anna")


@pytest.mark.parametrize("name", all_but_first_are_studies(NAMES, first=2))
def test_no_method_that_a_route_does_not_have_succeeds(server, routes, name, unhurried):  # noqa: F811
    declared = {(method, route.path) for method, route in requests_of(routes)}
    paths = sorted({route.path for route in routes if route.methods})
    client = client_of(server, name)
    succeeded = []
    for path in paths:
        target = re.sub(r"{[^}]*}", "nothing", path)
        for method in METHODS:
            if (method, path) in declared or (method == "HEAD" and ("GET", path) in declared):
                continue
            status = client.request(method, target).status_code
            if status < 400 or status >= 500:
                succeeded.append((method, path, status))

    assert len(paths) > 60
    assert succeeded == []


def sessions_of(client):
    return {one["session"]["id"] for one in client.get("/api/me/sessions").json()}


@pytest.mark.parametrize("name", ["vera", "otto", "rita"])
def test_nobody_but_an_admin_reads_or_ends_sessions_of_others(server, name):  # noqa: F811
    with server.signed_in("anna") as anna, server.signed_in(name) as other:
        (own, *_) = sessions_of(anna) - sessions_of(other)

        assert sessions_of(anna) & sessions_of(other) == set()
        assert other.delete(f"/api/me/sessions/{own}").status_code == 404
        assert other.delete(f"/api/sessions/{own}").status_code == 403
        assert other.get("/api/sessions").status_code == 403
        assert anna.get("/api/me").status_code == 200


@pytest.mark.parametrize("name", ["vera", "otto", "rita"])
def test_nobody_changes_another_person_or_their_own_role(server, name):  # noqa: F811
    with server.signed_in(name) as client:
        statuses = {
            client.patch(f"/api/people/{target}", json=change).status_code
            for target in (name, "anna", "Anna")
            for change in ({"role": "admin"}, {"disabled": True}, {"password": "x" * 20})
        }
        assert statuses == {403}
        assert client.post("/api/people", json={"name": "eva", "role": "admin"}).status_code == 403
        assert client.get("/api/me").json()["role"] != "admin"


def test_a_form_token_of_one_person_is_worth_nothing_for_another(server):  # noqa: F811
    with server.signed_in("anna") as anna, server.signed_in("otto") as otto:
        stolen = otto.headers["X-Recon4-Token"]

        answer = anna.patch(
            "/api/people/vera", json={"role": "viewer"}, headers={"X-Recon4-Token": stolen}
        )

        assert answer.status_code == 403


def test_an_upload_is_written_only_by_who_may_process(server):  # noqa: F811
    given = {"name": "walk", "files": 1, "bytes": 4, "fingerprint": "walk-1"}
    with server.signed_in("otto") as otto, server.signed_in("vera") as vera:
        begun = otto.post("/api/uploads", json=given)
        assert begun.status_code == 201, begun.text
        path = f"/api/uploads/{begun.json()['id']}"

        assert vera.delete(path).status_code == 403
        assert vera.post("/api/uploads", json=given).status_code == 403
        assert otto.get(path).status_code == 200
        assert otto.delete(path).status_code == 204
