"""The values of an array, each once."""

from __future__ import annotations

from typing import TypeVar

import numpy as np
from numpy.typing import NDArray

Number = TypeVar("Number", bound=np.generic)


def distinct(values: NDArray[Number]) -> NDArray[Number]:
    """Values in increasing order, each once, of an array of any shape, -> (N,).

    It is `numpy.unique` for large arrays of integers. That puts them into a hash table since
    NumPy 2.3, which takes 20 times as long as to sort them.
    """
    ordered = np.sort(values, axis=None)
    new = np.ones(len(ordered), bool)
    np.not_equal(ordered[1:], ordered[:-1], out=new[1:])
    return ordered[new]
