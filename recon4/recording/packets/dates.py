"""Calendar dates of times, as packets of several makers state them."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray


def dates_of(seconds: NDArray[np.int64]) -> NDArray[np.int64]:
    """Year, month, day, hour, minute and second of times in seconds since 1970, (N, 6)."""
    days, rest = np.divmod(np.asarray(seconds, dtype=np.int64), 86400)
    month = days.astype("datetime64[D]").astype("datetime64[M]")
    first, months = month.astype("datetime64[D]").astype(np.int64), month.astype(np.int64)
    date = (1970 + months // 12, months % 12 + 1, days - first + 1)
    return np.column_stack([*date, rest // 3600, rest // 60 % 60, rest % 60])
