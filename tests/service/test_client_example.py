"""The client of the documentation against real servers."""

import os
import shutil
import subprocess
import sys

import pytest

from tests.service.running import ROOT, SLOW, server_thread
from tests.service.secure import PASSWORD, secure_server

FINISHING = "tests.service.finishing_worker"


@pytest.fixture
def here(tmp_path, data):
    """Working folder of the client, with a recording."""
    folder = tmp_path / "here"
    folder.mkdir()
    capture = data("packets/mrpt") / "sample_velodyne_vlp16_gps.pcap"
    shutil.copy(capture, folder / "walk.pcap")
    return folder


@pytest.fixture
def root(tmp_path):
    (tmp_path / "server").mkdir()
    return tmp_path / "server"


def call(here, url, *more):
    return subprocess.run(
        [sys.executable, str(ROOT / "examples" / "http_client.py"), url, "walk.pcap", *more],
        cwd=here,
        capture_output=True,
        text=True,
        timeout=120.0,
        env={**os.environ, "RECON4_PASSWORD": PASSWORD},
    )


def test_the_client_signs_in_sends_follows_and_fetches_a_result(here, root):
    with secure_server(root, worker_module=FINISHING) as server:
        certificate = root / ".recon4" / "tls" / "certificate.pem"
        who = ["--name", "otto", "--certificate", str(certificate)]

        ended = call(here, server.url, "--project", "office", "--result", "trajectory.tum", *who)

        with server.signed_in("vera") as client:
            (view,) = client.get("/api/jobs").json()

    assert ended.returncode == 0, ended.stderr
    assert "sent 100%" in ended.stderr and "succeeded" in ended.stderr
    fetched = (here / "trajectory.tum").read_bytes()
    assert fetched == (root / "office" / "trajectory.tum").read_bytes()
    assert view["job"]["inputs"]["preset"] in ("indoor", "outdoor")


@pytest.mark.study
def test_a_failed_job_is_reported_with_the_message_of_the_server(here, root):
    with server_thread(root, worker_module=SLOW) as server:  # its worker takes no capture
        ended = call(here, server.url, "--project", "office")

    assert ended.returncode == 1
    assert "holds no points; record again" in ended.stderr
