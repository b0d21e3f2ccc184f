"""Arrays on disk: exact if intact, a StoreError otherwise."""

import numpy as np
import pytest

from recon4.errors import StoreError
from recon4.store.arrays import load_arrays


@pytest.fixture
def whole(tmp_path):
    path = tmp_path / "steps.npz"
    np.savez(path, t_ns=np.arange(500), t_m=np.ones((500, 3)))
    return path


def test_named_arrays_come_back_bit_for_bit(whole):
    found = load_arrays(whole, ["t_m", "t_ns"])

    assert list(found) == ["t_m", "t_ns"]
    assert np.array_equal(found["t_ns"], np.arange(500))


@pytest.mark.parametrize("kept", [0, 3, 100, 2000, -30, -1])
def test_a_file_cut_off_anywhere_is_one_error(whole, kept):
    whole.write_bytes(whole.read_bytes()[:kept])

    with pytest.raises(StoreError, match=r"steps\.npz"):
        load_arrays(whole, ["t_ns", "t_m"])


@pytest.mark.parametrize("at", [200, 5000, 14000])
def test_altered_bytes_are_one_error(whole, at):
    content = bytearray(whole.read_bytes())
    content[at] ^= 0xFF
    whole.write_bytes(content)

    with pytest.raises(StoreError, match=r"steps\.npz"):
        load_arrays(whole, ["t_ns", "t_m"])


def test_a_missing_file_a_missing_name_and_a_lone_array_are_one_error(whole, tmp_path):
    lone = tmp_path / "lone.npz"
    np.save(tmp_path / "lone.npy", np.ones(3))
    (tmp_path / "lone.npy").rename(lone)

    for path, name in ((tmp_path / "none.npz", "t_ns"), (whole, "speed"), (lone, "t_ns")):
        with pytest.raises(StoreError, match=path.name):
            load_arrays(path, [name])
