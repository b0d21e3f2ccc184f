"""A child of the compute pool: ``python -m app.compute_pool.child [--background] [MODULE ...]``.

It imports the modules, confines itself as its first message says, then answers calls until its
input ends.
"""

from __future__ import annotations

import importlib
import os
import pickle
import signal
import struct
import sys
import traceback
from typing import BinaryIO

LENGTH = struct.Struct("<Q")
BACKGROUND_NICE = 10


def main(arguments: list[str]) -> None:
    """Answer calls until the input ends."""
    signal.signal(signal.SIGINT, signal.SIG_IGN)  # Ctrl-C in the terminal is the server's
    background = "--background" in arguments
    if background:
        os.nice(BACKGROUND_NICE)
    # What a library prints must not get between our messages.
    answers = os.fdopen(os.dup(1), "wb", buffering=0)
    os.dup2(2, 1)
    for name in arguments:
        if not name.startswith("--"):
            importlib.import_module(name)
    calls = sys.stdin.buffer
    if (setup := _read(calls)) is not None:
        _confine(setup)
        while (message := _read(calls)) is not None:
            _answer(answers, message)


def _read(calls: BinaryIO) -> bytes | None:
    head = calls.read(LENGTH.size)
    if len(head) < LENGTH.size:
        return None
    (length,) = LENGTH.unpack(head)
    data = calls.read(length)
    return data if len(data) == length else None


def _confine(message: bytes) -> None:
    """Take away from this process whatever its work does not need; the one place for it."""
    from app.compute_pool.confinement import confine_child
    from app.compute_pool.messages import Setup

    setup: Setup = pickle.loads(message)  # noqa: S301  # from the server, which is trusted
    os.chdir(setup.scratch)
    confine_child(setup)


def _answer(answers: BinaryIO, message: bytes) -> None:
    from app.compute_pool.messages import FAILED, HEAD, REFUSED, RESULT, Call, encode_error
    from app.compute_pool.messages import encode_result
    from recon4.errors import Recon4Error

    try:
        call: Call = pickle.loads(message)  # noqa: S301  # from the server, which is trusted
        data = encode_result(call.function, call.function(*call.args, **call.kwargs))
        kind = RESULT
    except Recon4Error as error:
        kind, data = REFUSED, encode_error(error)
    except MemoryError:
        kind, data = REFUSED, encode_error(Recon4Error("out of memory: ask for less at a time"))
    except Exception:
        kind, data = FAILED, traceback.format_exc().encode()[-20_000:]
    view = memoryview(HEAD.pack(kind, len(data)) + data)
    while view:  # an unbuffered write may be short
        view = view[answers.write(view) :]


if __name__ == "__main__":
    main(sys.argv[1:])
