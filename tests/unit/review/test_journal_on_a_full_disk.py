"""The journal on a disk that fills up: acknowledged is kept, refused is said, never half a row."""

import os
import shutil
import subprocess
import sys

import pytest

SCRIPT = """
mount -t tmpfs -o size=400k tmpfs "$1"
exec "$2" -c "$3" "$1"
"""
WRITER = """
import os, sys
from pathlib import Path
from recon4.errors import NoSpace
from recon4.review.decisions import Decision, DecisionKind
from recon4.review.journal import append, broken, read_rows
root = Path(sys.argv[1]) / "office"
root.mkdir()
filler = root.parent / "filler"
def decide(k):
    return append(root, Decision(kind=DecisionKind.REJECT, who="anna", why=f"{k} " * 50,
                                 pair=(k, k + 300))).hash
kept, refused = [decide(0)], 0
with filler.open("wb", buffering=0) as file:
    try:
        while True: file.write(bytes(1024))
    except OSError: pass
for k in range(1, 400):
    try: kept.append(decide(k))
    except NoSpace: refused += 1
rows = read_rows(root)
print(len(kept), refused, [row.hash for row in rows] == kept, broken(rows))
filler.unlink()
kept.append(decide(400))
rows = read_rows(root)
print([row.hash for row in rows] == kept, broken(rows))
"""


def can_mount():
    if os.geteuid() != 0 or not shutil.which("unshare"):
        return False
    tried = ["unshare", "-m", "mount", "-t", "tmpfs", "tmpfs", "/mnt"]
    return subprocess.run(tried, capture_output=True, check=False).returncode == 0


@pytest.mark.skipif(not can_mount(), reason="mounts a small disk")
def test_what_was_acknowledged_on_a_full_disk_is_kept_and_the_rest_refused(tmp_path):
    done = subprocess.run(
        ["unshare", "-m", "sh", "-c", SCRIPT, "sh", str(tmp_path), sys.executable, WRITER],
        capture_output=True,
        text=True,
        timeout=120,
        check=False,
    )
    full, freed = done.stdout.splitlines() or ("", done.stderr)
    kept, refused, rest = full.split(" ", 2)

    assert rest == "True []", done.stdout + done.stderr
    assert int(kept) >= 1 and int(refused) > 0 and int(kept) + int(refused) == 400
    assert freed == "True []"
