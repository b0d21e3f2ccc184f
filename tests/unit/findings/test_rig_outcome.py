"""What came of comparing and calibrating a rig, in words."""

import pytest

from recon4.findings.witnesses.rig import agreement
from recon4.findings.wording import catalog, text_of
from recon4.model.calibration_figures import CalibrationOutcome, GnssOutcome, RigOutcome
from recon4.model.finding import Level
from recon4.model.finding_kinds import FindingKind

OBSERVED = ("consistent", "consistent", "not observable")


def test_a_rig_that_agrees_says_what_the_walk_does_not_show():
    found = agreement(CalibrationOutcome(rig=RigOutcome.AGREES), OBSERVED)

    assert (found.kind, found.level) == (FindingKind.RIG_AGREES, Level.GOOD)
    assert text_of(found) == (
        "Rig: the file agrees with the recording. 1 of 3 parameters are not observable."
    )


def test_parameters_that_speak_against_a_calibration_are_named():
    outcome = CalibrationOutcome(
        rig=RigOutcome.OTHER_VALUES,
        names=("rear rotation z", "imu clock"),
        gnss=GnssOutcome.OTHER_VALUES,
        gnss_names=("position x",),
    )

    found = agreement(outcome, ("off",))

    assert (found.kind, found.level) == (FindingKind.RIG_NOT_COMPARED, Level.NOTE)
    assert text_of(found) == (
        "Rig: inconclusive: another part of the walk gives other values. It is about: rear "
        "rotation z, imu clock. GNSS: inconclusive: another part of the walk gives other values. "
        "It is about: position x."
    )


@pytest.mark.parametrize("outcome", [*RigOutcome, *(one for one in GnssOutcome if one)])
def test_every_outcome_has_its_words(outcome):
    assert catalog().word(outcome) != outcome


def test_a_sentence_of_an_earlier_project_is_said_as_it_is():
    assert text_of(agreement("the rig file differs", ())) == "the rig file differs."
