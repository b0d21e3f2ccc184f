"""The tests are compiled once, before the processes that run them begin."""

from __future__ import annotations

import os
import subprocess
import sys

from tools import rewritten_tests

HELD = """def test_two():
    assert 1 + 1 == 2
"""


def test_pytest_takes_what_was_compiled_and_compiles_it_no_more(tmp_path, monkeypatch):
    monkeypatch.setattr(rewritten_tests, "ROOT", tmp_path)
    file = tmp_path / "tests" / "test_sum.py"
    file.parent.mkdir()
    file.write_text(HELD)

    rewritten_tests.main()
    (kept,) = file.parent.glob("__pycache__/test_sum*.pyc")
    before = kept.stat().st_mtime_ns
    file.with_name("pytest.ini").write_text("[pytest]\n")
    command = [sys.executable, "-m", "pytest", "-q", "-p", "no:cacheprovider", str(file)]
    keeping = {key: os.environ[key] for key in os.environ if key != "PYTHONDONTWRITEBYTECODE"}
    done = subprocess.run(command, cwd=file.parent, env=keeping, capture_output=True, text=True)

    assert "1 passed" in done.stdout, done.stdout + done.stderr
    assert [one.stat().st_mtime_ns for one in file.parent.glob("__pycache__/*.pyc")] == [before]
