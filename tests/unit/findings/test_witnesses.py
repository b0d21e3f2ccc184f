"""Witnesses are found by their folder, and findings are shown in the order of their kinds."""

from recon4.findings.audit import witnesses
from recon4.findings.witnesses.speed import Speed
from recon4.model.finding import Finding, Level, worst_first
from recon4.model.finding_kinds import FindingKind

LOOPS, LOST, MIRROR = (
    FindingKind.LOOPS_NONE, FindingKind.TRACKING_LOST, FindingKind.MIRROR,
)  # fmt: skip


def test_every_witness_of_the_folder_is_asked_once():
    asked = [type(one) for one in witnesses()]

    assert Speed in asked and len(asked) >= 30
    assert len(asked) == len(set(asked))


def test_the_worst_comes_first_and_then_the_order_of_the_kinds():
    found = [
        Finding(kind=MIRROR, level=Level.CHECK),
        Finding(kind=LOST, level=Level.CHECK, values={"lost": 2}),
        Finding(kind=LOST, level=Level.CHECK, values={"lost": 1}),
        Finding(kind=LOOPS, level=Level.DO_NOT_USE),
    ]

    assert worst_first(found) == (found[3], found[1], found[2], found[0])
