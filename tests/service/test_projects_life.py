"""Projects renamed, cloned, deleted and brought back; looks into recordings; long lists."""

import os
import shutil
import time

import httpx
import pytest

from recon4.settings import Settings
from recon4_app.projects.trash import Trash
from tests.project_builder import build_project
from tests.served import served
from tests.service.running import (
    SLOW,
    open_gate,
    ran,
    recording_with_gate,
    server_thread,
)


@pytest.fixture
def recording(tmp_path):
    return recording_with_gate(tmp_path / "walk")


server = served(fresh=True, worker_module=SLOW)


def finish(server, recording, **changes):
    request = {"project": "office", "recordings": [str(recording)]} | changes
    answer = server.post("/api/jobs", json=request)
    assert answer.status_code == 201, answer.text
    job = answer.json()["job"]["id"]
    gate = open_gate(recording)
    view = server.wait_state(job, "succeeded")
    os.close(gate)
    return view


def test_a_project_gets_another_name_and_keeps_its_address(server, recording):
    finish(server, recording)

    answer = httpx.patch(f"{server.url}/api/projects/office", json={"name": "Kancelář 2 <b>"})

    assert answer.json()["name"] == "Kancelář 2 <b>"
    assert [card["name"] for card in server.get("/api/projects").json()] == ["Kancelář 2 <b>"]


def test_while_a_job_runs_a_project_is_neither_renamed_nor_deleted(server, recording):
    job = server.start("office", recording)
    server.wait_at_gate(job)

    renamed = httpx.patch(f"{server.url}/api/projects/office", json={"name": "x"})
    deleted = httpx.delete(f"{server.url}/api/projects/office")

    assert (renamed.status_code, deleted.status_code) == (409, 409)
    assert "cancel it first" in deleted.json()["detail"]
    server.post(f"/api/jobs/{job}/cancel")
    server.wait_state(job, "cancelled")


def test_a_clone_keeps_what_does_not_depend_on_the_change(server, recording):
    finish(server, recording)
    view = finish(server, recording, project="thin", clone_of="office")

    states = {row["stage"]: row["state"] for row in view["status"]["stages"]}
    assert states == {"frames": "reused", "odometry": "reused"}
    assert ran(recording) == ["frames", "odometry", "finished"]
    again = server.post(
        "/api/jobs", json={"project": "thin", "recordings": [str(recording)], "clone_of": "office"}
    )
    assert again.status_code == 409 and "already" in again.json()["detail"]
    assert not list((server.root / ".recon4" / "clones").iterdir())


def test_what_a_project_was_made_with_is_known(server, recording):
    finish(server, recording, settings=["map.voxel_m=0.1"], preset="outdoor")

    (view,) = server.get("/api/projects/office/jobs").json()

    assert view["job"]["inputs"]["settings"] == ["map.voxel_m=0.1"]
    assert view["job"]["inputs"]["preset"] == "outdoor"


def test_deleted_is_aside_first_comes_back_whole_and_goes_for_good_when_asked(server, recording):
    finish(server, recording)
    (server.root / "my photos").mkdir()

    unknown = httpx.delete(f"{server.url}/api/projects/my photos")
    deleted = httpx.delete(f"{server.url}/api/projects/office").json()
    gone = server.get("/api/projects/office")
    back = server.post(f"/api/trash/{deleted['id']}/restore").json()
    there = server.get("/api/projects/office").json()

    assert unknown.status_code == 404 and (server.root / "my photos").exists()
    assert gone.status_code == 404
    assert back == {"project": "office"}
    assert there["finished"] and len(there["stages"]) == 2
    again = httpx.delete(f"{server.url}/api/projects/office").json()
    assert [one["project"] for one in server.get("/api/trash").json()] == ["office"]
    assert httpx.delete(f"{server.url}/api/trash/{again['id']}").status_code == 204
    assert server.get("/api/trash").json() == []
    assert httpx.delete(f"{server.url}/api/trash/..%2foffice").status_code in (404, 405)


def test_a_project_is_not_brought_back_over_another_one(tmp_path):
    trash = Trash(tmp_path, tmp_path / "trash", kept_s=100.0)
    (tmp_path / "office").mkdir()
    deleted = trash.put(tmp_path / "office")
    (tmp_path / "office").mkdir()

    with pytest.raises(Exception, match="another project office"):
        trash.restore(deleted.id)


def test_the_trash_is_emptied_of_what_is_old_only(tmp_path):
    trash = Trash(tmp_path, tmp_path / "trash", kept_s=100.0)
    (tmp_path / "office").mkdir()
    trash.put(tmp_path / "office")
    (tmp_path / "trash" / "not ours").mkdir()

    early = trash.sweep(time.time() + 50.0)
    late = trash.sweep(time.time() + 150.0)

    assert (early, late) == ([], ["office"])
    assert [path.name for path in (tmp_path / "trash").iterdir()] == ["not ours"]


def test_an_inspection_lists_sensors_and_suitable_settings(tmp_path, data):
    capture = next(
        path for path in sorted(data("packets/mrpt").iterdir()) if path.suffix == ".pcap"
    )
    folder = tmp_path / "Morning walk"
    folder.mkdir()
    shutil.copy(capture, folder / "recording.pcap")
    (folder / "gnss.csv").write_text("t_ns,lat_deg,lon_deg,height_m\n1,49,16,200\n")
    (folder / "notes.csv").write_text("nothing,known\n")
    with server_thread(tmp_path) as server:
        path = str(folder / "recording.pcap")
        found = server.get("/api/look", params={"path": path}).json()
        nothing = server.get("/api/look", params={"path": str(folder / "notes.csv")})
        outside = server.get("/api/look", params={"path": "/etc/passwd"})

    assert found["kind"] == "packets of LiDARs (pcap)"
    assert found["sensors"][0]["model"] and found["seconds"] > 0.0
    assert found["project"] == "morning-walk"
    assert found["preset"] == "outdoor"
    assert found["gnss"] == str(folder / "gnss.csv")
    assert nothing.status_code == 422 and "no reader recognizes it" in nothing.json()["detail"]
    assert outside.status_code == 403


def test_settings_are_listed_with_meaning_unit_and_value(server):
    groups = {g["name"]: g for g in server.get("/api/settings?of=outdoor").json()}

    rows = {row["name"]: row for row in groups["map"]["settings"]}
    assert rows["voxel_m"]["unit"] == "m"
    assert rows["voxel_m"]["default"] == Settings().map.voxel_m
    assert rows["voxel_m"]["value"] == 0.03
    assert rows["voxel_m"]["text"]
    mode = next(row for row in groups["graph"]["settings"] if row["name"] == "mode")
    assert (mode["kind"], mode["choices"]) == (
        "choice",
        ["10", "overlap", "verification", "beyond"],
    )


def test_every_wrong_setting_is_named(server, recording):
    wrong = ["map.voxel_m=5", "graph.node_stride=x"]

    problems = server.post("/api/settings/check", json={"settings": wrong}).json()["problems"]
    request = {"project": "a", "recordings": [str(recording)], "settings": wrong}
    refused = server.post("/api/jobs", json=request)

    assert problems.keys() == {"map.voxel_m", "graph.node_stride"}
    assert "voxel_m must be 0 to 1, got 5" in problems["map.voxel_m"]
    assert refused.status_code == 422
    assert refused.json()["problems"] == problems


def test_a_thousand_projects_are_listed_in_half_a_second(tmp_path):
    build_project(tmp_path / "p0", points=2000)
    for n in range(1, 1000):
        folder = tmp_path / f"p{n}"
        (folder / "artifacts").mkdir(parents=True)
        for name in ("project.json", "summary.json"):
            os.link(tmp_path / "p0" / name, folder / name)
    with server_thread(tmp_path) as server:
        server.get("/healthz")
        cold_s, first = timed(lambda: server.get("/api/projects"))
        warm_s, _ = timed(lambda: server.get("/api/projects"))

    with server_thread(tmp_path) as server:  # has the index of the one before
        server.get("/healthz")
        again_s, second = timed(lambda: server.get("/api/projects"))

    assert len(first.json()) == 1000 and second.json() == first.json()
    assert cold_s < 2.5, cold_s
    assert again_s < 0.5, again_s
    assert warm_s < cold_s


def timed(call):
    """Seconds of processor time, the server's included: it is a thread of this process."""
    began = time.process_time()
    answer = call()
    return time.process_time() - began, answer
