"""How people share the review of pairs: who has a pair, what was said, and whether two agree.

All of it is rows of the journal, so an approval signs it with the decisions.
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass, field
from enum import StrEnum

from recon4.locales.languages import ENGLISH
from recon4.locales.texts import texts
from recon4.review.decisions import MEASURED, VERDICTS, Decision, DecisionKind, Pair, not_undone


class OpinionAgreement(StrEnum):
    """What the people who decided about a pair say together."""

    NONE = "none"
    """Nobody decided."""
    ONE = "one"
    """One person decided."""
    AGREE = "agree"
    """At least two decided, all alike."""
    DISAGREE = "disagree"


@dataclass(frozen=True, slots=True)
class Opinion:
    """The last decision of a person about a pair as it is measured now."""

    who: str
    accepted: bool


@dataclass(slots=True, kw_only=True)
class PairWork:
    """The work of people on a pair."""

    pair: Pair
    assignee: str = ""
    """Who has it; empty = nobody."""
    skipped_by: str = ""
    """Who left it for later; empty = nobody since the last decision about it."""
    second_by: str = ""
    """Who asked for a second opinion; empty = nobody."""
    comments: int = 0
    opinions: list[Opinion] = field(default_factory=list)
    """Of each person one, in the order in which they were given."""

    @property
    def agreement(self) -> OpinionAgreement:
        """What they say together."""
        if len(self.opinions) < 2:
            return OpinionAgreement.ONE if self.opinions else OpinionAgreement.NONE
        alike = len({one.accepted for one in self.opinions}) == 1
        return OpinionAgreement.AGREE if alike else OpinionAgreement.DISAGREE

    @property
    def waits(self) -> bool:
        """Whether a second opinion was asked for, and two people do not agree yet."""
        return bool(self.second_by) and self.agreement is not OpinionAgreement.AGREE


def team_work(decisions: Sequence[Decision]) -> list[PairWork]:
    """The work on each pair that people decided or talked about, ordered by pair.

    Args:
        decisions: All rows of a journal, oldest first.

    Raises:
        StoreError: If the journal is damaged.
    """
    work: dict[Pair, PairWork] = {}
    in_force, _ = not_undone(decisions)
    for decision in in_force:
        if decision.pair is not None and decision.kind in VERDICTS:
            _judge(work.setdefault(decision.pair, PairWork(pair=decision.pair)), decision)
    for decision in decisions:
        if decision.pair is not None:
            _take_work(work.setdefault(decision.pair, PairWork(pair=decision.pair)), decision)
    return [work[pair] for pair in sorted(work)]


def second_opinion_missing(decisions: Iterable[Decision], language: str = ENGLISH) -> str:
    """On which pair two people do not agree yet though that was asked for; empty = on none."""
    waiting = [one for one in team_work(list(decisions)) if one.waits]
    if not waiting:
        return ""
    i, j = waiting[0].pair
    say, others = texts(language, "review"), len(waiting) - 1
    who = waiting[0].second_by
    return say("second-opinion-missing", who=who, i=str(i), j=str(j), others=others)


def _judge(one: PairWork, decision: Decision) -> None:
    """Take a verdict; a new measurement makes what was said about the one before void."""
    if decision.kind is DecisionKind.RESTORE or decision.kind in MEASURED:
        one.opinions = []
    if decision.kind is not DecisionKind.RESTORE:
        accepted = decision.kind is not DecisionKind.REJECT
        others = [opinion for opinion in one.opinions if opinion.who != decision.who]
        one.opinions = [*others, Opinion(decision.who, accepted)]


def _take_work(one: PairWork, decision: Decision) -> None:
    if decision.kind is DecisionKind.ASSIGN:
        one.assignee = decision.assignee
    elif decision.kind is DecisionKind.COMMENT:
        one.comments += 1
    elif decision.kind is DecisionKind.SKIP:
        one.skipped_by = decision.who
    elif decision.kind is DecisionKind.SECOND:
        one.second_by = decision.who
    elif decision.kind is DecisionKind.WAIVE:
        one.second_by = ""
    else:
        one.skipped_by = ""
