"""Every role on every route and WebSocket there is, by real requests."""

import asyncio
import re

import httpx
import msgspec.msgpack
import pytest
from fastapi import FastAPI
from viser import _messages
from websockets.exceptions import InvalidStatus

from recon4_app.access.middleware.origin import SAFE_METHODS
from recon4_app.access.middleware.session import OPEN_PATHS
from recon4_app.access.people import MAY, Permission, Role
from recon4_app.access.routes_check import check_declared, declared
from recon4_app.main import create_app
from recon4_app.settings import ServerSettings
from recon4_app.viewer.browser_messages import KINDS
from tests.deadlines import HANG_S
from tests.served import office, served
from tests.service.running import SLOW, recording_with_gate, wait_for
from tests.service.secure import ROLES, secure_server
from tests.service.viser_client import ViserClient, camera

server = served(office(points=1000), run=secure_server)


@pytest.fixture(scope="module")
def routes(tmp_path_factory):
    app = create_app(ServerSettings(root=tmp_path_factory.mktemp("nothing"), lan=True))
    return list(declared(app))


@pytest.fixture
def unhurried(server):
    """Without the limit of requests at a time: hundreds of them are the point here."""
    keeper = server.running.app.middleware_stack
    while not hasattr(keeper, "_requests"):
        keeper = getattr(keeper, "_app", None) or keeper.app
    limit, keeper._requests._burst = keeper._requests._burst, 100_000
    keeper._requests._left.clear()
    yield
    keeper._requests._burst = limit
    keeper._requests._left.clear()


def real_path(path):
    """With something in the place of each parameter, that exists nowhere."""
    return re.sub(r"{[^}]*}", "nothing", path)


def requests_of(routes):
    return [
        (method, one) for one in routes for method in sorted(one.methods) if method != "OPTIONS"
    ]


def test_every_route_declares_its_permission(routes):
    assert len(routes) > 20
    assert [one.path for one in routes if not one.needs and not one.allow_anonymous] == []


def test_a_server_with_a_silent_route_does_not_start():
    app = FastAPI(openapi_url=None, docs_url=None, redoc_url=None)
    app.get("/forgotten")(lambda: None)

    with pytest.raises(AssertionError, match="/forgotten"):
        check_declared(app)


def test_what_answers_before_login_is_exactly_what_the_door_lets_through(routes):
    assert {one.path for one in routes if one.allow_anonymous} == OPEN_PATHS


@pytest.mark.parametrize("name", [*ROLES, None])
def test_each_role_gets_past_the_door_where_it_may_and_nowhere_else(
    server, routes, name, unhurried
):
    role = ROLES[name] if name else Role.NOBODY
    wrong = []
    for method, route in requests_of(routes):
        if route.allow_anonymous or route.path in ("/api/logout", "/api/events"):
            continue
        status = status_of(server, name, method=method, path=real_path(route.path))
        expected_refusal = 403 if name else 401
        if (status == expected_refusal) != (not route.needs <= MAY[role]):
            wrong.append((method, route.path, status))

    assert wrong == []


def status_of(server, name, *, method, path):
    client = client_of(server, name)
    body = {"json": {}} if method not in SAFE_METHODS else {}
    with client.stream(method, path, **body) as answer:
        if "content-length" in answer.headers:  # else it may be a stream without an end
            answer.read()  # a connection with an unread answer is closed: the next shakes hands
        return answer.status_code


CLIENTS = {}


def client_of(server, name):
    """One client a person for the whole module; signing in takes a tenth of a second."""
    if name not in CLIENTS:
        opened = server.signed_in(name) if name else server.client()
        CLIENTS[name] = (opened, opened.__enter__())
    return CLIENTS[name][1]


@pytest.fixture(scope="module", autouse=True)
def closed():
    yield
    for opened, _ in CLIENTS.values():
        opened.__exit__(None, None, None)
    CLIENTS.clear()


def test_the_roles_are_as_documented():
    assert MAY[Role.NOBODY] == frozenset()
    assert MAY[Role.GUEST] == {Permission.SHARED}
    assert MAY[Role.VIEWER] == {Permission.SHARED, Permission.LOOK}
    assert {role for role in Role if Permission.SHARE in MAY[role]} == {Role.REVIEWER, Role.ADMIN}
    assert Permission.REVIEW not in MAY[Role.OPERATOR]
    assert Permission.PROCESS in MAY[Role.REVIEWER]
    assert {role for role in Role if Permission.ADMINISTER in MAY[role]} == {Role.ADMIN}


@pytest.mark.parametrize("name", [*ROLES, None])
def test_every_websocket_asks_who_one_is(server, routes, name, unhurried):
    sockets = [one for one in routes if not one.methods]
    assert sockets
    for route in sockets:
        allowed = route.needs <= MAY[ROLES[name] if name else Role.NOBODY]
        path = re.sub(r"{[^}]*}", "office", route.path)
        statuses = handshake(server, client_of(server, name), path)
        assert (statuses == 403) != allowed, route.path


def handshake(server, client, path):
    try:
        with server.viewer(client) if "viewer" in path else server.websocket(path, client):
            return 101
    except InvalidStatus as refused:
        return refused.response.status_code


def test_no_unsafe_method_passes_without_our_origin_or_the_token(server, routes, unhurried):
    passed = []
    for method, route in requests_of(routes):
        if method in SAFE_METHODS:
            continue
        path = real_path(route.path)
        foreign = client_of(server, "anna").request(
            method, path, json={}, headers={"Origin": "https://evil.example"}
        )
        cross = client_of(server, "anna").request(
            method, path, json={}, headers={"Sec-Fetch-Site": "cross-site"}
        )
        without = client_of(server, "anna").request(
            method, path, json={}, headers={"X-Recon4-Token": ""}
        )
        if {foreign.status_code, cross.status_code, without.status_code} != {403}:
            passed.append((method, path))

    assert passed == []


@pytest.mark.parametrize("method", ["PUT", "DELETE", "PATCH", "POST", "TRACE"])
def test_methods_a_route_does_not_have_do_nothing(server, method, unhurried):
    answer = client_of(server, "anna").request(method, "/api/projects")

    assert answer.status_code == 405


def test_of_all_messages_viser_knows_a_viewers_browser_may_only_send_those_of_looking(
    server, caplog
):
    """Nothing passes that a viewer may not do, for nobody: so there is no role to get round."""
    passed = {kind.__struct_config__.tag for kind in KINDS}
    kinds = sorted({kind.__name__ for kind in _messages.Message.get_subclasses()} - passed)
    assert len(kinds) > 100
    assert {"ShareUrlRequest", "TransformControlsUpdateMessage"} <= set(kinds)

    for name in ("vera", "rita"):
        caplog.clear()
        with server.viewer(client_of(server, name)) as socket:
            for kind in kinds:
                socket.send(msgspec.msgpack.encode({"type": kind}))
            screen = ViserClient(socket)
            screen.send(camera())
            screen.until(lambda one: one.points)
        wait_for(lambda: f"dropped {len(kinds) - 1} more" in caplog.text, "the count in the log")


@pytest.mark.study
def test_a_session_above_its_rate_limit_gets_retry_after(server):
    async def many(cookies):
        options = {"base_url": server.url, "verify": server.trust(), "cookies": cookies}
        async with httpx.AsyncClient(**options, timeout=HANG_S) as client:
            return await asyncio.gather(*(client.get("/api/me") for _ in range(300)))

    with server.signed_in("vera") as client, server.signed_in("otto") as other:
        answers = asyncio.run(many(client.cookies))
        static = client.get("/web/shared/base.css")
        others = other.get("/api/me")

    refused = [one for one in answers if one.status_code == 429]
    assert len(answers) - len(refused) >= 60
    assert refused
    assert int(refused[0].headers["retry-after"]) >= 1
    assert (static.status_code, others.status_code) == (200, 200)


def test_a_person_starts_ten_jobs_an_hour_and_refused_ones_do_not_count(tmp_path):
    with secure_server(tmp_path, worker_module=SLOW) as server, server.signed_in("otto") as client:
        for _ in range(12):
            assert client.post("/api/jobs", json={}).status_code == 422
        statuses = []
        for k in range(11):
            recording = recording_with_gate(tmp_path / f"walk {k}")
            job = {"project": f"walk-{k}", "recordings": [str(recording)]}
            statuses.append(client.post("/api/jobs", json=job).status_code)

    assert statuses == [201] * 10 + [429]
