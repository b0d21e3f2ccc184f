"""The environment of a child: an allow-list, because secrets live in environments."""

from __future__ import annotations

import os
import sys
from collections.abc import Mapping

from recon4.sandbox.kernel import threads_of_this_process

ALLOWED = frozenset(
    {"PATH", "HOME", "USER", "LOGNAME", "LANG", "LANGUAGE", "TZ", "TMPDIR", "VIRTUAL_ENV"}
    | {"PYTHONPATH", "PYTHONHOME", "PYTHONSAFEPATH", "PYTHONHASHSEED", "PYTHONUNBUFFERED"}
    | {"PYTHONDONTWRITEBYTECODE", "PYTHONPYCACHEPREFIX", "PYTHONUTF8", "PYTHONNOUSERSITE"}
    | {"LD_LIBRARY_PATH", "DYLD_LIBRARY_PATH", "PROJ_DATA", "PROJ_LIB", "PROJ_NETWORK"}
    | {"NUMBA_CACHE_DIR", "NUMBA_NUM_THREADS", "NUMBA_CPU_NAME", "NUMBA_CPU_FEATURES"}
    | {"NUMBA_DISABLE_JIT", "OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS", "MKL_NUM_THREADS"}
    | {"OPENBLAS_CORETYPE", "OPENBLAS_L2_SIZE", "NPY_DISABLE_CPU_FEATURES"}
    | {"MPLCONFIGDIR", "XDG_CACHE_HOME", "XDG_CONFIG_HOME"}
    | {"RECON4_LANGUAGE", "TERM", "COLORTERM", "COLUMNS", "LINES", "NO_COLOR", "FORCE_COLOR"}
)
"""Variables a child needs to find its programs, libraries, language and number of threads.

Those that choose instructions of the processor must not be lost either: libraries loaded after the
loss would round differently from those before, and from the same work in another process.
"""


ONE_THREAD = dict.fromkeys(("OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS", "MKL_NUM_THREADS"), "1")
"""One thread per library: processes do not compete, and `confine` runs before threads start."""


def allowed_environment(variables: Mapping[str, str]) -> dict[str, str]:
    """The variables passed to a child; others may contain passwords, keys and addresses."""
    return {
        name: value
        for name, value in variables.items()
        if name in ALLOWED or name.startswith("LC_")
    }


def restart_with_one_thread() -> None:
    """Restart this program with one thread per library, if libraries started threads already.

    `confine` must come before other threads; a process started by hand need not care.
    """
    if threads_of_this_process() > 1 and not ONE_THREAD.items() <= os.environ.items():
        os.environ |= ONE_THREAD
        os.execv(sys.executable, [sys.executable, *sys.orig_argv[1:]])
