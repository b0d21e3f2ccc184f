"""The topic of a 2-D laser that a rig file names."""

import json
from dataclasses import replace

import pytest

from recon4.errors import EmptyRecording
from recon4.geometry.se3 import SE3
from recon4.model.rig import Sensor
from recon4.progress import Silent
from recon4.recording.lasers.laser2d import read_laser_recording
from recon4.recording.report import ImportReport
from recon4.recording.rigs.choice import Stream, single_rig
from recon4.settings import IngestSettings
from recon4.slam2d.stage import import_scans
from recon4.workflows.planar import laser_input
from tests.unit.recording.topic_bags import scan, write


def test_a_laser_of_the_rig_file_that_a_bag_lacks_is_said_and_no_other_is_read(tmp_path):
    path = write(tmp_path, scan("/front/scan"), scan("/rear/scan"))

    with pytest.raises(
        EmptyRecording, match=r"topic /scan of \[\[sensor\]\] in the rig file is not"
    ):
        read_laser_recording([path], ImportReport(), topic="/scan")


@pytest.mark.parametrize("topic", ["/front/scan", ""])
def test_the_2d_map_is_made_of_the_laser_that_the_rig_file_names(tmp_path, topic):
    path = write(tmp_path, scan("/front/scan", view_deg=58.0), scan("/rear/scan"))
    mount = SE3.identity()
    laser = Sensor(
        name="l", model="generic", kind="laser2d", T_body_sensor=mount, topic="/front/scan"
    )
    rig = replace(single_rig(Stream("x", "generic")), sensors=(replace(laser, topic=topic),))
    (tmp_path / "out").mkdir()

    import_scans(
        [path],
        tmp_path / "out",
        settings=IngestSettings(),
        laser=laser_input(rig).value,
        progress=Silent(),
    )
    derived = json.loads((tmp_path / "out" / "report.json").read_text())["derived"]
    chosen = [one for one in derived if "/rear/scan" in one.get("values", {}).values()]

    assert len(chosen) == (not topic)
    other = replace(rig, sensors=(replace(laser, topic="/rear/scan"),))
    assert laser_input(rig).key != laser_input(other).key
