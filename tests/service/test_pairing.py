"""Phones that pair, on a real server with TLS and login."""

import base64
import concurrent.futures
import ipaddress
import logging
from urllib.parse import urlsplit

import pytest

from recon4_app.access.pairing.routes import is_served
from tests.served import served
from tests.service.running import server_thread
from tests.service.secure import PASSWORD, secure_server

server = served(run=secure_server)


@pytest.fixture(autouse=True)
def unhurried(server):
    pairings = server.running.app.state.parts.access.pairings
    pairings._tries._left.clear()
    pairings._requests.clear()


def invite(client, role="viewer"):
    answer = client.post("/api/pairing/invitations", json={"role": role})
    assert answer.status_code == 201, answer.text
    link = answer.json()["links"][0]
    return link, urlsplit(link["url"]).fragment


def redeem(client, token):
    return client.post("/api/pairing/redeem", json={"token": token})


def test_a_qr_code_makes_a_session_that_may_what_was_chosen_and_no_more(server):
    with server.signed_in("anna") as laptop, server.client() as phone:
        _, token = invite(laptop, "viewer")
        me = redeem(phone, token).json()

        assert (me["name"], me["role"], me["may"]) == ("anna", "viewer", ["shared", "look"])
        cookie = next(c for c in phone.cookies.jar if c.name == "__Host-sid")
        assert cookie.secure and cookie.path == "/" and cookie.has_nonstandard_attr("HttpOnly")
        assert phone.get("/api/projects").status_code == 200
        phone.headers["X-Recon4-Token"] = me["token"]
        assert phone.post("/api/live", json={"project": "x"}).status_code == 403
        assert phone.get("/api/people").status_code == 403
        with server.client() as another:
            assert redeem(another, token).status_code == 403


def test_a_paired_phone_can_neither_pair_others_nor_touch_its_owners_account(server):
    with server.signed_in("otto") as laptop, server.client() as phone:
        phone.headers["X-Recon4-Token"] = redeem(phone, invite(laptop, "operator")[1]).json()[
            "token"
        ]
        refused = [
            phone.post("/api/pairing/invitations", json={"role": "viewer"}),
            phone.post("/api/pairing/approve", json={"code": "000000", "role": "viewer"}),
            phone.post("/api/login/again", json={"password": PASSWORD}),
            phone.post("/api/me/password", json={"old": PASSWORD, "new": "four red hens sing"}),
            phone.get("/api/me/sessions"),
            phone.delete("/api/me/sessions/x"),
        ]

        assert [answer.status_code for answer in refused] == [403] * len(refused)
        mine = laptop.get("/api/me/sessions").json()
        assert [one["session"]["role"] for one in mine if one["session"]["phone"]] == ["operator"]


def test_eight_phones_at_once_with_one_link_are_one_session(server):
    with server.signed_in("otto") as laptop:
        _, token = invite(laptop)

        def try_it(_):
            with server.client() as phone:
                return redeem(phone, token).status_code

        with concurrent.futures.ThreadPoolExecutor(8) as pool:
            statuses = list(pool.map(try_it, range(8)))

    assert sorted(statuses) == [200] + [403] * 7


def test_guessing_is_slowed_down_and_noted(server):
    with server.signed_in("anna") as laptop, server.client() as stranger:
        statuses = [redeem(stranger, f"secret {k}").status_code for k in range(12)]
        log = laptop.get("/api/audit").json()["entries"]

    assert statuses == [403] * 10 + [429] * 2
    assert {"pair phone"} <= {one["action"] for one in log if one["outcome"] == "failed"}
    assert not any("secret" in one["object"] for one in log)


def test_digits_on_the_phone_and_typed_on_the_laptop(server):
    with server.signed_in("otto") as laptop, server.client() as phone:
        asked = phone.post("/api/pairing/requests", json={"name": "Otto's phone"}).json()
        waiting = phone.post("/api/pairing/claim", json={"token": asked["token"]})
        approved = laptop.post(
            "/api/pairing/approve", json={"code": asked["code"], "role": "operator"}
        )
        me = phone.post("/api/pairing/claim", json={"token": asked["token"]}).json()

        assert (waiting.status_code, waiting.json()) == (200, None)
        assert approved.json() == {"name": "Otto's phone", "address": "127.0.0.1"}
        assert me["role"] == "operator" and "capture" in me["may"]
        with server.client() as another:
            again = another.post("/api/pairing/claim", json={"token": asked["token"]})
        assert again.status_code == 403


def test_digits_of_another_script_are_no_server_error(server):
    with server.signed_in("otto") as laptop, server.client() as phone:
        asked = phone.post("/api/pairing/requests", json={}).json()
        code = asked["code"].translate(dict(zip(b"0123456789", "٠١٢٣٤٥٦٧٨٩", strict=True)))
        answer = laptop.post("/api/pairing/approve", json={"code": code, "role": "operator"})

    assert answer.status_code == 422


def test_a_long_name_and_a_flood_are_refused(server):
    with server.client() as stranger:
        long = stranger.post("/api/pairing/requests", json={"name": "x" * 65})
        flood = [stranger.post("/api/pairing/requests", json={}).status_code for _ in range(12)]

    assert long.status_code == 422
    assert flood.count(201) <= 4 and flood[-1] == 429


def test_a_page_of_another_site_cannot_pair_and_a_link_keeps_the_person(server):
    with server.signed_in("otto") as laptop, server.client() as phone:
        _, token = invite(laptop)
        evil = phone.post(
            "/api/pairing/redeem", json={"token": token}, headers={"Origin": "https://evil.example"}
        )
        who_is_in = redeem(laptop, token)

        assert evil.status_code == 403
        assert who_is_in.status_code == 403 and "signed in already" in who_is_in.text
        assert redeem(phone, token).status_code == 200


def test_the_qr_code_is_that_link_and_the_certificate_is_shown(server):
    with server.signed_in("vera") as laptop:
        pairing = laptop.get("/api/pairing").json()
        link, token = invite(laptop)

    assert pairing["login"] and pairing["roles"] == ["viewer"]
    assert len(pairing["fingerprint"].split(":")) == 32
    assert link["url"].startswith("https://") and "/pair#" in link["url"]
    assert link["qr"].startswith("data:image/svg+xml")
    assert "script" not in link["qr"]
    assert len(base64.urlsafe_b64decode(token + "==")) == 16


def test_every_link_leads_to_an_address_that_the_server_listens_on(server):
    with server.signed_in("vera") as laptop:
        answer = laptop.post("/api/pairing/invitations", json={"role": "viewer"}).json()

    assert [link["host"] for link in answer["links"]] == ["127.0.0.1"]


@pytest.mark.parametrize(
    ("listens_on", "hosts"),
    [
        ("0.0.0.0", ["192.0.2.7"]),
        ("::", ["192.0.2.7", "2001:db8::7"]),
        ("192.0.2.7", ["192.0.2.7"]),
        ("127.0.0.1", []),
    ],
)
def test_addresses_of_this_computer_are_offered_only_where_the_server_listens(listens_on, hosts):
    own = map(ipaddress.ip_address, ("192.0.2.7", "2001:db8::7"))

    assert [str(one) for one in own if is_served(one, listens_on)] == hosts


def test_tokens_are_in_no_log_and_no_file(server, caplog):
    with caplog.at_level(logging.DEBUG), server.signed_in("otto") as laptop:
        tokens = [invite(laptop)[1]]
        with server.client() as phone:
            tokens.append(phone.post("/api/pairing/requests", json={}).json()["token"])
            assert redeem(phone, tokens[0]).status_code == 200
            tokens.append(phone.cookies["__Host-sid"])
    kept = b"".join(
        path.read_bytes() for path in (server.root / ".recon4").rglob("*") if path.is_file()
    )

    ours = [r.getMessage() for r in caplog.records if not r.name.startswith(("httpx", "httpcore"))]
    for token in tokens:
        assert token.encode() not in kept
        assert not any(token in message for message in ours)


def test_ending_the_session_of_a_phone_ends_it(server):
    with server.signed_in("otto") as laptop, server.client() as phone:
        redeem(phone, invite(laptop)[1])
        sessions = laptop.get("/api/me/sessions").json()
        mine = max((s["session"] for s in sessions if s["session"]["phone"]),
                   key=lambda one: one["began_s"])  # fmt: skip
        assert laptop.delete(f"/api/me/sessions/{mine['id']}").status_code == 204

        assert phone.get("/api/me").status_code == 401


def test_without_login_pairing_fails_with_a_hint(tmp_path):
    with server_thread(tmp_path) as running:
        pairing = running.get("/api/pairing").json()
        answer = running.post("/api/pairing/invitations", json={"role": "viewer"})

    assert pairing["login"] is False and pairing["fingerprint"] == ""
    assert answer.status_code == 409 and "--lan" in answer.json()["detail"]
