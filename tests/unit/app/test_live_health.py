"""Health of LiDARs and batteries, choice of rigs, marks of a session."""

import numpy as np
import pytest

from recon4.live.mapper.import_notes import NotesWatch
from recon4.live.newest_messages import Newest
from recon4.live.session import CaptureSession
from recon4.model.rig import format_rig, load_rig, rig_presets
from recon4.recording.packets.sensor_clock import SensorClock
from recon4.recording.report import ImportReport
from recon4_app.live.current_capture import marks_of
from recon4_app.live.health import lidars
from recon4_app.live.power import Battery, Power, battery_findings, read_battery
from recon4_app.live.rigs import rig_files, rigs_in, shipped_rigs
from tests.live_messages import sender, status

RIG = load_rig("4recon")
SECOND_NS = 1_000_000_000


def newest(rate=754.0, notes=None):
    senders = (sender(2368, rate), sender(2369, rate, source="10.0.0.2"))
    return Newest(status=status(*senders), notes=notes)


def clock_of(name, offset_s):
    """A report after some packets of a sensor whose clock is so far off."""
    report = ImportReport()
    clock = SensorClock(name, packet_s=0.00133, report=report)
    t_ns = np.arange(200, dtype=np.int64) * 1_330_000 + 1_790_000_100 * SECOND_NS
    stamps = (t_ns // 1000 + round(offset_s * 1e6)) % 3_600_000_000
    clock.push(t_ns, stamps)
    return report


def health(report, rate=754.0):
    found = lidars(RIG, newest(rate, NotesWatch(report).message(0.0)))
    return {one.name: one for one in found}


def test_a_lidar_without_pps_is_distinguished_from_one_in_step():
    found = health(clock_of("vertical", 700.0))

    assert found["vertical"].clock == "own, shifted"
    assert found["horizontal"].clock == "in step"


def test_lost_packets_are_those_of_the_lidar_that_lost_them():
    report = ImportReport()
    notes = NotesWatch(report)
    notes.message(0.0)
    report.count("packets_missing", 838)
    report.count("packets_missing_vertical", 838)

    found = lidars(RIG, newest(notes=notes.message(9.0)))

    assert [(one.name, one.lost) for one in found] == [("horizontal", 0.0), ("vertical", 0.1)]


def test_what_went_wrong_before_the_first_message_is_reported_for_ten_seconds():
    report = ImportReport()
    report.count("clock_jumps")
    notes = NotesWatch(report)

    recent = [notes.message(now_s).recent for now_s in (30.0, 39.0, 41.0)]

    assert recent == [{"clock_jumps": 1}, {"clock_jumps": 1}, {}]


def test_a_jump_is_counted_of_the_sensor_whose_clock_jumped():
    """Also of one whose name is a part of that of another."""
    report = ImportReport()
    for name in ("vertical", "horizontal", "vertical", "horizontal 2"):
        report.count_jump(name)

    found = health(report)

    assert report.counts["clock_jumps"] == 4
    assert {name: (one.clock, one.jumps) for name, one in found.items()} == {
        "vertical": ("jumped", 2),
        "horizontal": ("jumped", 1),
    }


@pytest.mark.parametrize("jumped", ["profiler", "laser2d"])
def test_a_jump_of_a_profiler_is_not_one_of_the_laser_beside_it(jumped):
    rig, report = load_rig("wuerzburg"), ImportReport()
    scans, lines = sender(8311, 25.0, data_per_s=0.0), sender(8312, 300.0, data_per_s=0.0)
    report.count_jump(jumped)
    notes = NotesWatch(report).message(0.0)

    found = lidars(rig, Newest(status=status(scans, lines), notes=notes))

    assert [(one.name, one.jumps) for one in found if one.clock == "jumped"] == [(jumped, 1)]


def test_without_data_and_for_a_silent_lidar_loss_and_clock_are_unknown():
    assert lidars(RIG, Newest()) == []
    (first, _) = lidars(RIG, newest())
    assert (first.lost, first.clock) == (None, "")
    assert health(ImportReport(), rate=0.0)["vertical"].lost is None


@pytest.fixture
def supplies(tmp_path):
    def put(name, **properties):
        (tmp_path / name).mkdir()
        lines = [f"POWER_SUPPLY_{key.upper()}={value}" for key, value in properties.items()]
        (tmp_path / name / "uevent").write_text("\n".join(lines))

    put("AC", type="Mains", online=0)
    put("mouse", type="Battery", scope="Device", capacity=1, status="Discharging")
    return tmp_path, put


def test_two_batteries_are_one_and_a_mouse_is_none(supplies):
    folder, put = supplies
    assert read_battery(folder) is None
    put("BAT0", type="Battery", status="Discharging", energy_now=10, energy_full=40, power_now=20)
    put("BAT1", type="Battery", status="Not charging", energy_now=20, energy_full=20, power_now=0)

    battery = read_battery(folder)

    assert battery == Battery(charge=0.5, left_s=3600.0 * 30 / 20, mains=False)


def test_a_battery_with_capacity_only_and_one_on_mains(supplies):
    folder, put = supplies
    put("BAT0", type="Battery", status="Charging", capacity=4)

    assert read_battery(folder) == Battery(charge=0.04, left_s=None, mains=True)
    assert battery_findings(read_battery(folder)) == []
    assert read_battery(folder / "nothing") is None


@pytest.mark.parametrize(
    ("charge", "left_s", "level"),
    [
        (0.5, 3000.0, None),
        (0.12, None, "warning"),
        (0.5, 600.0, "warning"),
        (0.05, 2000.0, "error"),
    ],
)
def test_a_low_battery_gives_a_warning(charge, left_s, level):
    found = battery_findings(Battery(charge, left_s, mains=False))

    assert [one.level for one in found] == ([level] if level else [])


def test_the_battery_is_read_at_intervals():
    reads, now = [], [0.0]
    power = Power(lambda: reads.append(1), clock=lambda: now[0])

    for now[0] in (0.0, 1.0, 14.0, 15.5, 16.0):
        assert power.battery is None

    assert len(reads) == 2


def test_own_rig_files_come_first_and_a_broken_one_has_its_problem(tmp_path):
    (tmp_path / "rigs").mkdir()
    (tmp_path / "rigs" / "ours.toml").write_text(format_rig(RIG))
    (tmp_path / "broken.toml").write_text('[[sensor]]\nname = "a"\nmodel = "VLP-99"')
    (tmp_path / "pyproject.toml").write_text("[project]")

    broken, ours = rigs_in(rig_files([tmp_path]))
    shipped = shipped_rigs()

    assert "VLP-99" in broken.problem
    assert (ours.rig, ours.problem) == (str(tmp_path / "rigs" / "ours.toml"), "")
    assert ours.sensors == ["horizontal", "vertical"]
    assert [one.rig for one in shipped] == rig_presets()


def test_marks_are_read_up_to_the_line_that_was_being_written(tmp_path):
    session = CaptureSession(project=tmp_path)
    assert marks_of(session) == []
    session.marks.parent.mkdir()
    session.marks.write_text('{"t_ns": 1, "what": "point"}\n{"t_ns": 2, "wh')

    assert [one.t_ns for one in marks_of(session)] == [1]
