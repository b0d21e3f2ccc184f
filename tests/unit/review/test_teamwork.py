"""Several people on one pair: opinions, questions, and what an approval waits for."""

import pytest

from recon4.errors import ConfigError
from recon4.review.decisions import Decision, DecisionKind, fold
from recon4.review.journal import JournalChanged, append, broken, read_decided, read_rows
from recon4.review.teamwork import OpinionAgreement, second_opinion_missing, team_work
from tests.unit.review.test_decisions import HERE, MEASURED

PAIR = (2, 7)


def row(kind, who="Eva", pair=PAIR, **more):
    return Decision(kind=DecisionKind(kind), who=who, pair=pair, **more)


def undo():
    return Decision(kind=DecisionKind.UNDO, who="Eva")


def of(*rows):
    (work,) = team_work(rows)
    return work


def test_two_people_agree_disagree_and_change_their_mind():
    accepted, rejected = row("accept"), row("reject", "Jan")

    assert of(accepted).agreement is OpinionAgreement.ONE
    assert of(accepted, row("accept", "Jan")).agreement is OpinionAgreement.AGREE
    assert of(accepted, rejected).agreement is OpinionAgreement.DISAGREE
    assert of(accepted, rejected, row("accept", "Jan")).agreement is OpinionAgreement.AGREE
    assert of(accepted, row("accept")).agreement is OpinionAgreement.ONE  # the same person twice
    assert of(accepted, rejected, undo()).agreement is OpinionAgreement.ONE
    assert of(accepted, rejected, row("restore", "Jan")).agreement is OpinionAgreement.NONE


def test_an_opinion_about_an_earlier_measurement_is_void():
    work = of(row("accept"), row("replace", "Jan", measurement=MEASURED))

    assert [one.who for one in work.opinions] == ["Jan"]


def test_an_approval_waits_until_two_people_agree():
    asked = [row("accept"), row("second")]

    assert "Eva asked for a second opinion on multiframes 2 and 7" in second_opinion_missing(asked)
    assert second_opinion_missing([*asked, row("reject", "Jan")])
    assert second_opinion_missing([*asked, row("accept", "Jan")]) == ""
    assert second_opinion_missing([*asked, row("waive", "Jan")]) == ""
    assert second_opinion_missing([row("accept")]) == ""


def test_a_second_opinion_that_agrees_leaves_the_map_as_it_is():
    asked = [row("accept", T_i_j=HERE), row("second")]
    agrees = row("accept", "Jan", T_i_j=HERE)

    assert fold([*asked, agrees]).key == fold(asked).key == fold(asked[:1]).key
    assert fold([asked[0], agrees]).standing[0].who == "Jan"  # nobody asked: as before
    assert fold([*asked, row("reject", "Jan", T_i_j=HERE)]).standing[0].who == "Jan"
    moved = (1.0, *HERE[1:])
    assert fold([*asked, row("accept", "Jan", T_i_j=moved)]).standing[0].T_i_j == moved


def test_sharing_the_work_changes_no_decision_and_no_undo():
    shared = [
        row("assign", assignee="Jan"),
        row("comment", why="glass"),
        row("skip"),
        row("comment", "Jan", why="a mirror"),
    ]

    decided = fold([row("accept"), *shared])

    assert decided.key == fold([row("accept")]).key and decided.undoable == 1
    work = of(row("accept"), *shared)
    assert (work.assignee, work.comments, work.skipped_by) == ("Jan", 2, "Eva")
    assert of(*shared, row("reject")).skipped_by == ""
    assert of(*shared, row("assign")).assignee == ""
    assert fold([row("accept"), *shared, undo()]).undoable == 0


def test_it_is_kept_in_the_journal(tmp_path):
    append(tmp_path, row("assign", assignee="Jan"))
    append(tmp_path, row("comment", why="glass"))

    rows = read_rows(tmp_path)

    assert broken(rows) == []
    assert of(*(one.decision() for one in rows)).assignee == "Jan"
    assert not read_decided(tmp_path)


def test_a_step_passes_over_talk_but_not_over_decisions(tmp_path):
    append(tmp_path, row("accept"))
    append(tmp_path, row("comment", "Jan", why="glass"))

    append(tmp_path, undo(), after_seq=1)
    with pytest.raises(JournalChanged):
        append(tmp_path, Decision(kind=DecisionKind.REDO, who="Eva"), after_seq=1)
    approve = Decision(kind=DecisionKind.APPROVE, who="Eva")
    with pytest.raises(JournalChanged):  # who signs has read what was said
        append(tmp_path, approve, after_seq=2)


def test_no_decision_about_a_pair_is_replaced_unseen(tmp_path):
    append(tmp_path, row("accept"))
    append(tmp_path, row("comment", "Jan", why="glass"))

    with pytest.raises(JournalChanged, match="Eva decided about this pair meanwhile"):
        append(tmp_path, row("reject", "Jan"), seen_seq=0)
    with pytest.raises(JournalChanged, match="Eva decided"):
        append(tmp_path, row("reject", "Jan"))  # it is not known what Jan saw
    with pytest.raises(JournalChanged, match="in another window"):
        append(tmp_path, row("reject"), seen_seq=0)
    append(tmp_path, row("reject"))  # one's own, by a program
    append(tmp_path, row("reject", "Jan", pair=(2, 9)), seen_seq=0)
    append(tmp_path, row("accept", "Jan"), seen_seq=3)


@pytest.mark.parametrize(
    ("kind", "more"),
    [("comment", {}), ("comment", {"why": " "}), ("skip", {"assignee": "Jan"})],
)
def test_what_makes_no_sense_is_refused(kind, more):
    with pytest.raises(ConfigError):
        row(kind, **more)


@pytest.mark.parametrize("kind", ["assign", "comment", "skip", "second", "waive"])
def test_all_of_it_is_about_a_pair(kind):
    with pytest.raises(ConfigError, match="names a pair"):
        row(kind, pair=None, why="text")
