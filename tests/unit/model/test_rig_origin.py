"""What is said of the origin of a rig: serial numbers, and the age of its calibration."""

from dataclasses import replace

import pytest

from recon4.findings.walk_record import WalkRecord
from recon4.findings.witnesses.rig import RigAge
from recon4.model.rig import RigCalibration, load_rig
from recon4.model.rig_origin import RigOrigin
from recon4.settings.calibration import RigSettings
from recon4.settings.reads import AuditReads
from tests.said import texts

NOON_2026_11_22_NS = 1_795_348_800_000_000_000
NOTE = RigCalibration(date="2026-11-12", method="joint", sd_deg=0.02, sd_mm=1.1, sd_ms=0.1)


def origin(note=NOTE, *, recorded_ns=NOON_2026_11_22_NS, most=30):
    first, second = load_rig("4recon").sensors
    sensors = (replace(first, serial="AF17"), second)
    rig = replace(load_rig("4recon"), sensors=sensors, calibration=note)
    return RigOrigin.of(rig, recorded_ns=recorded_ns, max_age_days=most)


def test_serial_numbers_and_age_are_reported():
    found = origin()

    assert [(one.name, one.serial) for one in found.sensors] == [
        ("horizontal", "AF17"), ("vertical", "")
    ]  # fmt: skip
    assert found.age_days == 10
    assert not found.is_old


@pytest.mark.parametrize(("most", "old"), [(9, True), (10, False)])
def test_a_rig_older_than_the_set_age_is_mentioned(most, old):
    rig = replace(load_rig("4recon"), calibration=NOTE)

    reads = AuditReads(rig=RigSettings(max_age_days=most))
    walk = WalkRecord(settings=reads, rig=rig, recorded_ns=NOON_2026_11_22_NS)
    said = texts(RigAge().check(walk))

    assert origin(most=most).is_old is old
    assert any("calibrated on 2026-11-12, 10 days before the walk" in text for text in said) is old


@pytest.mark.parametrize("given", [{"note": None}, {"recorded_ns": 5_000_000_000}])
def test_without_a_date_there_is_no_age(given):
    found = origin(**given)

    assert found.age_days is None
    assert not found.is_old
