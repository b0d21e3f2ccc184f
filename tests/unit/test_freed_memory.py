"""Large blocks go back to the system when they are freed."""

import subprocess
import sys

import pytest

_CHILD = """
import sys
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


@pytest.mark.skipif(sys.platform != "linux", reason="RssAnon is of Linux")
def test_freed_blocks_below_a_used_one_are_returned():
    # Where something lies above the heap it cannot grow: the system takes each block back.
    if _held_mb("kept") < 100.0:
        pytest.skip("nothing is kept in this environment")

    assert _held_mb("returned") < 20.0


def _held_mb(mode):
    return float(subprocess.check_output([sys.executable, "-c", _CHILD, mode], text=True))


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


@pytest.mark.skipif(sys.platform != "linux", reason="mallopt is of glibc")
def test_a_batch_of_points_takes_the_memory_of_the_one_before_it():
    faults = int(subprocess.check_output([sys.executable, "-c", _REUSE], text=True))

    assert faults < 2000  # 47 000 pages if each batch takes new ones
