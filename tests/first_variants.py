"""Variants of one test: some run in ``make test``, the others in ``make studies``."""

from __future__ import annotations

from collections.abc import Iterable
from typing import Any

import pytest


def all_but_first_are_studies(variants: Iterable[Any], *, first: int = 1) -> list[Any]:
    """Parameters of a test of which only the first ones are worth their time on every change."""
    return [
        pytest.param(one, marks=[pytest.mark.study] if k >= first else [])
        for k, one in enumerate(variants)
    ]
