"""Every count that a reader keeps has words, and those of lost data reach the operator."""

import ast

import pytest

from recon4.findings.wording import whole_text
from recon4.locales.texts import texts
from recon4.model.count_meanings import COUNT_MEANINGS, CountKind
from recon4.model.import_counts import count_text, losses, meaning
from recon4.recording.report import ImportReport
from tests.source_trees import sources, trees_with
from tests.warned import K, findings_of, kinds


def is_count(call: ast.Call) -> bool:
    """Whether a call is `ImportReport.count`, by the name of the report."""
    if not isinstance(call.func, ast.Attribute) or call.func.attr != "count":
        return False
    return ast.unparse(call.func.value).split(".")[-1].lstrip("_") == "report"


def names_in(node: ast.expr) -> set[str]:
    """Names of counts in an argument; of an f-string without fixed end, its start."""
    if isinstance(node, ast.JoinedStr):
        return {text for kind in ("imu", "gnss", "NAME") if (text := filled(node, kind))}
    found = {n.value for n in ast.walk(node) if isinstance(n, ast.Constant)}
    return {value for value in found if isinstance(value, str)}


def filled(node: ast.JoinedStr, value: str) -> str:
    """An f-string with a value: of samples, or the name of a sensor at its end."""
    sensor = isinstance(node.values[-1], ast.FormattedValue)
    if sensor != (value == "NAME"):
        return ""
    parts = [part.value if isinstance(part, ast.Constant) else value for part in node.values]
    return "".join(map(str, parts))


def counted() -> set[tuple[str, str]]:
    """File and name of every count in the code."""
    found = set()
    for path, tree in trees_with(r"report\s*\.count\(", sources("recon4")):
        for node in ast.walk(tree):
            if isinstance(node, ast.Call) and is_count(node):
                found |= {(path.name, name) for name in names_in(node.args[0])}
    return found


def test_every_count_of_the_code_has_words():
    found = counted()
    assert len(found) > 60
    for file, name in sorted(found):
        try:
            meaning(name)
        except KeyError:
            pytest.fail(f"{file} counts {name!r}: list it in recon4/model/count_meanings.py")


def test_every_count_refers_to_what_was_read_and_has_words():
    words = texts("en", "counts")
    for name, found in COUNT_MEANINGS.items():
        parts = words.parts(f"count-{name}")
        if found.of:
            assert COUNT_MEANINGS[found.of].kind is CountKind.READ, name
        elif found.kind is not CountKind.READ:
            assert "noun" in parts, name


def test_a_loss_says_how_many_of_how_many():
    counts = {"packets": 1000, "packets_missing": 250}
    assert losses(counts)[0].ratio == 0.2
    assert count_text("packets_missing", counts).startswith("250 of 1250 data packets: never")


def test_large_losses_are_warnings_and_small_ones_are_listed():
    report = ImportReport()
    report.count("packets", 10_000)
    report.count("packets_late", 99)
    report.count("packets_wrong_flag", 100)
    report.warn_of_losses()
    assert kinds(report) == [K.DATA_LOST]
    assert "100 of 10000 data packets: " in whole_text(findings_of(report)[0])
    assert len(report.lost()) == 2


def test_what_the_reader_itself_says_is_not_repeated():
    report = ImportReport()
    report.count("messages", 10)
    report.count("messages_corrupt", 5)
    report.warn_of_losses()
    assert not report.findings and "5 of 10 messages" in report.lost()[0]


def test_good_recordings_are_not_accused():
    report = ImportReport()
    for name in ("points_no_return", "points_near", "points_far", "points_invalid"):
        report.count(name, 10**6)
    report.count("points", 10)
    report.count("records_not_udp", 50)
    report.count("nmea_no_fix", 50)
    report.warn_of_losses()
    assert not report.findings and not report.lost() and not report.repaired()


def test_counts_of_one_sensor_name_it():
    text = count_text("packets_missing_vertical", {"packets_missing_vertical": 3})
    assert text == "3 data packets: never arrived of this sensor (vertical)"
