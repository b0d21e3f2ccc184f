"""Signing in, sessions, and what is refused without: on a real server with TLS."""

import time
from urllib.parse import urlsplit

import pytest
from websockets.exceptions import ConnectionClosed, InvalidStatus

from recon4_app.access.login.login_service import open_access
from recon4_app.access.people import Role
from recon4_app.network.listen import make_state
from recon4_app.settings import ServerSettings
from tests.deadlines import BUSY_S, HANG_S
from tests.served import office, served
from tests.service.running import server_thread
from tests.service.secure import PASSWORD, secure_server

server = served(office(points=1000), run=secure_server)


def cookies_of(answer):
    return {line.split("=")[0]: line for line in answer.headers.get_list("set-cookie")}


def test_without_a_session_only_the_login_is_answered(server):
    with server.client() as client:
        answers = {
            path: client.get(path).status_code
            for path in ("/", "/api/projects", "/api/me", "/projects/office/", "/openapi.json")
        }
        nothing = client.get("/no/such/page").status_code
        open_ones = [client.get(path).status_code for path in ("/login", "/healthz")]
        static = client.get("/web/shared/base.css").status_code

    assert set(answers.values()) == {401}
    assert nothing == 401
    assert (open_ones, static) == ([200, 200], 200)


def test_a_browser_is_led_to_the_login_and_back(server):
    with server.client() as client:
        answer = client.get("/projects/office/", headers={"Accept": "text/html,*/*"})

    assert answer.status_code == 303
    assert answer.headers["location"] == "/login#next=/projects/office/"


def test_a_session_is_a_cookie_no_script_reads_and_no_other_site_sends(server):
    with server.client() as client:
        answer = client.post("/api/login", json={"name": "Anna", "password": PASSWORD})

    cookie = cookies_of(answer)["__Host-sid"]
    parts = {part.strip().lower() for part in cookie.split(";")[1:]}
    assert {"httponly", "secure", "samesite=strict", "path=/"} <= parts
    assert not any(part.startswith("domain") for part in parts)
    assert len(cookie.split(";")[0].split("=")[1]) == 43  # 256 bits
    assert answer.headers["cache-control"] == "no-store"


def test_the_database_holds_neither_password_nor_token(server):
    with server.signed_in("vera") as client:
        token = client.cookies["__Host-sid"]
        stored = b"".join(path.read_bytes() for path in (server.root / ".recon4").glob("access.*"))

        assert token.encode() not in stored
        assert PASSWORD.encode() not in stored
        assert b"$argon2id$v=19$" in stored


def test_every_login_has_a_new_token_and_the_session_before_ends(server):
    with server.signed_in("vera") as client:
        first = client.cookies["__Host-sid"]
        client.post("/api/login", json={"name": "vera", "password": PASSWORD})
        second = client.cookies["__Host-sid"]

        with server.client(cookies={"__Host-sid": first}) as old:
            assert old.get("/api/me").status_code == 401
    assert first != second


@pytest.mark.parametrize("name", ["anna", "nobody of that name"])
def test_a_wrong_password_and_a_wrong_name_are_answered_alike(server, name):
    with server.client() as client:
        answer = client.post("/api/login", json={"name": name, "password": "wrong wrong wrong"})

    assert answer.status_code == 401
    assert answer.json()["error"] == "WrongPassword"
    assert answer.json()["detail"] == "wrong name or password"


@pytest.mark.parametrize("token", ["", "x" * 43, "a" * 1000, "../../etc", "é" * 43])
def test_a_made_up_session_is_none(server, token):
    with server.client(headers={b"Cookie": f"__Host-sid={token}".encode()}) as client:
        assert client.get("/api/me").status_code == 401


def test_two_session_cookies_are_none(server):
    with server.signed_in("vera") as client:
        token = client.cookies["__Host-sid"]
    with server.client(headers={"Cookie": f"__Host-sid={token}; __Host-sid={token}"}) as client:
        assert client.get("/api/me").status_code == 401


def test_what_changes_something_needs_the_token_of_the_session(server):
    with server.signed_in("otto") as client, server.signed_in("otto") as other:
        right = client.headers.pop("X-Recon4-Token")
        without = client.post("/api/jobs", json={})
        wrong = client.post("/api/jobs", json={}, headers={"X-Recon4-Token": "0" * 64})
        anothers = client.post(
            "/api/jobs", json={}, headers={"X-Recon4-Token": other.headers["X-Recon4-Token"]}
        )
        good = client.post("/api/jobs", json={}, headers={"X-Recon4-Token": right})

    assert [one.status_code for one in (without, wrong, anothers, good)] == [403, 403, 403, 422]
    assert without.json()["error"] == "StaleToken"


def test_signing_out_ends_the_session_at_once(server):
    with server.signed_in("vera") as client:
        token = client.cookies["__Host-sid"]
        answer = client.post("/api/logout")
        with server.client(cookies={"__Host-sid": token}) as again:
            after = again.get("/api/me")

    assert (answer.status_code, after.status_code) == (204, 401)
    assert "Max-Age=0" in cookies_of(answer)["__Host-sid"]
    assert answer.headers["clear-site-data"] == '"cache", "storage"'


def test_a_get_never_signs_out(server):
    with server.signed_in("vera") as client:
        assert client.get("/api/logout").status_code in (404, 405)
        assert client.get("/api/me").status_code == 200


def test_giving_the_password_again_changes_the_cookie_and_keeps_the_session(server):
    with server.signed_in("rita") as client:
        before = client.cookies["__Host-sid"]
        wrong = client.post("/api/login/again", json={"password": "wrong wrong wrong"})
        answer = client.post("/api/login/again", json={"password": PASSWORD})
        client.headers["X-Recon4-Token"] = answer.json()["token"]

        sessions = client.get("/api/me/sessions").json()
        assert client.cookies["__Host-sid"] != before
        assert sum(one["current"] for one in sessions) == 1
        assert wrong.status_code == 401
        assert client.post("/api/logout").status_code == 204


def test_a_person_ends_only_their_own_sessions(server):
    with (
        server.signed_in("vera") as phone,
        server.signed_in("vera") as client,
        server.signed_in("otto") as other,
    ):
        theirs = other.get("/api/me/sessions").json()[0]["session"]["id"]
        mine = {one["current"]: one["session"]["id"] for one in phone_and_client(client)}

        refused = client.delete(f"/api/me/sessions/{theirs}").status_code
        ended = client.delete(f"/api/me/sessions/{mine[False]}").status_code

        assert (refused, ended) == (404, 204)
        assert other.get("/api/me").status_code == 200
        assert phone.get("/api/me").status_code == 401


def phone_and_client(client):
    """One's two latest sessions."""
    return client.get("/api/me/sessions").json()[:2]


def test_a_new_password_ends_all_other_sessions(tmp_path):
    with secure_server(tmp_path) as server, server.signed_in("otto") as other:
        with server.signed_in("otto") as client:
            fresh = "seven blue mice sleep"
            weak = client.post("/api/me/password", json={"old": PASSWORD, "new": "password1234"})
            wrong = client.post("/api/me/password", json={"old": "x" * 12, "new": fresh})
            good = client.post("/api/me/password", json={"old": PASSWORD, "new": fresh})

            assert [one.status_code for one in (weak, wrong, good)] == [422, 401, 200]
            assert client.get("/api/me").status_code == 200
        assert other.get("/api/me").status_code == 401
        with server.signed_in("otto", fresh):
            pass


@pytest.mark.parametrize("change", [{"role": "operator"}, {"disabled": True}])
def test_another_role_and_a_locked_door_end_the_sessions(tmp_path, change):
    with (
        secure_server(tmp_path) as server,
        server.signed_in("anna") as admin,
        server.signed_in("vera") as vera,
    ):
        answer = admin.patch("/api/people/vera", json=change)

        assert answer.status_code == 200
        assert vera.get("/api/me").status_code == 401


def test_the_last_admin_cannot_be_taken_away(server):
    with server.signed_in("anna") as admin:
        demoted = admin.patch("/api/people/anna", json={"role": "viewer"})
        disabled = admin.patch("/api/people/anna", json={"disabled": True})

        assert (demoted.status_code, disabled.status_code) == (409, 409)
        assert admin.get("/api/people").status_code == 200


def test_a_command_on_this_computer_locks_out_within_seconds(tmp_path):
    with secure_server(tmp_path) as server, server.signed_in("vera") as vera:
        assert vera.get("/api/me").status_code == 200

        access = open_access(tmp_path / ".recon4", login=True)
        access.accounts.set_disabled("vera", True)
        access.close()
        began_s = time.monotonic()
        while vera.get("/api/me").status_code == 200 and time.monotonic() < began_s + 10 + BUSY_S:
            pass

        assert time.monotonic() - began_s < 5.0 + BUSY_S


# -- what stays open


def test_an_open_viewer_and_an_open_stream_end_within_5_s_of_signing_out(server):
    with (
        server.signed_in("vera") as client,
        server.viewer(client) as socket,
        client.stream("GET", "/api/events") as stream,
    ):
        assert stream.status_code == 200
        assert client.post("/api/logout").status_code == 204
        began_s = time.monotonic()
        with pytest.raises(ConnectionClosed) as closed:
            while True:
                socket.recv(timeout=HANG_S)
        socket_s = time.monotonic() - began_s
        for _ in stream.iter_lines():  # ends in order
            pass
        stream_s = time.monotonic() - began_s

    assert closed.value.rcvd.code == 1008
    assert socket_s < 5.0 + BUSY_S
    assert stream_s < 5.0 + BUSY_S


def test_an_open_stream_ends_when_an_admin_ends_the_session(server):
    with server.signed_in("vera") as vera, server.signed_in("anna") as anna:
        mine = next(one for one in vera.get("/api/me/sessions").json() if one["current"])
        with vera.stream("GET", "/api/events") as stream:
            assert anna.delete(f"/api/sessions/{mine['session']['id']}").status_code == 204
            began_s = time.monotonic()
            for _ in stream.iter_lines():
                pass

    assert time.monotonic() - began_s < 5.0 + BUSY_S


def test_a_viewer_without_a_session_is_refused_before_it_opens(server):
    with (
        server.client() as client,
        pytest.raises(InvalidStatus) as refused,
        server.viewer(client),
    ):
        pass

    assert refused.value.response.status_code == 403


@pytest.mark.parametrize(
    "origin",
    [
        None,
        "null",
        "http://{host}",
        "https://127.0.0.1",
        "https://127.0.0.1:1",
        "https://{host}.evil.example",
        "https://evil.example",
        "https://evil.example#{host}",
        "https://localhost:{port}",
        "https://{host}@evil.example",
        "wss://{host}",
        "HTTPS://{host}/",
    ],
)
def test_a_viewer_opened_by_another_site_is_refused_although_the_cookie_is_there(server, origin):
    given = origin and origin.format(host=server.host, port=urlsplit(server.url).port)
    with (
        server.signed_in("vera") as client,
        pytest.raises(InvalidStatus) as refused,
        server.viewer(client, origin=given),
    ):
        pass

    assert refused.value.response.status_code == 403


# -- the first admin


def test_the_first_admin_is_made_once_with_the_link_and_never_without(tmp_path):
    settings = ServerSettings(root=tmp_path, lan=True)
    make_state(settings)
    with server_thread(tmp_path, lan=True) as running:
        from tests.service.secure import Secure

        server = Secure(running)
        access = running.app.state.parts.access
        token = access.logins.open_setup()
        given = {"name": "Anna", "password": PASSWORD}
        with server.client() as client:
            wrong = client.post("/api/setup", json={**given, "token": "x" * 43})
            weak = client.post("/api/setup", json={**given, "password": "anna" * 4, "token": token})
            right = client.post("/api/setup", json={**given, "token": token})
            again = client.post(
                "/api/setup",
                json={"name": "Bert", "password": PASSWORD, "token": token},
                headers={"X-Recon4-Token": right.json()["token"]},
            )
            people = client.get("/api/people").json()

    assert [one.status_code for one in (wrong, weak, right, again)] == [403, 422, 200, 403]
    assert [(one["name"], one["role"]) for one in people] == [("Anna", Role.ADMIN)]


def test_on_loopback_there_is_no_login_and_every_caller_is_local(tmp_path):
    with server_thread(tmp_path) as server:
        me = server.get("/api/me").json()
        login = server.post("/api/login", json={"name": "anna", "password": PASSWORD})

    assert (me["name"], me["role"], me["login"], me["token"]) == ("local", "admin", False, "")
    assert login.status_code == 409
