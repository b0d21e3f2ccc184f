"""Tags, archive, space and the index of the list of projects, on a real server."""

import json
import os
import shutil

import pytest

from recon4.store.project import Project
from recon4_app.projects.import_folders import ImportFolders
from recon4_app.projects.store import ProjectStore
from tests.project_builder import approve_project, build_project
from tests.served import served
from tests.service.running import server_thread


def projects(root):
    build_project(root / "office", points=2000)
    build_project(root / "hall", points=2000)


server = served(projects)


def change(server, project, **changes):
    return server._ask("PATCH", f"/api/projects/{project}", json=changes)


def card(server, project):
    return next(one for one in server.get("/api/projects").json() if one["id"] == project)


def test_tags_and_archive_stay_with_the_project(server):
    changed = change(server, "office", tags=["  Brno  2 ", "brno 2", "2026"], archived=True)

    assert changed.status_code == 200 and changed.json()["tags"] == ["brno 2", "2026"]
    assert (card(server, "office")["tags"], card(server, "office")["archived"]) == (
        ["brno 2", "2026"],
        True,
    )
    stored = json.loads((server.root / "office" / "project.json").read_text())
    assert stored["tags"] == ["brno 2", "2026"] and stored["preset"] == "indoor"
    change(server, "office", archived=False)
    assert card(server, "office")["tags"] == ["brno 2", "2026"]  # what is left out stays


@pytest.mark.parametrize("tags", [["x" * 41], [""], ["a\u202eb"], ["a"] * 21, "a"])
def test_a_tag_that_is_none_is_refused(server, tags):
    assert change(server, "hall", tags=tags).status_code == 422
    assert card(server, "hall")["tags"] == []


def test_the_same_recording_is_known_by_its_hash(server):
    inputs = [{"name": "walk.pcap", "bytes": 3, "sha256": "ab" * 32}]
    with Project.open(server.root / "hall") as project:
        project.describe(inputs=inputs)

    assert card(server, "hall")["recording"] == "ab" * 32
    assert card(server, "office")["recording"] == ""


def test_space_is_counted_and_freed_but_not_what_an_approval_needs(server):
    def space(project):
        found = server.get("/api/storage/projects").json()
        return next(one for one in found if one["id"] == project)

    before = space("hall")
    freed = server.post("/api/projects/hall/free", json={"what": ["map"]})
    approve_project(server.root / "office", server.root / ".recon4" / "signing.key")

    assert freed.status_code == 200, freed.text
    assert before["freeable"]["map"] > 10_000
    assert freed.json()["bytes"] == pytest.approx(
        before["bytes"] - before["freeable"]["map"], abs=9000
    )
    assert space("hall")["freeable"].get("map") is None
    assert space("office")["freeable"] == {}
    refused = server.post("/api/projects/office/free", json={"what": ["everything"]})
    assert refused.status_code == 422


def test_an_index_outlives_the_server_and_is_never_stale(tmp_path):
    build_project(tmp_path / "office", points=1000)
    index = tmp_path / ".recon4" / "index" / "projects.json"
    with server_thread(tmp_path) as first:
        assert card(first, "office")["points"] == 1000
    kept = json.loads(index.read_text())
    kept["cards"]["office"][1]["name"] = "from the index"
    index.write_text(json.dumps(kept))
    summary = tmp_path / "office" / "summary.json"

    def listed():
        return ProjectStore(tmp_path, ImportFolders(()), index=index).all()[0]

    assert listed().name == "from the index"  # nothing of the project was read again
    times = summary.stat().st_atime_ns, summary.stat().st_mtime_ns
    shutil.copy(summary, tmp_path / "copy")
    (tmp_path / "copy").replace(summary)
    os.utime(summary, ns=times)  # the same time and size, and yet another file
    assert listed().name == "office"
    index.write_text("[]")
    assert listed().name == "office"


def test_an_approved_card_is_judged_again_by_each_server(tmp_path):
    build_project(tmp_path / "office", points=1000)
    with server_thread(tmp_path) as server:
        approve_project(tmp_path / "office", tmp_path / ".recon4" / "signing.key")
        assert card(server, "office")["approval"]["kind"] != "draft"

    kept = json.loads((tmp_path / ".recon4" / "index" / "projects.json").read_text())
    assert kept["cards"] == {}
