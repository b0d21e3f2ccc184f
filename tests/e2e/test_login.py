"""Signing in, out, and what admins do, in a real browser over TLS."""

import re
from collections.abc import Iterator

import pytest
from playwright.sync_api import Page, Route, expect

from tests.e2e.axe import barriers, needs_axe
from tests.e2e.conftest import (
    EXPECTED_NOISE,
    browser_context,
    first_of,
    leave_out_viewer,
    looks,
    on_both_screens,
    open_menu,
)
from tests.served import office, served
from tests.service.running import server_thread
from tests.service.secure import PASSWORD, Secure, secure_server

pytestmark = pytest.mark.e2e


server = served(office(points=20_000), run=secure_server)


@pytest.fixture
def page(browser, look) -> Iterator[Page]:
    """A browser that accepts the self-signed certificate, as after comparing the fingerprint."""
    with browser_context(browser, look) as context:
        page = context.new_page()
        complaints: list[str] = []
        page.on("pageerror", lambda error: complaints.append(str(error)))
        page.on(
            "console", lambda message: message.type == "error" and complaints.append(message.text)
        )
        yield page
    noise = (*EXPECTED_NOISE, "status of 422")
    assert [text for text in complaints if not any(one in text for one in noise)] == []


def sign_in(page, server: Secure, name: str, path: str = "/"):
    page.goto(server.url + path)
    page.get_by_label("Name").fill(name)
    page.get_by_label("Password", exact=True).fill(PASSWORD)
    page.get_by_role("button", name="Sign in").click()
    expect(page.locator("#login")).to_have_count(0)  # else the failure quotes what it says
    page.wait_for_url(server.url + path)


def fits(page):
    """Nothing overflows to the side, and every control is large enough."""
    assert page.evaluate("document.documentElement.scrollWidth <= innerWidth")
    small = page.evaluate(
        """[...document.querySelectorAll('button, input:not([type=checkbox]), select, .bar a')]
        .filter((one) => one.checkVisibility() && one.getBoundingClientRect().height < 44)
        .map((one) => one.outerHTML.slice(0, 80))"""
    )
    assert small == []


@needs_axe
@pytest.mark.parametrize("path", ["/login", "/pair", "/guest"])
def test_a_page_before_the_login_has_no_barrier(server, page, path):
    page.goto(server.url + path)
    expect(page.get_by_role("heading", level=1)).to_be_visible()

    assert barriers(page) == []


@needs_axe
def test_the_page_of_an_account_has_no_barrier(server, page):
    sign_in(page, server, "rita", "/account")
    expect(page.get_by_role("heading", level=1)).to_be_visible()

    assert barriers(page) == []


def test_a_page_redirects_to_the_login_and_back(server, page, screenshot):
    leave_out_viewer(page)
    page.goto(f"{server.url}/projects/office/")
    expect(page.get_by_role("heading", name="Sign in")).to_be_visible()
    expect(page.get_by_label("Name")).to_be_focused()
    fits(page)

    page.get_by_label("Name").fill("rita")
    page.get_by_label("Password", exact=True).fill("wrong wrong wrong")
    page.get_by_role("button", name="Sign in").click()
    expect(page.get_by_role("alert")).to_have_text("wrong name or password")
    fits(page)
    screenshot(page, "login")

    page.get_by_label("Password", exact=True).fill(PASSWORD)
    page.get_by_role("button", name="Sign in").click()
    page.wait_for_url(f"{server.url}/projects/office/")
    expect(page.get_by_role("heading", name="office")).to_be_visible()
    open_menu(page)
    expect(page.get_by_role("link", name="Account of rita reviewer")).to_be_visible()


@looks("desktop light")
def test_a_password_goes_where_it_is_typed_however_late_the_server_says_who_one_is(server, page):
    held: list[Route] = []
    page.route("**/api/me", lambda route: route.continue_() if held else held.append(route))
    with page.expect_request("**/api/me"):
        page.goto(f"{server.url}/login")
    page.get_by_label("Password", exact=True).focus()
    page.keyboard.type("three green")

    held[0].continue_()
    page.evaluate("fetch('/api/me').then((answer) => answer.text())")  # after the one before it
    page.keyboard.type(" owls")

    expect(page.get_by_label("Password", exact=True)).to_have_value("three green owls")
    expect(page.get_by_label("Name")).to_have_value("")


@looks("desktop light", "phone dark")
def test_signing_out_shows_the_login_and_clears_the_session(server, page):
    sign_in(page, server, "vera")
    expect(page.get_by_role("listitem").filter(has_text="office")).to_be_visible()
    open_menu(page)
    expect(page.get_by_role("link", name="Rigs")).to_be_visible()
    expect(page.get_by_role("link", name="People")).to_have_count(0)
    fits(page)

    page.get_by_role("button", name="Sign out").click()
    expect(page.get_by_role("heading", name="Sign in")).to_be_visible()
    page.go_back()
    expect(page.get_by_role("heading", name="Sign in")).to_be_visible()

    assert page.context.cookies(server.url + "/api/me") == [] or not any(
        cookie["name"] == "__Host-sid" for cookie in page.context.cookies()
    )


@looks("desktop dark")
def test_who_is_signed_out_while_a_page_is_open_signs_in_there_and_loses_nothing(
    server, page, screenshot
):
    sign_in(page, server, "rita", "/projects/office/map/")
    expect(page.locator("#status .shown")).to_contain_text("20 000 points")
    page.keyboard.press("n")
    page.locator("#map").click(position={"x": 500, "y": 450})
    page.locator("#panel textarea").fill("crack over the door")
    open_at = page.url

    page.context.clear_cookies()  # as when a role was changed: all sessions of the person ended
    page.get_by_text("Keep the note").dispatch_event("click")  # the login may cover it already
    login = page.get_by_role("dialog", name="Sign in")
    expect(login).to_contain_text("Your session has ended")
    expect(login.get_by_label("Name")).to_have_value("rita")
    expect(login.get_by_label("Password")).to_be_focused()
    page.keyboard.type("wrong wrong wrong")
    page.keyboard.press("Enter")
    expect(login.get_by_role("alert")).to_have_text("wrong name or password")
    screenshot(page, "login-again")
    login.get_by_label("Password").fill(PASSWORD)
    page.keyboard.press("Enter")

    expect(page.locator("#panel .notes li")).to_contain_text("crack over the door")
    assert page.url.split("?")[0] == open_at.split("?")[0]

    page.context.clear_cookies()
    page.reload()  # no page, nobody to ask
    expect(page.get_by_role("heading", name="Sign in", level=1)).to_be_visible()


def measure_a_point(page):
    """Sends a request: a page that shows all of its map sends none of its own."""
    page.mouse.click(500, 450)  # under the login, if that is open already


@looks("desktop dark")
def test_another_person_gets_a_page_of_their_own_and_nobody_the_page_of_who_was_there(server, page):
    sign_in(page, server, "rita", "/projects/office/map/")
    expect(page.locator("#status .shown")).to_contain_text("20 000 points")
    page.keyboard.press("i")
    page.context.clear_cookies()
    measure_a_point(page)
    login = page.get_by_role("dialog", name="Sign in")
    login.get_by_label("Name").fill("vera")
    login.get_by_label("Password").fill(PASSWORD)
    with page.expect_navigation():
        page.keyboard.press("Enter")
    expect(page.get_by_role("link", name="Account of vera viewer")).to_be_attached()

    expect(page.locator("#status .shown")).to_contain_text("20 000 points")
    page.keyboard.press("i")
    page.context.clear_cookies()
    measure_a_point(page)
    expect(login).to_be_visible()
    page.keyboard.press("Escape")
    page.wait_for_url(f"{server.url}/login#next=*")


@looks("desktop dark")
def test_a_hostile_link_stays_on_this_server_and_no_script_reads_the_session(server, page):
    page.goto(f"{server.url}/login#next=//evil.example/x")
    page.get_by_label("Name").fill("vera")
    page.get_by_label("Password", exact=True).fill(PASSWORD)
    page.get_by_role("button", name="Sign in").click()

    page.wait_for_url(f"{server.url}/")
    expect(page.locator(".account")).to_contain_text("vera")
    assert page.evaluate("document.cookie") == ""
    assert page.evaluate("JSON.stringify([localStorage, sessionStorage])") == "[{},{}]"


@looks("desktop dark")
def test_a_password_is_not_sent_before_the_script_has_loaded(server, page):
    held: list[Route] = []
    page.route("**/account/login.js*", lambda route: held.append(route))
    page.goto(f"{server.url}/login#next=/account", wait_until="commit")
    page.get_by_label("Name").fill("vera")
    page.get_by_label("Password", exact=True).fill(PASSWORD)
    page.keyboard.press("Enter")
    expect(page.get_by_role("button", name="Sign in")).to_be_disabled()

    assert page.url == f"{server.url}/login#next=/account"
    held.pop().continue_()
    page.get_by_role("button", name="Sign in").click()
    page.wait_for_url(f"{server.url}/account")


@looks("desktop dark")
def test_the_viewer_works_behind_the_login(server, page):
    sign_in(page, server, "vera", "/projects/office/")

    viewer = page.frame_locator("iframe")
    expect(viewer.get_by_text("map frame · z up · meters")).to_be_visible()
    page.frames[-1].wait_for_function("window.__viserMutable?.canvas")


def test_an_admin_adds_a_person_changes_a_role_and_reads_the_log(server, page, look, screenshot):
    screen, scheme = look
    name = f"Žofie {screen} {scheme}"
    sign_in(page, server, "anna", "/people")

    form = page.locator("#add")
    form.get_by_label("Name").fill(name)
    form.get_by_label("Role").select_option("operator")
    form.get_by_label("First password").fill("password1234")
    form.get_by_role("button", name="Add").click()
    expect(form.get_by_role("alert")).to_contain_text("the password is found in about")
    form.get_by_label("First password").fill(PASSWORD)
    form.get_by_role("button", name="Add").click()

    row = page.locator("#people tr").filter(has_text=name)
    expect(row).to_contain_text("May sign in")
    row.get_by_label(f"Role of {name}").select_option("reviewer")
    expect(page.locator("#audit tr").first).to_contain_text("set role")
    row.get_by_role("button", name=f"Disable {name}").click()
    expect(row).to_contain_text("Disabled")
    expect(page.locator("#chain")).to_contain_text("hash chain intact")
    expect(page.locator("session-list")).to_contain_text("This one")
    fits(page)
    page.evaluate("scrollTo(0, 0)")
    screenshot(page, "people")


def test_a_person_lists_own_sessions_and_ends_another(server, page, screenshot):
    with server.signed_in("otto"):
        sign_in(page, server, "otto", "/account")
        expect(page.get_by_role("heading", name="otto, operator")).to_be_visible()
        rows = page.locator("session-list tbody tr")
        expect(rows.filter(has_text="This one")).to_have_count(1)
        fits(page)
        screenshot(page, "account")
        before = rows.count()

        rows.filter(has_not_text="This one").first.get_by_role("button").click()

        expect(rows).to_have_count(before - 1)


@first_of("desktop dark", "phone dark")
def test_a_signature_requires_a_recent_password(server, page, look, screenshot):
    sign_in(page, server, "anna", "/people")
    access = server.running.app.state.parts.access
    clock = access.sessions._clock
    access.sessions._clock = lambda: clock() + 1200.0
    try:
        row = page.locator("#people tr").filter(has_text="rita")
        row.get_by_label("Role of rita").select_option("reviewer")
        dialog = page.get_by_role("dialog", name="Your password again")
        expect(dialog.get_by_label("Password")).to_be_focused()
        screenshot(page, "password-again")
        page.keyboard.type("wrong wrong wrong")
        page.keyboard.press("Enter")
        expect(dialog.get_by_role("alert")).to_have_text("wrong name or password")
        page.keyboard.type(PASSWORD)
        page.keyboard.press("Enter")
        expect(dialog).to_be_hidden()
        expect(page.locator("#audit tr").first).to_contain_text("set role")
    finally:
        access.sessions._clock = clock


@first_of("desktop light", "phone light")
def test_the_first_admin_is_created_in_the_browser(tmp_path, page, look, screenshot):
    with server_thread(tmp_path, lan=True) as running:
        token = running.app.state.parts.access.logins.open_setup()
        page.goto(f"{running.url}/login#setup={token}")
        expect(page.get_by_role("heading", name="Create the first admin")).to_be_visible()
        assert token not in page.url
        on_both_screens(page, fits)
        screenshot(page, "setup")
        page.get_by_label("Name").fill("Anna")
        page.get_by_label("Password", exact=True).fill(PASSWORD)
        page.get_by_role("button", name="Create admin and sign in").click()

        open_menu(page)
        expect(page.get_by_role("link", name="People")).to_be_visible()
        page.goto("about:blank")  # else its event stream is cut by the end of the server


@pytest.mark.study
@looks("desktop light")
def test_a_guest_opens_a_link_and_sees_one_map_until_it_is_revoked(
    server, page, browser, look, screenshot
):
    with server.signed_in("rita") as rita:
        made = rita.post("/api/projects/office/guests", json={"label": "Client", "days": 7}).json()
    sign_in(page, server, "rita", "/projects/office/map/")
    page.get_by_role("button", name="Share…").click()
    dialog = page.get_by_role("dialog", name="Share with a guest")
    expect(dialog.get_by_role("listitem").first).to_contain_text("not opened yet")
    dialog.get_by_label("For whom").fill("Surveyor")
    dialog.get_by_role("button", name="Make a link").click()
    link = dialog.get_by_label("The link: copy it now").input_value()
    expect(dialog.get_by_text("Surveyor").first).to_be_visible()
    screenshot(page, "share")

    with browser_context(browser, look) as context:
        guest = context.new_page()
        guest.goto(f"{server.url}/guest#{made['token']}?o=1")
        expect(guest.locator("#status .shown")).to_contain_text("points")
        assert "#" not in guest.url and "map/?" in guest.url
        tabs = guest.get_by_role("navigation", name="Pages of the project")
        expect(tabs.get_by_role("link")).to_have_text(["Map", "Slices", "Report"])
        expect(guest.get_by_role("button", name="Share…")).to_have_count(0)
        expect(guest.locator("#message")).to_be_empty()
        screenshot(guest, "guest-map")
        tabs.get_by_role("link", name="Slices").click()
        expect(guest.locator(".caption").first).to_contain_text("points")
        expect(guest.locator("#findings")).to_be_empty()
        screenshot(guest, "guest-slices")

        dialog.get_by_role("button", name="Revoke the link for Client").first.click()
        expect(dialog.get_by_role("listitem").last).to_contain_text("revoked")
        guest.get_by_role("group", name="Kind").get_by_text("Vertical").click()
        expect(guest.get_by_text("This visit has ended")).to_be_visible()  # not a password
        guest.goto(link)
        expect(guest.locator("#status .shown")).to_contain_text("points")  # the other one works
        guest.goto(f"{server.url}/guest#{made['token']}")
        expect(guest.locator("#message")).to_contain_text("revoked")
        screenshot(guest, "guest-refused")


@looks("desktop light")
def test_a_link_is_offered_until_it_is_revoked(server, page):
    sign_in(page, server, "rita", "/projects/office/map/")
    page.get_by_role("button", name="Share…").click()
    dialog = page.get_by_role("dialog", name="Share with a guest")
    dialog.get_by_label("For whom").fill("Architect")
    dialog.get_by_role("button", name="Make a link").click()
    made = dialog.get_by_label("The link: copy it now")
    expect(made).to_have_value(re.compile("/guest#"))

    dialog.get_by_role("button", name="Revoke the link for Architect").click()

    expect(dialog.get_by_role("listitem").filter(has_text="Architect")).to_contain_text("revoked")
    expect(made).to_have_count(0)


@looks("phone light")
def test_a_person_makes_an_access_token_and_ends_it(server, page, look, screenshot):
    sign_in(page, server, "otto", "/account")
    expect(page.get_by_label("It may").locator("option")).to_have_text(
        ["look only", "look, and start jobs and captures"]
    )
    page.get_by_label("For which program").fill(f"helper {look[0]}")
    page.get_by_role("button", name="Make access token").click()

    token = page.locator("#token").inner_text()
    expect(page.locator("#made-token pre")).to_contain_text(f'"url": "{server.url}/mcp"')
    with server.client(headers={"Authorization": f"Bearer {token}"}) as program:
        assert program.get("/api/me").json()["role"] == "viewer"
        on_both_screens(page, fits)
        assert page.evaluate("innerWidth") == page.viewport_size["width"]  # else it is zoomed out
        assert barriers(page) == []
        screenshot(page, "access-token")
        row = page.locator("session-list tbody tr").filter(has_text=f"“helper {look[0]}”")
        row.get_by_role("button").click()
        expect(row).to_have_count(0)
        assert program.get("/api/me").status_code == 401
