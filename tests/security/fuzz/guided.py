"""Coverage-guided fuzzing of the readers that are Python: mutants that reach new lines are kept.

    .venv/bin/pip install --no-deps --target out/atheris atheris==3.0.0
    PYTHONPATH=out/atheris .venv/bin/python -m tests.security.fuzz.guided --kind pcap --minutes 5

For development only, and not in the lock: atheris (Apache-2.0) has wheels for Linux on x86_64 only.
A kind ends at its first finding; its file is kept in ``--keep``, and ``--replay FILE`` reads it.
"""

from __future__ import annotations

import argparse
import importlib
import logging
import os
import sys
import tempfile
import warnings
from pathlib import Path
from typing import Any

from recon4.sandbox.private_cache import KERNELS
from tests.security.fuzz.runner import GOOD, fast_folder

_INSTRUMENTED = ["recon4", "recon4_app.live"]
_COMPILED = [f"recon4.kernels.{path.stem}" for path in KERNELS.glob("*.py")]
"""Numba cannot compile what is instrumented."""
_HANG_S = 60
"""Of the clock; a reader on a busy computer is slow."""
_MEMORY_MB = 2000
"""Of the whole process; a reader may take 1 GiB (`tests.security.fuzz.child`)."""
_MAX_BYTES = 1 << 16


def main() -> int:
    """Fuzz kinds one after the other, each in a fork, so that all is imported only once."""
    parser = argparse.ArgumentParser(prog="python -m tests.security.fuzz.guided")
    parser.add_argument("--kind", action="append", required=True)
    parser.add_argument("--minutes", type=float, default=5.0, help="a kind")
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--keep", type=Path, default=Path("out/guided"), help="folder of findings")
    parser.add_argument("--replay", type=Path, help="read one file instead")
    chosen = parser.parse_args()
    atheris = importlib.import_module("atheris")
    with atheris.instrument_imports(include=_INSTRUMENTED, exclude=_COMPILED):
        importlib.import_module("tests.security.fuzz.kinds")
    warnings.simplefilter("ignore")
    logging.disable()
    chosen.keep.mkdir(parents=True, exist_ok=True)
    codes = []
    for name in chosen.kind:
        child = os.fork()
        if not child:
            _fuzz(atheris, name, chosen)
            os._exit(0)
        codes.append(os.waitstatus_to_exitcode(os.waitpid(child, 0)[1]))
    return max(map(abs, codes))


def _fuzz(atheris: Any, name: str, chosen: argparse.Namespace) -> None:
    """Fuzz one kind; libFuzzer ends the process, with another code than 0 after a finding."""
    from tests.security.fuzz.child import judge_whole
    from tests.security.fuzz.kinds import KINDS

    kind = KINDS[name]
    with tempfile.TemporaryDirectory(prefix="guided-", dir=fast_folder()) as place:
        folder, corpus = Path(place) / "trial", Path(place) / "corpus"
        folder.mkdir()
        corpus.mkdir()
        kind.prepare(folder)
        path = folder / kind.file_name

        def read(data: bytes) -> None:
            path.write_bytes(data)
            outcome, words = judge_whole(kind, path, data)
            if outcome not in GOOD:
                sys.stderr.write(f"{name}: {outcome}: {words}\n")
                raise AssertionError(f"{outcome}: {words}")

        if chosen.replay:
            read(chosen.replay.read_bytes())
            return
        seeds = list(kind.seeds())
        for number, seed in enumerate(seeds):
            (corpus / str(number)).write_bytes(seed)
            read(seed)  # loads the kernels, so that this time does not count
        options = {
            "max_total_time": round(60 * chosen.minutes),
            "seed": chosen.seed,
            "timeout": _HANG_S,
            "rss_limit_mb": _MEMORY_MB,
            "max_len": max(_MAX_BYTES, *map(len, seeds)),
            "artifact_prefix": f"{chosen.keep}/{name}-",
            "print_final_stats": 1,
            "verbosity": 0,
        }
        words = [f"-{option}={value}" for option, value in options.items()]
        sys.stderr.write(f"{name}\n")
        atheris.Setup([sys.argv[0], *words, str(corpus)], read)
        atheris.Fuzz()


if __name__ == "__main__":
    sys.exit(main())
