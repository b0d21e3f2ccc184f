"""The environment of a child: an allow-list, because secrets live in environments."""

from __future__ import annotations

from collections.abc import Mapping

ALLOWED = frozenset(
    {"PATH", "HOME", "USER", "LOGNAME", "LANG", "LANGUAGE", "TZ", "TMPDIR", "VIRTUAL_ENV"}
    | {"PYTHONPATH", "PYTHONHOME", "PYTHONSAFEPATH", "PYTHONHASHSEED", "PYTHONUNBUFFERED"}
    | {"PYTHONDONTWRITEBYTECODE", "PYTHONPYCACHEPREFIX", "PYTHONUTF8", "PYTHONNOUSERSITE"}
    | {"LD_LIBRARY_PATH", "DYLD_LIBRARY_PATH", "PROJ_DATA", "PROJ_LIB", "PROJ_NETWORK"}
    | {"NUMBA_CACHE_DIR", "NUMBA_NUM_THREADS", "NUMBA_CPU_NAME", "NUMBA_CPU_FEATURES"}
    | {"NUMBA_DISABLE_JIT", "OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS", "MKL_NUM_THREADS"}
    | {"MPLCONFIGDIR", "XDG_CACHE_HOME", "XDG_CONFIG_HOME"}
)
"""Variables a child needs to find its programs, libraries, language and number of threads."""


def allowed_environment(variables: Mapping[str, str]) -> dict[str, str]:
    """The variables a child may have; the others may hold passwords, keys and addresses."""
    return {
        name: value
        for name, value in variables.items()
        if name in ALLOWED or name.startswith("LC_")
    }
