"""A pipeline of three small but real stages; run as a program it can be killed anywhere.

``python small_pipeline.py PROJECT`` runs it. ``python small_pipeline.py`` runs it for each line
``N PROJECT`` of its input, in a process that kills itself, as ``kill -9`` would, just before its
Nth operation on a file of the project; it answers with the exit code. Starting Python for each
would take ten times as long as the runs.
"""

import json
import os
import signal
import sys
from collections.abc import Iterable
from pathlib import Path
from typing import NoReturn

from recon4.model.figures import Figures
from recon4.progress import Silent
from recon4.settings import Settings
from recon4.settings.reads import ImportReads, MapReads, ReadsNothing
from recon4.store.project import Project
from recon4.store.stage import Input, Stage, StageRunner

FILE_OPERATIONS = {"open", "os.rename", "os.mkdir", "os.remove", "os.rmdir", "shutil.rmtree"}


class WordCount(Figures, frozen=True, kw_only=True):
    words: int


def count(context, *, text):
    (context.out / "deep").mkdir()
    (context.out / "deep" / "lengths.json").write_text(json.dumps([len(w) for w in text.split()]))
    (context.out / "range.txt").write_text(str(context.settings.ingest.max_range_m))
    return WordCount(words=len(text.split()))


def scale(context, *, counted):
    lengths = json.loads((counted / "deep" / "lengths.json").read_text())
    for k, length in enumerate(lengths):
        context.progress.advance()
        (context.out / f"{k}.txt").write_text(f"{length * context.settings.map.voxel_m:.6f}")


def total(context, *, counted, scaled):
    range_m = float((counted / "range.txt").read_text())
    found = sum(
        float(path.read_text()) for path in sorted(scaled.iterdir()) if path.suffix == ".txt"
    )
    (context.out / "total.txt").write_text(f"{found * range_m:.6f}")


COUNT = Stage("count", 1, ImportReads, count, WordCount)
SCALE = Stage("scale", 1, MapReads, scale)
TOTAL = Stage("total", 1, ReadsNothing, total)
TEXT = "a walk through an office and back"


def run_all(root: Path, settings: Settings | None = None, progress=None) -> StageRunner:
    with Project.open(root) as project:
        runner = StageRunner(project, settings or Settings(), progress or Silent())
        counted = runner.run(COUNT, text=Input(key=TEXT, value=TEXT))
        scaled = runner.run(SCALE, counted=counted)
        runner.run(TOTAL, counted=counted, scaled=scaled)
    return runner


def results(root: Path) -> dict[str, bytes]:
    """Every byte of every finished artifact, but for the manifests' times."""
    files = [path for path in (root / "artifacts").rglob("*") if path.is_file()]
    return {
        path.relative_to(root).as_posix(): path.read_bytes()
        for path in files
        if path.name != "manifest.json"
    }


def kill_before(operation: int, root: Path) -> None:
    seen = 0

    def watch(event, arguments):
        nonlocal seen
        if event in FILE_OPERATIONS and str(root) in str(arguments[0]):
            seen += 1
            if seen == operation:
                os.kill(os.getpid(), signal.SIGKILL)

    sys.addaudithook(watch)


def run_each(lines: Iterable[str]) -> None:
    """Run the pipeline in a fork for each line, and say how it ended."""
    for line in lines:
        operation, root = line.rstrip("\n").split(" ", 1)
        child = os.fork()
        if child == 0:
            _run_killed(int(operation), Path(root))
        _, status = os.waitpid(child, 0)
        sys.stdout.write(f"{os.waitstatus_to_exitcode(status)}\n")
        sys.stdout.flush()


def _run_killed(operation: int, root: Path) -> NoReturn:
    code = 1
    try:
        kill_before(operation, root)
        run_all(root)
        code = 0
    finally:
        os._exit(code)


if __name__ == "__main__":
    if len(sys.argv) > 1:
        run_all(Path(sys.argv[1]))
    else:
        run_each(sys.stdin)
