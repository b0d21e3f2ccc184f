"""No maker outlives the test that started it."""

import pytest

from recon4.orders import on_worker


@pytest.fixture(autouse=True)
def _no_makers_left():
    yield
    for maker in on_worker._idle:
        maker.end()
    on_worker._idle.clear()
