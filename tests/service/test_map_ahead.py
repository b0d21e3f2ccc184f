"""What the page *Map* reads first is made before somebody asks for it."""

from functools import partial

import pytest

from recon4_app.compute_pool.process import ChildProcess
from tests.project_builder import build_project
from tests.served import served
from tests.service.running import wait_for

FIRST = {"index.json", "xyz.bin", "normalized.bin"}


def projects(root):
    build_project(root / "office", points=1000)


server = served(projects, fresh=True, ahead=True, worker_module="tests.service.finishing_worker")


def made(server):
    """Kinds of the files that are kept of maps."""
    kept = server.app.state.parts.settings.state / "slices"
    return {path.name for path in kept.glob("*-map*-first/*")}


@pytest.fixture
def prepared(server):
    return partial(wait_for, lambda: made(server) == FIRST, "what is read first is made")


@pytest.fixture
def children(monkeypatch):
    """One entry for each child of the compute pool that begins."""
    start, begun = ChildProcess.start, []

    async def counted(*args, **options):
        begun.append(args)
        return await start(*args, **options)

    monkeypatch.setattr(ChildProcess, "start", counted)
    return begun


def test_by_the_page_of_a_project_that_has_a_map(server, prepared, children):
    assert not made(server)
    assert server.get("/projects/office/").status_code == 200
    prepared()
    index = server.get("/api/projects/office/map").json()
    assert index["color"] == "normalized"
    for stored in ("xyz", "normalized"):
        query = {"stored": stored, "version": index["version"]}
        answer = server.get(f"/api/projects/office/map/{index['key']}/sample", params=query)
        assert answer.status_code == 200
    assert len(children) == 1


def test_by_a_job_that_has_made_a_map(server, prepared, tmp_path):
    recording = tmp_path / "recording"
    recording.mkdir()
    job = server.start("fresh", recording)
    server.wait(job, lambda view: view["job"]["state"] == "succeeded")
    prepared()
