"""Fixtures every test may use."""

import os
from collections.abc import Callable
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[1]
DATA = Path(os.environ.get("RECON4_DATA") or ROOT.parent / "shared" / "data")


@pytest.fixture(scope="session")
def data() -> Callable[[str], Path]:
    """``data("packets/mrpt")`` is that set of real recordings, or the test is skipped.

    Where the sets are supposed to be (``CI=true`` and the folder is there) a missing one fails.
    """

    def find(name: str) -> Path:
        path = DATA / name
        if path.exists():
            return path
        if os.environ.get("CI") == "true" and DATA.exists():
            pytest.fail(f"real data {name} is missing in {DATA}")
        pytest.skip(f"needs real data {name} in {DATA} (set RECON4_DATA)")

    return find
