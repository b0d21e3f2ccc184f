"""What tests of access and pairing share."""

from __future__ import annotations

import pytest


class Clock:
    """Time as the test sets it."""

    now_s = 1_000_000.0

    def __call__(self) -> float:
        return self.now_s


@pytest.fixture
def clock() -> Clock:
    return Clock()
