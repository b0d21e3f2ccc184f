"""Names that do not belong to their places, and surveys with other names than the picks."""

import numpy as np
import pytest

from recon4.errors import GeoreferenceError
from recon4.georeference.control_blunders import Blunder, BlunderKind, named_blunders
from recon4.slices.control_points import ControlPoint
from recon4.slices.measured_points import MeasuredPosition
from recon4.slices.renamed_points import renamed_points
from recon4.slices.site_control import site_control
from tests.unit.georeference.test_control_fit import PLACES, sites, surveyed, targets


def suspected(order: list[int]) -> tuple[Blunder, ...]:
    found = targets()
    other = surveyed(found, sites(found)[order])
    return renamed_points(other, named_blunders(other, leveled=True)[1])


def test_a_list_that_is_shifted_by_a_line_is_named():
    (one,) = suspected([1, 2, 3, 4, 5, 0])
    assert (one.kind, one.points[0], one.picks[0]) == (BlunderKind.RENAMED, "C1", "C2")
    assert "C1 of the survey is C2, C2 of the survey is C3" in one.text


def test_two_exchanged_pairs_are_named():
    (one,) = suspected([1, 0, 3, 2, 4, 5])
    assert dict(zip(one.points, one.picks, strict=True)) == {
        "C1": "C2", "C2": "C1", "C3": "C4", "C4": "C3",
    }  # fmt: skip


def test_other_blunders_stay_as_they_are():
    found = targets()
    p_site = sites(found)
    p_site[2] += [0.6, -0.8, 0.0]
    wrong = surveyed(found, p_site)
    blunders = named_blunders(wrong, leveled=True)[1]
    assert renamed_points(wrong, blunders) == blunders
    assert renamed_points(found, ()) == ()


def test_an_order_that_another_one_equals_is_not_named():
    square = np.array([[0.0, 0.0, 0.0], [9.0, 0.0, 0.0], [9.0, 9.0, 0.0], [0.0, 9.0, 0.0]])
    found = targets(square)
    doubt = (Blunder(kind=BlunderKind.CONTRADICTION, points=()),)
    assert renamed_points(found, doubt) == doubt


def test_a_survey_that_shares_no_name_with_the_picks_is_refused_with_both():
    points = [ControlPoint(f"P0{k}", (*row,), "control") for k, row in enumerate(PLACES.tolist())]
    picks = {f"P{k}": MeasuredPosition(row, np.eye(3)) for k, row in enumerate(PLACES)}
    with pytest.raises(GeoreferenceError, match=r"survey has P00, P01, .* …, measured are P0, P1"):
        site_control(points, picks, {})
