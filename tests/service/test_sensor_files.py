"""A file that describes a LiDAR lies beside a recording; only the recording is named on a page."""

import json
import shutil

import pytest

from tests.service.running import server_thread

CAPTURE = "packets/ouster/OS-1-128_v2.3.0_1024x10_lb_n3.pcap"
METADATA = "packets/ouster/OS-1-128_v2.3.0_1024x10.json"


@pytest.mark.study
def test_look_and_worker_read_the_metadata_beside_a_single_file(tmp_path, data):
    folder = tmp_path / "walks"
    folder.mkdir()
    recording = folder / "walk.pcap"
    shutil.copy(data(CAPTURE), recording)
    shutil.copy(data(METADATA), folder / "sensor.json")

    with server_thread(tmp_path) as server:
        found = server.get(f"/api/look?path={recording}").json()
        job = server.start("office", recording)
        view = server.wait(job, lambda view: view["job"]["state"] in ("succeeded", "failed"))
        log = server.get(f"/api/jobs/{job}/log").text

    assert [one["model"] for one in found["sensors"]] == ["OS1-128"]
    assert view["job"]["state"] == "succeeded", (view["job"]["note"], log)
    summary = json.loads((tmp_path / "office" / "summary.json").read_text())
    assert sorted(summary["hashes"]["inputs"]) == ["sensor.json", "walk.pcap"]
