"""A map that decisions would hardly move says so."""

from recon4.findings.walk_record import WalkRecord
from recon4.findings.witnesses.loops import Decisions
from recon4.findings.wording import text_of
from recon4.model.figures import LevelFigures, MovedFigures
from recon4.model.finding import Level
from recon4.model.finding_kinds import FindingKind


def found(held):
    level = LevelFigures(leveled_by="imu", tilt_deg=0.0, crs="", local="no GNSS", held=held)
    return list(Decisions().check(WalkRecord(level=level)))


def test_a_move_that_the_map_does_not_follow_is_noted():
    (note,) = found(MovedFigures(moved_m=0.0031, turned_rad=1e-4))

    assert (note.kind, note.level) == (FindingKind.REVIEW_HELD, Level.NOTE)
    assert "0.3 cm" in text_of(note).replace("\u202f", " ").replace("\xa0", " ")


def test_a_map_that_follows_or_does_not_move_says_nothing():
    assert found(None) == []
    assert found(MovedFigures(moved_m=2e-16, turned_rad=0.0)) == []
    assert list(Decisions().check(WalkRecord())) == []
