"""Why the map has no place on earth, as the finding says it."""

import pytest

from recon4.findings.walk_record import WalkRecord
from recon4.findings.witnesses.placing import Gnss
from recon4.findings.wording import text_of
from recon4.model.figures import FrameFigures, LevelFigures
from recon4.model.finding import Finding

FRAMES = FrameFigures(multiframes=10, points=1, rig="backpack", imu=True, gnss=True)


def finding_of(**georeference: object) -> Finding:
    reason = str(georeference["reason"])
    level = LevelFigures(leveled_by="imu", tilt_deg=0.0, crs="", local=reason)
    record = {"georeference": {"georeferenced": False} | georeference}
    (found,) = Gnss().check(WalkRecord(frames=FRAMES, level=level, georeference=record))
    return found


@pytest.mark.parametrize(
    ("georeference", "text"),
    [
        ({"reason": "switched-off"}, "the map is local: GNSS is switched off (gnss.enabled)."),
        (
            {"reason": "few-fixes", "fixes": 30, "fixes_usable": 3},
            "the map is local: too few fixes are usable. Of 30 fixes 3 are usable.",
        ),
        (
            {
                "reason": "no-agreement",
                "fixes": 30,
                "fixes_usable": 20,
                "fixes_agreeing": 4,
                "extent_m": 1.26,
                "beside_m": 55.04,
            },
            "the map is local: too few fixes agree with the trajectory. Of 30 fixes 20 are usable. "
            "4 of them agree, over 1.3 m. Fixes lie up to 55.0 m beside the trajectory: either the "
            "trajectory or GNSS is wrong.",
        ),
    ],
)
def test_the_reason_is_said_with_the_figures_that_are_known(georeference, text):
    assert text_of(finding_of(**georeference)) == f"The positions were not used, {text}"


def test_a_reason_that_an_earlier_version_wrote_is_said_as_it_stands():
    text = text_of(finding_of(reason="3 usable fixes of 30", fixes=30))

    assert text == "The positions were not used, the map is local: 3 usable fixes of 30."
