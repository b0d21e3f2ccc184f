"""Pairing in two browsers, over TLS: the laptop's page and the phone's."""

from urllib.parse import urlsplit

import pytest
from playwright.sync_api import expect

from tests.e2e.conftest import browser_context
from tests.served import served
from tests.service.running import server_thread
from tests.service.secure import PASSWORD, secure_server

pytestmark = pytest.mark.e2e


server = served(run=secure_server)


@pytest.fixture
def look():
    return "desktop", "light"


@pytest.fixture
def phone(browser):
    yield from opened(browser, "phone")


@pytest.fixture
def laptop(browser):
    yield from opened(browser, "desktop")


def opened(browser, screen):
    with browser_context(browser, (screen, "light")) as context:
        yield context.new_page()


def sign_in(page, server, path):
    page.goto(server.url + path)
    page.get_by_label("Name").fill("otto")
    page.get_by_label("Password", exact=True).fill(PASSWORD)
    page.get_by_role("button", name="Sign in").click()
    page.wait_for_url(server.url + path)


def test_a_phone_signs_in_by_qr_code_and_the_token_is_nowhere(server, laptop, phone, screenshot):
    sign_in(laptop, server, "/")
    laptop.get_by_role("link", name="Phone").click()
    with laptop.expect_response("**/api/pairing/invitations") as answered:
        laptop.get_by_role("button", name="Show QR code").click()
    expect(laptop.get_by_role("img", name="QR code for one phone")).to_be_visible()
    token = urlsplit(answered.value.json()["links"][0]["url"]).fragment
    screenshot(laptop, "pairing")

    phone.goto(f"{server.url}/pair#{token}")
    phone.wait_for_url(f"{server.url}/live")
    expect(phone.get_by_role("button", name="Start…")).to_be_visible()

    assert phone.evaluate("document.cookie") == ""  # no script reads the session
    phone.go_back()
    assert phone.url == "about:blank"  # the link is in no history


def test_a_viewers_phone_has_no_buttons_and_a_used_code_is_rejected(server, laptop, phone, browser):
    sign_in(laptop, server, "/phone")
    laptop.get_by_label("viewer: look only").check()
    with laptop.expect_response("**/api/pairing/invitations") as answered:
        laptop.get_by_role("button", name="Show QR code").click()
    token = urlsplit(answered.value.json()["links"][0]["url"]).fragment

    phone.goto(f"{server.url}/pair#{token}")
    phone.wait_for_url(f"{server.url}/live")
    expect(phone.locator("#hint")).to_contain_text("View only")
    expect(phone.locator("#actions button")).to_have_count(0)

    for another in opened(browser, "phone"):
        another.goto(f"{server.url}/pair#{token}")
        expect(another.get_by_role("alert")).to_contain_text("used already or is too old")
        assert another.url == f"{server.url}/pair"
        expect(another.get_by_role("button", name="Show a code")).to_be_visible()


def test_a_phone_pairs_with_six_digits_and_again_after_its_session(server, laptop, phone):
    phone.goto(f"{server.url}/live")
    phone.wait_for_url(f"{server.url}/pair")
    phone.get_by_label("Name of this phone").fill("Otto's phone")
    phone.get_by_role("button", name="Show a code").click()
    expect(phone.locator("#left")).to_contain_text("Waiting")
    sign_in(laptop, server, "/phone")

    laptop.get_by_label("Six digits").fill(phone.locator("#digits").inner_text())
    laptop.get_by_role("button", name="Approve").click()

    expect(laptop.get_by_text("✓ Otto's phone")).to_be_visible()
    phone.wait_for_url(f"{server.url}/live")

    with server.signed_in("otto") as otto:
        phones = [one["session"] for one in otto.get("/api/me/sessions").json()]
        newest = max((one for one in phones if one["phone"]), key=lambda one: one["began_s"])
        otto.delete(f"/api/me/sessions/{newest['id']}")
    expect(phone.get_by_text("The session of this phone has ended")).to_be_visible()
    expect(phone.get_by_role("button", name="Show a code")).to_be_visible()


def test_a_server_without_network_shows_how_to_start_it_for_phones(laptop, tmp_path):
    with server_thread(tmp_path) as running:
        laptop.goto(f"{running.url}/phone")
        expect(laptop.get_by_text("recon4 serve ROOT --lan")).to_be_visible()
        expect(laptop.get_by_role("button", name="Show QR code")).to_be_hidden()
