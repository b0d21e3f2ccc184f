"""Where the commands keep compiled kernels: code that the next process loads.

A folder that others may write is refused: what they put there would run as this user. A user
without a home, as services have, gets a private folder.
"""

from __future__ import annotations

import os

from recon4.errors import ConfigError
from recon4.locales.coded import CodedText
from recon4.sandbox.private_cache import cache_in_use, planted
from recon4.system.runtime_folder import private_folder, runtime_folder


def settle_kernel_cache() -> None:
    """Choose the folder before Numba is imported; children inherit it.

    Raises:
        ConfigError: If others may write it.
        StoreError: If there is no place for one.
    """
    cache = cache_in_use()
    if cache is None:
        folder = private_folder(runtime_folder() / "kernels")
        os.environ["NUMBA_CACHE_DIR"] = str(folder)
    elif why := planted(cache):
        raise ConfigError(CodedText("kernel-cache-others", why=why))
