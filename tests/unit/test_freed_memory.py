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
import resource, sys
import numpy as np
from recon4.sandbox.freed_memory import return_freed_memory
from recon4.sandbox.tuning import CONFINEMENT

return_freed_memory(getattr(CONFINEMENT, sys.argv[1]))
def batch():
    columns = [np.ones(int(sys.argv[2])) for _ in range(4)]
batch()
before = resource.getrusage(resource.RUSAGE_SELF).ru_minflt
for _ in range(20):
    batch()
print(resource.getrusage(resource.RUSAGE_SELF).ru_minflt - before)
"""


@glibc
@pytest.mark.parametrize(
    ("above", "numbers"), [("returned_block_bytes", "300000"), ("returned_packet_bytes", "780000")]
)
def test_a_batch_of_points_takes_the_memory_of_the_one_before_it(above, numbers):
    """Columns of 2.4 MB, as points of a tenth of a second; of 6.2 MB while packets are decoded."""
    command = [sys.executable, "-c", _REUSE, above, numbers]
    faults = int(subprocess.check_output(command, text=True))

    assert faults < 2000  # 47 000 pages if each batch takes new ones


_LIBRARIES = """
import ctypes, mmap, re, tempfile, threading
from pathlib import Path
import numpy as np
from recon4.sandbox.freed_memory import return_freed_memory

libc = ctypes.CDLL(None)
def files_mb():
    return int(re.search(r"RssFile:\\s+(\\d+)", Path("/proc/self/status").read_text())[1]) / 1024

# What the loader does: it writes a page of a file's mapping, and forbids to write it again.
file = tempfile.NamedTemporaryFile(suffix=".so")
file.write(bytes(mmap.PAGESIZE))
file.flush()
relocated = mmap.mmap(file.fileno(), mmap.PAGESIZE, access=mmap.ACCESS_COPY)
relocated[0] = 7
at = ctypes.addressof(ctypes.c_char.from_buffer(relocated))
assert libc.mprotect(ctypes.c_void_p(at), ctypes.c_size_t(mmap.PAGESIZE), mmap.PROT_READ) == 0

np.linalg.eigh(np.eye(3))
before = files_mb()
return_freed_memory()
after = files_mb()

def allocate():
    blocks = [bytes(2000) for _ in range(100)]
for thread in [threading.Thread(target=allocate) for _ in range(4)]:
    thread.start()
    thread.join()
with tempfile.NamedTemporaryFile() as info:
    libc.fopen.restype = ctypes.c_void_p
    opened = ctypes.c_void_p(libc.fopen(info.name.encode(), b"w"))
    libc.malloc_info(0, opened)
    libc.fclose(opened)
    arenas = Path(info.name).read_text().count("<heap nr")
print(before, after, relocated[0], arenas, np.linalg.eigh(np.eye(3))[0].sum())
"""


@glibc
def test_pages_of_libraries_are_returned_but_not_what_the_loader_wrote_and_threads_share_a_heap():
    said = subprocess.check_output([sys.executable, "-c", _LIBRARIES], text=True).split()
    before_mb, after_mb, written, arenas, works = map(float, said)

    assert after_mb < 0.5 * before_mb
    assert written == 7
    assert arenas == 1
    assert works == 3.0
