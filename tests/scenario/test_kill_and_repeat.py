"""A run that was stopped or killed and resumed gives the same bytes, as does any other run."""

import json
import os
import signal
import subprocess
import sys
import time

import numpy as np
import pytest

from recon4.cli.main import main
from recon4.workflows.map_results import RESULTS as ALL_RESULTS
from tests.short_capture import process_short

UNFINISHED = (".tmp-", "buckets-")
"""Beginnings of the names of unfinished files and folders."""
RESULTS = sorted({*ALL_RESULTS} - {"report.html"})  # it says when it was made
ENDED_AFTER = {"odometry:": signal.SIGKILL, "graph:": signal.SIGINT, "intensity:": signal.SIGTERM}
"""Every stage of a job, by a gate: ``tests/service/test_killing.py``."""
EARLIER_AND_LATER = {
    "hash": signal.SIGTERM,
    "odometry:": signal.SIGKILL,
    "graph:": signal.SIGINT,
    "refine:": signal.SIGKILL,
    "intensity:": signal.SIGTERM,
}


def results(out):
    summary = json.loads((out / "summary.json").read_text())
    for name in RESULTS:
        assert summary["hashes"]["results"][name]
    return {name: (out / name).read_bytes() for name in RESULTS}


def assert_same(found, expected):
    for name in RESULTS:
        assert found[name] == expected[name], name


def test_the_walk_is_tracked_and_has_accepted_loops(short_project):
    summary = json.loads((short_project / "summary.json").read_text())

    assert summary["multiframes"] in {25, 26}
    assert summary["edges"]["accepted"] > 10
    assert summary["lost"] == 0


@pytest.mark.study
def test_one_thread_gives_the_bytes_of_two(short_recording, short_project, tmp_path):
    one_thread = ["--set", "graph.workers=1"]

    assert main([*process_short(short_recording, tmp_path / "one"), *one_thread]) == 0

    assert_same(results(tmp_path / "one"), results(short_project))


@pytest.mark.parametrize(
    "ended_after",
    [ENDED_AFTER, pytest.param(EARLIER_AND_LATER, marks=pytest.mark.study)],
    ids=["three", "five"],
)
def test_a_run_ended_in_many_stages_resumes_to_the_same_bytes(
    short_recording, short_project, tmp_path, ended_after
):
    """Each run is ended a random while after a stage ended, so that the next one is hit.

    The signals go to a real process. SIGKILL: no cleaning up, no last word. The others: one line,
    no traceback, no unfinished file.
    """
    rng = np.random.default_rng(5)
    out = tmp_path / "ended"
    finished = []
    for stage, sign in ended_after.items():
        run = process_short(short_recording, out)
        code, said = run_and_end(run, news=stage, seconds=rng.uniform(0.0, 0.3), sign=sign)
        finished.append(len([*(out / "artifacts").glob("[!.]*")]))
        if sign == signal.SIGKILL:
            assert code == -sign
            continue
        assert code == 128 + sign, said
        stopped = f"recon4: stopped by {sign.name}; the same command goes on"
        assert stopped in said and said.count("recon4:") == 1, said
        assert "Traceback" not in said
        assert not [path for path in out.rglob("*") if path.name.startswith(UNFINISHED)]

    assert main(process_short(short_recording, out)) == 0

    assert_same(results(out), results(short_project))
    assert len(set(finished)) >= len(ended_after) - 1, (
        f"signals should fall into different stages: {finished}"
    )
    assert not list(out.glob("**/.tmp-*"))
    assert main(["verify", str(out)]) == 0


def run_and_end(arguments, *, news, seconds, sign):
    """Start a run, wait for a line that begins with ``news``, and some time more; send a signal.

    Returns:
        Exit code, and what it said after that line.
    """
    run = subprocess.Popen(
        [sys.executable, "-m", "recon4", *arguments],
        stderr=subprocess.PIPE,
        text=True,
        env=os.environ | {"OMP_NUM_THREADS": "1"},
    )
    with run:
        assert run.stderr is not None
        said = next((line for line in run.stderr if line.startswith(news)), "")
        time.sleep(seconds)
        run.send_signal(sign)
        rest = run.stderr.read()
    assert said, f"ended before it said {news!r}: {rest}"
    return run.returncode, rest
