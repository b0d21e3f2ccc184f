"""A file is what its name says."""

from pathlib import Path

import pytest

from recon4.errors import ConfigError
from recon4.export.names import check_name


@pytest.mark.parametrize(
    ("name", "ending", "words"),
    [
        ("x.copc.laz", ".laz", r"COPC is not written; take x\.laz"),
        ("X.COPC.LAZ", ".laz", r"take X\.laz"),
        ("x.las", ".laz", r"must be named \.laz"),
        ("x.cog.tif", ".tif", r"take x\.tif"),
        ("x", ".ply", r"must be named \.ply"),
    ],
)
def test_a_name_of_another_format_is_refused(name: str, ending: str, words: str) -> None:
    with pytest.raises(ConfigError, match=words):
        check_name(Path(name), ending)


@pytest.mark.parametrize("name", ["x.laz", "X.LAZ", "walk.2026.laz", "copc.laz"])
def test_a_plain_name_passes(name: str) -> None:
    check_name(Path(name), ".laz")
