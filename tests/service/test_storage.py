"""What takes space on the server, and recordings deleted in two steps."""

import httpx
import pytest

from tests.project_builder import build_project
from tests.served import served
from tests.service.running import SLOW, recording_with_gate
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
    server.post(f"/api/jobs/{job}/cancel")
    server.wait(job, lambda view: view["job"]["finished"])
    assert httpx.delete(f"{server.url}/api/recordings/{folder}").status_code == 200


@pytest.mark.parametrize("name", ["office", "..%2foffice", "mine", "walk-0123456789ab"])
def test_only_what_was_uploaded_can_be_deleted(server, name):
    build_project(server.root / "office", with_map=False)
    (server.root / "recordings" / "mine").mkdir(parents=True)

    assert httpx.delete(f"{server.url}/api/recordings/{name}").status_code in (404, 405)
    assert (server.root / "recordings" / "mine").is_dir() and (server.root / "office").is_dir()
