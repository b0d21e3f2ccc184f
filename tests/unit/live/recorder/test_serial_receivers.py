"""Serial GNSS receivers: which devices are opened, by whom, and what is recorded of them."""

import os
import signal
import subprocess
import sys
import termios
import tty
from dataclasses import replace

import numpy as np
import pytest

from recon4.errors import ConfigError
from recon4.live.recorder import serial_port
from recon4.live.recorder.device_opener import DeviceOpener
from recon4.live.recorder.ports import check_sources
from recon4.live.recorder.serial_port import (
    check_serial_device,
    driver_kind,
    open_line,
    open_serial_device,
)
from recon4.model.rig import load_rig
from recon4.model.serial_device import SerialDevice, parse_serial_device
from recon4.recording.formats.pcap import read_pcap
from recon4.recording.report import ImportReport
from recon4.system.processes import process_identity
from tests.deadlines import HANG_S
from tests.service.running import wait_for
from tests.unit.live.recorder import recorder_of_a_terminal
from tests.unit.live.recorder.recorder_process import recording

DRIVERS = """\
/dev/tty             /dev/tty        5       0 system:/dev/tty
/dev/console         /dev/console    5       1 system:console
rfcomm               /dev/rfcomm   216 0-255 serial
acm                  /dev/ttyACM   166 0-255 serial
usbserial            /dev/ttyUSB   188 0-511 serial
serial               /dev/ttyS       4 64-111 serial
pty_slave            /dev/pts      136 0-1048575 pty:slave
unknown              /dev/tty        4 1-63 console
"""


@pytest.fixture
def terminal():
    """A pseudo terminal: its end for the test, and the path of the other one."""
    ours, theirs = os.openpty()
    tty.setraw(theirs)
    yield ours, os.ttyname(theirs)
    os.close(ours)
    os.close(theirs)


@pytest.mark.parametrize(
    ("text", "path", "baud"),
    [
        ("/dev/ttyUSB0:115200", "/dev/ttyUSB0", 115200),
        ("/dev/ttyS0", "/dev/ttyS0", 9600),
        ("/dev/ttyACM1:460800", "/dev/ttyACM1", 460800),
        ("/dev/ttyTHS1:38400", "/dev/ttyTHS1", 38400),
        ("/dev/ttymxc2", "/dev/ttymxc2", 9600),
        ("/dev/rfcomm0", "/dev/rfcomm0", 9600),
        ("/dev/gps0:4800", "/dev/gps0", 4800),
        ("/dev/cu.usbserial-A50285BI:115200", "/dev/cu.usbserial-A50285BI", 115200),
        (
            "/dev/serial/by-id/usb-u-blox_AG_-_www.u-blox.com_u-blox_GNSS_receiver-if00:115200",
            "/dev/serial/by-id/usb-u-blox_AG_-_www.u-blox.com_u-blox_GNSS_receiver-if00",
            115200,
        ),
        (
            "/dev/serial/by-path/pci-0000:00:14.0-usb-0:2:1.0-port0",
            "/dev/serial/by-path/pci-0000:00:14.0-usb-0:2:1.0-port0",
            9600,
        ),
        (
            "/dev/serial/by-path/pci-0000:00:14.0-usb-0:2:1.0:38400",
            "/dev/serial/by-path/pci-0000:00:14.0-usb-0:2:1.0",
            38400,
        ),
    ],
)
def test_names_of_serial_devices_are_split_from_the_baud_rate(text, path, baud):
    assert parse_serial_device(text) == SerialDevice(path, baud)


@pytest.mark.parametrize(
    "text",
    [
        *("/dev/pts/0", "/dev/pts/0:9600", "/dev/tty", "/dev/tty1:9600", "/dev/console"),
        *("/dev/ptmx", "/dev/ttyp0", "/dev/sda:9600", "/dev/input/event0", "/dev/watchdog"),
        *("/dev/stdin", "/dev/fd/3", "/etc/passwd", "/proc/1/fd/0", "ttyUSB0", "COM3:9600"),
        *("/dev/ttyUSB0/../pts/0", "/dev/serial/by-id/..:9600", "/dev/serial/by-id/../../pts/0"),
        *("/dev/../dev/pts/0", "/dev/ttyS0\n", "/dev/ttyUSB0 /dev/pts/0", "/dev/ttyUSB0\0"),
        *("/dev/ttyUSB0:fast", ":9600", "/dev/ttyUSB0:0", "/dev/ttyUSB0:", "/dev/ttyUSB0:٩٦٠٠"),
        *("socket://10.0.0.1:7000", "rfc2217://10.0.0.1:7000", "loop://", "/dev/ttyS0:99999999"),
    ],
)
def test_other_names_are_refused(text):
    with pytest.raises(ConfigError, match="expected DEVICE:BAUD with a serial device"):
        parse_serial_device(text)


@pytest.mark.parametrize(
    ("major", "minor", "kind"),
    [
        *((188, 0, "serial"), (166, 255, "serial"), (4, 64, "serial"), (4, 111, "serial")),
        *((4, 1, "console"), (136, 7, "pty:slave"), (5, 0, "system:/dev/tty")),
        *((5, 1, "system:console"), (4, 112, ""), (8, 0, ""), (166, 256, "")),
    ],
)
def test_the_kernel_says_what_a_terminal_is(major, minor, kind):
    assert driver_kind(os.makedev(major, minor), DRIVERS) == kind


def linked(tmp_path, target):
    """A name as udev gives: a link, so that only the device itself tells."""
    link = tmp_path / "gps0"
    link.symlink_to(target)
    return SerialDevice(str(link), 9600)


@pytest.mark.skipif(sys.platform != "linux", reason="asks the kernel of Linux")
def test_a_link_to_another_terminal_is_not_opened(tmp_path, terminal):
    ours, path = terminal
    device = linked(tmp_path, path)
    os.write(ours, b"typed by somebody else\n")

    for ask in (check_serial_device, open_serial_device):
        with pytest.raises(ConfigError, match="is no serial line but pty:slave: it is not opened"):
            ask(device)

    kept = os.open(path, os.O_RDWR | os.O_NOCTTY | os.O_NONBLOCK)
    assert os.read(kept, 100) == b"typed by somebody else\n"
    os.close(kept)


@pytest.mark.skipif(sys.platform != "linux", reason="asks the kernel of Linux")
@pytest.mark.parametrize(
    ("target", "said"),
    [
        ("/dev/null", "no serial line but another device"),
        ("/dev/tty", "no serial line but system:/dev/tty"),
        ("/etc/passwd", "is no device"),
        ("/dev", "is no device"),
    ],
)
def test_other_devices_and_files_are_not_opened(tmp_path, target, said):
    with pytest.raises(ConfigError, match=said):
        open_serial_device(linked(tmp_path, target))


def test_a_console_of_the_computer_is_not_opened(tmp_path, terminal, monkeypatch):
    _, path = terminal
    number = os.stat(path).st_rdev
    table = f"pretended /dev/pts {os.major(number)} 0-1048575 serial\n"
    (tmp_path / "drivers").write_text(table)
    files = {"console/active": "tty0 ttyX0\n", "tty0/dev": "4:0\n", "ttyX0/dev": "4:64\n"}
    for name, text in files.items():
        (tmp_path / name).parent.mkdir()
        (tmp_path / name).write_text(text)
    monkeypatch.setattr(serial_port, "DRIVERS", tmp_path / "drivers")
    monkeypatch.setattr(serial_port, "TERMINALS", tmp_path)

    os.close(open_serial_device(SerialDevice(path, 9600)))
    (tmp_path / "ttyX0" / "dev").write_text(f"{os.major(number)}:{os.minor(number)}\n")

    with pytest.raises(ConfigError, match="is a console of this computer"):
        open_serial_device(SerialDevice(path, 9600))


def test_a_receiver_that_is_not_plugged_in_yet_is_no_reason_not_to_start():
    rig = replace(load_rig("single-vlp16"), gnss_serial="/dev/ttyUSB399:115200")

    check_sources(rig)
    with pytest.raises(FileNotFoundError):
        open_serial_device(parse_serial_device(rig.gnss_serial))


def test_the_opener_hands_over_the_device_with_its_rate_and_ends(terminal):
    ours, path = terminal
    opener = DeviceOpener(lambda: open_line(path, 57600))

    line = opener.open()
    os.write(ours, b"$GP")

    assert os.read(line, 100) == b"$GP"
    assert termios.tcgetattr(line)[4] == termios.B57600
    os.close(line)
    opener.close()  # waits for its end


def test_the_opener_opens_no_file_and_says_why(tmp_path):
    secret = tmp_path / "secret"
    secret.write_text("key")
    opener = DeviceOpener(lambda: os.open(secret, os.O_RDONLY))

    with pytest.raises(OSError, match="Permission denied"):
        opener.open()
    with pytest.raises(OSError, match="Permission denied"):  # it goes on
        opener.open()
    opener.close()


def test_the_opener_ends_with_a_recorder_that_was_killed(tmp_path):
    code = (
        "import os, signal\n"
        "from recon4.live.recorder.device_opener import DeviceOpener\n"
        "opener = DeviceOpener(lambda: os.open('/dev/null', os.O_RDONLY))\n"
        "os.close(opener.open())\n"
        "print(opener._child, flush=True)\n"
        "os.kill(os.getpid(), signal.SIGKILL)\n"
    )
    process = subprocess.Popen([sys.executable, "-c", code], stdout=subprocess.PIPE)

    text, _ = process.communicate(timeout=HANG_S)  # the pipe closes when both have ended

    assert process.returncode == -signal.SIGKILL
    wait_for(lambda: not process_identity(int(text)), "the opener lives on")


def rig_with(session, serial):
    session.rig.write_text(
        f'name = "test"\n[[sensor]]\nname = "lidar"\n[gnss]\nserial = "{serial}"\n'
    )


def test_a_recorder_whose_rig_names_another_terminal_does_not_start(session, terminal):
    _, path = terminal
    rig_with(session, f"{path}:9600")
    command = [sys.executable, "-m", "recon4.live.recorder.process", str(session.project)]

    done = subprocess.run(command, capture_output=True, text=True, timeout=HANG_S)

    assert done.returncode == 1
    assert "expected DEVICE:BAUD with a serial device" in done.stderr
    assert path in done.stderr
    assert not session.capture.exists()


def test_sentences_of_a_serial_receiver_are_in_the_capture_also_after_unplugging(session):
    receiver = session.project / recorder_of_a_terminal.RECEIVER
    rig_with(session, "/dev/ttyUSB399:115200")
    sentence = b"$GPGGA,120000.00,4912.0,N,01636.0,E,4,12,0.8,250.0,M,44.0,M,1.0,0001*7B"
    link = session.project / "plug"
    receiver.write_text(str(link))
    with recording(session, recorder_of_a_terminal.__name__) as (process, talk):
        talk.hear("status", lambda message: "No such file" in (message["serial"] or ""))
        for count in (2, 4):
            ours, theirs = os.openpty()
            link.symlink_to(os.ttyname(theirs))
            talk.hear("status", lambda message: message["serial"] == "")
            os.write(ours, sentence[:30])
            os.write(ours, sentence[30:] + b"\r\n" + sentence + b"\r\n")
            talk.hear("status", lambda message, n=count: message["file"]["datagrams"] == n)
            link.unlink()
            os.close(ours)  # pulled out
            os.close(theirs)
            talk.hear("status", lambda message: "/dev/ttyUSB399" in message["serial"])
        talk.send(do="stop")
        process.wait(20)

    (batch,) = read_pcap(session.capture, ImportReport())
    assert batch.port.tolist() == [8310] * 4
    assert batch.payloads(np.array([1]), len(sentence)).tobytes() == sentence
