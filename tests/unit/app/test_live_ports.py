"""LiDARs that send to the port of another one."""

from recon4.live.findings import findings
from recon4.live.newest_messages import Newest
from recon4.model.rig import load_rig
from tests.live_messages import pose, sender, status

RIG = load_rig("4recon")
IMU = sender(8309, 200.0)


def found_in(*senders):
    found = findings(RIG, Newest(status=status(*senders), pose=pose()), "")
    return [(one.level, one.text) for one in found]


def test_two_lidars_at_the_port_of_one_are_named_with_what_to_do():
    first, second = sender(2368, source="10.0.0.1"), sender(2368, source="10.0.0.2")
    ((level, text), *_) = found_in(first, second, IMU)

    assert level == "error" and text.startswith("vertical LiDAR silent at port 2369 for")
    assert "but 10.0.0.1, 10.0.0.2 send to port 2368: give each LiDAR the port" in text
    alone = found_in(first, IMU)
    assert any(text.startswith("vertical LiDAR silent for") for _, text in alone)
