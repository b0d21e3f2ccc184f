"""What takes space on the server, and recordings deleted in two steps."""

import os
import time

import httpx
import pytest

from recon4.archive.kept_files import kept_files
from recon4.archive.space import stored_parts
from recon4.store.project import Project
from recon4_app.jobs.space import size_below
from recon4_app.storage.storage_work import free_expired
from tests.project_builder import add_multiframes, approve_project, build_project
from tests.served import served
from tests.service.running import SLOW, recording_with_gate, server_thread, wait_for
from tests.service.tus_client import CHUNK, TUS, create

server = served(fresh=True, worker_module=SLOW)


def uploaded(server, name, content=b"12345"):
    """Folder name of a recording that was uploaded."""
    location = create(server.url, len(content), filename=name).headers["Location"]
    sent = httpx.patch(
        server.url + location, headers=TUS | CHUNK | {"Upload-Offset": "0"}, content=content
    )
    assert sent.status_code == 204
    return next(one for one in server.get("/api/uploads").json() if one["name"] == name)["folder"]


def items(server):
    return {(one["kind"], one["name"]): one for one in server.get("/api/storage").json()["items"]}


def test_everything_that_takes_space_is_listed_with_its_size(server):
    build_project(server.root / "office", with_map=False)
    uploaded(server, "walk.bag", b"x" * 1000)
    create(server.url, 10, filename="cut.bag")

    view = server.get("/api/storage").json()

    found = items(server)
    assert found["recording", "walk"]["bytes"] == 1000
    assert found["project", "office"]["bytes"] > 0
    assert found["upload", "cut.bag"]["bytes"] == 0
    assert [one["bytes"] for one in view["items"]] == sorted(
        (one["bytes"] for one in view["items"]), reverse=True
    )
    assert 0 < view["free_bytes"] <= view["disk_bytes"]


def test_an_uploaded_recording_is_deleted_restored_and_removed(server):
    folder = uploaded(server, "walk.bag")
    path = server.root / "recordings" / folder

    deleted = httpx.delete(f"{server.url}/api/recordings/{folder}").json()
    assert not path.exists() and server.get("/api/uploads").json() == []
    assert items(server)["deleted", folder]["bytes"] == 5
    assert server.post(f"/api/trash/{deleted['id']}/restore").json() == {"project": folder}
    assert (path / "walk.bag").read_bytes() == b"12345"
    again = httpx.delete(f"{server.url}/api/recordings/{folder}").json()

    assert httpx.delete(f"{server.url}/api/trash/{again['id']}").status_code == 204
    assert items(server) == {}


def test_the_same_file_sent_after_its_recording_was_deleted_is_a_new_one(server):
    folder = uploaded(server, "walk.bag")
    httpx.delete(f"{server.url}/api/recordings/{folder}")

    assert uploaded(server, "walk.bag") != folder


def test_a_recording_that_a_job_reads_is_kept(server):
    folder = "walk-0123456789ab"
    recording = recording_with_gate(server.root / "recordings" / folder)
    job = server.start("office", recording)
    server.wait_at_gate(job)

    refused = httpx.delete(f"{server.url}/api/recordings/{folder}")

    assert refused.status_code == 409 and "cancel it first" in refused.json()["detail"]
    assert recording.is_dir()
    assert items(server)["recording", "walk"]["used_by"] == ["office"]
    kept = server.post("/api/projects/office/free", json={"what": ["frames"]})
    assert kept.status_code == 409 and "cancel it first" in kept.json()["detail"]
    server.post(f"/api/jobs/{job}/cancel")
    server.wait(job, lambda view: view["job"]["finished"])
    assert httpx.delete(f"{server.url}/api/recordings/{folder}").status_code == 200


@pytest.mark.parametrize("name", ["office", "..%2foffice", "mine", "walk-0123456789ab"])
def test_only_what_was_uploaded_can_be_deleted(server, name):
    build_project(server.root / "office", with_map=False)
    (server.root / "recordings" / "mine").mkdir(parents=True)

    assert httpx.delete(f"{server.url}/api/recordings/{name}").status_code in (404, 405)
    assert (server.root / "recordings" / "mine").is_dir() and (server.root / "office").is_dir()


def freeable(server, project="office"):
    parts = server.get(f"/api/projects/{project}/storage").json()["parts"]
    return {one["what"]: one["freeable"] for one in parts if one["freeable"]}


def test_a_project_says_what_takes_its_space_and_frees_what_is_chosen(server):
    build_project(server.root / "office", points=500)
    add_multiframes(server.root / "office")
    assert freeable(server) == {"frames": "frames", "map": "map"}

    after = server.post("/api/projects/office/free", json={"what": ["frames"]}).json()

    assert freeable(server) == {"map": "map"}
    assert after["bytes"] == items(server)["project", "office"]["bytes"]
    assert server.get("/api/projects/office").json()["bytes"] > 0
    for body in ({"what": []}, {"what": ["all"]}):
        assert server.post("/api/projects/office/free", json=body).status_code == 422
    assert server.post("/api/projects/none/free", json={"what": ["map"]}).status_code == 404


def kept(server):
    """Names of the files that the server keeps of maps."""
    return [path.name for _, path in kept_files(server.root / ".recon4")]


def test_what_is_kept_of_a_map_for_the_pages_is_counted_and_goes_with_the_map(server):
    for name in ("office", "shop"):
        build_project(server.root / name, points=100 * len(name))
        for page in ("map", "thumbnail"):
            assert server.get(f"/api/projects/{name}/{page}").status_code == 200
    ahead = server.root / ".recon4/slices" / f"{kept(server)[0].partition('-')[0]}-first"
    ahead.mkdir()
    (ahead / "index.json").write_text("{}")
    both = kept(server)
    sizes = [size_below(path) for _, path in kept_files(server.root / ".recon4")]

    parts = [
        server.get(f"/api/projects/{one}/storage").json()["parts"] for one in ("office", "shop")
    ]

    counted = [part["bytes"] for one in parts for part in one if part["what"] == "pages"]
    assert len(both) >= 4 and sum(counted) == sum(sizes)
    assert server.post("/api/projects/office/free", json={"what": ["map"]}).status_code == 200
    of_shop = kept(server)
    assert of_shop and len(of_shop) < len(both)
    assert httpx.delete(f"{server.url}/api/projects/shop").status_code == 200
    assert sorted(server.app.state.parts.project_spaces.sweep_kept()) == sorted(of_shop)
    assert kept(server) == []


def test_earlier_runs_go_when_their_time_is_over_except_what_is_approved(tmp_path):
    for name, age_s in (("old", 7200.0), ("new", 0.0), ("approved", 7200.0)):
        build_project(tmp_path / name, points=500)
        if name == "approved":
            approve_project(tmp_path / name, tmp_path / "signing.key")
        with Project.open(tmp_path / name) as project:
            project.ledger.clear_current("level")
            project.ledger.clear_current("map")
        os.utime(tmp_path / name / "summary.json", (time.time() - age_s,) * 2)

    with server_thread(tmp_path, keep_earlier_s=3600.0) as server:
        wait_for(lambda: freeable(server, "old") == {}, "nothing was freed")
        free_expired(server.app.state.parts, time.time())

        assert {"map", "level"} <= freeable(server, "new").keys()
        assert {"map", "level"} <= {one.what for one in stored_parts(tmp_path / "approved")}
