"""Large blocks go back to the system when they are freed."""

import os
import subprocess
import sys

import pytest

_CHILD = """
import ctypes, os, sys
if sys.argv[2:] != ["below"]:  # addresses that are not random: nothing lies above the heap
    ctypes.CDLL(None).personality(0x0040000)
    os.execv(sys.executable, [*sys.orig_argv, "below"])
import numpy as np
from recon4.sandbox.freed_memory import return_freed_memory

def held_mb():
    for line in open("/proc/self/status"):
        if line.startswith("RssAnon"):
            return int(line.split()[1]) / 1024

np.ones(3_900_000)  # 31 MB, freed: glibc keeps blocks of this size from now on
if sys.argv[1] == "returned":
    return_freed_memory()
before = held_mb()
blocks = [np.ones(1_000_000) for _ in range(30)]
del blocks[:-1]
print(held_mb() - before)
"""


glibc = pytest.mark.skipif(
    not getattr(os, "confstr_names", {}).get("CS_GNU_LIBC_VERSION"), reason="mallopt is of glibc"
)


@glibc
def test_freed_blocks_below_a_used_one_are_returned():
    assert _held_mb("kept") > 100.0, "what the C library does by itself"
    assert _held_mb("returned") < 20.0


def _held_mb(mode):
    tuned = ("MALLOC_", "GLIBC_TUNABLES")
    env = {name: value for name, value in os.environ.items() if not name.startswith(tuned)}
    command = [sys.executable, "-c", _CHILD, mode]
    return float(subprocess.check_output(command, text=True, env=env))


_REUSE = """
import resource
import numpy as np
from recon4.sandbox.freed_memory import return_freed_memory

return_freed_memory()
def batch():
    columns = [np.ones(300_000) for _ in range(4)]  # 2.4 MB each, as points of a tenth of a second
batch()
before = resource.getrusage(resource.RUSAGE_SELF).ru_minflt
for _ in range(20):
    batch()
print(resource.getrusage(resource.RUSAGE_SELF).ru_minflt - before)
"""


@glibc
def test_a_batch_of_points_takes_the_memory_of_the_one_before_it():
    faults = int(subprocess.check_output([sys.executable, "-c", _REUSE], text=True))

    assert faults < 2000  # 47 000 pages if each batch takes new ones
