"""Runs of rejected fixes that agree with each other are announced; scattered ones are noise."""

import numpy as np
import pytest

from recon4.findings.placement import placement_in
from recon4.findings.walk_record import WalkRecord
from recon4.findings.wording import text_of
from recon4.model.finding import Level
from recon4.model.finding_kinds import FindingKind
from recon4.model.rejected_fixes import RejectedRun, disputed_m
from recon4.settings import preset
from tests.said import found_in


def fixes(rejected, residual_m, *, count=300):
    """A record of fixes at 10 Hz with these rows rejected."""
    used = np.ones(count, bool)
    used[rejected] = False
    residual = np.zeros((count, 3))
    residual[rejected] = residual_m
    return {
        "t_ns": (np.arange(count) * 100_000_000).tolist(),
        "used": used.tolist(),
        "residual_enu_m": residual.tolist(),
        "georeferenced": True,
    }


def gnss(record):
    return placement_in({"georeference": record}).gnss


def growing(count):
    """Fixes from which the trajectory runs away, to 3 m at last."""
    return np.column_stack([np.linspace(0.5, 3.0, count), np.zeros(count), np.full(count, 0.2)])


def test_the_last_fixes_from_which_the_trajectory_runs_away_are_a_contradiction():
    (found,) = gnss(fixes(slice(239, 300), growing(61))).rejected_runs

    assert (found.start_s, found.end_s, found.fixes) == pytest.approx((23.9, 29.9, 61))
    assert found.horizontal_m == pytest.approx(3.0)
    assert found.height_m == pytest.approx(0.2)


def test_scattered_outliers_are_noise():
    scattered = np.arange(0, 300, 15)
    jumping = np.random.default_rng(1).normal(0.0, 2.0, (40, 3))

    assert gnss(fixes(scattered, [2.0, 0.0, 0.0])).rejected_runs == []
    assert gnss(fixes(slice(100, 140), jumping)).rejected_runs == []
    assert gnss(fixes(slice(100, 108), growing(8))).rejected_runs == []


def test_without_gnss_nothing_is_contradicted():
    assert gnss({"georeferenced": False}).rejected_runs == []


def test_a_contradiction_is_a_warning_as_multipath_of_a_good_map_looks_the_same():
    record = {"georeference": fixes(slice(239, 300), growing(61))}

    found = found_in(WalkRecord(georeference=record), preset("outdoor"))

    (one,) = [one for one in found if one.kind is FindingKind.GNSS_REJECTED]
    assert one.level is Level.CHECK
    assert "61 GNSS fixes agree" in text_of(one) and "3.00 m horizontally" in text_of(one)


@pytest.mark.parametrize(
    ("fixes_rejected", "expected_m"), [(0, 0.0), (30, 0.55), (150, 3.54), (300, 5.0)]
)
def test_the_more_fixes_are_rejected_the_more_the_place_is_disputed(fixes_rejected, expected_m):
    run = RejectedRun(start_s=0.0, end_s=9.0, fixes=fixes_rejected, horizontal_m=3.0, height_m=4.0)

    found = disputed_m([run] if fixes_rejected else [], fixes=300)

    assert found == pytest.approx(expected_m, abs=0.01)
