"""Reports in these tests have their charts."""

import pytest


@pytest.fixture(scope="module", autouse=True)
def _drawn(drawn):
    """Every file here is about what a report shows."""
