"""Records of plain values in threads, at the first use of their types."""

import re
import subprocess
import sys
from pathlib import Path

SOURCES = [Path(__file__).parents[2] / room for room in ("recon4", "app")]
MADE = re.compile(r"\bmsgspec\.(convert|json\.decode)\(")
FIRST_USE = """
import sys, threading
from types import ModuleType
from recon4.untrusted.typed import as_type, decoded

sys.setswitchinterval(1e-6)
FIELDS = "".join(f"    a{k}: int | None = None\\n" for k in range(12))


def records(kind):
    module = sys.modules[f"m{kind}"] = ModuleType(f"m{kind}")
    text = "from __future__ import annotations\\nimport msgspec\\n"
    text += "from dataclasses import dataclass\\n"
    head = ("class D{}(msgspec.Struct):\\n", "@dataclass\\nclass D{}:\\n")[kind % 2]
    for k in range(6):
        text += head.format(k) + FIELDS + (f"    n: D{k - 1} | None = None\\n" if k else "")
    exec(text, module.__dict__)
    return module.D5


def use(kind, ready, made):
    ready.wait()
    made.append(as_type({"a0": 1, "n": {"a1": 2}}, kind).n.a1)
    made.append(decoded('{"a0": 1, "n": {"a1": 2}}', kind).n.a1)


for k in range(300):
    kind, ready, made = records(k), threading.Barrier(4), []
    users = [threading.Thread(target=use, args=(kind, ready, made)) for _ in range(4)]
    [one.start() for one in users]
    [one.join() for one in users]
    assert made == [2] * 8, made
print("done")
"""


def test_threads_may_be_the_first_to_use_a_type():
    """msgspec alone ends the process, so it is another one."""
    done = subprocess.run(
        [sys.executable, "-c", FIRST_USE], capture_output=True, text=True, check=False
    )

    assert (done.returncode, done.stdout) == (0, "done\n"), done.stderr


def test_records_are_made_in_one_place():
    found = [
        path.name
        for room in SOURCES
        for path in room.rglob("*.py")
        if MADE.search(path.read_text("utf-8"))
    ]

    assert found == ["typed.py"]
