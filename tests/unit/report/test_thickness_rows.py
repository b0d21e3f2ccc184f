"""The thickness of surfaces has the same words in the report as on the page of slices."""

from recon4.mapping.tiles import surface_text
from recon4.model.figures import MapFigures, PlaneThickness
from recon4.report.html import _thickness

FITTED = PlaneThickness(p50_m=0.001, p95_m=0.003, planar_coverage=0.6)
MEASURED = PlaneThickness(p50_m=0.012, p95_m=0.02, planar_coverage=0.5)


def figures(**more):
    bounds = ((0.0, 0.0, 0.0), (1.0, 1.0, 1.0))
    return MapFigures(points=9, bounds_m=bounds, **more)


def test_both_thicknesses_of_a_map_of_fitted_surfaces_are_named():
    rows = _thickness(figures(surface="fitted", thickness=FITTED, thickness_as_measured=MEASURED))

    assert rows[:2] == [
        (f"thickness σ {surface_text('fitted')}, median / p95", "0.10 / 0.30", "cm"),
        (f"thickness σ {surface_text('raw')}, median / p95", "1.20 / 2.00", "cm"),
    ]
    assert rows[2] == ("planar places", "60", "%")


def test_a_map_as_measured_has_one_thickness_and_a_map_without_figures_none():
    (row, _) = _thickness(figures(surface="raw", thickness=MEASURED))

    assert row[0] == "thickness σ as measured, median / p95"
    assert _thickness(figures()) == [] and _thickness(None) == []
