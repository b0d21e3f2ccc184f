"""What an estimate says of a parameter depends on how many windows it comes from."""

from dataclasses import replace

import numpy as np
import pytest

from recon4.calibration.equations import Fit
from recon4.calibration.held_out import contradicted_beams, refusal
from recon4.calibration.joint import JointEstimate
from recon4.calibration.judgment import judge
from recon4.calibration.parameters import Parameters
from recon4.geometry.se3 import SE3
from recon4.model.beams import BeamCorrections
from recon4.model.calibration_figures import CalibrationFigures, RigOutcome
from tests.room_walks import rig_of
from tests.said import rig_texts

FIT = Fit(points=1000, shared_points=500, rms_m=0.01, offset_m=0.001, imu_rms=1.0)


def estimate(turn_deg, sd_deg, *, windows, formal_deg=0.001):
    """A LiDAR that is turned about y, known by the scatter of some windows."""
    rig = rig_of(SE3.identity(), SE3.identity())
    parameters = Parameters.of(rig, reference=0, lidars=(1,), imu=False)
    change = np.deg2rad([0.0, turn_deg, 0.0, 0.0, 0.0, 0.0, 0.0])
    formal, scatter = (np.full(7, np.deg2rad(value)) for value in (formal_deg, sd_deg))
    return JointEstimate(rig, parameters, change, formal, scatter, (FIT,) * windows)


@pytest.mark.parametrize(("windows", "status"), [(4, "not observable"), (24, "off")])
def test_few_windows_show_their_own_scatter_only_roughly(windows, status):
    rows = judge(estimate(0.91, 0.22, windows=windows))

    assert rows[1].status == status
    assert bool(rig_texts(CalibrationFigures(parameters=rows))) == (status == "off")


def test_a_large_error_is_found_by_few_windows():
    rows = judge(estimate(1.4, 0.04, windows=4))

    assert rows[1].status == "off"
    (text,) = rig_texts(CalibrationFigures(parameters=rows))
    assert "rotation differs by 1.40° ± 0.04°, mostly about y" in text


def test_formal_deviations_are_known():
    rows = judge(estimate(0.5, 0.01, windows=4, formal_deg=0.15))

    assert rows[1].status == "off"


def test_a_change_that_may_be_noise_does_not_confirm_the_rig_file():
    rows = judge(estimate(0.39, 0.09, windows=4))

    assert rows[1].status == "not observable"
    assert rows[0].status == "consistent"


def beams_of(rows):
    """An estimate of the beams of one LiDAR: rows of range, elevation, azimuth, (3, 16)."""
    rig = rig_of(SE3.identity())
    parameters = Parameters.of(rig, reference=0, lidars=(), imu=False).with_beams(rig, {0: 16})
    sensor = replace(rig.sensors[0], beams=BeamCorrections.of(rows))
    known = np.full(len(parameters), 1e-5)
    found = replace(rig, sensors=(sensor,))
    return JointEstimate(found, parameters, rows.ravel(), known, known, (FIT,) * 8)


@pytest.mark.parametrize(("wrong", "kept"), [(1, 1), (4, 4), (5, 0)])
def test_single_beams_that_another_part_of_the_walk_contradicts_keep_their_values(wrong, kept):
    one, other = np.zeros((3, 16)), np.zeros((3, 16))
    one[0, 5] = other[0, 5] = 0.005
    other[1, :wrong] = np.deg2rad(0.1)
    first, second = beams_of(one), beams_of(other)

    found = contradicted_beams(first, second)

    assert found.sum() == kept
    assert found[16 : 16 + kept].all()
    refused = refusal(judge(first, not_observable=found), first, second)
    if kept:
        assert refused is None or refused.rig is not RigOutcome.OTHER_VALUES
    else:
        assert refused.rig is RigOutcome.OTHER_VALUES
        assert refused.names[0] == "s0 beam elevation 0"


def test_without_another_part_of_the_walk_no_beam_is_contradicted():
    assert not contradicted_beams(beams_of(np.zeros((3, 16))), None).any()
