"""The suffix of a file name must match its format."""

from pathlib import Path

import pytest

from recon4.errors import ConfigError
from recon4.export.names import check_name


@pytest.mark.parametrize(
    ("name", "ending", "text"),
    [
        ("x.copc.laz", ".laz", "this is a plain LAZ file"),
        ("X.COPC.LAZ", ".laz", "this is a plain LAZ file"),
        ("x.laz", ".copc.laz", r"must be named \.copc\.laz"),
        ("X.SPLAT.PLY", ".ply", r"use X\.ply"),
        ("x.las", ".laz", r"must be named \.laz"),
        ("x.cog.tif", ".tif", r"use x\.tif"),
        ("x", ".ply", r"must be named \.ply"),
    ],
)
def test_a_name_of_another_format_is_refused(name: str, ending: str, text: str) -> None:
    with pytest.raises(ConfigError, match=text):
        check_name(Path(name), ending)


@pytest.mark.parametrize("name", ["x.laz", "X.LAZ", "walk.2026.laz", "copc.laz"])
def test_a_plain_name_passes(name: str) -> None:
    check_name(Path(name), ".laz")
