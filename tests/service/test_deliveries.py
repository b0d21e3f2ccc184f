"""Deliveries as exports: chosen, packed in a confined process, signed, verified, refused."""

import io
import zipfile
from dataclasses import replace

import pytest

from recon4.delivery.check import check_file
from recon4.review.trusted_keys import ensure_own_key, read_keys
from recon4_app.jobs.folder import JobFolder
from tests.project_builder import approve_project, build_project
from tests.service.running import server_thread

BASE = "/api/projects/office/exports"
PART = {"clip": [[8.0, 1.0, 2.0, 6.0, 4.0, 3.0, 30.0]]}


@pytest.fixture(scope="module")
def server(tmp_path_factory):
    root = tmp_path_factory.mktemp("files") / "maps"
    build_project(root / "office", points=5_000)
    ensure_own_key(root / ".recon4")
    approve_project(root / "office", root / ".recon4/signing.key", who="J. Novák")
    with server_thread(root) as running:
        yield running


def finished(server, ask):
    answer = server.post(BASE, json=ask)
    assert answer.status_code == 201, answer.text
    server.wait(answer.json()["id"], lambda view: view["job"]["finished"])
    return next(row for row in server.get(BASE).json() if row["id"] == answer.json()["id"])


def delivery(**chosen):
    return {"file": "delivery.zip", "delivery": chosen}


@pytest.fixture(scope="module")
def part(server):
    return finished(server, {"file": "map.xyz", "options": PART})


@pytest.fixture(scope="module")
def asked(part):
    chosen = {"files": ["map.xyz", "map.laz"], "exports": [part["id"]], "language": "de"}
    return delivery(**chosen, license="CC BY 4.0")


@pytest.fixture(scope="module")
def made(server, asked):
    return finished(server, asked)


@pytest.fixture(scope="module")
def again(server, asked, made):
    """Of the same request."""
    return finished(server, asked)


def test_a_delivery_has_what_was_chosen_and_is_signed_for_any_computer(server, made, part):
    assert (made["state"], made["person"], made["note"]) == ("succeeded", "local", "")
    file = server.get(f"{BASE}/{made['id']}/file")
    checked = server.get(f"{BASE}/{made['id']}/check").json()
    kept = server.root / ".recon4/jobs" / made["id"] / "made/office-delivery.zip"
    found = check_file(kept, read_keys(server.root / ".recon4", server=True))

    assert file.headers["etag"] == f'"{made["made"]["sha256"]}"'
    with zipfile.ZipFile(io.BytesIO(file.content)) as packed:
        names, readme = set(packed.namelist()), packed.read("README.txt").decode()
        lines = packed.read("map-2.xyz").splitlines()
        assert packed.read("LICENSE.txt") == b"CC BY 4.0\n"
    assert {"map.xyz", "map-2.xyz", "map.laz", "report.pdf", "report.html"} < names
    heads = 2  # names of the columns, and the approval
    assert len(lines) == part["made"]["points"] + heads < 2_500
    assert "Lieferung" in readme and "clip" in readme
    assert found.whole and set(checked["intact"]) == set(found.intact) == names - {"manifest.json"}
    assert checked["signer"].startswith("this server, key ") and checked["doubt"] == ""


def test_a_delivery_is_made_again_because_people_may_have_added_notes(made, again):
    assert again["state"] == "succeeded" and again["id"] != made["id"]


def test_the_altered_file_of_a_delivery_is_named(server, again):
    path = server.root / ".recon4/jobs" / again["id"] / "made/office-delivery.zip"
    with zipfile.ZipFile(path) as packed:
        place = packed.getinfo("report.pdf").header_offset + 200
    data = bytearray(path.read_bytes())
    data[place] ^= 1
    path.write_bytes(data)

    found = server.get(f"{BASE}/{again['id']}/check").json()

    assert found["altered"] == ["report.pdf"] and "map.laz" in found["intact"]


@pytest.fixture(scope="module")
def exported(server):
    """Its file is altered, then removed."""
    return finished(server, {"file": "map.pcd", "options": {"thin_m": 0.3}})


@pytest.mark.parametrize("how", ["altered", "removed"])
def test_an_exported_file_that_changed_since_it_was_chosen_is_refused_in_words(
    server, exported, how
):
    file = server.root / ".recon4/jobs" / exported["id"] / "made/office-map.pcd"
    if how == "altered":
        data = bytearray(file.read_bytes())
        data[-1] ^= 1
        file.write_bytes(data)
    parts = server.app.state.parts
    limit, parts.supervisor._settings = parts.supervisor._settings, _held(parts)
    waiting = server.post(BASE, json=delivery(exports=[exported["id"]])).json()["id"]
    if how == "removed":
        server._ask("DELETE", f"{BASE}/{exported['id']}/file")
    parts.supervisor._settings = limit
    server.wait(waiting, lambda view: view["job"]["finished"])
    row = next(row for row in server.get(BASE).json() if row["id"] == waiting)

    says = {"altered": "is not the file that was exported", "removed": "was removed since"}
    assert (row["state"], row["made"]) == ("failed", None)
    assert row["note"].startswith(f"office-map.pcd {says[how]}")
    assert not JobFolder(server.root / ".recon4/jobs" / waiting).made.exists()
    gone = server.post(BASE, json=delivery(exports=[exported["id"]]))
    assert how == "altered" or (gone.status_code, gone.json()["code"]) == (404, "export-gone")


def _held(parts):
    """Settings with which no export is started."""
    return replace(parts.settings, max_running_exports=0)


@pytest.mark.parametrize(
    ("ask", "says"),
    [
        ({"file": "delivery.zip"}, "only for one"),
        ({"file": "map.laz", "delivery": {"files": ["map.laz"]}}, "only for one"),
        (delivery(), "at least one file"),
        (delivery(files=["delivery.zip"]), "expected a kind of file"),
        (delivery(files=["map.laz"], language="tlh"), "expected one of en, de"),
        (delivery(files=["map.laz"]) | {"options": {"crs": "EPSG:25832"}}, "cannot be put into"),
        (delivery(files=["map.laz"]) | {"options": {"thin_m": 0.1}}, "takes no thin_m"),
    ],
)
def test_what_cannot_be_delivered_is_refused_before_it_waits(server, ask, says):
    for path in (BASE, f"{BASE}/estimate"):
        answer = server.post(path, json=ask)
        assert (answer.status_code, says in answer.text) == (422, True), answer.text
