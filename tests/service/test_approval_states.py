"""Wherever a file is offered, pages and API say whether it is approved, in the same words."""

import shutil

import httpx
import pytest

from recon4.cli.main import main
from recon4.review.signature import public_key_of
from recon4.store.project import read_artifacts
from tests.deadlines import HANG_S
from tests.project_builder import approve_project, build_project
from tests.service.running import server_thread


@pytest.fixture(scope="module")
def made(tmp_path_factory):
    root = tmp_path_factory.mktemp("states") / "maps"
    build_project(root / "office", points=20_000)
    return root


@pytest.fixture
def maps(made, tmp_path):
    shutil.copytree(made, tmp_path / "maps")
    return tmp_path / "maps"


def sign_it(maps, key=".recon4/signing.key"):
    approve_project(maps / "office", maps / key, who="J. Novák")


def shown(server):
    """The approval in the list, on the project, in the review, on the slices and in the viewer."""
    (card,) = server.get("/api/projects").json()
    pages = [
        card["approval"],
        server.get("/api/projects/office").json()["approval"],
        server.get("/api/projects/office/review").json()["approval"],
        server.get("/api/projects/office/slices").json()["approval"],
    ]
    texts = {page["text"] for page in pages}
    assert len(texts) == 1 and pages[0]["kind"] == pages[-1]["kind"], pages
    assert texts.pop() in server.get("/projects/office/viewer/").text.replace("&#x27;", "'")
    return pages[0]


def test_a_draft_an_approved_map_and_a_changed_one_are_told_apart(maps, capsys):
    with server_thread(maps) as server:
        draft = shown(server)
        sign_it(maps)
        approved = shown(server)
        file = server.get("/api/projects/office/files/trajectory.tum")

    assert draft["text"] == "Draft: not approved"
    assert approved["text"] == f"Approved v1 · J. Novák · {approved['time'][:10]}"
    assert (approved["kind"], file.status_code) == ("approved", 200)
    assert main(["export", str(maps / "office"), str(maps / "map.ply")]) == 0
    assert approved["text"] in capsys.readouterr().out


def test_an_unknown_signer_is_named_and_its_files_are_refused_until_the_key_is_added(maps):
    (maps / ".recon4").mkdir()
    sign_it(maps, key="../other.key")
    key = public_key_of(maps / "../other.key")
    asked = {"plane": {"kind": "horizontal", "z_m": 1.5, "thickness_m": 0.4}}
    base = "/api/projects/office"
    with server_thread(maps) as server:
        before = shown(server)
        refused = [
            server.get(f"{base}/files/trajectory.tum"),
            server.get(f"{base}/report"),
            server.get(f"{base}/slices/export.csv", params={"ask": '{"plane": {"kind": "free"}}'}),
            server.get(f"{base}/slices/control/report.html"),
        ]
        image = server.post(f"{base}/slices/image", json=asked | {"width": 64, "height": 64})
        draft = server.get(f"{base}/slices/control/report.html", params={"draft": True})
        added = httpx.post(
            f"{server.url}/api/keys",
            json={"name": "Survey Brno", "public_key": key},
            headers={"Origin": server.url},
            timeout=HANG_S,
        )
        after = shown(server)
        counted = server.get(f"{base}/files/trajectory.tum")
        log = server.get("/api/audit").json()["entries"]

    assert before["kind"] == "unknown signer"
    assert before["text"].startswith("Signed by unknown key ") and key in before["detail"]
    assert [answer.status_code for answer in refused] == [422] * 4
    assert all("unknown key" in answer.json()["detail"] for answer in refused)
    assert (image.status_code, draft.status_code) == (200, 200)
    assert "Not approved" in draft.text
    assert added.status_code == 201 and after["kind"] == "approved"
    assert counted.status_code == 200
    assert [one["action"] for one in log if one["object"].endswith("Survey Brno")] == ["trust key"]


def test_altered_bytes_are_said_on_every_page_once_they_are_found(maps):
    sign_it(maps)
    path = maps / "office" / "versions" / "1" / "trajectory.tum"
    text = path.read_text().replace("0 0 0 0 0 0 0 1", "0 0 0 9 0 0 0 1")
    path.unlink()
    path.write_text(text)
    with server_thread(maps) as server:
        review = server.get("/api/projects/office/review").json()["approval"]
        found = shown(server)

    assert review["text"] == "Altered since the approval of version 1" == found["text"]
    assert "trajectory.tum: expected " in review["detail"]


def test_files_of_an_approval_that_the_summary_no_longer_names_are_compared(maps):
    """A stripped summary does not turn other bytes into a download beside "Approved"."""
    sign_it(maps)
    office = maps / "office"
    path = office / "summary.json"
    path.write_text(path.read_text().replace('"approval": {', '"was": {'))
    (office / "trajectory.tum").unlink()
    (office / "trajectory.tum").write_text("1 9 9 9 0 0 0 1\n")
    with server_thread(maps) as server:
        answer = server.get("/api/projects/office/files/trajectory.tum")

    issued = (office / "versions" / "1" / "trajectory.tum").read_text()
    assert (answer.status_code, answer.text) == (200, issued)


def test_an_earlier_version_says_that_a_newer_one_exists(maps):
    sign_it(maps)
    office = maps / "office"
    first = {stage: folder.name for stage, folder in read_artifacts(office).items()}
    for name in ("report.html", "trajectory.tum", "summary.json"):
        (office / name).unlink()  # they are links to the files of the version
    build_project(office, points=21_000)
    sign_it(maps)
    source = {"source": f"map:{first['map']}"}
    with server_thread(maps) as server:
        latest = shown(server)
        earlier = server.get("/api/projects/office/slices", params=source).json()["approval"]

    assert latest["text"].startswith("Approved v2 · J. Novák · ")
    assert earlier["kind"] == "earlier", earlier
    assert earlier["text"].endswith("; version 2 is newer")


def test_the_key_a_server_signs_with_is_listed_and_not_removed(maps):
    sign_it(maps)
    with server_thread(maps) as server:
        (key,) = server.get("/api/keys").json()
        answer = httpx.delete(
            f"{server.url}/api/keys/{key['fingerprint']}",
            headers={"Origin": server.url},
            timeout=HANG_S,
        )

    assert key["own"] and not key["removed"]
    assert answer.status_code == 422 and "make another first" in answer.json()["detail"]
