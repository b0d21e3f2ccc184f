"""Workers of jobs: chosen on the page People, shown on the page of the project."""

import json

import pytest
from playwright.sync_api import expect

from recon4_app.jobs.model import Inputs, Job, JobState
from tests.served import office, served

pytestmark = [pytest.mark.e2e, pytest.mark.study]

server = served(office(points=1000), fresh=True)
ROW = {"name": "north 4711", "part": "map-tile (0, 1, 0)", "made": 12, "failed": 1, "seconds": 31.5}


def finished_job(server) -> None:
    """A job of the office that workers have made."""
    parts = server.app.state.parts
    job = Job(
        id="ab" * 8,
        project="office",
        inputs=Inputs(recordings=("walk.pcap",)),
        created="2026-11-29T00:00:00+00:00",
        state=JobState.SUCCEEDED,
    )
    folder = parts.supervisor.folder(job.id).path
    folder.mkdir(parents=True)
    idle = ROW | {"name": "south 815", "part": "", "failed": 0}
    workers = {"workers": [ROW, idle], "problem": ""}
    (folder / "workers.json").write_text(json.dumps(workers), "utf-8")
    parts.jobs.add(job)


def test_an_admin_chooses_workers_and_the_page_of_the_job_shows_them(server, page, screenshot):
    finished_job(server)
    page.goto(f"{server.url}/people")
    section = page.get_by_role("region", name="Workers of jobs")
    section.get_by_label("Scheduler of Dask").fill("tcp://north:8786")
    section.get_by_role("button", name="Save").click()
    expect(section.get_by_role("alert")).to_contain_text("expected tls://HOST:PORT")
    section.get_by_label("Scheduler of Dask").fill("tls://north:8786")
    section.get_by_label("Its dashboard").fill("http://north:8787/status")
    section.get_by_role("button", name="Save").click()
    expect(section.get_by_role("status")).to_have_text("Saved; now test them")
    section.get_by_role("button", name="Test").click()
    expect(section.get_by_role("status")).to_contain_text("no such certificate")
    section.scroll_into_view_if_needed()
    screenshot(page, "workers")

    page.goto(f"{server.url}/projects/office/")
    workers = page.locator("job-workers")
    expect(workers.get_by_role("row")).to_have_count(3)
    expect(workers.get_by_role("row").nth(1)).to_contain_text("map-tile (0, 1, 0)")
    expect(workers.get_by_role("row").nth(1)).to_contain_text("1 failed")
    expect(workers.get_by_role("link", name="Dashboard")).to_have_attribute(
        "href", "http://north:8787/status"
    )
    workers.scroll_into_view_if_needed()
    screenshot(page, "job-workers")
