"""Commands that read files of users, taken over by such a file: nothing gets out or is changed.

Each command is run as by a user; in place of the function that reads the file runs the attack.
Figure to hold: 0 of 6 reaches by any of the 9 commands.
"""

from __future__ import annotations

import json
import os
import subprocess
import sys
from pathlib import Path

import pytest

from recon4.recording.formats.scratch import sweep_scratch
from recon4.sandbox import available_barriers
from tests.first_variants import all_but_first_are_studies
from tests.service.running import ROOT

pytestmark = pytest.mark.skipif(
    not {"files", "calls"} <= {barrier.name for barrier in available_barriers() if barrier.holds},
    reason="this kernel has no Landlock or no seccomp",
)

COMMANDS = {
    "info": ("recon4.recording.info.describe.describe", ["info", "in/a.pcap"]),
    "process": ("recon4.pipeline.process", ["process", "in/a.pcap", "--out", "out"]),
    "export": ("recon4.export.map_files.export_map", ["export", "in", "out/a.laz"]),
    "slice": ("recon4.store.project.read_artifacts", ["slice", "in", "out/a.laz", "--z", "1"]),
    "doubles": ("recon4.store.project.read_artifacts", ["doubles", "in"]),
    "verify": ("recon4.archive.verify.verify", ["verify", "out"]),
    "storage": ("recon4.archive.space.stored_parts", ["storage", "out"]),
    "calibrate": (
        "recon4.recording.sources.require_files",
        ["calibrate", "in/a.pcap", "--rig", "4recon", "--out", "out/rig.toml"],
    ),
    "evaluate": (
        "recon4.evaluation.evaluate.evaluate",
        ["evaluate", "in/a.tum", "--truth", "in/b.tum", "--report", "out/a.html"],
    ),
}
WRITES_NOTHING = {"info", "doubles"}

ATTACK = """
import importlib, json, mmap, os, socket, subprocess, sys
from pathlib import Path
PRIVATE = mmap.MAP_PRIVATE | mmap.MAP_ANONYMOUS | 0x4000  # MAP_NORESERVE: ask no heuristic
from recon4.errors import Recon4Error
from recon4.sandbox import private_cache
private_cache.is_compiled = lambda: True
module, _, function = sys.argv.pop(1).rpartition(".")

def tried(reach):
    try:
        reach()
    except OSError:
        return False
    return True

def attack(*_, **__):
    places = {
        "socket": lambda: socket.socket().close(),
        "program": lambda: subprocess.run(["/bin/true"]),
        "write": lambda: Path("beside").write_text("x"),
        "change": lambda: Path("in/a.pcap").write_text("x"),
        "memory": lambda: mmap.mmap(-1, 1 << 40, flags=PRIVATE).close(),
        "results": lambda: Path("out/result").write_text("x"),
    }
    found = {name: tried(reach) for name, reach in places.items()}
    found["secret"] = "SECRET" in os.environ
    print(json.dumps(found), flush=True)
    raise Recon4Error("attacked")

setattr(importlib.import_module(module), function, attack)
from recon4.__main__ import main
main()
"""
ONE_THREAD = dict.fromkeys(("OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS", "MKL_NUM_THREADS"), "1")


@pytest.fixture
def place(tmp_path):
    for name in ("in", "out", "tmp"):
        (tmp_path / name).mkdir()
    for name in ("a.pcap", "a.tum", "b.tum"):
        (tmp_path / "in" / name).write_text("before")
    return tmp_path


@pytest.mark.parametrize("command", all_but_first_are_studies(COMMANDS, first=3))
def test_a_command_that_a_file_took_over_reaches_nothing(command: str, place: Path) -> None:
    function, arguments = COMMANDS[command]
    environment = {
        **os.environ,
        **ONE_THREAD,
        "PYTHONPATH": str(ROOT),
        "TMPDIR": str(place / "tmp"),
    }
    environment |= {"SECRET": "token"}

    ended = subprocess.run(
        [sys.executable, "-c", ATTACK, function, *arguments],
        cwd=place,
        env=environment,
        capture_output=True,
        text=True,
        timeout=600.0,
        check=False,
    )

    found = json.loads(ended.stdout or "{}")
    assert found.pop("results") == (command not in WRITES_NOTHING), ended.stderr
    assert not any(found.values()), found
    assert (place / "in" / "a.pcap").read_text() == "before"
    assert ended.returncode == 1
    assert ended.stderr.strip() == "recon4: attacked"


def test_a_command_leaves_nothing_that_the_next_does_not_remove(place, monkeypatch):
    environment = {**os.environ, "PYTHONPATH": str(ROOT), "TMPDIR": str(place / "tmp")}
    command = [sys.executable, "-m", "recon4", "info", "in/a.pcap"]

    subprocess.run(command, cwd=place, env=environment, capture_output=True, check=False)

    monkeypatch.setattr("tempfile.tempdir", str(place / "tmp"))
    (left,) = (place / "tmp").glob("*/*")
    assert [path.name for path in left.iterdir()] == ["lock"]
    assert sweep_scratch() == 1
    assert not list((place / "tmp").glob("*/*"))


NOT_COMPILED = """
import sys
from recon4.sandbox import private_cache
private_cache.is_compiled = lambda: False
from recon4.__main__ import main
main()
"""


def test_the_first_command_has_another_process_compile_and_is_confined(place):
    """Here the other process finds them compiled."""
    environment = {**os.environ, **ONE_THREAD, "PYTHONPATH": str(ROOT)}

    ended = subprocess.run(
        [sys.executable, "-c", NOT_COMPILED, "process", "in/a.pcap", "--out", "new/place"],
        cwd=place,
        env=environment,
        capture_output=True,
        text=True,
        check=False,
    )

    first, *others = ended.stderr.splitlines()
    assert first.startswith("compiling the kernels: once after an installation")
    assert "no reader recognizes it" in others[-1]
    assert not any("not compiled" in line for line in others)
    assert not (place / "new").exists()


def test_a_failed_command_leaves_no_folder_that_it_made(place):
    """A confined process cannot remove the folder that it was given to write."""
    environment = {**os.environ, **ONE_THREAD, "PYTHONPATH": str(ROOT)}
    environment |= {"TMPDIR": str(place / "tmp")}

    ended = subprocess.run(
        [sys.executable, "-m", "recon4", "process", "in/a.pcap", "--out", "new/place"],
        cwd=place,
        env=environment,
        capture_output=True,
        text=True,
        check=False,
    )

    assert "no reader recognizes it" in ended.stderr
    assert ended.returncode == 1
    assert sorted(path.name for path in place.iterdir()) == ["in", "out", "tmp"]


ROUNDED = """
import sys
import numpy as np
from pathlib import Path
from recon4.sandbox import Policy, confine
if sys.argv[1:]:
    confine(Policy(read=(Path("/"),), temporary=Path(sys.argv[1])))
from scipy.linalg import inv  # as in a command: numpy before, SciPy after
print(inv(np.random.default_rng(0).normal(size=(40, 40))).tobytes().hex())
"""


def test_a_confined_process_rounds_as_any_other(place):
    """Who chooses the instructions of BLAS has them chosen for the libraries loaded later, too."""
    environment = {**os.environ, **ONE_THREAD, "PYTHONPATH": str(ROOT)}
    environment |= {"OPENBLAS_CORETYPE": "Nehalem"}  # older than any machine of today

    found = {
        subprocess.run(
            [sys.executable, "-c", ROUNDED, *arguments],
            env=environment,
            stdout=subprocess.PIPE,
            check=True,
        ).stdout
        for arguments in ([], [str(place / "tmp")])
    }

    assert len(found) == 1
