"""Every fault gives a warning; without faults there is none."""

import pytest

from recon4.live.findings import findings, rates
from recon4.live.newest_messages import Newest
from recon4.live.protocol import DiskState, FileState, RecentFrames
from recon4.live.tuning import CAPTURE_WARNINGS
from recon4.model.finding_kinds import FindingKind
from recon4.model.import_counts import count_fate, count_text
from recon4.model.rig import load_rig, parse_rig
from recon4.recording.packets.tuning import CAPTURE_STREAMS
from recon4.recording.report import warning
from tests import live_messages
from tests.live_messages import fix, notes, pose, sender

RIG = load_rig("4recon")
WITH_ADDRESSES = parse_rig(
    """
    [[sensor]]
    name = "horizontal"
    address = "10.0.0.1"
    [[sensor]]
    name = "vertical"
    port = 2369
    address = "10.0.0.2"
    """,
    where="test",
)


CHECK = "check power and cables, and that it sends to port 2368, 2369 of this computer"
PORTS = "2368, 2369", "8311, 8312"
FIRST, SILENT = sender(2368), sender(2368, 0.0, silent_s=4.0)
SECOND = sender(2369, source="10.0.0.2")
IMU = sender(8309, 200.0)


def status(*senders, **changed):
    return live_messages.status(*(senders or (FIRST, SECOND, IMU)), **changed)


def found_in(message=None, *, rig=RIG, problem="", **newest):
    found = findings(rig, Newest(status=message or status(), **newest), problem)
    return [(one.level, one.text) for one in found]


def test_without_faults_there_are_no_findings():
    rtk = fix(sd_m=[0.01, 0.01, 0.02])
    read = notes(counts={"packets": 9999}, recent={"packets": 9999})

    assert found_in(pose=pose(), fix=rtk, notes=read) == []
    assert found_in(rig=WITH_ADDRESSES, pose=pose()) == []


def test_no_sensor_is_silent_in_the_first_seconds():
    assert found_in(status(sender(9999), seconds=1.0)) == []


@pytest.mark.parametrize(
    ("senders", "text"),
    [
        ((FIRST, sender(2369, 0.0, silent_s=3.2), IMU), "vertical LiDAR silent for 3 s"),
        ((FIRST, IMU), "vertical LiDAR silent for 60 s"),
        ((FIRST, sender(2369, 5.0, data_per_s=0.0), IMU), "vertical LiDAR silent for 60 s"),
        (
            (SILENT, sender(2369, 0.0, silent_s=200.0), IMU),
            f"No LiDAR sends anything for 4 s: {CHECK}",
        ),
        ((IMU,), f"No LiDAR sends anything for 60 s: {CHECK}"),
    ],
)
def test_a_silent_lidar_is_named_with_how_long(senders, text):
    assert ("error", text) in found_in(status(*senders))


def test_lidars_at_other_addresses_are_taken_as_the_reader_takes_them():
    strangers = (sender(2368, source="10.0.0.7"), sender(2369, source="10.0.0.8"))

    assert found_in(status(*strangers, IMU), rig=WITH_ADDRESSES) == [
        (
            "info",
            f"{name} LiDAR sends from {source}, not {address}. It is used; correct the rig",
        )
        for name, source, address in (
            ("horizontal", "10.0.0.7", "10.0.0.1"),
            ("vertical", "10.0.0.8", "10.0.0.2"),
        )
    ]
    assert rates(WITH_ADDRESSES, status(*strangers, IMU))["vertical"] > 0
    assert CAPTURE_WARNINGS.taken_ratio == CAPTURE_STREAMS.foreign_ratio


def test_two_strangers_on_one_port_are_named_and_none_is_taken():
    strangers = (sender(2368, source="10.0.0.7"), sender(2368, source="10.0.0.8"))

    found = found_in(status(*strangers, IMU), rig=WITH_ADDRESSES)

    assert (
        "error",
        "No LiDAR of the rig sends: horizontal is expected from 10.0.0.1, but data packets for "
        "port 2368 come from 10.0.0.7, 10.0.0.8: correct the address in the rig or in the sensor",
    ) in found
    assert not any("No LiDAR sends anything" in text for _, text in found)


def test_a_replay_on_this_computer_sends_from_the_addresses_of_the_rig_on_the_loopback():
    replayed = (sender(2368, source="127.0.0.1"), sender(2369, source="127.0.0.2"))

    assert found_in(status(*replayed, IMU), rig=WITH_ADDRESSES) == found_in(
        status(sender(2368, source="10.0.0.1"), sender(2369, source="10.0.0.2"), IMU),
        rig=WITH_ADDRESSES,
    )


def test_datagrams_that_are_no_data_packets_are_named_not_reported_as_silence():
    found = found_in(status(sender(2368, 300.0, data_per_s=0.0, source="10.0.0.7"), IMU))

    assert (
        "error",
        "No LiDAR of the rig sends: datagrams for port 2368 (horizontal) come from 10.0.0.7, "
        "but they are not LiDAR data packets",
    ) in found


def test_a_trickle_on_the_port_of_a_silent_sensor_does_not_hide_it():
    stranger = sender(2369, 70.0, source="10.0.0.9")

    found = found_in(status(FIRST, stranger, IMU), rig=WITH_ADDRESSES)

    assert ("error", "vertical LiDAR silent for 60 s") in found
    assert ("info", "Foreign traffic on port 2369 from 10.0.0.9") in found


@pytest.mark.parametrize("rig", [RIG, WITH_ADDRESSES])
def test_foreign_traffic_is_named(rig):
    stranger = sender(2368, 300.0, source="10.0.0.7", data_per_s=100.0)

    assert found_in(status(FIRST, SECOND, IMU, stranger), rig=rig) == [
        ("info", "Foreign traffic on port 2368 from 10.0.0.7")
    ]


def test_the_rate_of_a_lidar_counts_its_data_packets():
    mixed = sender(2368, 800.0, data_per_s=754.0)

    found = rates(RIG, status(mixed, SECOND, IMU))

    assert found == {"horizontal": 754.0, "vertical": 754.0, "IMU": 200.0, "GNSS": 0.0}
    assert "not LiDAR data packets" in found_in(status(mixed, SECOND, IMU))[0][1]


@pytest.mark.parametrize(
    ("message", "level", "text"),
    [
        (status(FIRST, SECOND), "warning", "No IMU: walk and turn slowly"),
        (
            status(FIRST, SECOND, sender(8309, 0.0, silent_s=5.0)),
            "warning",
            "IMU silent for 5 s: turn slowly",
        ),
        (status(serial="/dev/x: gone"), "warning", "GNSS receiver: /dev/x: gone"),
        (status(kernel_drops=7), "error", "7 packets were lost: this computer is too busy"),
        (
            status(file=FileState(dropped=5)),
            "error",
            "5 packets are not in the recording: the disk was full or too slow",
        ),
        (
            status(file=FileState(problem="the disk is full")),
            "error",
            "Nothing is recorded: the disk is full",
        ),
        (
            status(notes="No space left on device"),
            "error",
            "A mark could not be saved: No space left on device",
        ),
        (status(disk=DiskState(left_s=185)), "error", "Disk full in 3 min"),
        (status(paused=True), "info", "Paused: nothing is recorded"),
    ],
)
def test_status_of_the_recorder_gives_findings(message, level, text):
    assert found_in(message) == [(level, text)]


@pytest.mark.parametrize(
    ("changed", "level", "text"),
    [
        ({"lost": True}, "error", "Tracking lost: stop, then go back a few steps"),
        ({"turn_rad_s": 3.5}, "warning", "Turn slower"),
        ({"match_ratio": 0.3}, "warning", "Tracking is degraded: walk slower, look at more walls"),
        (
            {"prediction_offset_m": 0.4},
            "warning",
            "Tracking is degraded: walk slower, look at more walls",
        ),
        ({"weak_sd_m": 0.5}, "warning", "Tracking is degraded: walk slower, look at more walls"),
        ({"error_m": 0.2}, "warning", "Tracking is degraded: walk slower, look at more walls"),
        (
            {"remark": "no-accelerometer zero"},
            "warning",
            "The IMU has no accelerometer (all its values are 0)",
        ),
        ({"age_s": 3.0}, "warning", "The preview is 3 s behind; the recording is complete"),
        (
            {"age_s": 3.0, "thinned": 80, "lately": RecentFrames(99, 40)},
            "warning",
            "The preview is 3 s behind: 40 of the last 99 frames are left out of the preview "
            "(80 in all); the recording is complete",
        ),
        (
            {"age_s": 0.8, "thinned": 3, "lately": RecentFrames(99, 3)},
            "info",
            "3 of the last 99 frames are left out of the preview (3 in all); the recording is "
            "complete",
        ),
    ],
)
def test_poses_of_the_mapper_give_findings(changed, level, text):
    assert found_in(pose=pose(**changed)) == [(level, text)]


@pytest.mark.parametrize(
    ("recent", "level", "text"),
    [
        (
            {"packets_missing": 3000},
            "warning",
            "30 % of the data packets: never arrived: check cable and recorder",
        ),
        (
            {"packets_duplicate": 700},
            "info",
            "10 % of the data packets: received twice, the copies dropped",
        ),
        ({"packets_out_of_order": 700}, "info", "10 % of the data packets: out of order, sorted"),
        ({"packets_late": 70}, "info", None),
    ],
)
def test_repairs_of_the_reader_are_reported_while_they_happen(recent, level, text):
    counts = {"packets": 10**6, "packets_missing": 10**5}

    found = found_in(notes=notes(counts=counts, recent={"packets": 7000} | recent))

    assert found == ([(level, text)] if text else [])


@pytest.mark.parametrize(
    "name",
    ["packets_missing", "packets_duplicate", "packets_late", "packets_wrong_length"],
)
def test_live_and_finished_runs_say_a_loss_in_the_same_words(name):
    counts = {"packets": 7000, name: 700}

    ((_, text),) = found_in(notes=notes(counts=counts, recent=counts))

    assert count_fate(name) in text
    assert count_text(name, counts).split(": ", 1)[1] == text.split(": ", 1)[1]


def test_a_clock_that_runs_freely_is_reported():
    free = warning(FindingKind.CLOCK_FREE, sensor="horizontal", ahead_s=5.0)

    ((level, text),) = found_in(notes=notes(findings=[free]))
    assert level == "warning" and text.startswith("horizontal: its clock is +5.000 s off")


@pytest.mark.parametrize(
    ("changed", "level", "text"),
    [
        ({"jumped_m": 50.2}, "warning", "GNSS jumped by 50 m: the map does not use it"),
        ({"quality": 1, "sd_m": [2.0, 3.1, 5.0]}, "info", "GNSS without RTK fix, ±3.1 m"),
        ({"quality": 0}, "info", "GNSS has no position"),
    ],
)
def test_the_gnss_fix_gives_findings(changed, level, text):
    assert found_in(fix=fix(**changed)) == [(level, text)]


def test_a_computer_that_is_too_slow_is_one_finding():
    slow = pose(age_s=4.2, thinned=7, lately=RecentFrames(frames=20, thinned=5), error_m=0.2)
    read = notes(recent={"packets": 9000, "packets_missing": 900})

    assert found_in(status(kernel_drops=900), pose=slow, notes=read) == [
        (
            "error",
            "900 packets were lost: this computer is too busy; the preview is 4 s behind: 5 of "
            "the last 20 frames are left out of the preview (7 in all)",
        )
    ]


def test_the_most_urgent_comes_first():
    paused = status(paused=True, kernel_drops=3)
    found = found_in(paused, problem="gone", pose=pose(remark="x"))

    assert [level for level, _ in found] == ["error", "error", "warning", "info"]


# -- a 2-D laser and a profiler

BACKPACK = load_rig("wuerzburg")
SCANS, LINES = sender(8311, 25.0, data_per_s=0.0), sender(8312, 300.0, data_per_s=0.0)


def test_scans_are_no_data_packets_and_still_counted():
    healthy = status(SCANS, LINES, IMU)

    assert found_in(healthy, rig=BACKPACK, pose=pose()) == []
    assert rates(BACKPACK, healthy)["laser2d"] == 25.0
    assert rates(BACKPACK, healthy)["profiler"] == 300.0


@pytest.mark.parametrize(
    ("senders", "text"),
    [
        ((sender(8311, 0.0, silent_s=5.0), LINES, IMU), "2-D laser silent for 5 s"),
        ((SCANS, sender(8312, 0.0, silent_s=7.0), IMU), "Profiler silent for 7 s"),
        ((IMU,), f"No scanner sends anything for 60 s: {CHECK.replace(*PORTS)}"),
    ],
)
def test_a_silent_scanner_is_named_by_its_kind(senders, text):
    assert ("error", text) in found_in(status(*senders), rig=BACKPACK)


def test_a_scanner_at_another_address_is_said():
    rig = parse_rig(
        '[[sensor]]\nname = "laser2d"\nkind = "laser2d"\naddress = "10.0.0.9"', where="test"
    )

    ((level, text), *_) = found_in(status(SCANS), rig=rig)

    assert level == "error"
    assert "laser2d is expected from 10.0.0.9, but datagrams for port 8311 come from 10.0" in text


def test_a_2d_laser_alone_needs_no_imu():
    rig = parse_rig('[[sensor]]\nname = "laser2d"\nkind = "laser2d"', where="test")

    assert found_in(status(SCANS), rig=rig) == []


@pytest.mark.parametrize(
    ("unobserved", "text"),
    [
        ("along", "Nothing holds the map along this corridor: look at a corner or an open door"),
        ("across", "Nothing holds the map across your way: keep near a wall"),
    ],
)
def test_a_direction_that_is_not_observed_is_said_in_words(unobserved, text):
    seen = pose(unobserved=unobserved, weak_sd_m=4.0)

    assert found_in(status(SCANS, LINES, IMU), rig=BACKPACK, pose=seen) == [("warning", text)]


@pytest.mark.parametrize(
    ("recent", "text"),
    [
        (
            {"scans": 200, "scans_repeated": 50},
            "20 % of the scans: repeated in other messages, the copies",
        ),
        (
            {"scans": 100, "scans_out_of_order": 100},
            "50 % of the scans of the 2-D laser: earlier than the one before",
        ),
        ({"scans": 200, "scans_damaged": 30}, "30 datagrams with scans cannot be read"),
        ({"scans_damaged": 30}, "Nothing of what the 2-D laser sends can be read: 30 datagrams"),
        ({"scans": 100, "scans_without_returns": 100}, "The 2-D laser sees nothing: is it covered"),
        ({"lines_without_angle": 300}, "The angles of the profiler's head are missing"),
    ],
)
def test_what_is_wrong_with_scans_is_said(recent, text):
    ((level, found),) = found_in(
        status(SCANS, LINES, IMU), rig=BACKPACK, notes=notes(recent=recent)
    )

    assert level == "warning"
    assert found.startswith(text)


def test_single_bad_scans_are_not_worth_a_warning():
    recent = {"scans": 250, "scans_repeated": 1, "scans_without_returns": 3, "scans_damaged": 1}

    assert found_in(status(SCANS, LINES, IMU), rig=BACKPACK, notes=notes(recent=recent)) == []


@pytest.mark.parametrize(
    ("model", "beside"),
    [("OS0-32", sender(7503, 100.0)), ("JT128", None)],
    ids=["in packets of its own", "in the data packets"],
)
def test_the_imu_of_a_lidar_is_not_missed(model, beside):
    rig = parse_rig(f'[[sensor]]\nname = "front"\nmodel = "{model}"', where="test")
    senders = [sender(rig.sensors[0].port, 640.0, data_per_s=640.0), *([beside] if beside else [])]

    assert found_in(status(*senders), rig=rig) == []
    assert rates(rig, status(*senders)).get("IMU") == (beside.per_s if beside else None)
