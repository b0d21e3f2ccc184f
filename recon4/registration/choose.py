"""The one place where the odometry decides what to assume: files and live, windows and walks.

    trials = choose(hypotheses, track, most=6)

`hypotheses` lists them lazily: the next one may depend on what those before have shown. `track`
tries one. What is compared, and what a hypothesis must show, is in `Score` and `Proof`.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass, field
from itertools import islice
from typing import Generic, Protocol, TypeVar

from recon4.model.tried_hypotheses import TrialVerdict
from recon4.registration.hypothesis import Hypothesis, Proof
from recon4.registration.score import Score


class Tracked(Protocol):
    """What tracking with a hypothesis leaves."""

    @property
    def score(self) -> Score:
        """What it is worth."""


OfTracked = TypeVar("OfTracked", bound=Tracked)


@dataclass(frozen=True, slots=True, eq=False)
class TrialRow:
    """What the table says of a hypothesis that was tried."""

    hypothesis: Hypothesis
    score: Score
    verdict: TrialVerdict


@dataclass(frozen=True, slots=True, eq=False)
class Trial(Generic[OfTracked]):
    """A hypothesis that was tried, with what it left: a walk takes 0.1 GB an hour."""

    row: TrialRow
    tracked: OfTracked

    @property
    def hypothesis(self) -> Hypothesis:
        """What was assumed."""
        return self.row.hypothesis

    @property
    def verdict(self) -> TrialVerdict:
        """How it compares with its rival."""
        return self.row.verdict


@dataclass(slots=True, eq=False)
class Trials(Generic[OfTracked]):
    """The table of what was tried, in order; of only two is kept what they left."""

    rows: list[TrialRow] = field(default_factory=list)
    _best: Trial[OfTracked] | None = None
    _last: Trial[OfTracked] | None = None

    @property
    def best(self) -> Trial[OfTracked]:
        """The last one that was preferred to its rival."""
        assert self._best is not None, "nothing was tried"
        return self._best

    @property
    def last(self) -> Trial[OfTracked]:
        """The newest one."""
        assert self._last is not None, "nothing was tried"
        return self._last

    def add(self, hypothesis: Hypothesis, tracked: OfTracked) -> None:
        """Compare a hypothesis with its rival; it is the best one from now on if it wins."""
        best = self._best.tracked.score if self._best else None
        score = tracked.score
        row = TrialRow(hypothesis, score, _verdict(hypothesis, score, best))
        self.rows.append(row)
        self._last = Trial(row, tracked)
        if row.verdict.wins:
            self._best = self._last


def choose(
    hypotheses: Callable[[Trials[OfTracked]], Iterator[Hypothesis]],
    track: Callable[[Hypothesis], OfTracked],
    *,
    most: int,
) -> Trials[OfTracked]:
    """Try hypotheses until there are no more.

    Args:
        hypotheses: Lists them, given the table so far.
        track: Tries one.
        most: No more than this many are tried.
    """
    trials: Trials[OfTracked] = Trials()
    for hypothesis in islice(hypotheses(trials), most):
        trials.add(hypothesis, track(hypothesis))
    return trials


def _verdict(hypothesis: Hypothesis, score: Score, best: Score | None) -> TrialVerdict:
    rival = hypothesis.rival or best
    if rival is None:
        return TrialVerdict.FIRST
    match hypothesis.proof:
        case Proof.CLEARLY_BETTER:
            return score.clearly_better(rival)
        case Proof.NO_WORSE:
            return score.no_worse(rival)
        case Proof.HOLDS | Proof.HOLDS_WITH_FIXES as proof:
            return score.holds(rival, with_fixes=proof is Proof.HOLDS_WITH_FIXES)
