"""How often each kind of finding is right: precision and recall over runs of the proving ground.

    python -m tests.benchmarks.precision OUT/runs.jsonl [docs/studies/… …] [--toml NAME]
        [--faults KIND,…]

Of a page with the published table (``.md``) only the first reason of each run is known.
``--toml`` prints a source for ``recon4/findings/measured.toml``, whose figures the page
``docs/reference/findings.md`` quotes. ``--faults`` adds, of kinds that may be notes, in how many
runs with a fault that they name, and without one, they are said at any level.

A finding is an *alarm* if it makes the verdict worse than good. Its precision is the ratio of its
alarms that stand in runs whose trajectory is not right, or whose degradation it names; its recall
the ratio of the wrong runs in which it is an alarm. The last lines are about whole runs: how many
of the right ones are *do not use* and *check* (goals: 2 % and 10 %), how many wrong ones are good,
and how true the stated uncertainty of the shape is (goal: 2 sigma 0.5 to 4 times the error that
95 % of the positions stay below after the best alignment).
"""

from __future__ import annotations

import argparse
import re
from collections import Counter
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

from recon4.evaluation.table import percentage, text_table
from recon4.model.finding import Level
from tests.benchmarks.proving_ground import read_lines

Line = Mapping[str, Any]

STATED_GOAL = (0.5, 4.0)
"""Stated 2 sigma as a multiple of the true 95 % error."""
_ALARMS = {str(Level.CHECK), str(Level.DO_NOT_USE)}
NAMES = {
    "extrinsics": {"RIG-CONTRADICTED", "IMU-GYRO-ROTATION"},
    "swap-lidars": {"RIG-EXCHANGED", "RIG-CONTRADICTED"},
    "lidar-clock": {"RIG-CONTRADICTED", "IMU-CLOCK"},
    "imu-rotation": {"RIG-CONTRADICTED", "IMU-GYRO-ROTATION"},
    "imu-clock": {"RIG-CONTRADICTED", "IMU-CLOCK"},
    "imu-scale": {"IMU-GYRO-SCALE", "IMU-GRAVITY", "IMU-SCALE", "TURN-SCALE"},
    "imu-unit": {"IMU-UNIT", "GYROSCOPE-UNIT", "ACCELEROMETER-UNIT", "IMPORT-REMARK"},
    "imu-axes": {"IMU-AXES", "IMU-LEFT-HANDED", "IMU-NOT-USED", "IMU-TURNED", "RIG-CONTRADICTED"},
    "imu-grade": {"IMU-GRAVITY", "IMU-SCALE", "IMU-ACCELEROMETER-NOT-USED"},
    "wrong-model": {"MODEL-CONTRADICTED", "MODEL-UNLIKELY", "MODEL-BY-INTERVAL", "DATA-LOST"}
    | {"IMPORT-REMARK", "IMPORT-UNUSED", "RIG-CONTRADICTED"},
    "packet-loss": {"DATA-LOST", "IMPORT-REMARK", "IMPORT-UNUSED"},
    "beam-bias": {"RIG-CONTRADICTED"},
    "lever-arm": {"ANTENNA-OFFSET"},
    "gnss-clock": {"GNSS-CLOCK"},
    "people": {"MOVING-OBJECTS"},
    "vehicles": {"MOVING-OBJECTS"},
    "imu-lever-arm": {"IMU-LEVER-ARM", "IMU-ACCELEROMETER-NOT-USED"},
    "imu-to-the-left": {"IMU-TURNED"},
    "imu-tilted": {"IMU-TURNED", "IMU-GYRO-ROTATION"},
    "imu-left-handed": {"IMU-AXES"},
    "gyro-sign": {"IMU-AXES"},
    "imu-set": {"CLOCK-JUMP"},
    "recorder-set": {"CLOCK-JUMP"},
    "frames-set": {"CLOCK-BACK"},
}
"""Degradation or fault -> kinds that name it: no false alarm, even if the trajectory is right."""

WITH_MIRRORS = ("mirrors", "showroom")
"""Worlds in which there is one."""
_FIRST_REASONS = {
    "The rig file contradicts the recording": "RIG-CONTRADICTED",
    "Between .* moving objects": "MOVING-OBJECTS",
    "Between .* the LiDAR hardly observes": "WEAK-DIRECTION",
    "no IMU": "IMU-MISSING",
    "The IMU measures .* where gravity is": "IMU-GRAVITY",
    "The IMU contradicts the recording. The scale": "IMU-SCALE",
    "The IMU contradicts the recording. The accelerometer measures about 1": "IMU-UNIT",
    "The IMU contradicts the recording. The accelerometer": "IMU-SCALE",
    "Tracking was lost": "TRACKING-LOST",
    "The positions are known to": "UNCERTAINTY",
    "The shape of the map is known to": "UNCERTAINTY",
    "The clock of the IMU": "IMU-CLOCK",
    "The mounts of": "RIG-EXCHANGED",
    "A mirror or a glass wall": "MIRROR",
    "The registration converged in only": "NOT-CONVERGED",
    r"\d+ multiframes did not converge": "NOT-CONVERGED",
    "No loop closure was accepted": "LOOPS-NONE",
    "The gyroscope is rotated": "IMU-GYRO-ROTATION",
    "The gyroscope measures turns": "IMU-GYRO-SCALE",
    "The rig file contradicts the GNSS fixes: their clock": "GNSS-CLOCK",
    "The rig file contradicts the GNSS fixes: the antenna": "ANTENNA-OFFSET",
    "the accelerometer contradicts the LiDARs": "IMU-ACCELEROMETER-NOT-USED",
    "the IMU contradicts the LiDARs": "IMU-NOT-USED",
    "[a-z]+: its packets say": "IMPORT-REMARK",
}
"""How the first reason in a published table begins, a regular expression, and its kind."""
_COLUMNS, _WALK = 12, re.compile(r"[a-z]+(:\d+)?/\d+")


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
        named = _named(line)
        for kind, level in line["kinds"].items():
            if level in _ALARMS:
                alarms[kind] += 1
                true[kind] += wrong or kind in named
                of_wrong[kind] += wrong
    return {
        kind: KindCounts(count, true[kind], of_wrong[kind]) for kind, count in alarms.most_common()
    }


def fault_counts(lines: Sequence[Line], kind: str) -> dict[str, int]:
    """In how many runs with a fault that a kind names, and without one, it is said."""
    said = Counter((kind in _named(line), kind in line["kinds"]) for line in lines)
    return {
        "with_fault": said[True, True] + said[True, False],
        "said": said[True, True],
        "without": said[False, True] + said[False, False],
        "false": said[False, True],
    }


def false_alarms(lines: Sequence[Line]) -> dict[str, float]:
    """Ratio of the right runs without a degradation that it names, by verdict."""
    clean = [
        line for line in lines
        if line["outcome"] == "right" and not _names_a_degradation(line)
    ]  # fmt: skip
    verdicts = Counter(line["verdict"] for line in clean)
    return {name: verdicts[name] / max(len(clean), 1) for name in ("check", "do not use")}


def stated_over_true(lines: Iterable[Line]) -> list[float]:
    """Largest stated 2 sigma of the shape over its true 95 % error, of each run with both."""
    errors = [line.get("errors") or {} for line in lines]
    return [one["shape_m"] / one["error_95_m"] for one in errors if one.get("error_95_m")]


def _stated(lines: Sequence[Line]) -> str:
    ratios = np.array(stated_over_true(lines))
    if not len(ratios):
        return "stated uncertainty: not known of these runs"
    low, high = STATED_GOAL
    below, above = int((ratios < low).sum()), int((ratios > high).sum())
    return (
        f"stated 2 sigma over the true 95 % error in {len(ratios)} runs: median "
        f"{np.median(ratios):.2f}, {len(ratios) - below - above} within {low:g} to {high:g}, "
        f"{below} below, {above} above"
    )


def _names_a_degradation(line: Line) -> bool:
    """Whether some alarm of a run names what is wrong with its recording."""
    named = _named(line)
    return any(level in _ALARMS and kind in named for kind, level in line["kinds"].items())


def _named(line: Line) -> set[str]:
    """The kinds that name what is wrong with a recording, or what stands in its world."""
    named = {kind for one in line["degradation"].split("+") for kind in NAMES.get(one, ())}
    return named | ({"MIRROR"} if line["walk"].startswith(WITH_MIRRORS) else set())


def table_lines(page: Path) -> list[Line]:
    """The runs of a published table, each with its first reason.

    Raises:
        ValueError: If the kind of a reason is not known.
    """
    rows = ([cell.strip() for cell in text.strip("| ").split("|")] for text in _rows_of(page))
    lines: list[Line] = []
    for row in rows:
        walk, degradation, verdict, outcome, reason = (row[k] for k in (0, 1, 8, 9, 10))
        verdict = verdict.strip("()")
        kinds = {_kind_of(reason): verdict} if reason else {}
        run = {"walk": walk, "degradation": degradation, "verdict": verdict, "outcome": outcome}
        lines.append(run | {"kinds": kinds})
    return lines


def _rows_of(page: Path) -> list[str]:
    texts = (text.strip() for text in page.read_text("utf-8").splitlines())
    rows = [text for text in texts if text.count("|") == _COLUMNS + 1]
    return [text for text in rows if _WALK.fullmatch(text.split("|")[1].strip())]


def _kind_of(reason: str) -> str:
    for begin, kind in _FIRST_REASONS.items():
        if re.match(begin, reason):
            return kind
    raise ValueError(f"expected the first reason of a run, got {reason!r}")


def source_toml(lines: Sequence[Line], name: str, faults: Sequence[str] = ()) -> str:
    """The counts as a source of ``recon4/findings/measured.toml``; ``faults`` are kinds."""
    right = sum(line["outcome"] == "right" for line in lines)
    rows = [
        f"{kind} = {{ alarms = {n.alarms}, true = {n.true}, of_wrong = {n.of_wrong} }}"
        for kind, n in sorted(kind_counts(lines).items())
    ]
    head = ["[[sources]]", f'name = "{name}"', f"right = {right}", f"wrong = {len(lines) - right}"]
    counted = {kind: fault_counts(lines, kind) for kind in sorted(faults)}
    named = [
        f"{kind} = {{ {', '.join(f'{key} = {n}' for key, n in counts.items())} }}"
        for kind, counts in counted.items()
    ]
    return "\n".join(
        [*head, "[sources.kinds]", *rows, *(["[sources.faults]", *named] if named else [])]
    )


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
            _stated([line for line in lines if line["outcome"] == "right"]) + " (right runs)",
            _stated(lines) + " (all)",
        ]
    )


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("runs", type=Path, nargs="+")
    parser.add_argument("--toml", metavar="NAME", help="print a source of that name")
    parser.add_argument("--faults", metavar="KIND,…", default="", help="count them at any level")
    asked = parser.parse_args()
    lines = [
        line for path in asked.runs
        for line in (table_lines(path) if path.suffix == ".md" else read_lines(path))
    ]  # fmt: skip
    kinds = [kind for kind in asked.faults.split(",") if kind]
    print(source_toml(lines, asked.toml, kinds) if asked.toml else report(lines))


if __name__ == "__main__":
    main()
