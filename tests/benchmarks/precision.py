"""How often each kind of finding is right: precision and recall over runs of the proving ground.

    python -m tests.benchmarks.precision OUT/runs.jsonl [OUT/runs.jsonl …]

A finding is an *alarm* if it makes the verdict worse than good. Its precision is the ratio of its
alarms that stand in runs whose trajectory is not right, or whose degradation it names; its recall
the ratio of the wrong runs in which it is an alarm. The last lines are about whole runs: how many
of the right ones are *do not use* and *check* (goals: 2 % and 10 %), and how many wrong ones are
good.
"""

from __future__ import annotations

import argparse
from collections import Counter
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from recon4.evaluation.table import percentage, text_table
from recon4.findings.finding import Level
from tests.benchmarks.proving_ground import read_lines

Line = Mapping[str, Any]

_ALARMS = {str(Level.CHECK), str(Level.DO_NOT_USE)}
NAMES = {
    "extrinsics": {"RIG-CONTRADICTED"},
    "swap-lidars": {"RIG-EXCHANGED", "RIG-CONTRADICTED"},
    "lidar-clock": {"RIG-CONTRADICTED"},
    "imu-rotation": {"RIG-CONTRADICTED", "IMU-GYRO-ROTATION"},
    "imu-clock": {"RIG-CONTRADICTED", "IMU-CLOCK"},
    "imu-scale": {"IMU-GYRO-SCALE", "IMU-GRAVITY", "IMU-SCALE", "TURN-SCALE"},
    "imu-unit": {"IMU-UNIT", "IMPORT-REMARK"},
    "imu-axes": {"IMU-LEFT-HANDED", "IMU-NOT-USED", "RIG-CONTRADICTED"},
    "imu-grade": {"IMU-GRAVITY", "IMU-ACCELEROMETER-NOT-USED"},
    "wrong-model": {"IMPORT-REMARK", "IMPORT-UNUSED", "RIG-CONTRADICTED"},
    "packet-loss": {"IMPORT-REMARK", "IMPORT-UNUSED"},
    "beam-bias": {"RIG-CONTRADICTED"},
    "lever-arm": {"ANTENNA-OFFSET"},
    "gnss-clock": {"GNSS-CLOCK"},
    "people": {"MOVING-OBJECTS"},
    "vehicles": {"MOVING-OBJECTS"},
}
"""Degradation -> kinds that name it: no false alarm, even if the trajectory is right."""


@dataclass(frozen=True, slots=True)
class KindCounts:
    """Alarms of one kind."""

    alarms: int
    true: int
    """In runs that are wrong, or whose degradation it names."""
    of_wrong: int
    """In runs that are wrong."""


def kind_counts(lines: Iterable[Line]) -> dict[str, KindCounts]:
    """Alarms of each kind, the most frequent first."""
    alarms, true, of_wrong = Counter[str](), Counter[str](), Counter[str]()
    for line in lines:
        wrong = line["outcome"] != "right"
        named = {kind for one in line["degradation"].split("+") for kind in NAMES.get(one, ())}
        for kind, level in line["kinds"].items():
            if level in _ALARMS:
                alarms[kind] += 1
                true[kind] += wrong or kind in named
                of_wrong[kind] += wrong
    return {
        kind: KindCounts(count, true[kind], of_wrong[kind]) for kind, count in alarms.most_common()
    }


def false_alarms(lines: Sequence[Line]) -> dict[str, float]:
    """Ratio of the right runs without a degradation that it names, by verdict."""
    clean = [
        line for line in lines
        if line["outcome"] == "right" and not _names_a_degradation(line)
    ]  # fmt: skip
    verdicts = Counter(line["verdict"] for line in clean)
    return {name: verdicts[name] / max(len(clean), 1) for name in ("check", "do not use")}


def _names_a_degradation(line: Line) -> bool:
    """Whether some alarm of a run names what is wrong with its recording."""
    named = {kind for one in line["degradation"].split("+") for kind in NAMES.get(one, ())}
    return any(level in _ALARMS and kind in named for kind, level in line["kinds"].items())


def report(lines: Sequence[Line]) -> str:
    """Both tables as text."""
    wrong = sum(line["outcome"] != "right" for line in lines)
    rows = [
        [kind, f"{n.alarms}", percentage(n.true / n.alarms), f"{n.of_wrong} of {wrong}"]
        for kind, n in kind_counts(lines).items()
    ]
    silent = sum(line["outcome"] == "SILENT" for line in lines)
    rates = false_alarms(lines)
    return "\n".join(
        [
            text_table(["finding", "alarms", "precision", "wrong runs"], rows),
            "",
            f"{len(lines)} runs, {len(lines) - wrong} right, {silent} silent",
            f"right runs without a named degradation: {percentage(rates['do not use'])} do not use "
            f"(goal 2 %), {percentage(rates['check'])} check (goal 10 %)",
        ]
    )


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("runs", type=Path, nargs="+")
    lines = [line for path in parser.parse_args().runs for line in read_lines(path)]
    print(report(lines))


if __name__ == "__main__":
    main()
