"""Corrections of single beams: applied exactly, composed exactly, read and written."""

import numpy as np
import pytest

from recon4.errors import ConfigError
from recon4.model.beams import BeamCorrections, beam_change
from recon4.model.rig import format_rig, parse_rig

ONE = '[[sensor]]\nname = "a"\n'


def points(range_m, elevation_rad, azimuth_rad):
    flat = range_m * np.cos(elevation_rad)
    x, y = flat * np.cos(azimuth_rad), flat * np.sin(azimuth_rad)
    return np.stack([x, y, range_m * np.sin(elevation_rad)], axis=1)


@pytest.fixture
def measured():
    rng = np.random.default_rng(1)
    count = 500
    return (
        rng.uniform(0.5, 80.0, count),
        rng.uniform(-0.3, 0.3, count),
        rng.uniform(-np.pi, np.pi, count),
        rng.integers(0, 16, count).astype(np.uint8),
    )


def drawn(seed, beams=16):
    return BeamCorrections.of(0.01 * np.random.default_rng(seed).standard_normal((3, beams)))


def test_a_correction_adds_to_range_elevation_and_azimuth(measured):
    range_m, elevation, azimuth, ring = measured
    beams = drawn(2)

    found, unknown = beams.apply(points(range_m, elevation, azimuth), ring)

    expected = points(
        range_m + beams.range_m[ring],
        elevation + beams.elevation_rad[ring],
        azimuth + beams.azimuth_rad[ring],
    )
    assert np.allclose(found, expected, atol=1e-9)
    assert unknown == 0


def test_points_in_single_precision_stay_so(measured):
    range_m, elevation, azimuth, ring = measured
    exact, beams = points(range_m, elevation, azimuth), drawn(2)

    found, _ = beams.apply(exact.astype(np.float32), ring)

    assert found.dtype == np.float32
    assert np.allclose(found, beams.apply(exact, ring)[0], atol=2e-5)


def test_a_change_of_the_table_gives_the_same_as_the_new_table(measured):
    range_m, elevation, azimuth, ring = measured
    raw, first, second = points(range_m, elevation, azimuth), drawn(3), drawn(4)

    change = beam_change(first, second)
    found, _ = change.apply(first.apply(raw, ring)[0], ring)

    assert np.allclose(found, second.apply(raw, ring)[0], atol=1e-9)
    assert beam_change(None, None) is None
    assert beam_change(first, first) is None
    assert np.allclose(beam_change(first, None).rows, -first.rows)


def test_points_of_beams_without_a_correction_stay_and_are_counted():
    raw = np.array([[3.0, 1.0, 0.5], [2.0, 0.0, 0.1]])

    found, unknown = drawn(5, beams=4).apply(raw, np.array([7, 2], np.uint8))

    assert unknown == 1
    assert np.allclose(found[0], raw[0], atol=1e-12)
    assert not np.allclose(found[1], raw[1], atol=1e-4)


def test_a_rig_file_keeps_the_corrections():
    values = [0.001 * k for k in range(16)]
    text = ONE + f"[sensor.beams]\nrange_m = {values}\nelevation_deg = {values}\n"

    rig = parse_rig(text + '[[sensor]]\nname = "b"\n', where="x")
    again = parse_rig(format_rig(rig), where="again")

    assert rig.sensors[1].beams is None and again.sensors[1].beams is None
    for one in (rig.sensors[0].beams, again.sensors[0].beams):
        assert np.allclose(one.range_m, values)
        assert np.allclose(np.rad2deg(one.elevation_rad), values)
        assert not one.azimuth_rad.any()


@pytest.mark.parametrize(
    ("table", "message"),
    [
        ("range_m = [0.1]", "range_m must be 16 finite numbers"),
        (f"range_m = {[0.0] * 15 + [0.3]}", "range_m must be within ±0.2, got 0.3 of beam 15"),
        (f"elevation_deg = {[-3.0] + [0.0] * 15}", "elevation_deg must be within ±2"),
        (f"azimuth_deg = {[2.5] + [0.0] * 15}", "azimuth_deg must be within ±2"),
        ("range_m = [nan" + ", 0.0" * 15 + "]", "16 finite numbers"),
        ("distance_m = [0.0]", "unknown"),
        ("", "expected some of range_m, elevation_deg, azimuth_deg, got none"),
    ],
)
def test_a_wrong_table_is_refused_with_its_defect(table, message):
    with pytest.raises(ConfigError, match=f"sensor 0: beams: .*{message}"):
        parse_rig(f"{ONE}[sensor.beams]\n{table}\n", where="x")


def test_the_table_of_a_generic_lidar_tells_its_number_of_beams():
    generic = ONE + 'model = "generic"\n[sensor.beams]\n'

    assert len(parse_rig(generic + "range_m = [0.0, 0.1]", where="x").sensors[0].beams) == 2
    with pytest.raises(ConfigError, match="elevation_deg must be 2 finite numbers"):
        parse_rig(generic + "range_m = [0.0, 0.1]\nelevation_deg = [0.1]", where="x")
    with pytest.raises(ConfigError, match="expected 1 to 128 beams in range_m, got 200"):
        parse_rig(generic + f"range_m = {[0.0] * 200}", where="x")


def test_a_laser_with_one_beam_has_no_table():
    text = f'{ONE}kind = "laser2d"\n[sensor.beams]\nrange_m = [0.0]\n'

    with pytest.raises(ConfigError, match="only a lidar has corrections of beams"):
        parse_rig(text, where="x")
