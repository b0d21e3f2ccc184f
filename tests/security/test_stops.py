"""A stopped command prints one line and exits with 128 + n, wherever the signal arrives.

Figures to hold: 0 tracebacks, 0 unfinished files, exit code 143 (SIGTERM) or 130 (SIGINT).
"""

from __future__ import annotations

import shutil
import signal
import subprocess
import sys

import numpy as np
import pytest

from tests.service.killing import QUICK
from tests.service.running import ROOT

STOPS = 4
"""Random moments in one run."""

SWALLOWED = """
import ctypes, os, signal, sys, weakref
from recon4.stopping import StopSignals

def send():
    os.kill(os.getpid(), signal.{signal})
    for _ in range(1000): pass

class Held:
    def __del__(self): send()

def in_destructor():
    held = Held()
    del held

def in_weak_reference():
    held = Held.__new__(type("Plain", (), {{}}))
    watched = weakref.ref(held, lambda _: send())
    del held

def in_native_callback():
    order = ctypes.CFUNCTYPE(ctypes.c_int, ctypes.c_void_p, ctypes.c_void_p)
    def compare(a, b):
        send()
        return 0
    ctypes.CDLL(None).qsort((ctypes.c_int * 2)(2, 1), 2, 4, order(compare))

with StopSignals() as stop:
    try:
        {where}()
        while True: pass
    except KeyboardInterrupt:
        stop.say()
sys.exit(stop.exit_code)
"""


@pytest.mark.parametrize("where", ["in_destructor", "in_weak_reference", "in_native_callback"])
@pytest.mark.parametrize("name", ["SIGTERM", "SIGINT"])
def test_a_signal_is_obeyed_where_python_throws_exceptions_away(where, name):
    code = SWALLOWED.format(where=where, signal=name)

    ended = subprocess.run(
        [sys.executable, "-c", code],
        capture_output=True,
        text=True,
        check=False,
        cwd=ROOT,
        timeout=60,
        start_new_session=True,
        preexec_fn=obey_sigint,
    )

    assert ended.stderr == f"recon4: stopped by {name}\n"
    assert ended.returncode == 128 + signal.Signals[name]


@pytest.mark.slow
def test_processing_stopped_at_random_moments_leaves_nothing_and_goes_on(tmp_path, short_recording):
    """Each command goes on where the last one was stopped."""
    shutil.copytree(short_recording, tmp_path / "walk")
    rng = np.random.default_rng(4)
    stopped = 0
    for _ in range(STOPS):
        sign = rng.choice([signal.SIGTERM, signal.SIGINT])
        code, err = stop_after(tmp_path, lines=int(rng.integers(1, 6)), sign=sign)
        if code != 0:
            stopped += 1
            assert code == 128 + sign, err
            assert err.count("recon4:") == 1, err
            assert (
                f"recon4: stopped by {signal.Signals(sign).name}; the same command goes on" in err
            )
        assert "Traceback" not in err
        left = [p for p in (tmp_path / "out").rglob("*") if p.name.startswith((".tmp", "bu"))]
        assert left == []

    assert stopped
    assert subprocess.run(command(tmp_path), check=False, capture_output=True).returncode == 0


def obey_sigint():
    """In the child: a shell that runs this in the background had it ignored."""
    signal.signal(signal.SIGINT, signal.SIG_DFL)


def stop_after(folder, *, lines, sign):
    """Send a signal after some lines of progress; returns exit code and standard error."""
    with subprocess.Popen(
        command(folder),
        stderr=subprocess.PIPE,
        stdout=subprocess.DEVNULL,
        text=True,
        cwd=ROOT,
        preexec_fn=obey_sigint,
    ) as process:
        said = "".join(process.stderr.readline() for _ in range(lines))
        process.send_signal(sign)
        said += process.stderr.read()
    return process.returncode, said


def command(folder):
    walk, sets = folder / "walk", [word for one in QUICK for word in ("--set", one)]
    given = [str(walk / "recording.pcap"), "--rig", "4recon", "--imu", str(walk / "imu.csv")]
    return [sys.executable, "-m", "recon4", "process", *given, "--out", str(folder / "out"), *sets]
