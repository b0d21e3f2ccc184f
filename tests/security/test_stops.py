"""A stopped command prints one line and exits with 128 + n, wherever the signal arrives.

Runs that are stopped and resumed: ``tests/scenario/test_kill_and_repeat.py``.
"""

from __future__ import annotations

import signal
import subprocess
import sys

import pytest

from tests.service.running import ROOT

SWALLOWED = """
import ctypes, os, signal, sys, weakref
from recon4.system.stopping import StopSignals

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
    )

    assert ended.stderr == f"recon4: stopped by {name}\n"
    assert ended.returncode == 128 + signal.Signals[name]
