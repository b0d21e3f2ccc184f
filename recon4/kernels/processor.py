"""Which instructions the kernels are compiled for: those that all computers of a kind have.

So a kernel is the same machine code, and gives the same bytes, on every computer, and a wheel can
bring the compiled kernels with it. Numba asks for the processor's own instructions otherwise.
"""

from __future__ import annotations

import os
import sys

from llvmlite.binding import get_host_cpu_features, get_process_triple

COMMON = {
    "x86_64": ("x86-64-v3", ("avx2", "bmi", "bmi2", "f16c", "fma", "lzcnt", "movbe")),
}
"""Architecture -> its kind of processor, and the instructions that one of that kind has."""


def instructions() -> str:
    """Name of the instructions that Numba compiles for in this process; empty: the processor's."""
    if chosen := os.environ.get("NUMBA_CPU_NAME"):
        return chosen
    name, needs = COMMON.get(get_process_triple().partition("-")[0], ("", ()))
    has = get_host_cpu_features()
    return name if all(has.get(need) for need in needs) else ""


def choose_instructions() -> None:
    """Set Numba's variables, unless the user has; call before Numba compiles."""
    if "NUMBA_CPU_NAME" in os.environ or not (name := instructions()):
        return
    os.environ["NUMBA_CPU_NAME"] = name
    os.environ.setdefault("NUMBA_CPU_FEATURES", "")
    if (config := sys.modules.get("numba.core.config")) is not None:  # it read its environment
        config.__dict__["CPU_NAME"] = name
        config.__dict__["CPU_FEATURES"] = os.environ["NUMBA_CPU_FEATURES"]
