"""Heights of fixes above the ellipsoid, above sea level, and of unknown kind."""

import numpy as np
import pytest

from recon4.model.import_notes import HEIGHTS_ORTHOMETRIC as ORTHOMETRIC
from recon4.model.import_notes import HEIGHTS_UNSTATED as UNSTATED
from recon4.model.samples import GnssSamples
from recon4.recording.report import ImportReport
from recon4.recording.samples.csv_files import read_gnss_csv
from recon4.recording.samples.datagrams import SampleDecoder
from recon4.recording.samples.heights import compare_heights, height_of_gga
from tests.warned import K

SEPARATION_M = 44.2


@pytest.mark.parametrize(
    ("header", "cells", "height_m", "counted"),
    [
        ("height_m", "300", 300.0, {UNSTATED: 1}),
        ("ellipsoidal_height_m", "300", 300.0, {}),
        ("orthometric_height_m,geoid_separation_m", "250,44.2", 294.2, {}),
        ("orthometric_height_m", "250", 250.0, {ORTHOMETRIC: 1}),
        ("orthometric_height_m,geoid_separation_m", "250,", 250.0, {ORTHOMETRIC: 1}),
        ("height_m,ellipsoidal_height_m", "1,300", 300.0, {}),
    ],
)
def test_the_names_of_the_columns_say_what_heights_are_above(
    tmp_path, header, cells, height_m, counted
):
    path, report = tmp_path / "gnss.csv", ImportReport()
    path.write_text(f"t_ns,lat_deg,lon_deg,{header}\n5,50,14,{cells}\n")

    gnss = read_gnss_csv(path, report)

    assert gnss.height_m.tolist() == pytest.approx([height_m])
    assert dict(report.counts) == counted


@pytest.mark.parametrize(
    ("key", "counted"), [("height_m", {UNSTATED: 1}), ("ellipsoidal_height_m", {})]
)
def test_datagrams_have_the_same_names(key, counted):
    report = ImportReport()
    line = f'{{"t_ns": 5, "lat_deg": 49, "lon_deg": 16, "{key}": 250.5}}'

    _, gnss = SampleDecoder(report).push([5], [line.encode()])

    assert gnss.height_m.tolist() == [250.5]
    assert {name: n for name, n in report.counts.items() if "heights" in name} == counted


@pytest.mark.parametrize(
    ("separation", "height_m", "counted"),
    [(44.2, 294.2, {}), ("", 250.0, {ORTHOMETRIC: 1}), (0.0, 250.0, {UNSTATED: 1})],
)
def test_a_sentence_without_the_geoid_is_counted(separation, height_m, counted):
    report = ImportReport()

    assert height_of_gga(250.0, separation, report) == pytest.approx(height_m)
    assert dict(report.counts) == counted


def fixes(height_m, *, rate_hz, count=200):
    t_ns = np.arange(count, dtype=np.int64) * round(1e9 / rate_hz)
    none = np.full((count, 3), np.nan)
    place = np.full(count, 0.8)
    heights = np.broadcast_to(np.asarray(height_m, np.float64), count).copy()
    return GnssSamples(t_ns, place, place, heights, none, np.full(count, 4, np.uint8), none)


def test_a_file_above_sea_level_is_told_by_the_heights_in_the_recording():
    noise = np.random.default_rng(1).normal(0.0, 1.5, 20)
    recorded = fixes(294.2 + noise, rate_hz=1, count=20)
    report = ImportReport()

    compare_heights(fixes(294.2 - SEPARATION_M, rate_hz=10), recorded, report)

    (found,) = report.findings
    assert (found.kind, found.values["side"]) == (K.HEIGHTS_DIFFER, "below")
    assert found.values["separation_m"] == pytest.approx(SEPARATION_M, abs=1.0)


@pytest.mark.parametrize(
    "height_m",
    [297.0, 100.0, np.linspace(250.0, 320.0, 200), np.nan],
    ids=["a poor fix", "farther than any geoid", "heights that drift apart", "no heights"],
)
def test_other_differences_are_not_taken_for_a_geoid(height_m):
    report = ImportReport()

    compare_heights(fixes(height_m, rate_hz=10), fixes(294.2, rate_hz=1, count=20), report)

    assert not report.findings
