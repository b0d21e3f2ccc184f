"""Rounding to float16 as numpy does, without its cost near zero."""

import numpy as np

from recon4.mapping.tile import as_half
from recon4.mapping.tile_memory import Scratch


def test_halves_are_those_of_numpy():
    halves = np.arange(1 << 16, dtype=np.uint16).view(np.float16).astype(np.float32)
    halves = halves[~np.isnan(halves)]
    finite = np.sort(halves[np.isfinite(halves)])
    between = (0.5 * (finite[1:].astype(float) + finite[:-1])).astype(np.float32)
    random = np.random.default_rng(0).normal(size=20_000).astype(np.float32)
    edges = np.array([65519.9, 65520.0, 1e9, -1e30, 1e-8, -1e-8, 2.0**-25], np.float32)
    up, down = (np.nextafter(between, np.float32(at)) for at in (1e9, -1e9))
    values = np.concatenate([halves, between, up, down, random, 1e-5 * random, edges])

    with np.errstate(over="ignore"):
        expected = values.astype(np.float16)
    assert as_half(values).tobytes() == expected.tobytes()
    assert np.isnan(as_half(np.full((2, 3), np.nan, np.float32))).all()


def test_scratch_is_the_same_memory_until_more_is_needed():
    scratch = Scratch()
    first = scratch.array("a", (100, 3), np.float32)
    first[:] = 7.0

    again, other = scratch.array("a", (50,), np.float32), scratch.array("b", (50,), np.float32)
    larger = scratch.array("a", (1000,), np.float64)

    assert np.shares_memory(first, again)
    assert not np.shares_memory(first, other)
    assert not np.shares_memory(first, larger)
    assert larger.shape == (1000,)
    assert larger.dtype == np.float64
