"""What the status of a job says while the kernels are compiled before it."""

import sys

from recon4.model.events import WorkProgress
from recon4_app.jobs import compiling
from recon4_app.jobs.events import read_events


def test_the_status_of_a_job_says_that_kernels_are_compiled_before_it(monkeypatch, tmp_path):
    monkeypatch.setattr(compiling, "is_compiled", lambda: False)
    monkeypatch.setattr(
        compiling, "_start", lambda: compiling.subprocess.Popen([sys.executable, "-c", ""])
    )

    compiling.compile_kernels_once(tmp_path)

    events, _ = read_events(tmp_path / "events.jsonl", 0)
    assert [one.what for one in events if isinstance(one, WorkProgress)] == ["compile"]
    assert (tmp_path / "heartbeat").exists()
