"""Ports and rigs that a recorder listens to."""

import socket
import subprocess
import sys

import pytest

from recon4.errors import ConfigError
from recon4.live.recorder.ports import check_sources, open_ports, wanted_ports
from recon4.model.rig import load_rig, parse_rig
from tests.deadlines import HANG_S


def test_a_port_in_use_is_named_with_what_it_is_for(session):
    taken = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)
    taken.bind((session.address, 2368))
    command = [sys.executable, "-m", "recon4.live.recorder.process", str(session.project)]

    done = subprocess.run(command, capture_output=True, text=True, timeout=HANG_S)
    taken.close()

    assert done.returncode == 1
    assert "UDP port 2368 (lidar) cannot be opened" in done.stderr


@pytest.mark.parametrize(
    ("sensors", "gnss", "said"),
    [
        (("", ""), "", "first, second all send to port 2368: give each its address"),
        (("10.0.0.1", ""), "", "all send to port 2368"),
        (("10.0.0.1", "10.0.0.1"), "", "all send to port 2368"),
        (("10.0.0.1", "10.0.0"), "", "second: address must be like 192.168.1.201"),
        (("10.0.0.1", "10.0.0.2"), 'serial = "/dev/ttyUSB7:fast"', "DEVICE:BAUD"),
        (("10.0.0.1", "10.0.0.2"), 'serial = "/dev/pts/0"', "with a serial device"),
        (("10.0.0.1", "10.0.0.2"), 'serial = "/dev/ttyUSB7"\nport = 0', "serial needs a port"),
    ],
)
def test_a_rig_that_cannot_be_listened_to_is_refused_with_what_to_do(sensors, gnss, said):
    text = "".join(
        f'[[sensor]]\nname = "{name}"\naddress = "{address}"\n'
        for name, address in zip(("first", "second"), sensors, strict=True)
    )
    rig = parse_rig(f"{text}[gnss]\n{gnss}\n", where="test")

    with pytest.raises(ConfigError, match=said):
        check_sources(rig)


def test_why_a_port_cannot_be_opened_is_said():
    rig = parse_rig('[[sensor]]\nname = "a"\n', where="test")

    with pytest.raises(ConfigError, match="no network card of this computer has that address"):
        open_ports(rig, address="192.0.2.1")


LASER, PROFILER, LIDAR = (
    f"""
    [[sensor]]
    name = "{kind}"
    kind = "{kind}"
    """
    for kind in ("laser2d", "profiler", "lidar")
)


@pytest.mark.parametrize("text", [LASER, LASER + PROFILER])
def test_rigs_with_a_2d_laser_are_accepted(text):
    check_sources(parse_rig(text, where="test"))


@pytest.mark.parametrize("text", [PROFILER, LASER + LIDAR, PROFILER + LIDAR])
def test_other_mixtures_are_refused_with_what_to_do(text):
    with pytest.raises(ConfigError, match=r"got .* \(kind .*in a bag"):
        check_sources(parse_rig(text, where="test"))


def test_scans_have_ports_of_their_own_by_default():
    assert set(wanted_ports(load_rig("wuerzburg"))) == {8309, 8310, 8311, 8312}
