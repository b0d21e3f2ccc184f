"""The child that reads mutants: started again by `tests.security.fuzz.runner` when it dies."""

from __future__ import annotations

import json
import logging
import os
import resource
import sys
import tempfile
import traceback
import warnings
from collections.abc import Sequence
from pathlib import Path
from typing import Any

from recon4.errors import Recon4Error
from tests.security.fuzz.broken import BROKEN
from tests.security.fuzz.kind import Kind
from tests.security.fuzz.kinds import KINDS
from tests.security.fuzz.mutators import Mutant, mutant

MEMORY_BYTES = 1 << 30
"""Memory that a reader may allocate beyond that of the child at its start."""


def main() -> None:
    """Read batches as lines of JSON from the standard input, each in a fork of this process.

    The imports are done once; whatever a reader breaks is gone with the fork.
    """
    warnings.simplefilter("ignore")
    logging.disable()
    _read_seeds()
    _say({"ready": True})
    for line in sys.stdin:
        fork = os.fork()
        if not fork:
            _read_batch(json.loads(line))
            os._exit(0)
        _, status = os.waitpid(fork, 0)
        _say({"end": os.waitstatus_to_exitcode(status)})


def _read_seeds() -> None:
    """Read a valid file of every kind, so that no fork imports or loads kernels by itself."""
    with tempfile.TemporaryDirectory(prefix="seeds-") as place:
        for kind in KINDS.values():
            folder = Path(place) / kind.name
            folder.mkdir()
            kind.prepare(folder)
            _count_of_seed(kind, folder / kind.file_name, kind.seeds()[0])


def _read_batch(batch: dict[str, Any]) -> None:
    """Read the mutants of a batch; one line before and one behind each."""
    kind, folder = (KINDS | BROKEN)[batch["kind"]], Path(batch["folder"])
    kind.prepare(folder)
    path = folder / kind.file_name
    seeds = list(kind.seeds())
    whole = [_count_of_seed(kind, path, data) for data in seeds]
    limit = _virtual_bytes() + MEMORY_BYTES
    resource.setrlimit(resource.RLIMIT_AS, (limit, limit))
    resource.setrlimit(resource.RLIMIT_CORE, (0, 0))
    _say({"pid": os.getpid()})
    for number in range(batch["first"], batch["stop"]):
        _say({"start": number})
        made = mutant(kind, seeds, batch["seed"], number)
        path.write_bytes(made.data)
        outcome, words = _judge(kind, path, made, whole)
        _say({"number": number, "outcome": outcome, "words": words, "how": made.how})


def _count_of_seed(kind: Kind, path: Path, data: bytes) -> int:
    path.write_bytes(data)
    found = kind.read(path)
    assert not found.salvaged, f"{kind.name}: a seed is read as damaged"
    assert kind.promised(data) in (None, found.count), f"{kind.name}: a seed promises otherwise"
    return found.count


def _judge(kind: Kind, path: Path, made: Mutant, whole: Sequence[int]) -> tuple[str, str]:
    try:
        found = kind.read(path)
    except Recon4Error as error:
        return ("rejected", str(error)[:300]) if str(error) else ("TRACEBACK", "without words")
    except MemoryError as error:
        return "MEMORY", _place(error)
    except Exception as error:
        return "TRACEBACK", _place(error)
    if found.salvaged:
        return "salvaged", ""
    promised = kind.promised(made.data)
    if promised is not None and promised != found.count:
        return "SILENT", f"{promised} promised, {found.count} returned"
    if made.cut_from is not None and kind.knows_end and found.count < whole[made.cut_from]:
        return "SILENT", f"cut file: {found.count} of {whole[made.cut_from]} returned"
    return "ok", ""


def judge_whole(kind: Kind, path: Path, data: bytes) -> tuple[str, str]:
    """How reading a file ended that is at ``path`` already, and words to it."""
    return _judge(kind, path, Mutant(data, "", None), ())


def _place(error: BaseException) -> str:
    frames = traceback.extract_tb(error.__traceback__)
    ours = [f for f in frames if "/recon4/" in f.filename or "/app/" in f.filename] or frames
    at = ours[-1]
    return f"{type(error).__name__} at {Path(at.filename).name}:{at.lineno}: {str(error)[:120]}"


def _virtual_bytes() -> int:
    pages = int(Path("/proc/self/statm").read_text("ascii").split()[0])
    return pages * os.sysconf("SC_PAGE_SIZE")


def _say(facts: dict[str, object]) -> None:
    sys.__stdout__.write(json.dumps(facts) + "\n")
    sys.__stdout__.flush()


if __name__ == "__main__":
    main()
