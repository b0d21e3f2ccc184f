"""The client of the documentation against a real server."""

import shutil
import subprocess
import sys

from tests.service.running import ROOT, SLOW, server_thread


def test_the_client_of_the_documentation_does_what_it_says(tmp_path, data):
    root, here = tmp_path / "server", tmp_path / "here"
    root.mkdir()
    here.mkdir()
    capture = data("packets/mrpt") / "sample_velodyne_vlp16_gps.pcap"
    shutil.copy(capture, here / "walk.pcap")
    with server_thread(root, worker=SLOW) as server:
        client = [sys.executable, str(ROOT / "docs" / "client_example.py"), server.url]
        ended = subprocess.run(
            [*client, "walk.pcap", "--project", "office"],
            cwd=here,
            capture_output=True,
            text=True,
            timeout=120.0,
        )
        views = server.get("/api/jobs").json()

    assert "sent 100%" in ended.stderr
    assert views[0]["job"]["inputs"]["preset"] in ("indoor", "outdoor")
    # the worker of the tests takes no capture: its words reach the client
    assert ended.returncode == 1
    assert "holds no points; record again" in ended.stderr
