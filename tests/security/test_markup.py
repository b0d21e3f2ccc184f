"""Text of users never becomes markup or a script on any page, in a real browser.

Figure: the corpus below in every text that people or files give (names of projects, rigs, people,
references, uploads, files, programs; reasons; addresses) x every page: 0 scripts run, 0 elements
made, 0 violations of the content security policy.
"""

import json

import pytest
from playwright.sync_api import expect

from recon4.review.decisions import Decision, DecisionKind
from recon4.review.journal import append
from tests.review_fixtures import copy_made
from tests.service.secure import PASSWORD, secure_server

pytestmark = pytest.mark.e2e

CORPUS = (
    "<img src=x data-injected onerror=caught('img')>",
    "<script data-injected>caught('script')</script>",
    "<svg data-injected onload=caught('svg')></svg>",
    "\"'><b data-injected autofocus tabindex=0 onfocus=caught('focus')>bold</b>",
    "</title></textarea></option><iframe data-injected srcdoc='<script>parent.caught(1)</script>'>",
    "javascript:caught('link')",
    "{{caught('template')}}${caught('literal')}",
    "<a data-injected href=\"javascript:caught('a')\">click</a>",
)
PAYLOAD = " ".join(CORPUS)
SHORT = CORPUS[0]
"""Where only some tens of characters fit."""
WATCH = """
window.caught = (what) => window.report(`script: ${what}`);
const violated = (event) => window.report(`policy: ${event.blockedURI}`);
addEventListener("securitypolicyviolation", violated);
const unfold = () => document.querySelectorAll("details").forEach((one) => (one.open = true));
setInterval(unfold, 100);
"""


@pytest.fixture(scope="module")
def server(tmp_path_factory):
    root = tmp_path_factory.mktemp("projects")
    copy_made(tmp_path_factory, root / "office")
    fill(root)
    with secure_server(root) as running:
        yield running


def fill(root):
    """Write the corpus into what the server finds when it starts."""
    describe(root / "office")
    append(
        root / "office",
        Decision(kind=DecisionKind.REJECT, who=SHORT, why=PAYLOAD[:500], pair=(17, 77)),
    )
    (root / SHORT.replace("/", "")).mkdir()


def describe(folder):
    """Every text of a project that a person or a file gives."""
    path = folder / "project.json"
    facts = json.loads(path.read_text("utf-8"))
    path.write_text(
        json.dumps({**facts, "name": PAYLOAD, "rig": {"name": PAYLOAD}, "preset": PAYLOAD})
    )
    path = folder / "summary.json"
    summary = json.loads(path.read_text("utf-8"))
    path.write_text(
        json.dumps({**summary, "warnings": [PAYLOAD], "rig": PAYLOAD, "preset": PAYLOAD})
    )


@pytest.fixture(scope="module")
def written(server):
    """The corpus sent through every route that keeps a text; what must be refused is."""
    cloud = server.root / "cloud.xyz"
    cloud.write_text("".join(f"{k % 7} {k % 5} {k % 3}\n" for k in range(500)))
    with server.signed_in("anna") as anna:
        anna.headers["User-Agent"] = PAYLOAD[:200]
        assert anna.post("/api/people", json=person(SHORT)).status_code in (400, 403, 409, 422)
        added = anna.post(
            "/api/projects/office/slices/references",
            json={"path": str(cloud), "name": SHORT, "frame": "map"},
        )
        upload = anna.post(
            "/api/uploads", json={"name": SHORT, "files": 1, "bytes": 10, "fingerprint": SHORT}
        )
        decision = {
            "kind": "accept",
            "frame_i": 17,
            "frame_j": 78,
            "T_i_j": [],
            "why": PAYLOAD[:500],
        }
        decided = anna.post("/api/projects/office/review/decisions", json=decision)
        renamed = anna.patch("/api/projects/office", json={"name": SHORT})
    with server.client(headers={"User-Agent": PAYLOAD[:200]}) as stranger:
        stranger.post("/api/login", json={"name": "anna", "password": PASSWORD})
        stranger.post("/api/login", json={"name": SHORT, "password": SHORT})
        stranger.post("/api/pair/requests", json={"name": SHORT})
    assert (added.status_code, decided.status_code) == (201, 201), (added.text, decided.text)
    return {"upload": upload.status_code, "rename": renamed.status_code}


def person(name):
    return {"name": name, "role": "viewer", "password": "copper violin under seven hedges"}


PAGES = (
    "/",
    "/projects/office/",
    "/projects/office/review/",
    "/projects/office/slices/",
    "/projects/office/viewer/",
    "/api/projects/office/report",
    "/live",
    "/phone",
    "/pair",
    "/people",
    "/account",
    "/api",
    "/login?next=javascript:caught('next')",
    "/projects/%3Cimg%20src=x%20data-injected%20onerror=caught(1)%3E/",
    "/%3Cscript%20data-injected%3Ecaught(1)%3C/script%3E",
)


def test_no_text_becomes_markup_or_a_script_on_any_page(server, written, browser):
    expect.set_options(timeout=45_000)  # two busy cores
    context = browser.new_context()
    context.set_default_timeout(60_000)
    caught: list[str] = []
    context.expose_binding(
        "report", lambda source, what: caught.append(f"{source['page'].url} {what}")
    )
    context.add_init_script(WATCH)
    page = context.new_page()
    page.on("dialog", lambda dialog: (caught.append(dialog.message), dialog.dismiss()))
    page.goto(f"{server.url}/login")
    page.get_by_label("Name").fill("anna")
    page.get_by_label("Password", exact=True).fill(PASSWORD)
    page.keyboard.press("Enter")
    page.wait_for_url(server.url + "/")

    shown = set()
    for path in PAGES:
        page.goto(server.url + path)
        open_everything(page, path)
        page.wait_for_timeout(500)  # whatever would run runs now
        for frame in page.frames:
            made = frame.locator("[data-injected]").count()
            caught.extend([f"{path} {made} elements"] if made else [])
            if "onerror=caught" in frame.evaluate("document.body?.innerText ?? ''"):
                shown.add(path)
    context.close()

    assert caught == []
    assert {"/", "/projects/office/review/", "/projects/office/slices/", "/account"} <= shown


def open_everything(page, path):
    """Wait for what a page shows of the corpus."""
    if path == "/":
        expect(page.get_by_text("onerror=caught").first).to_be_visible()
    if path.endswith("/review/"):
        expect(page.locator(".queue li").first).to_be_visible()
        expect(page.locator("#journal")).to_contain_text("onerror=caught")
        page.keyboard.press("j")
        expect(page.locator("#decision").get_by_role("button", name="Reject")).to_be_enabled()
    if path.endswith("/slices/"):
        expect(page.locator("body")).to_contain_text("onerror=caught")
    if path == "/account":
        expect(page.locator("body")).to_contain_text("onerror=caught")
