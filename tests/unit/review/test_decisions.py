"""The fold over the journal."""

import json
import math
import re
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from recon4.errors import ConfigError, StoreError
from recon4.model.class_corrections import Anchor, ClassCorrection, Reclassified
from recon4.model.classes import PointClass
from recon4.model.site_control import SeenTarget, SiteControl
from recon4.model.volumes import Prism
from recon4.review.decisions import (
    CHANGE_NOTHING,
    NOTHING_DECIDED,
    Decision,
    DecisionKind,
    correction_id,
    fold,
)
from recon4.review.row_contents import ApprovalFacts, Measurement, SeenFinding, numbers_of, pose_of

CAPTIONS = Path(__file__).parents[3] / "web" / "review" / "captions.js"
HERE = (0.1, 0.2, 0.3, 0.0, 0.0, 0.0, 1.0)
MEASURED = Measurement(
    T_i_j=HERE,
    information=tuple(np.eye(6).ravel()),
    overlap=0.7,
    error_m=0.012,
    limit_m=0.05,
    degeneracy=math.nan,
    iterations=9,
)
SEEN = SeenFinding(
    kind="WEAK-DIRECTION",
    level="check",
    span_s=(40.0, 44.0),
    direction="horizontal",
    sensor="",
    values={"known": True, "sd_m": 0.4},
)


def control_points(*names):
    return SiteControl(
        targets=tuple(
            SeenTarget(
                id=name,
                xyz_m=(1.0, 2.0, 3.0),
                role="control",
                sd_m=(0.01, 0.01),
                t_ns=(5,),
                p_body_m=((0.1, 0.2, 0.3),),
                directions_body=(((1.0, 0.0, 0.0),),),
            )
            for name in names
        ),
        crs="",
    )


def correction(x=0.0):
    return ClassCorrection(
        what=Reclassified(
            volume=Prism(polygon_m=((x, 0.0), (x + 1.0, 0.0), (x, 1.0)), low_m=0.1, high_m=0.3),
            to=int(PointClass.MOVING),
            only=(int(PointClass.UNCLASSIFIED),),
        ),
        points=12,
        map_key="ab",
        anchors=(Anchor(t_ns=1_700_000_000_000_000_001, T_map_body=HERE),),
    )


def decide(kind, pair=(2, 7), who="Eva", **more):
    if kind in (DecisionKind.UNDO, DecisionKind.REDO, DecisionKind.APPROVE):
        return Decision(kind=kind, who=who, **more)
    if kind is DecisionKind.ACKNOWLEDGE:
        return Decision(kind=kind, who=who, **{"why": "seen on site", "finding": SEEN, **more})
    if kind is DecisionKind.CONTROL:
        return Decision(kind=kind, who=who, **{"control": control_points("A"), **more})
    if kind is DecisionKind.CLASSIFY:
        return Decision(kind=kind, who=who, **{"correction": correction(), **more})
    if kind is DecisionKind.WITHDRAW:
        return Decision(kind=kind, who=who, **{"withdraws": correction_id(correction()), **more})
    if kind in (DecisionKind.REPLACE, DecisionKind.ADD):
        more.setdefault("measurement", MEASURED)
    if kind is DecisionKind.COMMENT:
        more.setdefault("why", "glass")
    return Decision(kind=kind, who=who, pair=pair, **more)


def test_the_last_decision_about_a_pair_stands():
    decided = fold(
        [decide(DecisionKind.ACCEPT), decide(DecisionKind.REJECT, who="Jan", why="wrong floor")]
    )

    (one,) = decided.standing
    assert (one.accepted, one.who, one.why) == (False, "Jan", "wrong floor")


def test_restore_leaves_the_pair_to_the_program():
    assert not fold([decide(DecisionKind.REJECT), decide(DecisionKind.RESTORE)])


def test_undo_and_redo_go_back_and_forth():
    rows = [decide(DecisionKind.REJECT), decide(DecisionKind.ACCEPT, pair=(3, 9))]

    undone = fold([*rows, decide(DecisionKind.UNDO)])
    redone = fold([*rows, decide(DecisionKind.UNDO), decide(DecisionKind.REDO)])

    assert [one.pair for one in undone.standing] == [(2, 7)]
    assert (undone.undoable, undone.redoable) == (1, 1)
    assert redone == fold(rows)


def test_a_new_decision_forgets_what_could_be_redone():
    decided = fold(
        [decide(DecisionKind.REJECT), decide(DecisionKind.UNDO), decide(DecisionKind.ACCEPT)]
    )

    assert (decided.undoable, decided.redoable) == (1, 0)


def test_undoing_a_replacement_brings_back_the_decision_before_it():
    decided = fold(
        [decide(DecisionKind.REJECT), decide(DecisionKind.REPLACE), decide(DecisionKind.UNDO)]
    )

    assert decided == fold(
        [decide(DecisionKind.REJECT), decide(DecisionKind.REPLACE), decide(DecisionKind.UNDO)]
    )
    assert decided.standing[0].measurement is None
    assert not decided.standing[0].accepted


def test_a_measurement_stays_when_its_pair_is_rejected_and_accepted_again():
    decided = fold(
        [decide(DecisionKind.ADD), decide(DecisionKind.REJECT), decide(DecisionKind.ACCEPT)]
    )

    assert decided.standing[0].measurement == MEASURED


def test_an_approval_changes_nothing_and_is_not_undone():
    facts = ApprovalFacts(version=1, approval="ab")
    rows = [decide(DecisionKind.REJECT), decide(DecisionKind.APPROVE, facts=facts)]

    assert fold([*rows, decide(DecisionKind.UNDO)]) == fold(
        [decide(DecisionKind.REJECT), decide(DecisionKind.UNDO)]
    )
    with pytest.raises(StoreError, match="nothing to undo"):
        fold([decide(DecisionKind.APPROVE, facts=facts), decide(DecisionKind.UNDO)])


def test_an_acknowledgment_comes_back_from_the_journal_and_changes_nothing():
    note = decide(DecisionKind.ACKNOWLEDGE)
    body = json.loads(json.dumps(note.body()))

    assert Decision.of("acknowledge", "Eva", "seen on site", pair=None, body=body) == note
    rows = [decide(DecisionKind.REJECT), note]
    assert fold([*rows, decide(DecisionKind.UNDO)]).standing == ()
    assert "finding" not in decide(DecisionKind.REJECT).body()


@pytest.mark.parametrize(
    ("kind", "more"),
    [
        (DecisionKind.ACKNOWLEDGE, {"why": " "}),
        (DecisionKind.ACKNOWLEDGE, {"finding": None}),
        (DecisionKind.ACCEPT, {"finding": SEEN}),
    ],
)
def test_an_acknowledgment_has_a_finding_and_a_note_and_nothing_else_has(kind, more):
    with pytest.raises(ConfigError, match="a finding and a note"):
        decide(kind, **more)


def test_the_key_depends_on_what_stands_and_not_on_how_it_came_about():
    short = fold([decide(DecisionKind.REJECT, pair=(3, 9)), decide(DecisionKind.ACCEPT)])
    long = fold(
        [
            decide(DecisionKind.ACCEPT),
            decide(DecisionKind.ACCEPT, pair=(3, 9)),
            decide(DecisionKind.REJECT, pair=(3, 9)),
        ]
    )

    assert short.key == long.key
    assert short.key != fold([decide(DecisionKind.ACCEPT)]).key


def test_the_key_tells_apart_measurements_and_people():
    other = Measurement(**{**_fields(MEASURED), "T_i_j": (0.1 + 1e-15, *HERE[1:])})
    keys = {
        fold([decide(DecisionKind.REPLACE)]).key,
        fold([decide(DecisionKind.REPLACE, measurement=other)]).key,
        fold([decide(DecisionKind.REPLACE, who="Jan")]).key,
    }

    assert len(keys) == 3


def test_a_decision_survives_the_journal_bit_for_bit():
    before = decide(DecisionKind.ADD, why="čtvrté patro")

    after = Decision.of("add", before.who, before.why, pair=before.pair, body=before.body())

    assert after.body() == before.body()
    assert after.measurement.T_i_j == MEASURED.T_i_j
    assert math.isnan(after.measurement.degeneracy)


@pytest.mark.parametrize(
    "wrong",
    [
        {"kind": DecisionKind.ACCEPT, "who": "Eva"},
        {"kind": DecisionKind.UNDO, "who": "Eva", "pair": (1, 2)},
        {"kind": DecisionKind.ACCEPT, "who": "Eva", "pair": (7, 2)},
        {"kind": DecisionKind.ACCEPT, "who": "auto", "pair": (2, 7)},
        {"kind": DecisionKind.ADD, "who": "Eva", "pair": (2, 7)},
        {"kind": DecisionKind.ACCEPT, "who": "Eva", "pair": (2, 7), "measurement": MEASURED},
    ],
)
def test_an_invalid_decision_is_rejected(wrong):
    with pytest.raises(ValueError, match=r"decision|pair"):
        Decision(**wrong)


def test_a_row_of_another_program_is_refused():
    with pytest.raises(StoreError, match="no decision"):
        Decision.of("bless", "Eva", "", pair=(2, 7), body=decide(DecisionKind.ACCEPT).body())


def test_a_pose_as_numbers_reads_back():
    T = pose_of(HERE)

    assert numbers_of(T) == pytest.approx(HERE)


def test_the_last_control_points_place_the_map_and_none_of_them_places_it_as_without():
    first, second = (decide(DecisionKind.CONTROL, control=control_points(n)) for n in "AB")
    rows = [decide(DecisionKind.REJECT), first, second]
    assert fold(rows).control == control_points("B")
    assert fold([*rows, decide(DecisionKind.UNDO)]).control == control_points("A")
    removed = fold([*rows, decide(DecisionKind.CONTROL, control=control_points())])
    assert removed.control is None
    assert removed.key == fold([decide(DecisionKind.REJECT)]).key != fold(rows).key
    assert len({fold(rows).key, fold(rows[:2]).key}) == 2
    assert fold(rows).pairs_key == removed.key


def test_control_points_are_read_back_as_they_were_written():
    one = decide(DecisionKind.CONTROL)
    body = json.loads(json.dumps(one.body()))
    assert Decision.of("control", "Eva", "", pair=None, body=body) == one
    with pytest.raises(ConfigError, match="control points"):
        decide(DecisionKind.CONTROL, control=None)


def test_corrections_of_classes_apply_in_their_order_until_they_are_withdrawn():
    first, second = (decide(DecisionKind.CLASSIFY, correction=correction(x)) for x in (0.0, 5.0))
    rows = [decide(DecisionKind.REJECT), first, second]
    both = fold(rows)

    assert [one.correction for one in both.corrections] == [correction(0.0), correction(5.0)]
    assert fold([rows[0], second, first]).key != both.key
    one = fold([*rows, decide(DecisionKind.WITHDRAW)])
    assert one.corrections == both.corrections[1:]
    assert fold([*rows, decide(DecisionKind.WITHDRAW), decide(DecisionKind.UNDO)]) == replace(
        both, redoable=1
    )
    neither = fold([*rows, decide(DecisionKind.UNDO), decide(DecisionKind.UNDO)])
    assert neither.key == fold(rows[:1]).key
    assert neither.classes_key is None


def test_a_correction_of_classes_is_read_back_as_it_was_written():
    one = decide(DecisionKind.CLASSIFY)
    body = json.loads(json.dumps(one.body()))

    assert Decision.of("classify", "Eva", "", pair=None, body=body) == one
    body["correction"]["what"]["volume"]["high_m"] = 0.1
    with pytest.raises(StoreError, match="not empty"):
        Decision.of("classify", "Eva", "", pair=None, body=body)


@settings(max_examples=10)
@given(st.integers(0, 2**32 - 1))
def test_a_thousand_operations_and_undoing_all_of_them_is_the_beginning(seed):
    rng = np.random.default_rng(seed)
    rows = []
    undoable = redoable = 0
    for _ in range(1000):
        kind = list(DecisionKind)[rng.integers(len(DecisionKind))]
        if (kind is DecisionKind.UNDO and not undoable) or (
            kind is DecisionKind.REDO and not redoable
        ):
            continue
        pair = (int(rng.integers(5)), 5 + int(rng.integers(5)))
        rows.append(decide(kind, pair=pair, who=f"p{rng.integers(3)}"))
        if kind is DecisionKind.UNDO:
            undoable, redoable = undoable - 1, redoable + 1
        elif kind is DecisionKind.REDO:
            undoable, redoable = undoable + 1, redoable - 1
        elif kind not in CHANGE_NOTHING:
            undoable, redoable = undoable + 1, 0
    decided = fold(rows)
    assert (decided.undoable, decided.redoable) == (undoable, redoable)

    before = fold([*rows, *[decide(DecisionKind.UNDO)] * undoable])
    again = fold(
        [*rows, *[decide(DecisionKind.UNDO)] * undoable, *[decide(DecisionKind.REDO)] * undoable]
    )

    assert before.key == NOTHING_DECIDED.key
    assert again.key == decided.key


def _fields(record):
    return {name: getattr(record, name) for name in record.__slots__}


def test_the_page_of_the_review_has_words_for_every_kind_of_row():
    block = CAPTIONS.read_text("utf-8").partition("export const KINDS = {")[2].partition("};")[0]
    assert {*re.findall(r"^  (\w+):", block, re.MULTILINE)} == {*DecisionKind}
