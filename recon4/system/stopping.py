"""Ends a process at SIGINT, SIGTERM or SIGHUP: in order, with one line, without a traceback.

Work that can be broken off gets a `StoppedBySignal` in the main thread, so that every ``with``
block removes what it had not finished. Work that ends by itself when it is requested to (a server,
a recording) names with `StopSignals.request` what the signal shall call instead.

Only the first signal counts. Later ones do nothing until the process is gone: `end_process` never
puts the earlier handlers back, by which the next signal would kill it. Python may throw an
exception away (it is raised inside a callback of native code, a destructor or a weak reference) and
print a traceback instead: then it is raised again a moment later, and nothing is printed.
"""

from __future__ import annotations

import gc
import os
import signal
import sys
import threading
import time
from collections.abc import Callable
from contextlib import suppress
from types import FrameType, TracebackType
from typing import Any, NoReturn, Self

from recon4.system.tuning import PROCESSES, STOPPING

SIGNALS = (signal.SIGINT, signal.SIGTERM, signal.SIGHUP)
OF_A_TERMINAL = (signal.SIGINT, signal.SIGHUP)
"""Ctrl-C and a closed window reach all processes of a terminal."""
_OUTPUTS = (1, 2)


class StoppedBySignal(KeyboardInterrupt):
    """A signal requested the command to stop."""


def end_process(work: Callable[[StopSignals], int]) -> NoReturn:
    """Do the work of this process and end it, with the exit code of the work or of the signal.

    Args:
        work: Returns the exit code; all that the process does.
    """
    stop = StopSignals()
    stop.catch()
    gc.set_threshold(PROCESSES.collected_after)
    try:
        code = work(stop)
        stop.ignore_from_now()
    except BaseException:
        if not stop.broke_off:
            stop.ignore_from_now()
            raise
        stop.ignore_from_now()
        code = stop.exit_code
    stop.say()
    if stop.broke_off:
        os._exit(code)  # without waiting for what other threads still compute
    gc.freeze()  # memory goes with the process: nothing is gained by a search for cycles in it
    sys.exit(code)


def leave_terminal_to_parent() -> None:
    """Ignore what a terminal sends to all its processes: the parent decides what follows."""
    for number in OF_A_TERMINAL:
        signal.signal(number, signal.SIG_IGN)


class StopSignals:
    """Catches the signals; as a context manager it puts the handlers of before back."""

    def __init__(self) -> None:
        self.received: signal.Signals | None = None
        """The first signal that came, None as long as there is none."""
        self.broke_off = False
        """Whether the work was left by a `StoppedBySignal`."""
        self._request: Callable[[], object] | None = None
        self._received_s = 0.0
        self._said = self._over = False
        self._before: dict[int, Any] = {}
        self._terminals: list[int] = []
        self._hooks = sys.unraisablehook, threading.excepthook, sys.excepthook

    @property
    def exit_code(self) -> int:
        """What a shell reports for a program that the signal ended."""
        assert self.received is not None
        return 128 + self.received

    def request(self, end: Callable[[], object]) -> None:
        """From now on a signal calls `end`, and the work ends by itself; nothing is raised.

        Args:
            end: Called in the main thread between two instructions: it sets a flag or wakes a
                loop (``partial(loop.call_soon_threadsafe, event.set)``).
        """
        self._request = end

    def catch(self) -> None:
        """Install the handlers; without effect outside the main thread, which gets all signals."""
        if threading.current_thread() is not threading.main_thread():
            return
        self._terminals = [number for number in _OUTPUTS if os.isatty(number)]
        self._before[signal.SIGALRM] = signal.signal(signal.SIGALRM, self._raise_again)
        self._hooks = sys.unraisablehook, threading.excepthook, sys.excepthook
        sys.unraisablehook, threading.excepthook = self._unraisable, self._in_thread
        sys.excepthook = self._at_the_end
        for number in SIGNALS:
            if signal.getsignal(number) is not signal.SIG_IGN:  # nohup, jobs in the background
                self._before[number] = signal.signal(number, self._stop)

    def ignore_from_now(self) -> None:
        """Nothing is left to stop; a signal would kill the process while Python takes it down."""
        self._over = True
        signal.setitimer(signal.ITIMER_REAL, 0.0)
        for number in self._before:
            signal.signal(number, signal.SIG_IGN)

    def __enter__(self) -> Self:
        self.catch()
        return self

    def __exit__(self, *_: object) -> None:
        if not self._before:
            return
        self._over = True
        signal.setitimer(signal.ITIMER_REAL, 0.0)
        for number, handler in self._before.items():
            signal.signal(number, handler)
        sys.unraisablehook, threading.excepthook, sys.excepthook = self._hooks

    def say(self, more: str = "") -> None:
        """Write one line with the reason of the end; only the first call counts."""
        if self._said or self.received is None:
            return
        self._said = True
        with suppress(OSError, RuntimeError, ValueError):  # no terminal, or in the midst of a line
            sys.stderr.flush()
        with suppress(OSError):
            os.write(2, f"recon4: stopped by {self.received.name}{more}\n".encode())

    def is_said(self) -> None:
        """Another process has said why this one ends."""
        self._said = True

    def _stop(self, number: int, _: FrameType | None) -> None:
        if number == signal.SIGHUP:
            self._forget_closed_terminals()
        if self._over:
            return
        if self.received is None:
            self.received, self._received_s = signal.Signals(number), time.monotonic()
            self._obey()
        elif time.monotonic() - self._received_s > STOPPING.cleaning_up_s:
            self.say(", at once")
            os._exit(self.exit_code)

    def _obey(self) -> None:
        self.broke_off = self._request is None
        if self._request is None:
            raise StoppedBySignal
        with suppress(RuntimeError):  # its loop is closed: the work has ended
            self._request()

    def _forget_closed_terminals(self) -> None:
        """What is still said goes nowhere; writing to a closed terminal would be an error."""
        for number in self._terminals:
            if not os.isatty(number):
                nowhere = os.open(os.devnull, os.O_WRONLY)
                os.dup2(nowhere, number)
                os.close(nowhere)

    def _raise_again(self, *_: object) -> None:
        if not self._over:
            self._obey()

    def _unraisable(self, lost: sys.UnraisableHookArgs) -> None:
        if not self.broke_off:
            self._hooks[0](lost)
        elif lost.exc_type is not None and issubclass(lost.exc_type, StoppedBySignal):
            signal.setitimer(signal.ITIMER_REAL, STOPPING.raised_again_after_s)

    def _in_thread(self, lost: threading.ExceptHookArgs) -> None:
        if not self.broke_off:
            self._hooks[1](lost)

    def _at_the_end(
        self, kind: type[BaseException], error: BaseException, at: TracebackType | None
    ) -> None:
        if not self.broke_off:
            self._hooks[2](kind, error, at)
        else:
            self.say()
            os._exit(self.exit_code)
