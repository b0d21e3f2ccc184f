"""A client that openapi-python-client generates from the description of a server drives it."""

import importlib
import json
import shutil
import subprocess
import sys
import time

import httpx
import pytest

from tests.service.running import ROOT, server_thread

FINISHING = "tests.service.finishing_worker"
GENERATOR = shutil.which("openapi-python-client")
CONFIG = ROOT / "examples" / "openapi-client.yaml"

pytestmark = [
    pytest.mark.study,
    pytest.mark.skipif(GENERATOR is None, reason="openapi-python-client is not installed"),
]


@pytest.fixture
def generated(tmp_path, monkeypatch):
    """Generates the client of a server; returns a function that imports its modules."""

    def generate(url):
        described = httpx.get(f"{url}/openapi.json").json()
        (tmp_path / "openapi.json").write_text(json.dumps(described))
        command = [GENERATOR, "generate", "--path", "openapi.json", "--config", str(CONFIG)]
        command += ["--meta", "none", "--output-path", "recon4_client"]
        made = subprocess.run(command, cwd=tmp_path, capture_output=True, text=True, timeout=300)
        assert made.returncode == 0, made.stdout + made.stderr
        assert "Warning" not in made.stdout, made.stdout
        monkeypatch.syspath_prepend(tmp_path)
        return lambda name: importlib.import_module(f"recon4_client.{name}")

    yield generate
    for name in [one for one in sys.modules if one.startswith("recon4_client")]:
        del sys.modules[name]


def test_a_generated_client_lists_starts_watches_and_fetches(tmp_path, data, generated):
    root = tmp_path / "server"
    root.mkdir()
    capture = root / "walk.pcap"
    shutil.copy(data("packets/mrpt") / "sample_velodyne_vlp16_gps.pcap", capture)
    with server_thread(root, worker_module=FINISHING) as server:
        module = generated(server.url)
        new_job = module("models.new_job").NewJob(project="office", recordings=[str(capture)])
        read = module("api.jobs.jobs_read_job").sync
        list_jobs = module("api.jobs.jobs_list_jobs").sync
        with module("client").Client(base_url=server.url) as client:
            before = list_jobs(client=client)
            view = module("api.jobs.jobs_start_job").sync(client=client, body=new_job)
            until_s = time.monotonic() + 120.0
            while view.job.state in ("queued", "running") and time.monotonic() < until_s:
                view = read(view.job.id, client=client)
            after = list_jobs(client=client)
            download = module("api.projects.projects_download").sync_detailed
            fetched = download("office", "trajectory.tum", client=client)
            problem = read("nothing", client=client)

    assert before == [] and [one.job.project for one in after] == ["office"]
    assert view.job.state == "succeeded" and view.run_progress == 1.0
    assert fetched.content == (root / "office" / "trajectory.tum").read_bytes()
    assert problem.code == "job-unknown" and problem.values["job"] == "nothing"
