"""What readers derive is records: no sentence in a reader, words only in the catalog."""

import ast
import json
import re
from pathlib import Path

import pytest

from recon4.errors import StoreError
from recon4.findings.derived import derived_sentences, derived_text, said_derived
from recon4.findings.explain import explained
from recon4.locales.languages import ENGLISH, ROOT
from recon4.locales.texts import messages_of
from recon4.model.derived import Derived
from recon4.model.derived_kinds import DerivedKind
from recon4.model.finding_kinds import FindingKind
from recon4.model.import_notes import derived_in
from recon4.recording.info.records import RecordingInfo
from recon4.recording.kinds import RecordingKind
from recon4.recording.report import ImportReport
from tests.source_trees import sources, trees_with

CODE = Path(__file__).parents[3]
MADE_IN = {"info", "frame_files"}
"""Rooms of `recon4/recording/` with functions that make such records."""
FROZEN = Path(__file__).with_name("report_with_sentences.json")
"""``report.json`` of a version that wrote sentences."""
WORDS = re.compile(r"[A-Za-z]{2,} [a-z]{2,}")
"""Two words one after the other: the begin of a sentence."""
UNIT = Derived(kind=DerivedKind.CLOCK_BY_GPS, values={"sensor": "front", "off_s": 1.5})


def calls():
    """Each call that states what is derived: its place, its first argument, its values."""
    for path, tree in trees_with(r"\bderived?\(|\bDerived\(", sources("recon4")):
        for node in ast.walk(tree):
            if isinstance(node, ast.Call) and getattr(node.func, "attr", "") == "derive":
                yield f"{path.relative_to(CODE)}:{node.lineno}", node.args, node.keywords
            elif kind := made(node, path):
                yield f"{path.relative_to(CODE)}:{node.lineno}", [kind], [ast.keyword(None, node)]


def made(node, path):
    """The kind of a record that a reader makes itself, such as `RecordingInfo.walk`."""
    if (
        path.parent.name in MADE_IN
        and isinstance(node, ast.Call)
        and getattr(node.func, "id", "") == "Derived"
    ):
        return next(one.value for one in node.keywords if one.arg == "kind")
    return None


CALLS = list(calls())


def kind_of(arguments):
    """The kind that a call names; None = it names none, for example states a sentence."""
    match arguments:
        case [ast.Attribute(value=ast.Name(id="DerivedKind"), attr=name)]:
            return DerivedKind[name]
    return None


def quoted(kind):
    """Values that any sentence of a kind quotes or depends on."""
    return set().union(*(one.quotes | ({one.given} - {""}) for one in derived_sentences(kind)))


def texts_in(keyword):
    """The texts that a value of a call is made of."""
    return [one.value for one in ast.walk(keyword.value) if isinstance(one, ast.Constant)]


def test_no_reader_states_a_sentence():
    assert len(CALLS) > 90
    assert [place for place, arguments, _ in CALLS if kind_of(arguments) is None] == []
    assert [
        (place, text)
        for place, _, keywords in CALLS
        for keyword in keywords
        for text in texts_in(keyword)
        if isinstance(text, str) and WORDS.search(text)
    ] == []


def test_a_reader_states_what_the_words_quote():
    unread = {
        place: left
        for place, arguments, keywords in CALLS
        if (left := {one.arg for one in keywords if one.arg} - quoted(kind_of(arguments)))
    }

    assert unread == {}, "values that nobody reads"


def test_a_reader_states_all_values_of_some_sentence():
    silent = []
    for place, arguments, keywords in CALLS:
        values = {one.arg for one in keywords}
        sentences = derived_sentences(kind_of(arguments))
        if None not in values and not any(one.quotes <= values for one in sentences):
            silent.append(place)

    assert silent == []


def test_faults_of_topics_are_values_that_the_words_quote():
    code = "".join(
        (CODE / "recon4" / "recording" / "bags" / name).read_text("utf-8")
        for name in ("topic_contents.py", "topic_choice.py")
    )
    named = set(re.findall(r'Fault\([\d.]+, "(\w+)"|less(?:: str)? ?= ?"(\w+)"', code))
    names = {one for pair in named for one in pair if one}

    assert len(names) > 12
    assert names <= quoted(DerivedKind.TOPIC_LEFT_OUT)


def test_each_kind_has_words_and_some_reader_and_no_finding_has_its_code():
    used = {kind_of(arguments) for _, arguments, _ in CALLS}

    assert set(DerivedKind) - used == {DerivedKind.EARLIER_SENTENCE}
    assert set(messages_of(ROOT / ENGLISH / "derived.ftl")) == set(map(str, DerivedKind))
    assert all(derived_sentences(kind) for kind in DerivedKind)
    assert set(map(str, DerivedKind)).isdisjoint(map(str, FindingKind))
    assert all(kind.name == kind.value.replace("-", "_") for kind in DerivedKind)


def test_the_same_is_derived_once_and_what_is_no_number_is_left_out():
    report = ImportReport()
    for _ in range(2):
        report.derive(DerivedKind.CLOCK_BY_GPS, sensor="front", off_s=1.5)
    report.derive(DerivedKind.RANGE_LARGEST, limit_m=float("nan"))

    assert report.derived == [UNIT, Derived(kind=DerivedKind.RANGE_LARGEST)]
    assert derived_text(report.derived[1]) == "RANGE-LARGEST"


def test_a_record_is_said_in_any_language():
    assert derived_text(UNIT).endswith("the recorder's clock is +1.500 s off UTC.")
    assert derived_text(UNIT, "de").endswith("weicht um +1,500 s von UTC ab.")
    assert said_derived(UNIT) == {
        "kind": "CLOCK-BY-GPS",
        "values": {"sensor": "front", "off_s": 1.5},
        "text": derived_text(UNIT),
    }
    assert "recorder's clock is ‹off_s› s off UTC" in explained("clock-by-gps")


def test_info_says_it_as_lines_and_as_a_record_with_its_text():
    info = RecordingInfo(path="a", kind=RecordingKind.PCAP.text, bytes=0, derived=(UNIT,))

    assert info.lines("de")[-1] == f"gefolgert {derived_text(UNIT, 'de')}"
    assert info.to_json("de")["derived"] == [said_derived(UNIT, "de")]


def test_sentences_of_an_earlier_import_are_said_as_they_are():
    stored = json.loads(FROZEN.read_text())

    assert [derived_text(one) for one in derived_in(stored)] == stored["derived"]
    assert [derived_text(one, "de") for one in derived_in(stored)] == stored["derived"]


def test_what_an_import_stores_is_read_again_and_what_is_damaged_refused():
    stored = json.loads(json.dumps({"derived": [{"kind": UNIT.kind, "values": UNIT.values}]}))

    assert derived_in(stored) == (UNIT,)
    assert derived_in({}) == ()
    with pytest.raises(StoreError, match=r"report\.json"):
        derived_in({"derived": [{"kind": "NO-SUCH"}]})


@pytest.mark.parametrize(("last_s", "ends"), [(4, "4.00 s"), (-4, "its times run backward")])
def test_a_recording_that_plays_backward_is_named_so(last_s, ends):
    begin_ns, end_ns = 10**18, 10**18 + last_s * 10**9
    info = RecordingInfo(
        path="a", kind=RecordingKind.PCAP.text, bytes=0, t_first_ns=begin_ns, t_last_ns=end_ns
    )
    (time,) = [line for line in info.lines() if line.startswith("time ")]
    assert ", 4.00 s" in time
    assert time.endswith(ends)
