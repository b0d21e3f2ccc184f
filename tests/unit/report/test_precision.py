"""Precision and recall of findings over runs of the proving ground."""

from recon4.findings.kinds import FindingKind
from tests.benchmarks.precision import NAMES, KindCounts, false_alarms, kind_counts, report
from tests.benchmarks.proving_ground import DEGRADATIONS


def run(outcome, verdict, degradation="none", **kinds):
    named = {name.replace("_", "-"): level for name, level in kinds.items()}
    return {"outcome": outcome, "verdict": verdict, "degradation": degradation, "kinds": named}


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


def test_degradations_and_kinds_are_those_of_the_program():
    assert set(NAMES) <= set(DEGRADATIONS)
    assert {kind for kinds in NAMES.values() for kind in kinds} <= set(FindingKind)
