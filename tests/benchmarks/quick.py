"""What became slower, larger or hungrier than stored: by hand, in some minutes.

    python -m tests.benchmarks.quick [--store]

A short simulated walk is processed twice, and the lesser figure of each counts. Processor time is
divided by that of a fixed computation before, between and after (sorting, Zstandard, sines), so
that figures of different computers can be compared: they are stored in ``quick.json`` beside this
file (``--store`` writes it). Memory is in MB, the size of a project in sizes of its recording.
Ends with 1 if something is worse than stored by more than `WORSE`.
"""

from __future__ import annotations

import argparse
import json
import resource
import subprocess
import sys
import tempfile
import time
from pathlib import Path

import numpy as np
import zstandard

from recon4.archive.space import stored_parts
from recon4.evaluation.table import number, text_table
from recon4.progress import Silent
from recon4.simulation.setup import prepare
from recon4.simulation.simulate import simulate
from recon4.store.hashing import size_of
from recon4.store.project import read_stages

STORED = Path(__file__).with_suffix(".json")
WORSE = {"time": 1.25, "memory": 1.1, "size": 1.05}
"""A figure that exceeds the stored one by this factor is worse: times vary by a tenth."""
LEAST = 0.5
"""Times below this are not judged: half of them is the noise of the computer."""
SECONDS, SEED, RUNS = 10.0, 1, 2
COMMANDS = {"--help": ["--help"], "info": ["info"]}


def main() -> None:
    """Measure, compare and print."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--store", action="store_true", help="Write the figures as those to keep.")
    given = parser.parse_args()
    with tempfile.TemporaryDirectory() as folder:
        found = measured(Path(folder))
    stored: dict[str, float] = json.loads(STORED.read_text()) if STORED.exists() else {}
    rows, worse = compared(found, stored)
    print(text_table(["figure", "stored", "now", "by stored", ""], rows))
    if given.store:
        rounded = {name: round(value, 4) for name, value in found.items()}
        STORED.write_text(json.dumps(rounded, indent=1) + "\n")
    elif worse:
        sys.exit(f"worse: {', '.join(worse)}")


def compared(
    found: dict[str, float], stored: dict[str, float]
) -> tuple[list[list[str]], list[str]]:
    """Rows of the table, and the names of figures that are worse than stored."""
    rows: list[list[str]] = []
    worse: list[str] = []
    for name, value in found.items():
        before = stored.get(name, float("nan"))
        factor = value / before if before else float("nan")
        kind = name.split()[0]
        if factor > WORSE[kind] and (kind != "time" or value > LEAST):
            worse.append(name)
        word = "worse" if name in worse else "new" if name not in stored else ""
        rows.append([name, number(before, 3), number(value, 3), number(factor), word])
    return rows, worse


def measured(folder: Path) -> dict[str, float]:
    """All figures: ``time`` by the reference, ``memory`` in MB, ``size`` by the recording."""
    walk = folder / "walk"
    simulate(prepare("office", seconds=SECONDS, seed=SEED), walk, bag=False, progress=Silent())
    recon4("compile")
    recording = walk / "recording.pcap"
    references, runs = [reference_s()], []
    for run in range(RUNS):
        runs.append(processed(recording, folder / f"run{run}"))
        references.append(reference_s())
    unit_s = float(np.median(references))
    print(f"reference: {', '.join(number(one, 2) for one in references)} s")
    found = {name: min(run[name] for run in runs) for name in runs[0]}
    commands = {
        f"time recon4 {name}": min(recon4(*words, *_named(name, recording)) for _ in range(3))
        for name, words in COMMANDS.items()
    }
    times = {k: v / unit_s for k, v in (found | commands).items() if k.startswith("time")}
    return times | {name: value for name, value in found.items() if name not in times}


def _named(command: str, recording: Path) -> list[str]:
    return [str(recording)] if command == "info" else []


def processed(recording: Path, project: Path) -> dict[str, float]:
    """Seconds of processor and memory of each stage of a run, and the size of the project."""
    imu = str(recording.with_name("imu.csv"))
    whole_s = recon4("process", str(recording), "--imu", imu, "--out", str(project))
    stages = read_stages(project)
    found = {f"time {one.stage}": one.cpu_seconds for one in stages}
    found["time whole run"] = whole_s
    found |= {"memory largest stage": max(one.peak_bytes for one in stages) / 1e6}
    parts = stored_parts(project)
    sizes = {
        "size project": sum(one.bytes for one in parts),
        "size without what can be freed": sum(one.bytes for one in parts if not one.freeable),
    }
    return found | {name: size / size_of(recording) for name, size in sizes.items()}


def recon4(*words: str) -> float:
    """Run a command; its processor time [s].

    Raises:
        subprocess.CalledProcessError: If it fails.
    """
    began = _children_s()
    command = [sys.executable, "-m", "recon4", *words]
    subprocess.run(command, check=True, stdout=subprocess.DEVNULL)
    return _children_s() - began


def _children_s() -> float:
    used = resource.getrusage(resource.RUSAGE_CHILDREN)
    return used.ru_utime + used.ru_stime


def reference_s() -> float:
    """Processor time of a fixed computation of the kinds that a map needs [s]."""
    numbers = np.random.default_rng(1).integers(0, 1 << 40, 4_000_000)
    began = time.process_time()
    for _ in range(3):
        ordered = np.sort(numbers)
        steps = np.diff(ordered).astype(np.uint16)
        zstandard.ZstdCompressor(level=1).compress(steps.tobytes())
        np.sin(ordered * 1e-9).sum()
    return time.process_time() - began


if __name__ == "__main__":
    main()
