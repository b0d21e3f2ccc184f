"""Warnings of readers are records: no sentence in a reader, and each says what its words quote."""

import ast
from pathlib import Path

import pytest

from recon4.findings.wording import catalog, whole_text
from recon4.locales.coded import CodedText
from recon4.model.finding_kinds import MOUNT_DOUBTS, FindingKind
from recon4.recording.report import ImportReport
from tests.source_trees import sources, trees_with

ROOT = Path(__file__).parents[3]
READERS = [*sources("recon4/recording"), ROOT / "recon4" / "slam2d" / "stage.py"]
OWN = {"sensor", "start_s", "end_s"}
"""Values with a place of their own in a finding; a text need not quote them."""


def calls():
    """Each call that warns: its place, its first argument, its values; None = also others."""
    for path, tree in trees_with(r"\bwarn(ing)?\(", READERS):
        if path.name == "report.py":
            continue
        for node in ast.walk(tree):
            if isinstance(node, ast.Call) and _name(node.func) in {"warn", "warning"}:
                values = {keyword.arg for keyword in node.keywords}
                yield f"{path.relative_to(ROOT)}:{node.lineno}", node.args[:1], values


def _name(func):
    return func.attr if isinstance(func, ast.Attribute) else getattr(func, "id", "")


def kinds_of(first):
    """The kinds that a call names, one or one of two; none = something else, such as a sentence."""
    match first:
        case [ast.Attribute(value=ast.Name(id="FindingKind"), attr=name)]:
            return [FindingKind[name]]
        case [ast.IfExp(body=one, orelse=other)]:
            return kinds_of([one]) + kinds_of([other])
    return []


CALLS = list(calls())
NAMED = [(place, kind, values) for place, a, values in CALLS for kind in kinds_of(a)]


def quoted(kind):
    """Values that any sentence of a kind quotes or depends on, and those of each sentence."""
    entry = catalog().kinds[kind]
    each = [one.quotes | ({one.given} - {""}) for one in entry.text]
    return set().union(*each, entry.remedy_quotes), each


def test_no_reader_warns_with_a_sentence():
    assert len(NAMED) > 90
    assert [place for place, first, _ in CALLS if not kinds_of(first)] == []


@pytest.mark.parametrize(("place", "kind", "values"), NAMED, ids=[place for place, _, _ in NAMED])
def test_a_warning_states_what_its_words_quote(place, kind, values):
    needed, each = quoted(kind)

    assert {name for name in values if name} - OWN <= needed, "values that nobody reads"
    if None not in values:
        assert any(one <= values | OWN for one in each), "no sentence has all of its values"


def test_each_kind_of_a_reader_is_in_its_catalog_and_no_other():
    by_report = {FindingKind.DATA_LOST}

    assert {kind for _, kind, _ in NAMED} | by_report == catalog().readers
    assert MOUNT_DOUBTS - {FindingKind.LASER_MOUNT} <= catalog().readers


def test_a_warning_quotes_a_reason_in_the_language_of_the_reader():
    report = ImportReport()
    why = CodedText("refused-count", number=9, total=9, what=CodedText("count-packets_hdl64"))

    report.warn(FindingKind.PACKETS_UNREAD, sender="a", packets=9, why=why)

    assert "9 of 9 data packets: blocks of the lower lasers" in whole_text(report.findings[0])
    assert "9 von 9 Datenpaketen: Blöcke der unteren Laser" in whole_text(report.findings[0], "de")
