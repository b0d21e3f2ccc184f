"""Ends a command at SIGINT, SIGTERM or SIGHUP: in order, without a traceback.

The signal becomes a `StoppedBySignal` in the main thread, so that every ``with`` block removes
what it had not finished. Python may throw such an exception away (it is raised inside a callback
of native code, a destructor or a weak reference) and print a traceback instead: then it is raised
again a moment later, and nothing is printed.
"""

from __future__ import annotations

import os
import signal
import sys
import threading
import time
from types import FrameType, TracebackType
from typing import Any, Self

SIGNALS = (signal.SIGINT, signal.SIGTERM, signal.SIGHUP)
RAISED_AGAIN_AFTER_S = 0.02
CLEANING_UP_S = 10.0
"""Signals that come while the first one is obeyed are ignored this long, then the process ends."""


class StoppedBySignal(KeyboardInterrupt):
    """A signal requested the command to stop."""


class StopSignals:
    """Context manager: while it is open, signals raise `StoppedBySignal` in the main thread."""

    def __init__(self) -> None:
        self.received: signal.Signals | None = None
        """The first signal that came, None as long as there is none."""
        self._received_s = 0.0
        self._said = False
        self._before: dict[int, Any] = {}
        self._hooks = sys.unraisablehook, threading.excepthook, sys.excepthook

    @property
    def exit_code(self) -> int:
        """What a shell reports for a program that the signal ended."""
        assert self.received is not None
        return 128 + self.received

    def __enter__(self) -> Self:
        if threading.current_thread() is not threading.main_thread():
            return self  # signals go to the main thread, whose code handles them
        for number in SIGNALS:
            if signal.getsignal(number) is not signal.SIG_IGN:  # nohup, jobs in the background
                self._before[number] = signal.signal(number, self._stop)
        self._before[signal.SIGALRM] = signal.signal(signal.SIGALRM, self._raise_again)
        self._hooks = sys.unraisablehook, threading.excepthook, sys.excepthook
        sys.unraisablehook, threading.excepthook = self._unraisable, self._in_thread
        sys.excepthook = self._at_the_end
        return self

    def __exit__(self, *_: object) -> None:
        if not self._before:
            return
        signal.setitimer(signal.ITIMER_REAL, 0.0)
        for number, handler in self._before.items():
            if signal.getsignal(number) is not signal.SIG_IGN:
                signal.signal(number, handler)
        sys.unraisablehook, threading.excepthook, sys.excepthook = self._hooks

    def say(self, more: str = "") -> None:
        """Write one line with the reason of the end; only the first call counts."""
        if not self._said and self.received is not None:
            self._said = True
            sys.stderr.write(f"recon4: stopped by {self.received.name}{more}\n")
            sys.stderr.flush()

    def _stop(self, number: int, _: FrameType | None) -> None:
        if self.received is None:
            self.received, self._received_s = signal.Signals(number), time.monotonic()
            raise StoppedBySignal
        if time.monotonic() - self._received_s > CLEANING_UP_S:
            os._exit(self.exit_code)

    def _raise_again(self, *_: object) -> None:
        raise StoppedBySignal

    def _unraisable(self, lost: sys.UnraisableHookArgs) -> None:
        if self.received is None:
            self._hooks[0](lost)
        elif lost.exc_type is not None and issubclass(lost.exc_type, StoppedBySignal):
            signal.setitimer(signal.ITIMER_REAL, RAISED_AGAIN_AFTER_S)

    def _in_thread(self, lost: threading.ExceptHookArgs) -> None:
        if self.received is None:
            self._hooks[1](lost)

    def _at_the_end(
        self, kind: type[BaseException], error: BaseException, at: TracebackType | None
    ) -> None:
        if self.received is None:
            self._hooks[2](kind, error, at)
        else:
            self.say()
            os._exit(self.exit_code)
