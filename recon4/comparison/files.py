"""Names of the files of a comparison, beside its LAZ file; imports nothing."""

from __future__ import annotations

POINTS_FILE = "points.bin"
"""`recon4.comparison.write.POINT` of every core point."""
FIGURES_FILE = "figures.json"
"""`recon4.comparison.records.MapDifferences`."""
