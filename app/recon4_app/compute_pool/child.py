"""A child of the compute pool, started by `recon4_app.compute_pool.process`.

Arguments: its scratch folder, descriptor of its lifeline, perhaps ``--background``, modules to
import. It confines itself as its first message demands, then serves calls until its input ends.
"""

from __future__ import annotations

import gc
import importlib
import os
import sys
import traceback
from pathlib import Path
from typing import BinaryIO

from recon4.errors import Recon4Error
from recon4.locales.coded import CodedText
from recon4.sandbox.private_cache import use_private_cache
from recon4.system.processes import die_with_parent
from recon4.system.stopping import leave_terminal_to_parent
from recon4.system.tuning import PROCESSES
from recon4_app.compute_pool.confinement import confine_child
from recon4_app.compute_pool.messages import (
    FAILED,
    HEAD,
    LENGTH,
    REFUSED,
    RESULT,
    Call,
    ChildSetup,
    decode_request,
    encode_error,
    encode_result,
)
from recon4_app.compute_pool.tuning import CHILD_PRIORITY


def main(arguments: list[str]) -> None:
    """Answer calls until the input ends."""
    scratch, lifeline, *rest = arguments
    die_with_parent(int(lifeline))
    kernels = use_private_cache(Path(scratch) / "kernels")
    leave_terminal_to_parent()
    gc.set_threshold(PROCESSES.collected_after)
    if "--background" in rest:
        os.nice(CHILD_PRIORITY.background_nice)
    # Output of a library must not mix with our messages.
    answers = os.fdopen(os.dup(1), "wb", buffering=0)
    os.dup2(2, 1)
    for name in rest:
        if not name.startswith("--"):
            importlib.import_module(name)
    calls = sys.stdin.buffer
    if (setup := _read(calls)) is not None:
        _confine(setup, Path(scratch), kernels)
        while (message := _read(calls)) is not None:
            _answer(answers, message)
    gc.freeze()  # the process ends: no search for cycles


def _read(calls: BinaryIO) -> bytes | None:
    head = calls.read(LENGTH.size)
    if len(head) < LENGTH.size:
        return None
    (length,) = LENGTH.unpack(head)
    data = calls.read(length)
    return data if len(data) == length else None


def _confine(message: bytes, scratch: Path, kernels: tuple[Path, ...]) -> None:
    """Confine this process to what its work needs; the only place that does."""
    setup: ChildSetup = decode_request(message)
    importlib.import_module(setup.module)
    os.chdir(scratch)
    confine_child(setup.access, scratch, kernels)


def _answer(answers: BinaryIO, message: bytes) -> None:
    try:
        call: Call = decode_request(message)
        data = encode_result(call.function, call.function(*call.args, **call.kwargs))
        kind = RESULT
    except Recon4Error as error:
        kind, data = REFUSED, encode_error(error)
    except MemoryError:
        kind, data = REFUSED, encode_error(Recon4Error(CodedText("out-of-memory")))
    except Exception:
        kind, data = FAILED, traceback.format_exc().encode()[-20_000:]
    view = memoryview(HEAD.pack(kind, len(data)) + data)
    while view:  # an unbuffered write may be short
        view = view[answers.write(view) :]


if __name__ == "__main__":
    main(sys.argv[1:])
