"""What may be said of the accuracy of a map at its check points."""

from msgspec.structs import replace

from recon4.evaluation.site_control import (
    ControlOutcome,
    ControlRow,
    Offset,
    PointTest,
    outcome_text,
    statements,
)

FLAT: Offset = (0.03, 0.04, None)
HEIGHT: Offset = (None, None, 0.02)


def outcome(*offsets: Offset, test: PointTest | None = None) -> ControlOutcome:
    role = "control" if test else "check"
    points = tuple(
        ControlRow(f"P{k}", role, (0.01, 0.01), off, off, test) for k, off in enumerate(offsets)
    )
    return ControlOutcome(crs="site grid", freedom=4, scale=1.0, points=points)


def test_each_accuracy_counts_the_points_that_were_measured_for_it():
    said = "\n".join(statements(outcome(*[HEIGHT] * 30, *[FLAT] * 2)))
    assert "Tested vertical positional accuracy: RMSE_V = 2.2 cm at 30 check points" in said
    assert "Estimated horizontal positional accuracy: RMSE_H = 5.2 cm at 2 check points" in said
    assert "Not tested: horizontal 2 of 30 check points." in said


def test_points_that_measure_nothing_are_within_no_limits():
    said = statements(outcome((None, None, None)))
    assert said == ["Not tested: horizontal 0 and vertical 0 of 30 check points."]


def test_a_blunder_is_named_although_a_direction_of_it_is_controlled_by_no_other_point():
    test = PointTest((0.0, 0.6, 0.6), w=9.0, limit=4.0, single_handed=True)
    assert "BLUNDER" in outcome_text(outcome(FLAT, test=test))
    german = outcome_text(outcome(FLAT, test=test), "de", ["P0 liegt falsch."])
    assert "P0 (Passpunkt)" in german and "9,0 (4,0)  GROBER FEHLER" in german
    assert german.endswith("Vermutet: P0 liegt falsch.")


def test_residuals_that_are_larger_than_stated_are_said_beyond_chance():
    test = PointTest((0.7, 0.7, 0.7), w=2.0, limit=4.0, single_handed=False)
    found = outcome(*[FLAT] * 4, test=test)  # 8 degrees of freedom: χ² at 0.1 % is 26.1
    assert "as large as stated" not in outcome_text(replace(found, sd0=1.8))
    assert "The residuals are 3.1 times as large as stated; up to 1.8" in outcome_text(
        replace(found, sd0=3.1)
    )


def test_what_is_rounded_to_zero_has_no_sign():
    assert "-0.0" not in outcome_text(outcome((-0.0004, 0.0, -0.0)))
