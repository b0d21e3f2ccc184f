import pytest

from recon4.model.calibration_figures import GNSS, IMU, CalibrationFigures, ParameterFigures


@pytest.mark.parametrize(
    ("sensor", "quantity", "unit", "change", "is_severe"),
    [
        ("vertical", "position", "m", 0.05, True),
        ("vertical", "position", "m", 0.02, False),
        (IMU, "rotation", "rad", 0.02, True),
        (IMU, "clock", "s", 0.02, True),
        (IMU, "position", "m", 0.05, False),
        (GNSS, "position", "m", 0.14, False),
    ],
)
def test_only_what_doubles_walls_is_severe(sensor, quantity, unit, change, is_severe):
    row = ParameterFigures(
        sensor=sensor, quantity=quantity, axis="z", unit=unit, change=change, sd=0.001, status="off"
    )

    assert CalibrationFigures(parameters=(row,)).is_severe == is_severe
