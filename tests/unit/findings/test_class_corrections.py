"""Corrections of classes that no longer fit the map are named."""

from msgspec.structs import replace

from recon4.findings.walk_record import WalkRecord
from recon4.findings.witnesses.class_corrections import ClassCorrections
from recon4.findings.wording import text_of
from recon4.model.figures import CorrectedClass, MapFigures
from recon4.model.finding import Level

ONE = CorrectedClass(
    id="0123456789ab",
    to="moving",
    who="Eva",
    why="",
    time="2026-11-27T12:00:00+00:00",
    points_then=1200,
    points=1180,
    applied=True,
    moved_m=0.003,
    apart_m=0.002,
    place_m=(4.0, 1.0, 1.5),
)


def found(one):
    figures = MapFigures(points=9, bounds_m=((0.0, 0.0, 0.0), (1.0, 1.0, 1.0)), corrections=(one,))
    return list(ClassCorrections().check(WalkRecord(map=figures)))


def test_a_correction_that_applies_where_it_was_made_is_no_finding():
    assert found(ONE) == []
    assert list(ClassCorrections().check(WalkRecord())) == []


def test_one_that_followed_its_points_is_noted():
    (note,) = found(replace(ONE, moved_m=0.4))

    assert note.level is Level.NOTE
    assert "has moved by 40" in text_of(note)
    assert "changes 1\u202f180 of them (1\u202f200 then)" in text_of(note)


def test_one_without_effect_is_named_with_its_reason():
    apart = replace(ONE, points=0, applied=False, moved_m=2.0, apart_m=0.31)
    texts = []
    for one in (apart, replace(apart, moved_m=None, apart_m=None), replace(ONE, points=0)):
        (check,) = found(one)
        assert check.level is Level.CHECK
        texts.append(text_of(check))

    assert "moved by 31" in texts[0]
    assert "no longer has the times" in texts[1] and "moved by" not in texts[1]
    assert "No point in its volume" in texts[2] and "moved by" not in texts[2]
