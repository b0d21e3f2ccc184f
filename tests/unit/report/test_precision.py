"""Precision and recall of findings over runs of the proving ground."""

import tomllib
from pathlib import Path

import msgspec
import pytest

from recon4.findings.explain import MeasuredRuns, sources
from recon4.model.finding_kinds import FindingKind
from tests.benchmarks.precision import (
    NAMES,
    KindCounts,
    false_alarms,
    kind_counts,
    report,
    source_toml,
    stated_over_true,
    table_lines,
)
from tests.benchmarks.proving_ground import DEGRADATIONS
from tests.benchmarks.recorded_faults import FAULTS


def run(outcome, verdict, degradation="none", **kinds):
    named = {name.replace("_", "-"): level for name, level in kinds.items()}
    line = {"outcome": outcome, "verdict": verdict, "degradation": degradation, "kinds": named}
    return line | {"walk": "office/1"}


RUNS = [
    run("right", "good", TRACKING_KEPT="good"),
    run("right", "check", WEAK_DIRECTION="check"),
    run("right", "check", "extrinsics", RIG_CONTRADICTED="do not use"),
    run("right", "do not use", UNCERTAINTY="do not use"),
    run("announced", "do not use", WEAK_DIRECTION="do not use"),
]


def test_an_alarm_is_true_in_a_wrong_run_and_where_it_names_the_degradation():
    counts = kind_counts(RUNS)

    assert counts["WEAK-DIRECTION"] == KindCounts(alarms=2, true=1, of_wrong=1)
    assert counts["RIG-CONTRADICTED"] == KindCounts(alarms=1, true=1, of_wrong=0)
    assert "TRACKING-KEPT" not in counts


def test_right_runs_that_name_their_degradation_are_no_false_alarms():
    assert false_alarms(RUNS) == {"check": 1 / 3, "do not use": 1 / 3}
    assert "5 runs, 4 right, 0 silent" in report(RUNS)


def test_the_stated_uncertainty_is_compared_where_a_run_says_both():
    runs = [
        run("right", "good") | {"errors": {"shape_m": shape_m, "error_95_m": error_m}}
        for shape_m, error_m in ((0.02, 0.01), (0.05, 0.01), (0.001, 0.01))
    ]

    assert stated_over_true([*RUNS, *runs, {"errors": None}]) == pytest.approx([2.0, 5.0, 0.1])
    assert "3 runs: median 2.00, 1 within 0.5 to 4, 1 below, 1 above (right runs)" in report(runs)
    assert "not known of these runs" in report(RUNS)


def test_degradations_and_kinds_are_those_of_the_program():
    assert set(NAMES) <= {*DEGRADATIONS, *FAULTS}
    assert {kind for kinds in NAMES.values() for kind in kinds} <= set(FindingKind)


TABLE = """
| walk | degradation | ATE | largest | 2σ | NEES | earth | lost | verdict | class | first | code |
|---|---|---:|---:|---:|---:|---:|---:|---|---|---|---|
| mirrors/1 | none | 0.2 | 1 | 1 | 1 | - | 0 | check | right | A mirror or a glass wall of … | O |
| garage/1 | none | 0.2 | 1 | 1 | 1 | - | 0 | (check) | right | A mirror or a glass wall of … | O |
| tunnel/1 | none | 90 | 99 | 99 | 1 | - | 0 | do not use | announced | Tracking was lost in … | O |
| office/1 | none | 0.2 | 1 | 1 | 1 | - | 0 | good | right |  | O |
"""


def test_a_published_table_has_the_first_reason_of_each_run(tmp_path):
    (tmp_path / "trust.md").write_text(TABLE, "utf-8")

    lines = table_lines(tmp_path / "trust.md")

    assert [line["verdict"] for line in lines] == ["check", "check", "do not use", "good"]
    # In a hall of mirrors a mirror is none that the program made up.
    assert kind_counts(lines)["MIRROR"] == KindCounts(alarms=2, true=1, of_wrong=0)
    assert kind_counts(lines)["TRACKING-LOST"] == KindCounts(alarms=1, true=1, of_wrong=1)


def test_a_reason_of_no_known_kind_is_refused(tmp_path):
    (tmp_path / "trust.md").write_text(TABLE.replace("A mirror or", "Something"), "utf-8")

    with pytest.raises(ValueError, match="Something a glass wall"):
        table_lines(tmp_path / "trust.md")


def test_what_the_page_of_findings_quotes_is_what_was_counted():
    source = msgspec.convert(
        tomllib.loads(source_toml(RUNS, "five runs"))["sources"][0], MeasuredRuns
    )

    assert (source.right, source.wrong) == (4, 1)
    assert source.words(FindingKind.WEAK_DIRECTION) == (
        "2 alarms in 5 runs, 50 % of them true, in 1 of 1 wrong runs (five runs)"
    )
    assert source.words(FindingKind.MIRROR) == "no alarm in 5 runs (five runs)"


def test_a_note_is_counted_in_runs_with_and_without_its_fault():
    runs = [
        run("right", "good", "imu-lever-arm", IMU_LEVER_ARM="note"),
        run("right", "good", "imu-lever-arm"),
        run("right", "good", "none", IMU_LEVER_ARM="note"),
        run("right", "good", "imu-set", CLOCK_JUMP="note"),
    ]
    text = source_toml(runs, "four runs", ["IMU-LEVER-ARM", "CLOCK-JUMP"])
    source = msgspec.convert(tomllib.loads(text)["sources"][0], MeasuredRuns)

    assert source.words(FindingKind.IMU_LEVER_ARM) == (
        "said in 1 of 2 runs with its fault, in 1 of 2 without it (four runs)"
    )
    assert source.words(FindingKind.CLOCK_JUMP) == (
        "said in 1 of 1 runs with its fault, in 0 of 3 without it (four runs)"
    )


def test_the_published_table_is_counted_in_the_catalog():
    lines = table_lines(Path(__file__).parents[3] / "docs" / "studies" / "proving-ground.md")

    source = next(one for one in sources() if "table of all runs" in one.name)

    assert len(lines) == source.right + source.wrong
    counts = kind_counts(lines)
    assert {kind: found.alarms for kind, found in source.kinds.items()} == {
        kind: found.alarms for kind, found in counts.items()
    }
