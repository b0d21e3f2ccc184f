"""Types of the cells of jobs are known before threads use them."""

import subprocess
import sys

KNOWN = """
from recon4_app.jobs import store
kinds = (store.Inputs, store.ExportedFile, store.JobReason)
print(*("__msgspec_cache__" in vars(kind) for kind in kinds))
"""


def test_the_types_of_cells_are_made_at_the_import():
    """Two threads at the first use of a dataclass ended the process: a fresh one is needed."""
    done = subprocess.run([sys.executable, "-c", KNOWN], capture_output=True, text=True, check=True)

    assert done.stdout.split() == ["True"] * 3
