"""Where kernels are compiled."""

import pytest

from recon4.sandbox.private_cache import is_compiled, mark_compiled, shared_caches


@pytest.fixture
def chosen(tmp_path, monkeypatch):
    """The folder of the kernels in a cache that the environment names."""
    monkeypatch.setenv("NUMBA_CACHE_DIR", str(tmp_path))
    return next(shared_caches())


def test_a_cache_that_is_chosen_is_filled_whatever_others_have(chosen):
    before = is_compiled(where_chosen=True)
    chosen.mkdir()
    (chosen / "points.place-10.py311.nbi").touch()
    mark_compiled()

    assert not before
    assert is_compiled(where_chosen=True)


def test_without_a_choice_every_cache_counts(monkeypatch):
    monkeypatch.delenv("NUMBA_CACHE_DIR", raising=False)

    assert is_compiled(where_chosen=True) == is_compiled()
